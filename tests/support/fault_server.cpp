#include "support/fault_server.h"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <system_error>
#include <utility>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <unistd.h>

namespace meridian {

namespace {

/// A proxy that the machine may have is not for servers on loopback. Set before there are threads.
[[maybe_unused]] const int isWithoutProxy = ::setenv("no_proxy", "127.0.0.1,localhost", 1);

bool sendAll(int connection, const std::string& bytes) {
  std::size_t sent = 0;
  while (sent < bytes.size()) {
    const ssize_t now = ::send(connection, bytes.data() + sent, bytes.size() - sent, MSG_NOSIGNAL);
    if (now <= 0) {
      return false;
    }
    sent += static_cast<std::size_t>(now);
  }
  return true;
}

FaultServer::Request parse(const std::string& head) {
  FaultServer::Request request;
  const std::size_t first = head.find(' ');
  request.target = head.substr(first + 1, head.find(' ', first + 1) - first - 1);
  for (std::size_t line = head.find("\r\n"); line != std::string::npos;) {
    const std::size_t end = head.find("\r\n", line + 2);
    const std::string text = head.substr(line + 2, end == std::string::npos ? end : end - line - 2);
    if (const std::size_t colon = text.find(": "); colon != std::string::npos) {
      std::string name = text.substr(0, colon);
      std::transform(name.begin(), name.end(), name.begin(),
                     [](unsigned char letter) { return static_cast<char>(std::tolower(letter)); });
      request.headers[name] = text.substr(colon + 2);
    }
    line = end;
  }
  return request;
}

}  // namespace

FaultServer::FaultServer() {
  listen();
}

FaultServer::~FaultServer() {
  refuse();
}

std::string FaultServer::url(const std::string& target) const {
  return "http://127.0.0.1:" + std::to_string(port_) + target;
}

void FaultServer::on(const std::string& target, Reply reply) {
  on(target, [reply = std::move(reply)](const Request&) { return reply; });
}

void FaultServer::on(const std::string& target, Handler handler) {
  const std::lock_guard lock(mutex_);
  handlers_[target] = std::move(handler);
}

void FaultServer::onAnything(Handler handler) {
  const std::lock_guard lock(mutex_);
  fallback_ = std::move(handler);
}

void FaultServer::listen() {
  const int listener = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  const int yes = 1;
  ::setsockopt(listener, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  address.sin_port = htons(static_cast<std::uint16_t>(port_));
  socklen_t size = sizeof address;
  if (::bind(listener, reinterpret_cast<sockaddr*>(&address), size) != 0 || ::listen(listener, 128) != 0 ||
      ::getsockname(listener, reinterpret_cast<sockaddr*>(&address), &size) != 0) {
    throw std::system_error(errno, std::generic_category(), "the fault server cannot listen");
  }
  const std::lock_guard lock(mutex_);
  stopping_ = false;
  port_ = ntohs(address.sin_port);
  listener_ = listener;
  accepting_ = std::thread([this, listener] {
    for (;;) {
      const int connection = ::accept4(listener, nullptr, nullptr, SOCK_CLOEXEC);
      if (connection < 0) {
        return;
      }
      const int noDelay = 1;
      ::setsockopt(connection, IPPROTO_TCP, TCP_NODELAY, &noDelay, sizeof noDelay);
      const std::lock_guard held(mutex_);
      if (stopping_) {
        ::close(connection);
        continue;
      }
      ++accepted_;
      open_.push_back(connection);
      connections_.emplace_back([this, connection] { serve(connection); });
    }
  });
}

void FaultServer::refuse() {
  std::vector<std::thread> connections;
  {
    const std::lock_guard lock(mutex_);
    if (listener_ < 0) {
      return;
    }
    stopping_ = true;
    ::shutdown(listener_, SHUT_RDWR);
    for (const int connection : open_) {
      ::shutdown(connection, SHUT_RDWR);
    }
  }
  ending_.notify_all();
  accepting_.join();
  {
    const std::lock_guard lock(mutex_);
    ::close(listener_);
    listener_ = -1;
    connections.swap(connections_);
  }
  for (std::thread& thread : connections) {
    thread.join();
  }
}

void FaultServer::serve(int connection) {
  std::string received;
  char buffer[4096];
  for (bool isOpen = true; isOpen;) {
    std::size_t end = received.find("\r\n\r\n");
    while (end == std::string::npos) {
      const ssize_t size = ::recv(connection, buffer, sizeof buffer, 0);
      if (size <= 0) {
        break;
      }
      received.append(buffer, static_cast<std::size_t>(size));
      end = received.find("\r\n\r\n");
    }
    if (end == std::string::npos) {
      break;
    }
    Request request = parse(received.substr(0, end));
    received.erase(0, end + 4);
    const Reply reply = replyTo(request);
    isOpen = answer(connection, request, reply);
    const std::lock_guard lock(mutex_);
    --atOnce_;
  }
  const std::lock_guard lock(mutex_);
  std::erase(open_, connection);
  ::close(connection);
}

FaultServer::Reply FaultServer::replyTo(Request& request) {
  Handler handler;
  {
    const std::lock_guard lock(mutex_);
    request.attempt = counts_[request.target]++;
    ledger_.push_back(request);
    mostAtOnce_ = std::max(mostAtOnce_, ++atOnce_);
    const auto known = handlers_.find(request.target);
    handler = known == handlers_.end() ? fallback_ : known->second;
  }
  return handler ? handler(request) : Reply{.status = 404};
}

/// False when the connection is to be closed.
bool FaultServer::answer(int connection, const Request&, const Reply& reply) {
  using Fault = Reply::Fault;
  if (reply.fault == Fault::CloseAtOnce) {
    return false;
  }
  if (reply.fault == Fault::StallAtOnce) {
    waitForEnd();
    return false;
  }
  std::size_t length = reply.body.size();
  length = reply.fault == Fault::PromiseMore ? length * 2 : reply.fault == Fault::PromiseLess ? length / 2 : length;
  std::string head = "HTTP/1.1 " + std::to_string(reply.status) + " Said\r\n";
  for (const std::string& header : reply.headers) {
    head += header + "\r\n";
  }
  while (reply.fault == Fault::EndlessHeaders) {
    if (!sendAll(connection, std::exchange(head, "X-More: and more and more\r\n"))) {
      return false;
    }
  }
  if (reply.status != 204 && reply.status != 304) {
    head += "Content-Length: " + std::to_string(length) + "\r\n";
  }
  head += "\r\n";
  const std::string half = reply.body.substr(0, reply.body.size() / 2);
  switch (reply.fault) {
    case Fault::StallInBody:
      sendAll(connection, head + half);
      waitForEnd();
      return false;
    case Fault::Truncate:
      sendAll(connection, head + half);
      return false;
    case Fault::Drip:
      for (std::size_t i = 0; i < reply.body.size(); ++i) {
        if (!sendAll(connection, std::exchange(head, "") + reply.body[i])) {
          return false;
        }
        std::unique_lock lock(mutex_);
        ending_.wait_for(lock, std::chrono::milliseconds(dripMilliseconds), [&] { return stopping_; });
      }
      return true;
    case Fault::PromiseMore:
    case Fault::PromiseLess:
      sendAll(connection, head + reply.body);
      return false;
    default:
      return sendAll(connection, head + reply.body);
  }
}

void FaultServer::waitForEnd() {
  std::unique_lock lock(mutex_);
  ending_.wait(lock, [&] { return stopping_; });
}

std::vector<FaultServer::Request> FaultServer::requests() const {
  const std::lock_guard lock(mutex_);
  return ledger_;
}

std::size_t FaultServer::count() const {
  const std::lock_guard lock(mutex_);
  return ledger_.size();
}

std::size_t FaultServer::count(const std::string& target) const {
  const std::lock_guard lock(mutex_);
  const auto known = counts_.find(target);
  return known == counts_.end() ? 0 : known->second;
}

std::size_t FaultServer::mostAtOnce() const {
  const std::lock_guard lock(mutex_);
  return mostAtOnce_;
}

}  // namespace meridian

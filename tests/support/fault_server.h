#pragma once

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace meridian {

/// A web server on 127.0.0.1, within the test's process, that misbehaves as it is told, and keeps a ledger of what it
/// was asked. HTTP/1.1 with one thread for each connection. What it is not told about is 404.
class FaultServer {
 public:
  struct Request {
    std::string target;                          ///< "/tiles/1.png?a=b"
    std::map<std::string, std::string> headers;  ///< names in lower case
    std::size_t attempt = 0;                     ///< 0 for the first request of this target
  };

  /// What one request is answered with, and how.
  struct Reply {
    enum class Fault {
      None,
      CloseAtOnce,  ///< without a byte
      StallAtOnce,  ///< says nothing until the server goes
      StallInBody,  ///< half of the body, then nothing
      Drip,         ///< the body byte by byte, one each dripMilliseconds
      Truncate,     ///< half of the body, then the connection is closed
      PromiseMore,  ///< Content-Length says twice the body's
      PromiseLess,  ///< Content-Length says half of the body's
      EndlessHeaders,
    };
    int status = 200;
    std::vector<std::string> headers{};  ///< "Name: value"
    std::string body{};
    Fault fault = Fault::None;
  };
  using Handler = std::function<Reply(const Request&)>;

  FaultServer();
  FaultServer(const FaultServer&) = delete;
  FaultServer& operator=(const FaultServer&) = delete;
  ~FaultServer();

  /// "http://127.0.0.1:PORT" and the target.
  [[nodiscard]] std::string url(const std::string& target) const;

  void on(const std::string& target, Reply reply);
  void on(const std::string& target, Handler handler);
  /// For each target that nothing else was said about.
  void onAnything(Handler handler);

  /// Takes no connections and drops those that are open, until listen() takes the same port again.
  void refuse();
  void listen();
  std::atomic<int> dripMilliseconds{1000};

  // The ledger.
  [[nodiscard]] std::vector<Request> requests() const;
  [[nodiscard]] std::size_t count() const;
  [[nodiscard]] std::size_t count(const std::string& target) const;
  /// The greatest number of requests that were being answered at the same time.
  [[nodiscard]] std::size_t mostAtOnce() const;
  [[nodiscard]] std::size_t connections() const { return accepted_; }

 private:
  void serve(int connection);
  bool answer(int connection, const Request& request, const Reply& reply);
  void waitForEnd();
  Reply replyTo(Request& request);

  mutable std::mutex mutex_;
  std::condition_variable ending_;
  std::map<std::string, Handler> handlers_;
  Handler fallback_;
  std::vector<Request> ledger_;
  std::map<std::string, std::size_t> counts_;
  std::size_t atOnce_ = 0;
  std::size_t mostAtOnce_ = 0;
  std::vector<int> open_;
  std::vector<std::thread> connections_;
  std::atomic<std::size_t> accepted_{0};
  bool stopping_ = false;
  int listener_ = -1;
  int port_ = 0;
  std::thread accepting_;
};

}  // namespace meridian

#include "support/nginx_server.h"

#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <system_error>
#include <vector>

#include <unistd.h>

namespace meridian {

namespace {

namespace fs = std::filesystem;

void run(const std::string& command) {
  if (std::system(command.c_str()) != 0) {
    throw std::runtime_error("this failed: " + command);
  }
}

std::string contents(const fs::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

}  // namespace

bool NginxServer::isInstalled() {
  return ::access("/usr/sbin/nginx", X_OK) == 0;
}

NginxServer::NginxServer() {
  std::string name = (fs::temp_directory_path() / "meridian-nginx-XXXXXX").string();
  folder_ = ::mkdtemp(name.data());
  fs::create_directory(root());
  for (int& port : ports_) {
    port = freePort();
  }
  try {
    makeCertificates();
    writeConfiguration();
    start();
  } catch (...) {
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
    throw;
  }
}

NginxServer::~NginxServer() {
  process_.reset();
  std::error_code ignored;
  fs::remove_all(folder_, ignored);
}

void NginxServer::makeCertificates() const {
  const std::string in = "cd '" + folder_.string() + "' && ";
  const std::string key = " -newkey ec -pkeyopt ec_paramgen_curve:prime256v1 -nodes ";
  std::ofstream(folder_ / "names") << "subjectAltName=IP:127.0.0.1\n";
  run(in + "openssl req -x509" + key + "-keyout ca.key -out ca.pem -days 2 -subj '/CN=Meridian test authority' 2>log");
  run(in + "openssl req" + key + "-keyout server.key -out server.csr -subj '/CN=tiles' 2>log");
  run(in +
      "openssl x509 -req -in server.csr -CA ca.pem -CAkey ca.key -CAcreateserial -days 2 -extfile names "
      "-out server.pem 2>log");
  run(in + "openssl req -x509" + key +
      "-keyout self.key -out self.pem -days 2 -subj '/CN=127.0.0.1' -addext subjectAltName=IP:127.0.0.1 2>log");
}

void NginxServer::writeConfiguration() const {
  std::ofstream file(folder_ / "nginx.conf");
  const auto server = [&](int port, const char* how, const char* certificate) {
    file << "  server {\n    listen 127.0.0.1:" << port << how << ";\n    root root;\n";
    if (certificate != nullptr) {
      file << "    ssl_certificate " << certificate << ".pem;\n    ssl_certificate_key " << certificate << ".key;\n";
    }
    file << "  }\n";
  };
  file << (::geteuid() == 0 ? "user root;\n" : "")
       << "daemon off;\nworker_processes 1;\npid pid;\nerror_log error.log;\n"
       << "events { worker_connections 512; }\nhttp {\n  types { image/png png; image/jpeg jpg; text/plain txt; }\n"
       << "  log_format short '$server_protocol $status $uri $connection';\n  access_log access.log short;\n"
       << "  keepalive_requests 1000000;\n  sendfile on;\n  tcp_nopush on;\n";
  for (const char* kind : {"client_body", "proxy", "fastcgi", "uwsgi", "scgi"}) {
    file << "  " << kind << "_temp_path temp_" << kind << ";\n";
  }
  server(ports_[0], "", nullptr);
  server(ports_[1], " ssl http2", "server");
  server(ports_[2], " ssl", "server");
  server(ports_[3], " ssl", "self");
  file << "}\n";
}

void NginxServer::start() {
  const std::string prefix = folder_.string() + "/";
  const std::string configuration = prefix + "nginx.conf";
  const std::string errors = prefix + "error.log";
  // root and the log files are taken from the prefix, certificates from the configuration's folder.
  try {
    process_ = std::make_unique<ServerProcess>(
        std::vector<std::string>{"/usr/sbin/nginx", "-p", prefix, "-c", configuration, "-e", errors}, ports_[3]);
  } catch (const std::runtime_error&) {
    throw std::runtime_error("nginx does not start: " + contents(errors));
  }
}

std::string NginxServer::accessLog() const {
  return contents(folder_ / "access.log");
}

}  // namespace meridian

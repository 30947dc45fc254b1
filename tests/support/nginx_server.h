#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "support/server_process.h"

namespace meridian {

/// nginx on 127.0.0.1, with files, configuration and certificates of its own in a temporary folder, all of which go
/// with this. Throws std::runtime_error with a reason when it cannot be started.
class NginxServer {
 public:
  NginxServer();
  NginxServer(const NginxServer&) = delete;
  NginxServer& operator=(const NginxServer&) = delete;
  ~NginxServer();

  [[nodiscard]] static bool isInstalled();

  /// What is put here is served, with ETag and Last-Modified.
  [[nodiscard]] std::filesystem::path root() const { return folder_ / "root"; }
  /// Of the authority that has signed the certificates of http2() and http1OverTls().
  [[nodiscard]] std::filesystem::path authority() const { return folder_ / "ca.pem"; }

  // Addresses without a path.
  [[nodiscard]] std::string http1() const { return "http://127.0.0.1:" + std::to_string(ports_[0]); }
  [[nodiscard]] std::string http2() const { return "https://127.0.0.1:" + std::to_string(ports_[1]); }
  [[nodiscard]] std::string http1OverTls() const { return "https://127.0.0.1:" + std::to_string(ports_[2]); }
  [[nodiscard]] std::string selfSigned() const { return "https://127.0.0.1:" + std::to_string(ports_[3]); }
  /// The same certificate as http2(), for a name that is not in it.
  [[nodiscard]] std::string otherName() const { return "https://localhost:" + std::to_string(ports_[1]); }

  /// A line for each request: "PROTOCOL STATUS PATH CONNECTION".
  [[nodiscard]] std::string accessLog() const;

 private:
  void makeCertificates() const;
  void writeConfiguration() const;
  void start();

  std::filesystem::path folder_;
  int ports_[4]{};
  std::unique_ptr<ServerProcess> process_;
};

}  // namespace meridian

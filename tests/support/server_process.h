#pragma once

#include <string>
#include <vector>

#include <sys/types.h>

namespace meridian {

/// A port on loopback that nobody listens on just now.
[[nodiscard]] int freePort();

/// A server on 127.0.0.1 that is a program of its own, and ends with this.
class ServerProcess {
 public:
  /// Waits until somebody answers at that port. Throws std::runtime_error when nobody does.
  ServerProcess(const std::vector<std::string>& command, int port);
  ServerProcess(const ServerProcess&) = delete;
  ServerProcess& operator=(const ServerProcess&) = delete;
  ~ServerProcess();

  /// Serves the files of a folder.
  [[nodiscard]] static std::vector<std::string> fileServer(const std::string& folder, int port);

 private:
  pid_t process_ = -1;
};

}  // namespace meridian

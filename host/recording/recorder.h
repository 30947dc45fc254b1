#pragma once

#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

#include "host/api/error.h"
#include "host/api/time.h"
#include "host/navigation/camera.h"

namespace meridian::recording {

/// Records a session as it runs, to a file of version 03.00, ASCII. What was recorded is in the file at any moment but
/// for the last second, so that a crash loses little.
class Recorder {
 public:
  /// Errors: the file cannot be written.
  [[nodiscard]] static Result<Recorder> create(const std::filesystem::path& file);

  /// Once a frame, after navigation; `seconds` since the frame before (0 at the first).
  [[nodiscard]] Result<void> addFrame(double seconds, const Time& time, const navigation::Camera& camera);
  /// A script that ran since the last frame. Calls of openspace.sessionRecording are left out, and a leading `return`.
  void addScript(std::string_view text, const Time& time);
  /// Writes what is left. Errors: the disk is full.
  [[nodiscard]] Result<void> finish();

 private:
  explicit Recorder(std::ofstream stream, std::string name) : stream_(std::move(stream)), name_(std::move(name)) {}
  std::ofstream stream_;
  std::string name_;
  double elapsed_ = 0.0;
  double lastFlush_ = 0.0;
};

}  // namespace meridian::recording

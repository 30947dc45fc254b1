#pragma once

#include <filesystem>
#include <functional>
#include <string_view>

#include "host/api/script_library.h"
#include "host/recording/session_control.h"

namespace meridian::recording {

/// What the paths of scripts mean; errors: where they may not read (write). A recording that names no place yet is kept
/// in `inProgress`.
struct RecordingPaths {
  std::function<Result<std::filesystem::path>(std::string_view)> readable;
  std::function<Result<std::filesystem::path>(std::string_view)> writable;
  std::filesystem::path inProgress;
};

/// `openspace.sessionRecording.*`, as OpenSpace has it now and as it had it up to version 0.20. Recordings are always
/// written as ASCII. The control outlives it.
[[nodiscard]] ScriptLibrary recordingLibrary(SessionControl& control, const RecordingPaths& paths);

}  // namespace meridian::recording

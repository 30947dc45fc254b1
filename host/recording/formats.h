#pragma once

#include <string_view>

#include "host/recording/session_recording.h"

namespace meridian::recording {

/// What follows the header. `version` is 1, 2 or 3 (of 01.00, 02.00, 03.00).
[[nodiscard]] Result<SessionRecording> parseAsciiBody(std::string_view body, int version, std::string_view where);
[[nodiscard]] Result<SessionRecording> parseBinaryBody(std::string_view body, int version, std::string_view where);

/// Errors, in words without a place: values that are not finite, a rotation of length zero. Normalises the rotation.
[[nodiscard]] Result<void> checkCamera(CameraEntry& entry);

/// What a `time` entry of the old versions sets.
[[nodiscard]] ScriptEntry timeScript(double timestamp, double simulationSeconds, double deltaSeconds, bool paused,
                                     bool jump);

}  // namespace meridian::recording

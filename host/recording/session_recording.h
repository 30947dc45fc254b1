#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include "host/api/error.h"
#include "host/api/time.h"

namespace meridian::recording {

/// The camera at one moment.
struct CameraEntry {
  double timestamp = 0.0;  ///< seconds since the recording began
  Time simulationTime{};
  glm::dvec3 position{0.0};  ///< metres from the node; along its axes if `followsRotation`, else the world's
  glm::dquat rotation{1.0, 0.0, 0.0, 0.0};  ///< unit; in the same axes
  double scale = 1.0;                       ///< OpenSpace's camera scaling; kept, not used
  bool followsRotation = false;
  std::string node;
  std::size_t line = 0;  ///< of its file, from 1; 0: not known, or of no file of lines
};

/// A script that ran at one moment.
struct ScriptEntry {
  double timestamp = 0.0;
  Time simulationTime{};
  std::string text;
  std::size_t line = 0;  ///< of its file, in which the text begins, from 1; 0: not known, or of no file of lines
};

/// A session recording: OpenSpace's format, versions 01.00, 02.00 and 03.00, ASCII and binary.
struct SessionRecording {
  using Entry = std::variant<CameraEntry, ScriptEntry>;
  std::vector<Entry> entries;     ///< timestamps ascend
  std::string version = "03.00";  ///< of the file that it was read from

  [[nodiscard]] double duration() const;  ///< timestamp of the last entry; 0 without any
};

/// Reads the content of a file. ASCII: blanks of any number, "\r\n", a missing last line end, lines that start with `#`
/// and empty ones are tolerated; `time` lines of version 01.00 become a script that sets the same. Binary files of the
/// same versions but for `t` frames. `where` names the file in errors.
/// Errors, with file and line (or byte): no such header or version, a damaged line (what was expected, what was found),
/// timestamps that descend.
[[nodiscard]] Result<SessionRecording> parseSessionRecording(std::string_view content, std::string_view where);
[[nodiscard]] Result<SessionRecording> readSessionRecording(const std::filesystem::path& file);

/// One entry as a line of version 03.00, ASCII, with its line end. A script becomes one line, unless joining its lines
/// could break a comment or a long string.
[[nodiscard]] std::string formatEntry(const SessionRecording::Entry& entry);
/// The header of version 03.00, ASCII.
[[nodiscard]] std::string_view asciiHeader();

/// The whole recording as version 03.00, ASCII. Errors: the file cannot be written.
[[nodiscard]] Result<void> writeSessionRecording(const SessionRecording& recording, const std::filesystem::path& file);

}  // namespace meridian::recording

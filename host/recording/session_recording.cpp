#include "host/recording/session_recording.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>

#include <fmt/format.h>

#include "host/api/regular_file.h"
#include "host/recording/formats.h"

namespace meridian::recording {

namespace {

constexpr std::string_view title = "OpenSpace_record/playback";
constexpr std::size_t versionLength = 5;

double timestampOf(const SessionRecording::Entry& entry) {
  return std::visit([](const auto& each) { return each.timestamp; }, entry);
}

}  // namespace

double SessionRecording::duration() const {
  return entries.empty() ? 0.0 : timestampOf(entries.back());
}

Result<void> checkCamera(CameraEntry& entry) {
  const glm::dvec3& p = entry.position;
  const glm::dquat& q = entry.rotation;
  for (const double value : {entry.timestamp, entry.simulationTime.tdbSeconds(), p.x, p.y, p.z, q.x, q.y, q.z, q.w}) {
    if (!std::isfinite(value)) {
      return failure("expected finite numbers");
    }
  }
  const double length = glm::length(q);
  if (!(length > 1e-6) || !std::isfinite(length)) {
    return failure("expected a rotation quaternion, found one of length zero");
  }
  entry.rotation = q / length;
  return {};
}

ScriptEntry timeScript(double timestamp, double simulationSeconds, double deltaSeconds, bool paused, bool jump) {
  std::string text = fmt::format("openspace.time.setPause({});openspace.time.setDeltaTime({})", paused, deltaSeconds);
  if (jump) {
    text += fmt::format(";openspace.time.setTime({})", simulationSeconds);
  }
  return {timestamp, Time(simulationSeconds), std::move(text)};
}

Result<SessionRecording> parseSessionRecording(std::string_view content, std::string_view where) {
  const std::string firstLine = std::string(where) + ":1";
  if (!content.starts_with(title)) {
    return failure("the file is not a session recording: it does not begin with '" + std::string(title) + "'",
                   firstLine, "name a .osrectxt or .osrec file");
  }
  const std::string version(content.substr(title.size(), versionLength));
  int number = 0;
  for (const auto& [text, known] : {std::pair{"01.00", 1}, std::pair{"02.00", 2}, std::pair{"03.00", 3}}) {
    if (version == text) {
      number = known;
    }
  }
  if (number == 0) {
    return failure("expected version 01.00, 02.00 or 03.00, found '" + version + "'", firstLine,
                   "convert the recording with a newer OpenSpace");
  }
  std::string_view rest = content.substr(title.size() + versionLength);
  const char mode = rest.empty() ? '\0' : rest.front();
  if (mode != 'A' && mode != 'B') {
    return failure("expected 'A' or 'B' after the version", firstLine, "record the session again");
  }
  rest.remove_prefix(1);
  if (rest.starts_with("\r\n")) {
    rest.remove_prefix(2);
  } else if (rest.starts_with('\n')) {
    rest.remove_prefix(1);
  } else if (!rest.empty()) {
    return failure("expected the end of the header line", firstLine, "record the session again");
  }
  auto parsed = mode == 'A' ? parseAsciiBody(rest, number, where) : parseBinaryBody(rest, number, where);
  if (parsed) {
    parsed->version = version;
  }
  return parsed;
}

Result<SessionRecording> readSessionRecording(const std::filesystem::path& file) {
  if (auto regular = requireRegularFile(file, "the recording", "name a .osrectxt or .osrec file"); !regular) {
    return tl::make_unexpected(std::move(regular.error()));
  }
  std::ifstream stream(file, std::ios::binary);
  const std::string content{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  if (!stream) {
    return failure("the file cannot be read", file.string(), "check its permissions");
  }
  return parseSessionRecording(content, file.string());
}

std::string_view asciiHeader() {
  return "OpenSpace_record/playback03.00A\n";
}

Result<void> writeSessionRecording(const SessionRecording& recording, const std::filesystem::path& file) {
  std::ofstream stream(file, std::ios::binary | std::ios::trunc);
  stream << asciiHeader();
  for (const SessionRecording::Entry& entry : recording.entries) {
    stream << formatEntry(entry);
  }
  stream.close();
  if (!stream) {
    return failure("the recording cannot be written", file.string(), "check the folder, its permissions and the disk");
  }
  return {};
}

}  // namespace meridian::recording

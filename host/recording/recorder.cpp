#include "host/recording/recorder.h"

#include <algorithm>

#include "host/recording/session_recording.h"

namespace meridian::recording {

namespace {

constexpr double secondsBetweenFlushes = 1.0;

}  // namespace

Result<Recorder> Recorder::create(const std::filesystem::path& file) {
  std::ofstream stream(file, std::ios::binary | std::ios::trunc);
  stream << asciiHeader();
  if (!stream) {
    return failure("the recording cannot be written", file.string(), "check the folder, its permissions and the disk");
  }
  return Recorder(std::move(stream), file.string());
}

Result<void> Recorder::addFrame(double seconds, const Time& time, const navigation::Camera& camera) {
  elapsed_ += std::max(seconds, 0.0);
  CameraEntry entry;
  entry.timestamp = elapsed_;
  entry.simulationTime = time;
  entry.position = camera.pose().position;
  entry.rotation = camera.pose().rotation;
  entry.followsRotation = true;
  entry.node = camera.anchor().identifier();
  stream_ << formatEntry(entry);
  if (elapsed_ - lastFlush_ >= secondsBetweenFlushes) {
    stream_.flush();
    lastFlush_ = elapsed_;
  }
  if (!stream_) {
    return failure("the recording cannot be written", name_, "make room on the disk");
  }
  return {};
}

void Recorder::addScript(std::string_view text, const Time& time) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t' || text.front() == '\n')) {
    text.remove_prefix(1);
  }
  constexpr std::string_view leadingReturn = "return ";
  if (text.starts_with(leadingReturn)) {
    text.remove_prefix(leadingReturn.size());
  }
  if (text.empty() || text.find("openspace.sessionRecording.") != std::string_view::npos) {
    return;
  }
  stream_ << formatEntry(ScriptEntry{elapsed_, time, std::string(text)});
}

Result<void> Recorder::finish() {
  stream_.close();
  if (!stream_) {
    return failure("the recording cannot be written", name_, "make room on the disk");
  }
  return {};
}

}  // namespace meridian::recording

#include "host/recording/session_control.h"

#include <utility>

#include <fmt/format.h>

#include "host/recording/session_recording.h"

namespace meridian::recording {

namespace {

/// Under the name of the recording's file, so that errors name its lines.
Result<void> runEntry(scripting::ScriptEngine& scripts, const std::filesystem::path& file, const ScriptEntry& script) {
  return script.line > 0 ? scripts.run(std::string(script.line - 1, '\n') + script.text, file.string())
                         : scripts.run(script.text, fmt::format("{}: script at {} s", file.string(), script.timestamp));
}

}  // namespace

SessionControl::SessionControl(navigation::Camera& camera, scripting::Clock& clock, scripting::ScriptEngine& scripts)
    : camera_(camera), clock_(clock), scripts_(scripts) {
  scripts.onQueuedScript([this](std::string_view text) {
    if (recorder_) {
      recorder_->addScript(text, clock_.time());
    }
  });
}

Result<void> SessionControl::requireIdle() const {
  if (isRecording()) {
    return failure("a session is recorded already", recordingFile_.string(),
                   "stop that with openspace.sessionRecording.stopRecording()");
  }
  if (isPlaying() || isInPlay_) {
    return failure("a recording is played already", {}, "stop it with openspace.sessionRecording.stopPlayback()");
  }
  return {};
}

Result<void> SessionControl::startRecording(const std::filesystem::path& file) {
  return requireIdle().and_then([&] { return Recorder::create(file); }).map([&](Recorder recorder) {
    recorder_.emplace(std::move(recorder));
    recordingFile_ = file;
  });
}

Result<void> SessionControl::stopRecording() {
  if (!recorder_) {
    return failure("nothing is recorded", {}, "begin with openspace.sessionRecording.startRecording()");
  }
  auto finished = recorder_->finish();
  recorder_.reset();
  return finished;
}

Result<void> SessionControl::startPlayback(const std::filesystem::path& file, bool loops, bool keepsTime) {
  if (auto idle = requireIdle(); !idle) {
    return idle;
  }
  auto recording = readSessionRecording(file);
  if (!recording) {
    return tl::make_unexpected(recording.error());
  }
  auto player = Player::create(std::move(*recording), camera_,
                               [this, file](const ScriptEntry& script) { return runEntry(scripts_, file, script); });
  if (!player) {
    Error error = player.error();
    if (error.where.empty()) {
      error.where = file.string();
    }
    return tl::make_unexpected(std::move(error));
  }
  player_.emplace(std::move(*player));
  loops_ = loops;
  paused_ = false;
  if (!keepsTime) {
    clock_.setTime(player_->startTime());
  }
  return {};
}

void SessionControl::stopPlayback() {
  setPlaybackPause(false);
  loops_ = false;
  if (isInPlay_) {
    wantsStop_ = true;
  } else {
    player_.reset();
  }
}

void SessionControl::setPlaybackPause(bool paused) {
  if (!isPlaying() || paused == paused_) {
    return;
  }
  paused_ = paused;
  if (paused) {
    pausedBy_ = scripts_.place();
    clockWasPaused_ = clock_.isPaused();
  }
  clock_.setPause(paused || clockWasPaused_);
}

void SessionControl::play(double seconds) {
  if (!player_) {
    return;
  }
  if (player_->finished()) {  // since the last frame
    player_.reset();
    return;
  }
  isInPlay_ = true;
  player_->advance(paused_ ? 0.0 : seconds);
  isInPlay_ = false;
  if (std::exchange(wantsStop_, false)) {
    player_.reset();
  } else if (player_->finished() && loops_) {
    player_->restart();
    clock_.setTime(player_->startTime());
  }
}

Result<void> SessionControl::record(double seconds) {
  return recorder_ ? recorder_->addFrame(seconds, clock_.time(), camera_) : Result<void>{};
}

}  // namespace meridian::recording

#include "host/app/session.h"

#include <utility>

#include "host/api/log.h"

namespace meridian::app {

Result<std::unique_ptr<Session>> Session::create(Application& application, const Options& options, bool fixedStep) {
  const auto timer = fixedStep ? scripting::FrameTimer::fixedStep(options.fps.value_or(Options::defaultFps))
                               : scripting::FrameTimer::realTime();
  std::unique_ptr<Session> session(new Session(application, options, timer));
  recording::SessionControl& control = application.recording();
  if (options.play) {
    if (auto started = control.startPlayback(*options.play, false, options.time.has_value()); !started) {
      return tl::make_unexpected(started.error());
    }
  }
  if (options.record) {
    if (auto started = control.startRecording(*options.record); !started) {
      return tl::make_unexpected(started.error());
    }
  }
  return session;
}

Result<void> Session::advance() {
  const double seconds = timer_.tick();
  application_.addSeconds(seconds);
  resumeScripts();
  for (const Error& error : application_.scripts().runQueued()) {
    log::error("{}", error.message());
  }
  const Time before = application_.clock().time();
  application_.clock().advance(seconds);
  deltaSeconds_ = application_.clock().time() - before;
  application_.animation().advance(seconds);
  application_.scene().evaluate(application_.clock().time());
  recording::SessionControl& control = application_.recording();
  isPlayed_ = control.isPlaying();
  control.play(seconds);
  if (!isPlayed_) {
    application_.flight().advance(seconds);
    application_.navigator().update(seconds);
  }
  return record(seconds);
}

void Session::resumeScripts() {
  if (!hasWaitingScripts()) {
    return;
  }
  for (const Error& error : application_.scripts().resumeWaiting()) {
    log::error("{}", error.message());
    failedScripts_ += wallSeconds() == 0.0 ? 1 : 0;
  }
  // They may have set the time, or moved nodes.
  application_.scene().evaluate(application_.clock().time());
}

Result<void> Session::checkPlayback() const {
  const recording::SessionControl& control = application_.recording();
  if (!isPlaying() || !control.isPlaybackPaused() || application_.scripts().hasQueued() || hasWaitingScripts() ||
      application_.animation().awaitsScript()) {
    return {};
  }
  return failure("the playback was paused, and nobody is left who could end the pause", control.pausedBy(),
                 "take it out, say with --frames how long the run is, or play the recording in a window");
}

Result<void> Session::record(double seconds) {
  recording::SessionControl& control = application_.recording();
  Result<void> recorded = control.record(seconds);
  if (recorded || control.recordingFile() == asked_) {
    return recorded;
  }
  log::error("the recording ends here: {}", recorded.error().message());
  static_cast<void>(control.stopRecording());  // fails for the same reason
  return {};
}

bool Session::keepClear() {
  return !isPlayed_ && application_.navigator().keepClear();
}

Result<void> Session::finish() {
  recording::SessionControl& control = application_.recording();
  return control.isRecording() ? control.stopRecording() : Result<void>{};
}

}  // namespace meridian::app

#include "host/app/session.h"

#include <utility>

#include "host/api/log.h"
#include "host/recording/session_recording.h"

namespace meridian::app {

Result<std::unique_ptr<Session>> Session::create(Application& application, const Options& options, bool fixedStep) {
  const auto timer = fixedStep ? scripting::FrameTimer::fixedStep(options.fps.value_or(Options::defaultFps))
                               : scripting::FrameTimer::realTime();
  std::unique_ptr<Session> session(new Session(application, timer));
  if (auto opened = session->openPlayer(options); !opened) {
    return tl::make_unexpected(opened.error());
  }
  if (auto opened = session->openRecorder(options); !opened) {
    return tl::make_unexpected(opened.error());
  }
  return session;
}

Result<void> Session::openPlayer(const Options& options) {
  if (!options.play) {
    return {};
  }
  auto recording = recording::readSessionRecording(*options.play);
  if (!recording) {
    return tl::make_unexpected(recording.error());
  }
  auto player = recording::Player::create(
      std::move(*recording), application_.camera(),
      [this](const std::string& text) { return application_.scripts().run(text, "recording"); });
  if (!player) {
    Error error = player.error();
    if (error.where.empty()) {
      error.where = options.play->string();
    }
    return tl::make_unexpected(std::move(error));
  }
  player_ = std::move(*player);
  if (!options.time) {
    application_.clock().setTime(player_->startTime());
  }
  return {};
}

Result<void> Session::openRecorder(const Options& options) {
  if (!options.record) {
    return {};
  }
  auto recorder = recording::Recorder::create(*options.record);
  if (!recorder) {
    return tl::make_unexpected(recorder.error());
  }
  recorder_ = std::move(*recorder);
  application_.scripts().onQueuedScript([this](std::string_view text) {
    if (recorder_) {
      recorder_->addScript(text, application_.clock().time());
    }
  });
  return {};
}

Result<void> Session::advance() {
  const double seconds = timer_.tick();
  application_.addSeconds(seconds);
  for (const Error& error : application_.scripts().runQueued()) {
    log::error("{}", error.message());
  }
  const Time before = application_.clock().time();
  application_.clock().advance(seconds);
  deltaSeconds_ = application_.clock().time() - before;
  application_.animation().advance(seconds);
  application_.scene().evaluate(application_.clock().time());
  if (isPlaying()) {
    player_->advance(seconds);
  } else {
    application_.flight().advance(seconds);
    application_.navigator().update(seconds);
  }
  return recorder_ ? recorder_->addFrame(seconds, application_.clock().time(), application_.camera()) : Result<void>{};
}

bool Session::keepClear() {
  return !player_ && application_.navigator().keepClear();
}

Result<void> Session::finish() {
  if (!recorder_) {
    return {};
  }
  auto finished = recorder_->finish();
  recorder_.reset();
  return finished;
}

}  // namespace meridian::app

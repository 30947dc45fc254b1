#include "host/app/run_loop.h"

#include <thread>
#include <utility>

#include <fmt/format.h>

#include "host/api/log.h"
#include "host/app/interruption.h"

namespace meridian::app {
namespace {

using namespace std::chrono_literals;

// Workers have two cores with us: between two looks at an incomplete view they may have both.
constexpr auto settlePause = 2ms;
constexpr auto minimisedPause = 50ms;
constexpr auto progressInterval = 5s;

double millisecondsSince(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
}

}  // namespace

Result<void> RunLoop::run() {
  while (!isStopped() && !isDone()) {
    if (auto drawn = frame(); !drawn) {
      return drawn;
    }
    tellProgress();
    if (options_.play && !options_.frames && parts_.window == nullptr) {
      if (auto playing = parts_.session.checkPlayback(); !playing) {
        return playing;
      }
    }
  }
  const bool hasAnEnd = options_.frames || options_.output || parts_.window == nullptr;
  if (isInterrupted() && hasAnEnd && !isDone()) {
    return failure(fmt::format("interrupted after {} frames", frames_));
  }
  return {};
}

bool RunLoop::isStopped() const {
  return quit_ || isInterrupted() || (parts_.window != nullptr && parts_.window->shouldClose());
}

bool RunLoop::isDone() const {
  if (options_.frames && frames_ >= *options_.frames) {
    return true;
  }
  const bool watched = parts_.window != nullptr && parts_.writer == nullptr;
  if (options_.play) {
    // At its end, or stopped by one of its own scripts.
    return frames_ >= 1 && !parts_.session.isPlaying() && !watched;
  }
  return parts_.window == nullptr && !options_.frames && frames_ >= 1;
}

glm::ivec2 RunLoop::pictureSize() const {
  const bool followsWindow = parts_.window != nullptr && parts_.writer == nullptr;
  return followsWindow ? parts_.window->framebufferSize() : options_.size;
}

Result<void> RunLoop::frame() {
  auto begin = Clock::now();
  if (parts_.window != nullptr) {
    graphics::WindowContext::pollEvents();
    if (const bool wanted = parts_.application.renderSettings().verticalSync.get(); wanted != verticalSync_) {
      parts_.window->setVerticalSync(wanted);
      verticalSync_ = wanted;
    }
  }
  if (auto advanced = parts_.session.advance(); !advanced) {
    return advanced;
  }
  if (awaitScripts()) {
    begin = Clock::now();
  }
  if (auto drawn = drawUntilSettled(begin); !drawn) {
    return drawn;
  }
  parts_.application.statistics().endFrame();
  ++frames_;
  return writePicture();
}

/// Scripts wait for a bounded time, and off screen nobody sees it pass: what they do then is in this frame already, and
/// the program does not end before they have done it.
bool RunLoop::awaitScripts() {
  if (parts_.window != nullptr || !parts_.session.hasWaitingScripts()) {
    return false;
  }
  while (parts_.session.hasWaitingScripts() && !isStopped()) {
    std::this_thread::sleep_for(settlePause);
    parts_.session.resumeScripts();
  }
  return true;
}

Result<void> RunLoop::drawOnce(Clock::time_point begin, double deltaSeconds, bool isDrawn) {
  Statistics::Frame& figures = parts_.application.statistics().frame;
  figures = {};
  SceneRenderer& renderer = parts_.renderer;
  renderer.beginFrame();
  const SceneRenderer::Moment moment{parts_.application.clock().time(), deltaSeconds, parts_.session.wallSeconds(),
                                     drawings_++, isDrawn};
  const graphics::RenderTarget::Shape shape{pictureSize(), parts_.application.renderSettings().antialiasing.get()};
  if (auto drawn = renderer.draw(moment, parts_.application.camera(), shape); !drawn) {
    return drawn;
  }
  if (isDrawn && parts_.application.renderSettings().showAttribution.get()) {
    caption_.draw(renderer.target(), renderer.attribution());
  }
  present();
  renderer.endFrame();
  figures.cpu = millisecondsSince(begin);
  if (parts_.window != nullptr) {
    parts_.window->swapBuffers();
    renderer.markFrame();
  } else {
    renderer.waitForFrame();
  }
  figures.frame = millisecondsSince(begin);
  return {};
}

void RunLoop::present() {
  if (parts_.window == nullptr) {
    return;
  }
  const glm::ivec2 size = parts_.window->framebufferSize();
  if (size.x <= 0 || size.y <= 0) {
    std::this_thread::sleep_for(minimisedPause);
    return;
  }
  parts_.renderer.target().blit(0, size);
  if (parts_.panels != nullptr) {
    parts_.panels->draw();
  }
}

double RunLoop::settleSeconds() const {
  // A server that is down would hold up every frame of a video.
  const bool isPicture = options_.output.has_value() && parts_.window == nullptr && !hasTimedOut_;
  return options_.settleSeconds.value_or(isPicture ? Options::defaultSettleSeconds : 0.0);
}

Result<void> RunLoop::drawUntilSettled(Clock::time_point begin) {
  if (auto drawn = drawOnce(begin, parts_.session.deltaSeconds()); !drawn || settleSeconds() <= 0.0) {
    return drawn;
  }
  auto& figures = parts_.application.statistics().settled;
  const auto start = Clock::now();
  const auto state = [this]() -> Settled {
    if (parts_.session.hasWaitingScripts()) {
      return {false, "a script waits for what it asked for"};
    }
    return parts_.renderer.settled();
  };
  Settled settled = state();
  // Without a window nobody sees what is not complete, and a software renderer would draw it with the cores that load.
  const bool isSeen = parts_.window != nullptr;
  bool isPending = false;
  // Where the ground is shows as it loads: a camera that was put below it is outside in the picture.
  while ((parts_.session.keepClear() || !settled.complete) && !isStopped() &&
         millisecondsSince(start) < 1000.0 * settleSeconds()) {
    std::this_thread::sleep_for(settlePause);
    if (isSeen) {
      graphics::WindowContext::pollEvents();
    }
    parts_.session.resumeScripts();
    if (auto drawn = drawOnce(Clock::now(), 0.0, isSeen); !drawn) {
      return drawn;
    }
    isPending = !isSeen;
    settled = state();
  }
  if (isPending) {
    if (auto drawn = drawOnce(Clock::now(), 0.0); !drawn) {
      return drawn;
    }
  }
  figures.waitMs += millisecondsSince(start);
  if (settled.complete) {
    ++figures.framesSettled;
  } else {
    ++figures.framesTimedOut;
    if (!hasTimedOut_ && !options_.settleSeconds) {
      log::warning("later frames are drawn as they are; --settle says how long each may wait");
    }
    hasTimedOut_ = true;
    log::warning("frame {} is not complete: {}", frames_, settled.reason);
  }
  return {};
}

Result<void> RunLoop::writePicture() {
  if (parts_.writer == nullptr) {
    return {};
  }
  const graphics::RenderTarget& target = parts_.renderer.target();
  return parts_.writer->write({target.size(), target.readPixels(), {}}, parts_.renderer.attributions());
}

void RunLoop::tellProgress() {
  if (parts_.window != nullptr || Clock::now() - lastTold_ < progressInterval) {
    return;
  }
  lastTold_ = Clock::now();
  log::info("{} frames{}", frames_, options_.frames ? fmt::format(" of {}", *options_.frames) : std::string());
}

}  // namespace meridian::app

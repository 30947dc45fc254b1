#pragma once

#include <chrono>
#include <cstdint>

#include "host/api/error.h"
#include "host/app/application.h"
#include "host/app/frame_writer.h"
#include "host/app/options.h"
#include "host/app/scene_renderer.h"
#include "host/app/session.h"
#include "host/graphics/context.h"
#include "host/ui/caption.h"
#include "host/ui/user_interface.h"

namespace meridian::app {

/// Frames, one after the other, until there is a reason to end (docs/architecture.md, A frame).
///
/// Input and scripts, clock, scene transforms (Session); renderables update and draw (SceneRenderer); panels; then swap
/// or write. With --settle a frame is drawn again, time standing still, until every view is complete or the bound has
/// passed; only its last drawing counts in the figures. Off screen a frame that a script waits in is drawn when it has
/// gone on.
///
/// Ends after --frames; when the window is closed; when interrupted; without a window or with --output also when the
/// recording has been played or was stopped, and without a window, --frames and --play after one frame.
class RunLoop {
 public:
  /// All outlive the loop; window, panels and writer may be null (no panels without a window).
  struct Parts {
    Application& application;
    Session& session;
    SceneRenderer& renderer;
    graphics::WindowContext* window = nullptr;
    ui::UserInterface* panels = nullptr;
    FrameWriter* writer = nullptr;
  };
  RunLoop(const Options& options, const Parts& parts) : options_(options), parts_(parts) {}

  /// Errors: a frame cannot be drawn, written or, with --record, recorded; interrupted before an end that was asked
  /// for; without a window and --frames, the recording of --play was paused for good.
  [[nodiscard]] Result<void> run();
  /// To be called from within run, by input.
  void quit() { quit_ = true; }

 private:
  using Clock = std::chrono::steady_clock;

  [[nodiscard]] Result<void> frame();
  /// Whether any had to be awaited.
  bool awaitScripts();
  [[nodiscard]] Result<void> drawOnce(Clock::time_point begin, double deltaSeconds, bool isDrawn = true);
  [[nodiscard]] Result<void> drawUntilSettled(Clock::time_point begin);
  /// How long a frame may wait until it is complete; 0: it does not.
  [[nodiscard]] double settleSeconds() const;
  [[nodiscard]] Result<void> writePicture();
  [[nodiscard]] glm::ivec2 pictureSize() const;
  [[nodiscard]] bool isStopped() const;
  [[nodiscard]] bool isDone() const;
  void present();
  void tellProgress();

  const Options& options_;
  Parts parts_;
  ui::Caption caption_;
  std::uint64_t frames_ = 0;    ///< done
  std::uint64_t drawings_ = 0;  ///< of them, with those of --settle
  Clock::time_point lastTold_ = Clock::now();
  bool quit_ = false;
  bool hasTimedOut_ = false;  ///< a frame was not complete in time
  bool verticalSync_ = true;
};

}  // namespace meridian::app

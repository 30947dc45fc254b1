#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>

#include "host/api/error.h"
#include "host/app/application.h"
#include "host/app/options.h"
#include "host/scripting/frame_timer.h"

namespace meridian::app {

/// What moves the scene from one frame to the next: scripts, clock, animations, and the camera by a recording or by the
/// mouse. The application must outlive it.
class Session {
 public:
  /// Opens what `--play` and `--record` name. With --play the clock starts at the recording's time unless --time says
  /// otherwise. `fixedStep`: frames last 1 / fps instead of what they took.
  /// Errors: a recording that cannot be read, or be written.
  [[nodiscard]] static Result<std::unique_ptr<Session>> create(Application& application, const Options& options,
                                                               bool fixedStep);
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  /// One frame later: scripts, clock, animations, scene transforms, camera, in this order. The first frame is at the
  /// start. Errors: what `--record` names cannot be written any more; a recording that a script began ends then, and
  /// nothing else does.
  [[nodiscard]] Result<void> advance();
  /// Scripts that waited for something go on, also between two drawings of a frame.
  void resumeScripts();
  /// Whether one still waits.
  [[nodiscard]] bool hasWaitingScripts() const { return application_.scripts().hasWaiting(); }
  /// How many failed after they had waited, if that was before the second frame: they belong to the scene's start.
  [[nodiscard]] std::size_t failedScripts() const { return failedScripts_; }
  /// Lifts a camera that no recording moves out of terrain that was loaded since `advance`. Whether that moved it.
  bool keepClear();
  /// Writes the end of what is recorded.
  [[nodiscard]] Result<void> finish();

  /// Simulation seconds between this frame and the one before.
  [[nodiscard]] double deltaSeconds() const { return deltaSeconds_; }
  /// Frame seconds since the start.
  [[nodiscard]] double wallSeconds() const { return timer_.total(); }
  [[nodiscard]] bool isPlaying() const { return application_.recording().isPlaying(); }
  /// Error: the playback is paused, and no script is left that could end that.
  [[nodiscard]] Result<void> checkPlayback() const;

 private:
  Session(Application& application, const Options& options, scripting::FrameTimer timer)
      : application_(application), asked_(options.record), timer_(timer) {}
  [[nodiscard]] Result<void> record(double seconds);

  Application& application_;
  std::optional<std::filesystem::path> asked_;  ///< the recording of `--record`
  scripting::FrameTimer timer_;
  std::size_t failedScripts_ = 0;
  double deltaSeconds_ = 0.0;
  bool isPlayed_ = false;  ///< a recording moved the camera in this frame
};

}  // namespace meridian::app

#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "host/api/error.h"
#include "host/navigation/camera.h"
#include "host/recording/player.h"
#include "host/recording/recorder.h"
#include "host/scripting/clock.h"
#include "host/scripting/script_engine.h"

namespace meridian::recording {

/// What is recorded and what is played, for the command line and for scripts: one at a time. Render thread only.
class SessionControl {
 public:
  /// All outlive it. It hears the engine's queued scripts from now on.
  SessionControl(navigation::Camera& camera, scripting::Clock& clock, scripting::ScriptEngine& scripts);

  /// Overwrites the file. Errors: something is recorded or played already; the file cannot be written.
  [[nodiscard]] Result<void> startRecording(const std::filesystem::path& file);
  /// Errors: nothing is recorded; the disk is full. Either way it is over then.
  [[nodiscard]] Result<void> stopRecording();
  [[nodiscard]] bool isRecording() const { return recorder_.has_value(); }
  /// Where to; of the last one when it is over.
  [[nodiscard]] const std::filesystem::path& recordingFile() const { return recordingFile_; }

  /// Sets the clock to the recording's time, unless `keepsTime`. Errors: something is recorded or played already; a
  /// file that is no recording, or none that can begin.
  [[nodiscard]] Result<void> startPlayback(const std::filesystem::path& file, bool loops = false,
                                           bool keepsTime = false);
  /// A script of the recording may say so; then it ends with the frame.
  void stopPlayback();
  /// The clock pauses, too, and goes on as it was. Nothing without playback.
  void setPlaybackPause(bool paused);
  [[nodiscard]] bool isPlaybackPaused() const { return paused_; }
  /// "CHUNK:LINE" of the script that paused it last, as in an Error; empty where no script did.
  [[nodiscard]] const std::string& pausedBy() const { return pausedBy_; }
  /// Paused or not.
  [[nodiscard]] bool isPlaying() const { return player_ && !player_->finished(); }

  /// Once a frame, after Scene::evaluate; moves the camera while something is played.
  void play(double seconds);
  /// Once a frame, after the camera has moved. Errors: the file cannot be written any more.
  [[nodiscard]] Result<void> record(double seconds);

 private:
  [[nodiscard]] Result<void> requireIdle() const;

  navigation::Camera& camera_;
  scripting::Clock& clock_;
  scripting::ScriptEngine& scripts_;
  std::optional<Recorder> recorder_;
  std::filesystem::path recordingFile_;
  std::optional<Player> player_;
  bool loops_ = false;  ///< it is played again at its end
  bool isInPlay_ = false;
  bool wantsStop_ = false;
  bool paused_ = false;
  std::string pausedBy_;
  bool clockWasPaused_ = false;
};

}  // namespace meridian::recording

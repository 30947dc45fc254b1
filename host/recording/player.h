#pragma once

#include <cstddef>
#include <functional>
#include <string>

#include "host/api/error.h"
#include "host/api/time.h"
#include "host/navigation/camera.h"
#include "host/recording/session_recording.h"

namespace meridian::recording {

/// Plays a recording on a camera. Scripts run in their order once their moment has passed; between two camera entries
/// the position is interpolated linearly and the rotation spherically, about the node of the earlier one.
class Player {
 public:
  using RunScript = std::function<Result<void>(const ScriptEntry& script)>;

  /// The camera outlives the player. A script that fails is logged, and playback goes on.
  /// Errors: no camera entry; the first one's node is not in the scene.
  [[nodiscard]] static Result<Player> create(SessionRecording recording, navigation::Camera& camera,
                                             RunScript runScript);

  /// To be set before the first advance, also after a restart: the first camera entry's.
  [[nodiscard]] Time startTime() const { return startTime_; }
  [[nodiscard]] double duration() const { return recording_.duration(); }
  [[nodiscard]] double elapsed() const { return elapsed_; }
  [[nodiscard]] bool finished() const { return elapsed_ >= duration() && nextScript_ == recording_.entries.size(); }

  /// `seconds` later, at least 0. Runs what is due, then places the camera at the scene's present time: call it after
  /// Scene::evaluate, and with 0 before the first frame.
  void advance(double seconds);
  /// Back to before the first advance. The camera stays where it is until the next.
  void restart();

 private:
  Player(SessionRecording recording, navigation::Camera& camera, RunScript runScript);
  void runDueScripts();
  void placeCamera();
  /// Why the camera cannot be placed: once, until it can again.
  void tellTrouble(const CameraEntry& entry, const std::string& why);

  SessionRecording recording_;
  navigation::Camera* camera_;
  RunScript runScript_;
  std::vector<std::size_t> cameras_;  ///< places of the camera entries
  Time startTime_;
  double elapsed_ = 0.0;
  std::size_t nextScript_ = 0;  ///< the first entry not yet looked at for scripts
  std::string trouble_;         ///< told last; empty while the camera can be placed
};

}  // namespace meridian::recording

#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "globebrowsing/layers/layer_step.h"

namespace meridian::globebrowsing {

/// Follows time (or a property) through the steps of one layer's provider: opens the step of the moment on a worker,
/// and while time plays the next ones in the direction of play. Keeps a few steps, however long it plays.
///
/// A step is shown once it is open (or has failed: then the layer has nothing to show); until then the one before
/// stays. Where time plays faster than steps open, the nearest that is open is shown. Where steps are interpolated, the
/// one on the other side of the moment is opened too. Render thread only.
class StepPlayer {
 public:
  /// Steps that are kept, beside those that somebody else holds.
  static constexpr std::size_t mostKept = 6;
  /// Steps that are opened at the same time: more would only queue.
  static constexpr std::size_t mostOpening = 2;
  /// Steps that are opened ahead.
  static constexpr int stepsAhead = 2;

  /// Both outlive the player.
  StepPlayer(WorkerPool* workers, TileStreamer* streamer) : workers_(workers), streamer_(streamer) {}

  /// Every frame. `source` is an open provider with steps.
  void update(const TileProvider& source, const Time& now);
  /// Forgets everything but what is shown.
  void rest();
  /// Forgets everything.
  void clear();

  /// The step to show; null before the first is open.
  [[nodiscard]] const LayerStepPointer& current() const { return current_; }
  /// What current() is mixed with, and how much of that there is, 0 to 1; null where there is nothing to mix, or not
  /// yet.
  [[nodiscard]] const LayerStepPointer& other() const { return other_; }
  [[nodiscard]] double otherWeight() const { return otherWeight_; }
  /// Whether the step of the moment, or the one to mix it with, is still being opened.
  [[nodiscard]] bool awaits() const { return awaits_; }
  /// Open steps that come next, nearest first.
  [[nodiscard]] const std::vector<LayerStepPointer>& ahead() const { return ahead_; }
  /// Whether any step that is kept has failed, or tiles of it.
  [[nodiscard]] bool hasFailed() const;
  /// Why the step of the moment has nothing to show, or an empty string.
  [[nodiscard]] const std::string& error() const { return error_; }

 private:
  struct Kept {
    LayerStepPointer step;
    std::uint64_t lastUsed = 0;
  };

  /// The step of that time, found or made, and being opened if there is room for that.
  LayerStepPointer stepAt(const TileProvider& source, const Time& time);
  void show(const LayerStepPointer& wanted);
  void mix(const TileProvider& source, const Time& now);
  void lookAhead(const TileProvider& source, const Time& now, const TileStep& shown);
  void noteMotion(const Time& now);
  void dropUnused();

  WorkerPool* workers_;
  TileStreamer* streamer_;
  std::vector<Kept> kept_;
  LayerStepPointer current_;
  LayerStepPointer other_;
  double otherWeight_ = 0.0;
  std::vector<LayerStepPointer> ahead_;
  std::string error_;
  std::optional<Time> last_;
  double moved_ = 0.0;   ///< seconds of scene time in the last frame in which time moved
  bool plays_ = false;   ///< it moved about as far as in the frame before
  bool rested_ = false;  ///< it stood still in the last frame
  bool awaits_ = false;
  bool told_ = false;  ///< a step that failed is logged once
  std::uint64_t frame_ = 0;
};

}  // namespace meridian::globebrowsing

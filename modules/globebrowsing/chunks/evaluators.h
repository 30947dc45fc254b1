#pragma once

#include "globebrowsing/chunks/selection.h"

namespace meridian::globebrowsing {

/// What an evaluator may know of a tile as seen by one view.
struct TileMeasure {
  double edgeLength = 0.0;  ///< metres
  double area = 0.0;        ///< square metres
  double facing = 1.0;      ///< cosine between its normal and the direction to the camera, 0..1, rounded up
  double distance = 0.0;    ///< metres to its nearest point, above 0
  double pixelsPerRadian = 0.0;
};

/// Whether a tile is too coarse for a view, and by how much: above 1 it is, and larger is more urgent.
///
/// An evaluator is a strategy without state; a new one is a class here and a line in evaluatorOf(). None looks at where
/// the view looks, so that the screens of a dome agree.
class EvaluatorStrategy {
 public:
  virtual ~EvaluatorStrategy() = default;
  [[nodiscard]] virtual double urgency(const TileMeasure& tile, const SelectionSettings& settings) const = 0;
  /// Whether it matters that some layer has finer data in the tile; if so a tile without any does not split.
  [[nodiscard]] virtual bool limitedByData() const = 0;
};

/// Pixels that a texel of the tile's composite covers at the tile's nearest point.
class ScreenSpaceErrorEvaluator final : public EvaluatorStrategy {
 public:
  [[nodiscard]] double urgency(const TileMeasure& tile, const SelectionSettings& settings) const override;
  [[nodiscard]] bool limitedByData() const override { return true; }
};

/// The tile's edge against its distance (Bladin & Broberg 2016, section 3.3.1): a tile splits when nearer than twice
/// its edge, whatever the screen's resolution and the data.
class DistanceEvaluator final : public EvaluatorStrategy {
 public:
  [[nodiscard]] double urgency(const TileMeasure& tile, const SelectionSettings& settings) const override;
  [[nodiscard]] bool limitedByData() const override { return false; }
};

/// The tile's area on screen against that of its composite (section 3.3.2): tiles seen at a slant stay coarser.
class ProjectedAreaEvaluator final : public EvaluatorStrategy {
 public:
  [[nodiscard]] double urgency(const TileMeasure& tile, const SelectionSettings& settings) const override;
  [[nodiscard]] bool limitedByData() const override { return false; }
};

/// As Distance, but never beyond the finest data of the enabled layers (section 3.3.3).
class AvailableDataEvaluator final : public EvaluatorStrategy {
 public:
  [[nodiscard]] double urgency(const TileMeasure& tile, const SelectionSettings& settings) const override;
  [[nodiscard]] bool limitedByData() const override { return true; }
};

/// Lives as long as the program.
[[nodiscard]] const EvaluatorStrategy& evaluatorOf(Evaluator evaluator);

}  // namespace meridian::globebrowsing

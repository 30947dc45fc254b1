#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include <glm/vec3.hpp>

#include "globebrowsing/chunks/chunk_bounds.h"
#include "globebrowsing/chunks/culling.h"
#include "globebrowsing/chunks/evaluators.h"
#include "globebrowsing/chunks/selection.h"

namespace meridian::globebrowsing {

/// Pixels that a metre covers, at most, within a tile, on the flat picture, which stretches what is off its middle.
struct ErrorScale {
  double vertical = 0.0;  ///< along the vertical, seen at the tile's slant
  double along = 0.0;     ///< along the surface
};

/// What all views together ask of a tile.
struct Demand {
  std::uint32_t views = 0;   ///< that see it
  std::uint32_t beside = 0;  ///< that would see it, looking elsewhere
  double distance = 0.0;
  double urgency = 0.0;
  double pixelsPerMetre = 0.0;  ///< at the tile's nearest point
  ErrorScale error;
  double centred = 0.0;  ///< 1 in the middle of a view, 0 behind it
};

/// The views of a selection, made ready for many tiles. At most 32; those that are not finite or look nowhere are left
/// out.
class PreparedViews {
 public:
  /// `radii`: of the globe. Settings in range.
  void prepare(std::span<const SelectionView> views, const SelectionSettings& settings, const glm::dvec3& radii);

  [[nodiscard]] bool empty() const { return count_ == 0; }
  /// What the tile's cap is made for; see Horizon.
  [[nodiscard]] double occluderScale() const { return occluderScale_; }
  /// Pixels per radian of the view that has most of them; 0 without views.
  [[nodiscard]] double finestPixels() const;
  [[nodiscard]] Demand demandOn(const ChunkBounds& bounds, const HorizonCap& cap) const;

 private:
  struct PreparedView {
    glm::dvec3 position{0.0};
    glm::dvec3 forward{0.0};  ///< unit, or zero where the matrix has none
    double pixelsPerRadian = 0.0;
    double leastCosine = 1.0;  ///< between forward and the corners of the picture
    std::uint32_t bit = 0;
    Frustum frustum;
    Horizon horizon{glm::dvec3(1.0), 0.0, glm::dvec3(0.0)};
  };
  static constexpr std::size_t mostViews = 32;
  [[nodiscard]] static ErrorScale errorScale(const ChunkBounds& bounds, const PreparedView& view, double distance);

  std::array<PreparedView, mostViews> views_{};
  std::size_t count_ = 0;
  double occluderScale_ = 1.0;
  SelectionSettings settings_;
  const EvaluatorStrategy* evaluator_ = &evaluatorOf(Evaluator::ScreenSpaceError);
};

}  // namespace meridian::globebrowsing

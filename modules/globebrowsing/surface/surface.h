#pragma once

#include <cstddef>
#include <optional>

#include <glm/vec3.hpp>

#include "globebrowsing/chunks/selection.h"
#include "host/api/frame_context.h"
#include "host/api/settled.h"

namespace meridian::globebrowsing {

/// What the globe's properties ask of its surface in a frame.
struct SurfaceSettings {
  SelectionSettings selection;
  bool shading = true;
  bool accurateNormals = false;   ///< of the relief, not of the ellipsoid
  bool showEdges = false;         ///< of chunks, for debugging
  double ambient = 0.05;          ///< 0..1
  double opacity = 1.0;           ///< 0..1
  double waterReflectance = 1.0;  ///< 1: as of a sea in a breeze
  double compositionMilliseconds = 2.0;
};

/// A way to draw a globe from its layers: the chunked surface, later the projective grid. Render thread only; per frame
/// update once, then draw once per view.
class Surface {
 public:
  virtual ~Surface() = default;

  /// From now on it is the one that its globe draws, no longer one that is filled to take another's place.
  virtual void setShown() = 0;
  virtual void update(const FrameContext& frame, const SurfaceSettings& settings) = 0;
  virtual void draw(const FrameContext& frame, std::size_t view) = 0;
  /// Of the last frame's view of that number.
  [[nodiscard]] virtual Settled settled(std::size_t view) const = 0;

  /// Whether all that the last frame wanted and there is room for is drawn, if only without what is late.
  [[nodiscard]] virtual bool filled() const = 0;

  /// Of the textures and buffers that hold something.
  [[nodiscard]] virtual std::size_t residentBytes() const = 0;

  /// Metres of the drawn surface above the ellipsoid; 0 where nothing is in memory. Angles in radians.
  [[nodiscard]] virtual double heightAt(double latitude, double longitude) const = 0;
  /// The first point of the drawn surface on the ray, in model space.
  [[nodiscard]] virtual std::optional<glm::dvec3> pick(const glm::dvec3& origin, const glm::dvec3& direction) const = 0;
};

}  // namespace meridian::globebrowsing

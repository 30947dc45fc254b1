#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "globebrowsing/providers/colour_ramp.h"

namespace meridian::globebrowsing {

/// How a layer colours the composed heights.
enum class ReliefKind : std::uint8_t { ColorRelief, Hillshade, Slope, Isolines };

/// What a shader needs for it; shaders/layers/relief.glsl has the formulas.
struct ReliefStyle {
  ReliefKind kind = ReliefKind::ColorRelief;
  /// Hillshade: towards the light (east, north, up; a unit vector), and the factor of heights.
  /// Isolines: metres between them, width in pixels of a tile, opacity.
  glm::vec4 parameters{0.0F};
  glm::dvec3 colour{1.0};                    ///< of isolines
  std::shared_ptr<const ColourRamp> ramp{};  ///< ColorRelief: by metres, Slope: by degrees; null: nothing is shown
  std::string problem{};                     ///< why the ramp that was asked for is not the one shown; empty without
};

}  // namespace meridian::globebrowsing

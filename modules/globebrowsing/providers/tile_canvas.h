#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include <glm/vec2.hpp>

#include "globebrowsing/source/resample.h"

namespace meridian::globebrowsing {

/// Red, green, blue, alpha; not premultiplied.
using Rgba = std::array<std::uint8_t, 4>;

/// Draws onto one tile in colourLayout: rectangles and text for tiles that are made, not read. Without OpenGL, and to
/// the pixel alike everywhere. Positions are pixels from the interior's upper left corner; what is outside is cut off.
class TileCanvas {
 public:
  explicit TileCanvas(const Rgba& background);

  void rectangle(const glm::ivec2& corner, const glm::ivec2& size, const Rgba& colour);
  /// ASCII text, its middle there; `unit` pixels for each pixel of the font, whose capitals are 7 high. With an outline
  /// of `outline`, so that it can be read on anything.
  void text(const glm::ivec2& middle, int unit, std::string_view text, const Rgba& colour, const Rgba& outline);

  /// The tile; the canvas is of no use afterwards.
  [[nodiscard]] ColourPixels take();

 private:
  ColourPixels pixels_;
};

}  // namespace meridian::globebrowsing

#include "globebrowsing/providers/tile_canvas.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

#include <stb/stb_easy_font.h>

namespace meridian::globebrowsing {

namespace {

/// A corner of a quad as stb_easy_font writes it.
struct FontVertex {
  float x, y, z;
  std::uint32_t colour;
};
using FontQuad = std::array<FontVertex, 4>;
static_assert(sizeof(FontQuad) == 64);

/// A letter's strokes, upright rectangles in pixels of the font.
std::vector<FontQuad> strokesOf(std::string_view text) {
  std::string copy(text.substr(0, 256));  // the library takes char*
  std::replace_if(
      copy.begin(), copy.end(), [](char c) { return c < 32 || c > 126; }, '?');
  constexpr std::size_t mostQuadsPerLetter = 16;
  std::vector<FontQuad> quads(mostQuadsPerLetter * (copy.size() + 1));
  const int count = stb_easy_font_print(0.0F, 0.0F, copy.data(), nullptr, quads.data(),
                                        static_cast<int>(quads.size() * sizeof(FontQuad)));
  quads.resize(static_cast<std::size_t>(count));
  return quads;
}

int pixels(float fontPixels, int unit) {
  return static_cast<int>(std::lround(fontPixels * static_cast<float>(unit)));
}

}  // namespace

TileCanvas::TileCanvas(const Rgba& background) {
  pixels_.size = colourLayout.size();
  const auto count = static_cast<std::size_t>(pixels_.size) * static_cast<std::size_t>(pixels_.size);
  pixels_.rgba.resize(4 * count);
  for (std::size_t i = 0; i < count; ++i) {
    std::memcpy(&pixels_.rgba[4 * i], background.data(), 4);
  }
}

void TileCanvas::rectangle(const glm::ivec2& corner, const glm::ivec2& size, const Rgba& colour) {
  const auto clamped = [&](int position) { return std::clamp(position + colourLayout.border, 0, pixels_.size); };
  for (int y = clamped(corner.y); y < clamped(corner.y + size.y); ++y) {
    for (int x = clamped(corner.x); x < clamped(corner.x + size.x); ++x) {
      std::memcpy(&pixels_.rgba[4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(pixels_.size) +
                                     static_cast<std::size_t>(x))],
                  colour.data(), 4);
    }
  }
}

void TileCanvas::text(const glm::ivec2& middle, int unit, std::string_view text, const Rgba& colour,
                      const Rgba& outline) {
  const std::vector<FontQuad> strokes = strokesOf(text);
  float right = 0.0F;
  for (const FontQuad& quad : strokes) {
    right = std::max(right, quad[2].x);
  }
  constexpr float capitals = 7.0F;
  const glm::ivec2 origin = middle - glm::ivec2(pixels(right, unit), pixels(capitals, unit)) / 2;
  const int edge = std::max(1, unit / 2);
  for (const bool outlining : {true, false}) {
    for (const FontQuad& quad : strokes) {
      const glm::ivec2 grow(outlining ? edge : 0);
      const glm::ivec2 from = origin + glm::ivec2(pixels(quad[0].x, unit), pixels(quad[0].y, unit)) - grow;
      const glm::ivec2 to = origin + glm::ivec2(pixels(quad[2].x, unit), pixels(quad[2].y, unit)) + grow;
      rectangle(from, to - from, outlining ? outline : colour);
    }
  }
}

ColourPixels TileCanvas::take() {
  pixels_.anyOpaque = false;
  pixels_.allOpaque = true;
  for (std::size_t i = 3; i < pixels_.rgba.size(); i += 4) {
    pixels_.anyOpaque = pixels_.anyOpaque || pixels_.rgba[i] > 0;
    pixels_.allOpaque = pixels_.allOpaque && pixels_.rgba[i] == 255;
  }
  return std::move(pixels_);
}

}  // namespace meridian::globebrowsing

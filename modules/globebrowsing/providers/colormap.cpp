#include "globebrowsing/providers/colormap.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "globebrowsing/source/document_file.h"
#include "globebrowsing/source/tile_formats.h"

namespace meridian::globebrowsing {

namespace {

constexpr std::size_t mostBytes = std::size_t{1} << 20;

}  // namespace

Result<std::shared_ptr<const Colormap>> Colormap::read(const std::string& path, const std::string& where) {
  return readTextFile(path, mostBytes, where, "name an image that is one row of colours")
      .and_then([&](const std::string& bytes) {
        const auto* data = reinterpret_cast<const std::uint8_t*>(bytes.data());
        return decodeByGdal({data, bytes.size()}, where).map_error([&](Error error) {
          error.what = "the colormap " + path + ": " + error.what;
          return error;
        });
      })
      .map([](const DecodedImage& image) {
        const DecodedColours& row = image.tile;
        const std::size_t count = static_cast<std::size_t>(row.width > 1 ? row.width : row.height);
        auto colormap = std::make_shared<Colormap>();
        for (std::size_t i = 0; i < colormap->colours_.size(); ++i) {
          const double at = static_cast<double>(i) / 255.0 * static_cast<double>(count - 1);
          const auto below = static_cast<std::size_t>(at);
          const std::size_t above = std::min(below + 1, count - 1);
          for (std::size_t band = 0; band < 3; ++band) {
            const double mixed =
                std::lerp(row.rgba[4 * below + band], row.rgba[4 * above + band], at - static_cast<double>(below));
            colormap->colours_[i][band] = static_cast<std::uint8_t>(std::lround(mixed));
          }
        }
        return std::shared_ptr<const Colormap>(std::move(colormap));
      });
}

void Colormap::apply(ColourPixels& pixels) const {
  for (std::size_t i = 0; i + 4 <= pixels.rgba.size(); i += 4) {
    const std::array<std::uint8_t, 3>& colour = colours_[pixels.rgba[i]];
    std::copy(colour.begin(), colour.end(), pixels.rgba.begin() + static_cast<std::ptrdiff_t>(i));
  }
}

}  // namespace meridian::globebrowsing

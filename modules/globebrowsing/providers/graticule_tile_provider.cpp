#include "globebrowsing/providers/graticule_tile_provider.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "globebrowsing/providers/inner_providers.h"

namespace meridian::globebrowsing {

namespace {

constexpr double pi = std::numbers::pi;
constexpr double secondsPerRadian = 180.0 * 3600.0 / pi;

/// Arc seconds; each divides 90 degrees.
constexpr std::array<int, 16> spacings{108000, 54000, 36000, 18000, 7200, 3600, 1800, 600,
                                       300,    120,   60,    30,    10,   5,    2,    1};
/// At least as many lines cross a tile.
constexpr int linesPerTile = 3;

/// From the nearest multiple of the spacing.
double distance(double value, double spacing) {
  return std::abs(std::remainder(value, spacing));
}

/// How much of a pixel a line covers whose middle is that far from the pixel's.
double coverage(double distance, double halfWidth, double pixel) {
  return std::clamp(0.5 + (halfWidth - distance) / pixel, 0.0, 1.0);
}

}  // namespace

const Schema& GraticuleTileProvider::schema() {
  using Type = Schema::Type;
  static const Schema fields({{"LineColor", Type::Vector3, "red, green and blue of the lines", false, 0.0, 1.0},
                              {"LineOpacity", Type::Number, "0 is invisible, 1 opaque", false, 0.0, 1.0},
                              {"LineWidth", Type::Number, "pixels of a tile, which has 512", false, 0.5, 32.0}});
  return fields;
}

Result<std::shared_ptr<TileProvider>> GraticuleTileProvider::make(const ProviderRequest& request) {
  Style style;
  if (const auto colour = valueAt(request.table, "LineColor").numbers(3)) {
    style.colour = {(*colour)[0], (*colour)[1], (*colour)[2]};
  }
  style.opacity = valueAt(request.table, "LineOpacity").number().value_or(style.opacity);
  style.widthPixels = valueAt(request.table, "LineWidth").number().value_or(style.widthPixels);
  return std::make_shared<GraticuleTileProvider>(style);
}

int GraticuleTileProvider::spacingOf(int level) {
  const double tileSeconds = 180.0 * 3600.0 / std::ldexp(1.0, level);
  for (const int spacing : spacings) {
    if (spacing * linesPerTile <= tileSeconds) {
      return spacing;
    }
  }
  return spacings.back();
}

int GraticuleTileProvider::meridianSpacing(int spacing, double latitude) {
  const double room = std::cos(latitude);
  // At the pole itself only four are left.
  int chosen = 90 * 3600;
  for (const int wider : spacings) {
    if (wider >= spacing && wider % spacing == 0 && wider * room >= 0.4 * spacing) {
      chosen = std::min(chosen, wider);
    }
  }
  return chosen;
}

Result<ColourPixels> GraticuleTileProvider::makeColours(const Tiling& tiling, const TileIndex& index,
                                                        std::stop_token stop) const {
  const int spacing = spacingOf(index.level);
  const double pixel = 180.0 * 3600.0 / std::ldexp(static_cast<double>(colourLayout.interior), index.level);
  const double halfWidth = 0.5 * style_.widthPixels * pixel;
  ColourPixels pixels;
  pixels.size = colourLayout.size();
  pixels.rgba.resize(4 * static_cast<std::size_t>(pixels.size) * static_cast<std::size_t>(pixels.size));
  const auto byte = [](double value) { return static_cast<std::uint8_t>(std::lround(255.0 * value)); };
  const std::array<std::uint8_t, 3> colour{byte(style_.colour.x), byte(style_.colour.y), byte(style_.colour.z)};
  std::uint8_t* at = pixels.rgba.data();
  for (int row = 0; row < pixels.size; ++row) {
    if (stop.stop_requested()) {
      return failure("cancelled");
    }
    for (int column = 0; column < pixels.size; ++column, at += 4) {
      const GeodeticPosition place = tiling.geodetic(index, colourLayout.uv(column, row));
      const double latitude = place.latitude * secondsPerRadian;
      const double band = (std::floor(std::abs(latitude) / spacing) + 1.0) * spacing / secondsPerRadian;
      const int meridians = meridianSpacing(spacing, std::min(band, pi / 2.0));
      const double narrowing = std::cos(place.latitude);
      const double parallel = coverage(distance(latitude, spacing), halfWidth, pixel);
      const double meridian =
          coverage(distance(place.longitude * secondsPerRadian, meridians) * narrowing, halfWidth, pixel);
      const double covered = std::max(parallel, meridian) * style_.opacity;
      std::copy(colour.begin(), colour.end(), at);
      at[3] = byte(covered);
      pixels.anyOpaque = pixels.anyOpaque || at[3] > 0;
    }
  }
  return pixels;
}

}  // namespace meridian::globebrowsing

#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "globebrowsing/source/map_crs.h"
#include "globebrowsing/source/tile_service.h"

namespace meridian::globebrowsing {

/// What a layer says of a service's tiles because their server does not: the layer's table `Tiles`.
struct TileSettings {
  std::optional<TileEncoding> encoding{};  ///< of any service

  // Of URL templates only: all other descriptions say these themselves.
  std::optional<int> pixelSize{};   ///< of a tile's side
  std::optional<int> firstLevel{};  ///< 0 to 30, not greater than lastLevel
  std::optional<int> lastLevel{};
  std::optional<bool> countsFromSouth{};
  std::optional<std::string> projection{};
  std::optional<Extent> square{};  ///< of level 0, in units of the projection
  std::optional<Extent> extentDegrees{};

  [[nodiscard]] bool isEmpty() const { return !encoding && keyOfTemplates().empty(); }
  /// The first key that is there of those for URL templates, as assets have it; empty: none is.
  [[nodiscard]] constexpr std::string_view keyOfTemplates() const {
    return pixelSize         ? "PixelSize"
           : firstLevel      ? "FirstLevel"
           : lastLevel       ? "LastLevel"
           : countsFromSouth ? "RowsFromSouth"
           : projection      ? "Projection"
           : square          ? "Square"
           : extentDegrees   ? "Extent"
                             : "";
  }
};

}  // namespace meridian::globebrowsing

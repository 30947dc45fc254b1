#pragma once

#include <optional>
#include <string>
#include <string_view>

#include <nlohmann/json_fwd.hpp>

#include "globebrowsing/source/capabilities.h"
#include "globebrowsing/source/tile_url.h"
#include "globebrowsing/source/xml_document.h"

namespace meridian::globebrowsing {

// What the readers of the kinds of capabilities share. Each leaves layers and problems in its result.

[[nodiscard]] Result<Capabilities> readWmsCapabilities(const XmlDocument& document);
[[nodiscard]] Result<Capabilities> readWmtsCapabilities(const XmlDocument& document);
[[nodiscard]] Result<Capabilities> readTmsCapabilities(const XmlDocument& document);
[[nodiscard]] Result<Capabilities> readTiledWmsCapabilities(const XmlDocument& document);
[[nodiscard]] Result<Capabilities> readArcGisCapabilities(const nlohmann::json& document, const std::string& url);

[[nodiscard]] Result<TileService> mapsOf(const Capabilities& capabilities, const CapabilitiesLayer& layer,
                                         const LayerChoices& choices);
[[nodiscard]] Result<TileService> tilesOf(const Capabilities& capabilities, const CapabilitiesLayer& layer,
                                          const LayerChoices& choices);

/// WMS 1.3.0 or later: CRS rather than SRS, and axes in the CRS's own order.
[[nodiscard]] bool isWmsThree(const std::string& version);

/// Less is better for us; nothing: not an image that is decoded here.
[[nodiscard]] std::optional<int> formatRank(std::string_view format);
[[nodiscard]] bool formatHasAlpha(std::string_view format);
/// Those that can be decoded come first, the best of them before the others.
void sortFormats(std::vector<std::string>& formats);

/// Radians from degrees, put right where that can be done: latitude and longitude exchanged, an extent over the
/// antimeridian with west greater than east, a pole overshot. Nothing where it cannot.
[[nodiscard]] std::optional<Extent> extentFromDegrees(Extent degrees);
[[nodiscard]] Extent toDegrees(const Extent& radians);
/// Radians of a box in units of the CRS, its easting first. Nothing where the CRS has no such place.
[[nodiscard]] std::optional<Extent> extentOfBox(const MapCrs& crs, const Extent& box);

/// The value to ask for: the chosen one, the default, else the last time or the first value; and whether somebody chose
/// it. Errors: a value chosen of a dimension that is no time and does not have it.
struct DimensionValue {
  std::string value;
  bool isDefault = false;
};
[[nodiscard]] Result<DimensionValue> dimensionValue(const LayerDimension& dimension, const LayerChoices& choices,
                                                    const std::string& where);

/// The places of a window in an address: {West} and so on.
[[nodiscard]] std::vector<TileUrl::Placeholder> windowPlaceholders();

/// Of parts that are not empty: "A; B".
[[nodiscard]] std::string joined(const std::vector<std::string>& parts, std::string_view separator);

}  // namespace meridian::globebrowsing

#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "globebrowsing/source/crs_names.h"
#include "globebrowsing/source/map_crs.h"
#include "globebrowsing/source/tile_service.h"
#include "host/api/error.h"

namespace meridian::globebrowsing {

enum class CapabilitiesKind : std::uint8_t {
  Wms,       ///< OGC WMS 1.0.0 to 1.3.0
  Wmts,      ///< OGC WMTS 1.0.0
  Tms,       ///< OSGeo TMS 1.0.0: a TileMap, or a list of them
  TiledWms,  ///< JPL's GetTileService
  ArcGis     ///< Esri's MapServer and ImageServer, as JSON, or a list of them
};
/// "WMS", "WMTS", "TMS", "TiledWMS", "ArcGIS".
[[nodiscard]] std::string_view kindName(CapabilitiesKind kind);

/// A dimension of a layer besides its two: time, elevation, or whatever the service has.
struct LayerDimension {
  std::string name;      ///< as the service spells it
  std::string values{};  ///< comma-separated values and intervals, for TimeDimension::parse where it is a time
  std::string defaultValue{};
  std::string units{};
  bool isNearestValue = false;  ///< the server takes the nearest to what is asked
  bool hasCurrent = false;

  [[nodiscard]] bool isTime() const;
};

struct LayerStyle {
  std::string identifier;
  std::string title{};
};

/// What a layer offers of a matrix set, for tiles that the service has cut.
struct MatrixSetLink {
  std::size_t set = 0;  ///< its place in Capabilities::matrixSets
  struct Limits {
    std::string matrix;
    std::int64_t firstRow = 0;
    std::int64_t lastRow = 0;
    std::int64_t firstColumn = 0;
    std::int64_t lastColumn = 0;
  };
  std::vector<Limits> limits{};  ///< empty: the whole set
};

/// A set of tile matrices, in the order of the document.
struct MatrixSet {
  std::string identifier;
  std::string crs;  ///< as the service names it
  std::vector<TileMatrix> matrices{};
  std::optional<double> southOrigin{};  ///< rows count from there northward (TMS)
  std::string problem{};                ///< why no layer can use it; empty: all is well
};

/// The address of a layer's tiles in one format, with WMTS's {TileMatrix}, {TileRow} ({TileRowFromSouth}), {TileCol},
/// {Style}, {TileMatrixSet} and dimensions; of maps, with {West} ..., {Width}, {Height} in place of the tile's.
struct AddressTemplate {
  std::string format;
  std::string address;
};

/// One layer of a service, its inheritance done.
struct CapabilitiesLayer {
  std::string identifier;  ///< what is asked for; empty: a heading, or (TMS, ArcGIS lists) a document of its own
  std::string title{};
  std::string abstract{};
  std::vector<std::string> path{};     ///< titles of what it lies in, outermost first
  std::optional<Extent> extent{};      ///< radians; west may be beyond -pi, east beyond pi
  std::vector<LayerStyle> styles{};    ///< the default first
  std::vector<std::string> formats{};  ///< as the service spells them, best for us first
  CrsNames crs{};                      ///< that maps can be asked in
  std::vector<LayerDimension> dimensions{};
  std::string attribution{};
  bool isOpaque = false;
  /// Empty: serviceOf can do it. Else why not, as a sentence without full stop.
  std::string obstacle{};
  /// The address of the document that describes it, where this one only names it.
  std::string document{};

  // For serviceOf.
  /// By CRS name, in its units. Of maps: in the document's order of axes. Of tiles: easting first, and only where they
  /// alone give the extent.
  std::vector<std::pair<std::string, Extent>> boundingBoxes{};
  std::vector<MatrixSetLink> matrixSets{};
  std::vector<AddressTemplate> addresses{};
  double coarsestPixelMetres = 0.0;  ///< maps of larger and smaller pixels are empty; 0: not said
  double finestPixelMetres = 0.0;
  int fixedWidth = 0;  ///< pixels; 0: any
  int fixedHeight = 0;
  bool isWholeOnly = false;  ///< no parts of its extent (WMS: noSubsets)
  /// Its values are no colours of 8 bits, and can be had as they are (ArcGIS's exportImage).
  bool hasValues = false;
  int valueBands = 0;              ///< of those; 0: not said
  std::optional<double> noData{};  ///< of those

  [[nodiscard]] const LayerDimension* timeDimension() const;
};

/// What a map service says that it has.
struct Capabilities {
  CapabilitiesKind kind = CapabilitiesKind::Wms;
  std::string version{};
  std::string url{};  ///< where the document came from
  std::string title{};
  std::string abstract{};
  std::string attribution{};                ///< provider, fees, constraints: whatever there is of it
  std::vector<CapabilitiesLayer> layers{};  ///< in document order, headings among them
  std::vector<std::string> problems{};      ///< what was left out, and why

  std::vector<MatrixSet> matrixSets{};
  int maximumWidth = 0;  ///< pixels of a map; 0: not said
  int maximumHeight = 0;
  std::string mapAddress{};  ///< where maps are asked for

  /// By identifier; then by title. Null without such a layer.
  [[nodiscard]] const CapabilitiesLayer* find(std::string_view name) const;
};

/// Reads a capabilities document of any of these services; which one, it says itself. `url` is where it came from:
/// addresses in it may be relative, and TMS and ArcGIS name no other. Reads what real servers write: elements missing,
/// namespaces and case at will.
/// Errors: neither XML nor JSON of a known kind; a service's exception, quoted; no layers at all.
[[nodiscard]] Result<Capabilities> parseCapabilities(std::span<const std::uint8_t> bytes, const std::string& url);

/// What to take where a layer offers several. Empty: the service's default, or what suits a globe best.
struct LayerChoices {
  std::string style{};
  std::string format{};
  std::string crs{};                                ///< of maps
  std::string matrixSet{};                          ///< of tiles
  std::string time{};                               ///< a value of the time dimension, as TimeDimension::text has it
  std::map<std::string, std::string> dimensions{};  ///< values of others, by name
  bool isTransparent = true;                        ///< maps without background, where the format has alpha
  /// Further parameters of the query, such as a vendor's, name and value.
  std::vector<std::pair<std::string, std::string>> parameters{};
};

/// The tiles of a layer of `capabilities`. Only what these capabilities allow is ever asked for.
/// Errors: the layer's obstacle; a choice that it does not offer; no CRS or matrix set that can be used.
[[nodiscard]] Result<TileService> serviceOf(const Capabilities& capabilities, const CapabilitiesLayer& layer,
                                            const LayerChoices& choices = {});

}  // namespace meridian::globebrowsing

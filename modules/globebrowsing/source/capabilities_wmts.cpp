#include <algorithm>
#include <cmath>
#include <optional>

#include "globebrowsing/source/capabilities_parts.h"
#include "globebrowsing/source/service_text.h"
#include "globebrowsing/source/tile_pyramid.h"

namespace meridian::globebrowsing {

namespace {

constexpr double pixelOfScale = 0.00028;  ///< metres of a pixel, OGC 07-057r7 section 6.1
constexpr double metresOfDegreeOfEarth = 111319.49079327358;

/// "-180.0 90.0"; some write a comma.
std::optional<std::pair<double, double>> readCorner(const std::string& corner) {
  const std::vector<std::string> parts = split(corner, " ,\t\r\n");
  if (parts.size() < 2) {
    return std::nullopt;
  }
  const auto first = number(parts[0]);
  const auto second = number(parts[1]);
  return first && second ? std::optional(std::pair{*first, *second}) : std::nullopt;
}

/// Of a bounding box, in the document's order of axes.
std::optional<Extent> readCorners(const pugi::xml_node& box) {
  const auto lower = readCorner(text(box, "LowerCorner"));
  const auto upper = readCorner(text(box, "UpperCorner"));
  return lower && upper ? std::optional(Extent{lower->first, lower->second, upper->first, upper->second})
                        : std::nullopt;
}

/// A matrix before its pixels are in units of the CRS.
struct ScaledMatrix {
  TileMatrix matrix;
  double scaleDenominator = 0.0;
  std::pair<double, double> corner;
};

std::optional<ScaledMatrix> readMatrix(const pugi::xml_node& node) {
  ScaledMatrix result;
  result.matrix.identifier = text(node, "Identifier");
  const auto scale = number(text(node, "ScaleDenominator"));
  const auto corner = readCorner(text(node, "TopLeftCorner"));
  const auto width = integer(text(node, "TileWidth"));
  const auto height = integer(text(node, "TileHeight"));
  const auto columns = integer(text(node, "MatrixWidth"));
  const auto rows = integer(text(node, "MatrixHeight"));
  constexpr long long mostPixels = 8192;
  if (result.matrix.identifier.empty() || !scale || *scale <= 0 || !corner || !width || !height || *width < 1 ||
      *height < 1 || *width > mostPixels || *height > mostPixels || !columns || !rows || *columns < 1 || *rows < 1) {
    return std::nullopt;
  }
  result.scaleDenominator = *scale;
  result.corner = *corner;
  result.matrix.tileWidth = static_cast<int>(*width);
  result.matrix.tileHeight = static_cast<int>(*height);
  result.matrix.lastColumn = *columns - 1;
  result.matrix.lastRow = *rows - 1;
  return result;
}

/// Northing first or easting first: the CRS says, unless no latitude can be that large.
bool isCornerTurned(const MapCrs& crs, const std::vector<ScaledMatrix>& matrices) {
  if (!crs.isGeographic()) {
    return crs.isNorthingFirst();
  }
  const auto isNoLatitude = [](double value) { return std::abs(value) > 90.5; };
  for (const ScaledMatrix& scaled : matrices) {
    if (isNoLatitude(scaled.corner.first)) {
      return false;
    }
    if (isNoLatitude(scaled.corner.second)) {
      return true;
    }
  }
  return crs.isNorthingFirst();
}

/// Metres of a degree as the service took them. The standard says the CRS's own body, and servers of other planets'
/// maps take the Earth's or a sphere's: a set that then spans just one turn tells.
struct DegreeLength {
  double metres = metresOfDegreeOfEarth;
  bool isOneTurn = false;
};

DegreeLength degreeLength(const MapCrs& crs, const std::vector<ScaledMatrix>& matrices) {
  for (const double metres : {crs.metresPerUnit(), metresOfDegreeOfEarth}) {
    const bool isOneTurn = !matrices.empty() && std::all_of(matrices.begin(), matrices.end(), [&](const auto& scaled) {
      const double columns = static_cast<double>(scaled.matrix.lastColumn + 1) * scaled.matrix.tileWidth;
      const double span = columns * scaled.scaleDenominator * pixelOfScale / metres;
      return std::abs(span / 360.0 - 1.0) < 0.005;
    });
    if (isOneTurn) {
      return {metres, true};
    }
  }
  return {crs.metresPerUnit(), false};
}

MatrixSet readSet(const XmlDocument& document, const pugi::xml_node& node) {
  MatrixSet set;
  set.identifier = text(node, "Identifier");
  set.crs = text(node, "SupportedCRS");
  const auto crs = MapCrs::of(set.crs, document.placeOf(node));
  if (!crs) {
    set.problem = crs.error().what;
    return set;
  }
  std::vector<ScaledMatrix> matrices;
  for (const pugi::xml_node& entry : children(node, "TileMatrix")) {
    if (auto matrix = readMatrix(entry)) {
      matrices.push_back(std::move(*matrix));
    }
  }
  const bool isTurned = isCornerTurned(*crs, matrices);
  const DegreeLength length = crs->isGeographic() ? degreeLength(*crs, matrices) : DegreeLength{crs->metresPerUnit()};
  for (ScaledMatrix& scaled : matrices) {
    TileMatrix& matrix = scaled.matrix;
    matrix.left = isTurned ? scaled.corner.second : scaled.corner.first;
    matrix.top = isTurned ? scaled.corner.first : scaled.corner.second;
    matrix.pixelWidth = scaled.scaleDenominator * pixelOfScale / length.metres;
    if (length.isOneTurn) {
      matrix.pixelWidth = 360.0 / (static_cast<double>(matrix.lastColumn + 1) * matrix.tileWidth);
    }
    matrix.pixelHeight = matrix.pixelWidth;
    set.matrices.push_back(matrix);
  }
  if (set.matrices.empty()) {
    set.problem = "the matrix set '" + set.identifier + "' has no matrix that can be read";
  }
  return set;
}

class WmtsReader {
 public:
  explicit WmtsReader(const XmlDocument& document) : document_(document) {}

  Result<Capabilities> read() {
    const pugi::xml_node root = document_.root();
    result_.kind = CapabilitiesKind::Wmts;
    result_.version = attribute(root, "version").empty() ? "1.0.0" : attribute(root, "version");
    const pugi::xml_node identification = child(root, "ServiceIdentification");
    result_.title = text(identification, "Title");
    result_.abstract = text(identification, "Abstract");
    const std::string constraints = text(identification, "AccessConstraints");
    result_.attribution = joined({text(root, "ServiceProvider/ProviderName"),
                                  equalIgnoringCase(constraints, "none") ? std::string() : constraints},
                                 "; ");
    readOperations(child(root, "OperationsMetadata"));
    const bool isSetsOnly = isNamed(root, "TileMatrixSets");
    readSets(isSetsOnly ? root : child(root, "Contents"));
    for (const pugi::xml_node& layer : children(child(root, "Contents"), "Layer")) {
      readLayer(layer);
    }
    if (result_.layers.empty() && !isSetsOnly) {
      return failure("the service has no layers", document_.placeOf(root));
    }
    return std::move(result_);
  }

 private:
  /// The addresses that take parameters; those that say nothing of their encoding do.
  void readOperations(const pugi::xml_node& operations) {
    for (const pugi::xml_node& operation : children(operations, "Operation")) {
      if (!equalIgnoringCase(attribute(operation, "name"), "GetTile")) {
        continue;
      }
      for (const pugi::xml_node& platform : children(operation, "DCP")) {
        for (const pugi::xml_node& get : children(child(platform, "HTTP"), "Get")) {
          readKeyValueAddress(get);
        }
      }
    }
  }

  void readKeyValueAddress(const pugi::xml_node& get) {
    std::string encodings;
    for (const pugi::xml_node& constraint : children(get, "Constraint")) {
      for (const pugi::xml_node& value : children(child(constraint, "AllowedValues"), "Value")) {
        encodings += text(value) + " ";
      }
    }
    const std::string address = attribute(get, "href");
    if (keyValueAddress_.empty() && !address.empty() && (encodings.empty() || containsIgnoringCase(encodings, "KVP"))) {
      keyValueAddress_ = resolvedUrl(document_.where(), repairedUrl(address));
    }
  }

  void readSets(const pugi::xml_node& contents) {
    for (const pugi::xml_node& node : contents.children()) {
      if (isNamed(node, "TileMatrixSet")) {
        MatrixSet set = readSet(document_, node);
        if (!set.problem.empty()) {
          result_.problems.push_back(document_.placeOf(node) + ": " + set.problem);
        }
        result_.matrixSets.push_back(std::move(set));
      } else if (isNamed(node, "Projection")) {  // GIBS's own list of sets
        readSets(node);
      }
    }
  }

  void readLayer(const pugi::xml_node& node) {
    CapabilitiesLayer layer;
    layer.identifier = text(node, "Identifier");
    layer.title = text(node, "Title").empty() ? layer.identifier : text(node, "Title");
    layer.abstract = text(node, "Abstract");
    for (const pugi::xml_node& style : children(node, "Style")) {
      const bool isDefault = boolean(attribute(style, "isDefault")).value_or(false);
      layer.styles.insert(isDefault ? layer.styles.begin() : layer.styles.end(),
                          {text(style, "Identifier"), text(style, "Title")});
    }
    for (const pugi::xml_node& format : children(node, "Format")) {
      layer.formats.push_back(text(format));
    }
    for (const pugi::xml_node& entry : children(node, "Dimension")) {
      LayerDimension dimension{text(entry, "Identifier")};
      std::vector<std::string> values;
      for (const pugi::xml_node& value : children(entry, "Value")) {
        values.push_back(text(value));
      }
      dimension.values = joined(values, ",");
      dimension.defaultValue = text(entry, "Default");
      dimension.units = text(entry, "UOM").empty() ? text(entry, "UnitSymbol") : text(entry, "UOM");
      dimension.hasCurrent = boolean(text(entry, "Current")).value_or(false);
      layer.dimensions.push_back(std::move(dimension));
    }
    readLinks(node, layer);
    readExtent(node, layer);
    readAddresses(node, layer);
    layer.obstacle = obstacleOf(layer);
    result_.layers.push_back(std::move(layer));
  }

  /// Where the layer gives no degrees, by a box in another CRS, that of a set before all others.
  void readExtent(const pugi::xml_node& node, CapabilitiesLayer& layer) const {
    if (const auto degrees = readCorners(child(node, "WGS84BoundingBox"))) {
      layer.extent = extentFromDegrees(*degrees);
    }
    if (layer.extent) {
      return;
    }
    auto& boxes = layer.boundingBoxes;
    for (const pugi::xml_node& entry : children(node, "BoundingBox")) {
      readBox(entry, layer);
    }
    std::stable_partition(boxes.begin(), boxes.end(),
                          [&](const auto& box) { return linkedSet(layer, box.first) != nullptr; });
    for (auto box = boxes.begin(); box != boxes.end() && !layer.extent; ++box) {
      const auto crs = MapCrs::of(box->first, document_.where());
      layer.extent = crs ? extentOfBox(*crs, box->second) : std::nullopt;
    }
  }

  /// A name that is a URI brings its authority's order of axes, "EPSG:..." has its easting first, as GDAL takes it.
  /// Where the box then lies beside its set and would not in the other order, that was meant.
  void readBox(const pugi::xml_node& node, CapabilitiesLayer& layer) const {
    std::string name = attribute(node, "crs");
    if (name.empty() && !layer.matrixSets.empty()) {
      name = result_.matrixSets[layer.matrixSets.front().set].crs;
    }
    const auto crs = MapCrs::of(name, document_.placeOf(node));
    const auto box = readCorners(node);
    if (!crs || !box || !(crs->isGeographic() || (box->west < box->east && box->south < box->north))) {
      return;
    }
    const Extent turned = axesExchanged(*box);
    const std::string scheme = lowerCase(name.substr(0, 4));
    const bool isTurned = crs->isNorthingFirst() && (scheme == "urn:" || scheme == "http");
    const MatrixSet* set = crs->isGeographic() ? nullptr : linkedSet(layer, name);
    const bool isOther =
        set != nullptr && !hasTilesIn(*set, isTurned ? turned : *box) && hasTilesIn(*set, isTurned ? *box : turned);
    layer.boundingBoxes.emplace_back(name, isTurned != isOther ? turned : *box);
  }

  [[nodiscard]] static bool hasTilesIn(const MatrixSet& set, const Extent& extent) {
    return std::any_of(set.matrices.begin(), set.matrices.end(),
                       [&](TileMatrix matrix) { return clip(matrix, extent); });
  }

  /// The set in that CRS, if the layer has one that can be used.
  [[nodiscard]] const MatrixSet* linkedSet(const CapabilitiesLayer& layer, const std::string& crs) const {
    for (const MatrixSetLink& link : layer.matrixSets) {
      const MatrixSet& set = result_.matrixSets[link.set];
      if (set.problem.empty() && canonicalCrsName(set.crs) == canonicalCrsName(crs)) {
        return &set;
      }
    }
    return nullptr;
  }

  void readLinks(const pugi::xml_node& node, CapabilitiesLayer& layer) {
    for (const pugi::xml_node& entry : children(node, "TileMatrixSetLink")) {
      // One set a link, says the standard; some list all of theirs in one.
      for (const pugi::xml_node& named : children(entry, "TileMatrixSet")) {
        readLink(entry, text(named), layer);
      }
    }
  }

  void readLink(const pugi::xml_node& entry, const std::string& name, CapabilitiesLayer& layer) {
    const auto set = std::find_if(result_.matrixSets.begin(), result_.matrixSets.end(),
                                  [&](const MatrixSet& candidate) { return candidate.identifier == name; });
    if (set == result_.matrixSets.end()) {
      result_.problems.push_back(document_.placeOf(entry) + ": there is no matrix set '" + name + "'");
      return;
    }
    MatrixSetLink link{static_cast<std::size_t>(set - result_.matrixSets.begin())};
    for (const pugi::xml_node& limits : children(child(entry, "TileMatrixSetLimits"), "TileMatrixLimits")) {
      const auto value = [&](std::string_view what, std::int64_t otherwise) {
        return integer(text(limits, what)).value_or(otherwise);
      };
      constexpr std::int64_t most = std::int64_t{1} << 40;
      link.limits.push_back({text(limits, "TileMatrix"), value("MinTileRow", 0), value("MaxTileRow", most),
                             value("MinTileCol", 0), value("MaxTileCol", most)});
    }
    layer.matrixSets.push_back(std::move(link));
  }

  void readAddresses(const pugi::xml_node& node, CapabilitiesLayer& layer) {
    for (const pugi::xml_node& resource : children(node, "ResourceURL")) {
      const std::string type = attribute(resource, "resourceType");
      const std::string address = attribute(resource, "template");
      if (!address.empty() && (type.empty() || equalIgnoringCase(type, "tile"))) {
        layer.addresses.push_back(
            {attribute(resource, "format"), resolvedUrl(document_.where(), repairedUrl(address))});
      }
    }
    if (hasImages(layer) || keyValueAddress_.empty()) {
      return;
    }
    for (const std::string& format : layer.formats) {
      QueryParameters parameters{{"SERVICE", "WMTS"},
                                 {"REQUEST", "GetTile"},
                                 {"VERSION", "1.0.0"},
                                 {"LAYER", percentEncoded(layer.identifier)},
                                 {"STYLE", "{Style}"},
                                 {"FORMAT", percentEncoded(format, "/")},
                                 {"TILEMATRIXSET", "{TileMatrixSet}"},
                                 {"TILEMATRIX", "{TileMatrix}"},
                                 {"TILEROW", "{TileRow}"},
                                 {"TILECOL", "{TileCol}"}};
      for (const LayerDimension& dimension : layer.dimensions) {
        parameters.emplace_back(percentEncoded(dimension.name), "{" + dimension.name + "}");
      }
      layer.addresses.push_back({format, withParameters(keyValueAddress_, parameters)});
    }
  }

  /// Whether one of the addresses gives tiles that can be read here.
  [[nodiscard]] static bool hasImages(const CapabilitiesLayer& layer) {
    return std::any_of(layer.addresses.begin(), layer.addresses.end(), [](const AddressTemplate& address) {
      return address.format.empty() || formatRank(address.format).has_value();
    });
  }

  [[nodiscard]] std::string obstacleOf(const CapabilitiesLayer& layer) const {
    if (layer.identifier.empty()) {
      return "it has no identifier";
    }
    if (layer.matrixSets.empty()) {
      return "it has no tile matrix set";
    }
    if (std::all_of(layer.matrixSets.begin(), layer.matrixSets.end(),
                    [&](const MatrixSetLink& link) { return !result_.matrixSets[link.set].problem.empty(); })) {
      return result_.matrixSets[layer.matrixSets.front().set].problem;
    }
    if (layer.addresses.empty()) {
      return "the service does not say where its tiles are";
    }
    if (!hasImages(layer)) {
      return "its tiles are no images that can be read here";
    }
    return {};
  }

  const XmlDocument& document_;
  Capabilities result_;
  std::string keyValueAddress_;
};

}  // namespace

Result<Capabilities> readWmtsCapabilities(const XmlDocument& document) {
  return WmtsReader(document).read();
}

}  // namespace meridian::globebrowsing

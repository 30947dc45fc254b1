#include <algorithm>
#include <cmath>

#include "globebrowsing/source/capabilities_parts.h"
#include "globebrowsing/source/service_text.h"

namespace meridian::globebrowsing {

namespace {

/// One TilePattern: the request for the first tile of a level.
struct Pattern {
  std::string query;
  TileMatrix matrix;
};

std::optional<Pattern> readPattern(const std::string& content) {
  // Further requests are the same tiles by other names.
  const std::vector<std::string> requests = split(content, " \t\r\n");
  if (requests.empty()) {
    return std::nullopt;
  }
  const std::string url = "?" + requests.front();
  const std::vector<std::string> box = split(parameterOf(url, "bbox").value_or(""), ",");
  const auto width = integer(parameterOf(url, "width").value_or(""));
  const auto height = integer(parameterOf(url, "height").value_or(""));
  if (box.size() != 4 || !width || !height || *width < 1 || *height < 1 || *width > 8192 || *height > 8192) {
    return std::nullopt;
  }
  const auto west = number(box[0]);
  const auto south = number(box[1]);
  const auto east = number(box[2]);
  const auto north = number(box[3]);
  if (!west || !south || !east || !north || !(*west < *east) || !(*south < *north)) {
    return std::nullopt;
  }
  Pattern pattern{requests.front(), {}};
  TileMatrix& matrix = pattern.matrix;
  matrix.tileWidth = static_cast<int>(*width);
  matrix.tileHeight = static_cast<int>(*height);
  matrix.left = *west;
  matrix.top = *north;
  matrix.pixelWidth = (*east - *west) / matrix.tileWidth;
  matrix.pixelHeight = (*north - *south) / matrix.tileHeight;
  constexpr std::int64_t most = std::int64_t{1} << 40;
  matrix.lastColumn = most;
  matrix.lastRow = most;
  return pattern;
}

class TiledWmsReader {
 public:
  explicit TiledWmsReader(const XmlDocument& document) : document_(document) {}

  Result<Capabilities> read() {
    const pugi::xml_node root = document_.root();
    result_.kind = CapabilitiesKind::TiledWms;
    result_.version = attribute(root, "version");
    result_.title = text(root, "Service/Title");
    result_.abstract = text(root, "Service/Abstract");
    const pugi::xml_node patterns = child(root, "TiledPatterns");
    const std::string address = attribute(child(patterns, "OnlineResource"), "href");
    result_.mapAddress = address.empty() ? document_.where() : resolvedUrl(document_.where(), repairedUrl(address));
    readGroups(patterns, {});
    if (result_.layers.empty()) {
      return failure("the service has no layers", document_.placeOf(root));
    }
    return std::move(result_);
  }

 private:
  void readGroups(const pugi::xml_node& node, const std::vector<std::string>& path) {
    for (const pugi::xml_node& entry : node.children()) {
      if (isNamed(entry, "TiledGroup")) {
        readGroup(entry, path);
      } else if (isNamed(entry, "TiledGroups")) {
        std::vector<std::string> inner = path;
        inner.push_back(text(entry, "Name"));
        readGroups(entry, inner);
      }
    }
  }

  void readGroup(const pugi::xml_node& node, const std::vector<std::string>& path) {
    CapabilitiesLayer layer;
    layer.identifier = text(node, "Name");
    layer.title = text(node, "Title").empty() ? layer.identifier : text(node, "Title");
    layer.abstract = text(node, "Abstract");
    layer.path = path;
    pugi::xml_node box = child(node, "LatLonBoundingBox");
    box = box ? box : child(document_.root(), "TiledPatterns/LatLonBoundingBox");
    const auto side = [&](std::string_view name, double otherwise) {
      return number(attribute(box, name)).value_or(otherwise);
    };
    layer.extent = extentFromDegrees({side("minx", -180), side("miny", -90), side("maxx", 180), side("maxy", 90)});
    if (!text(node, "Key").empty()) {
      layer.dimensions.push_back({"time"});
    }
    MatrixSet set{layer.identifier, {}};
    std::string query;
    for (const pugi::xml_node& entry : children(node, "TilePattern")) {
      auto pattern = readPattern(text(entry));
      if (!pattern) {
        result_.problems.push_back(document_.placeOf(entry) + ": a TilePattern without a box and sizes");
        continue;
      }
      query = query.empty() ? pattern->query : query;
      const bool isKnown = std::any_of(set.matrices.begin(), set.matrices.end(), [&](const TileMatrix& other) {
        return std::abs(other.pixelWidth / pattern->matrix.pixelWidth - 1.0) < 1e-6;
      });
      if (!isKnown) {
        pattern->matrix.identifier = std::to_string(set.matrices.size());
        set.matrices.push_back(pattern->matrix);
      }
    }
    finish(std::move(layer), std::move(set), query);
  }

  void finish(CapabilitiesLayer layer, MatrixSet set, const std::string& query) {
    const std::string url = "?" + query;
    set.crs = parameterOf(url, "srs").value_or(parameterOf(url, "crs").value_or("EPSG:4326"));
    const std::string format = replaceAll(parameterOf(url, "format").value_or("image/jpeg"), "%2F", "/");
    layer.formats.push_back(format);
    const char separator = result_.mapAddress.find('?') == std::string::npos ? '?' : '&';
    const bool needsNone = result_.mapAddress.ends_with('?') || result_.mapAddress.ends_with('&');
    const std::string address = result_.mapAddress + (needsNone ? std::string() : std::string(1, separator)) + query;
    layer.addresses.push_back(
        {format,
         withParameters(replaceAll(address, "${time}", "{time}"),
                        {{"width", "{Width}"}, {"height", "{Height}"}, {"bbox", "{West},{South},{East},{North}"}})});
    if (set.matrices.empty()) {
      layer.obstacle = "it has no tile patterns";
    } else if (!formatRank(format)) {
      layer.obstacle = "its tiles are '" + format + "', no images that can be read here";
    }
    layer.matrixSets.push_back({result_.matrixSets.size()});
    result_.matrixSets.push_back(std::move(set));
    result_.layers.push_back(std::move(layer));
  }

  const XmlDocument& document_;
  Capabilities result_;
};

}  // namespace

Result<Capabilities> readTiledWmsCapabilities(const XmlDocument& document) {
  return TiledWmsReader(document).read();
}

}  // namespace meridian::globebrowsing

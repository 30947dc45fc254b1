#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>

#include "globebrowsing/source/capabilities_parts.h"
#include "globebrowsing/source/service_text.h"

namespace meridian::globebrowsing {

namespace {

constexpr double pixelOfScale = 0.00028;  ///< metres of a pixel, OGC 06-042 section 7.2.4.6.9

std::optional<Extent> readBox(const pugi::xml_node& box) {
  const auto west = number(attribute(box, "minx"));
  const auto south = number(attribute(box, "miny"));
  const auto east = number(attribute(box, "maxx"));
  const auto north = number(attribute(box, "maxy"));
  if (!west || !south || !east || !north) {
    return std::nullopt;
  }
  return Extent{*west, *south, *east, *north};
}

std::optional<Extent> readGeographicBox(const pugi::xml_node& box) {
  const auto west = number(text(box, "westBoundLongitude"));
  const auto south = number(text(box, "southBoundLatitude"));
  const auto east = number(text(box, "eastBoundLongitude"));
  const auto north = number(text(box, "northBoundLatitude"));
  if (!west || !south || !east || !north) {
    return readBox(box);
  }
  return Extent{*west, *south, *east, *north};
}

template <class List, class Item, class Same>
void putOrReplace(List& list, Item item, Same same) {
  const auto found = std::find_if(list.begin(), list.end(), [&](const auto& other) { return same(other, item); });
  if (found == list.end()) {
    list.push_back(std::move(item));
  } else {
    *found = std::move(item);
  }
}

/// Goes through the tree of layers with what each inherits (OGC 06-042, table 7).
class WmsReader {
 public:
  explicit WmsReader(const XmlDocument& document) : document_(document) {}

  Result<Capabilities> read() {
    const pugi::xml_node root = document_.root();
    result_.kind = CapabilitiesKind::Wms;
    result_.version = attribute(root, "version");
    isThree_ = isWmsThree(result_.version) || (result_.version.empty() && isNamed(root, "WMS_Capabilities"));
    if (result_.version.empty()) {
      result_.version = isThree_ ? "1.3.0" : "1.1.1";
    }
    readService(child(root, "Service"));
    const pugi::xml_node capability = child(root, "Capability");
    readRequest(child(capability, "Request"));
    CapabilitiesLayer top;
    top.formats = formats_;
    const std::vector<pugi::xml_node> layers = children(capability ? capability : root, "Layer");
    for (const pugi::xml_node& layer : layers) {
      readLayer(layer, top);
    }
    if (result_.layers.empty()) {
      return failure("the service has no layers", document_.placeOf(capability ? capability : root));
    }
    return std::move(result_);
  }

 private:
  void readService(const pugi::xml_node& service) {
    result_.title = text(service, "Title");
    result_.abstract = text(service, "Abstract");
    const std::string constraints = text(service, "AccessConstraints");
    result_.attribution = joined({text(service, "ContactInformation/ContactPersonPrimary/ContactOrganization"),
                                  equalIgnoringCase(constraints, "none") ? std::string() : constraints},
                                 "; ");
    result_.maximumWidth = static_cast<int>(std::clamp(integer(text(service, "MaxWidth")).value_or(0), 0LL, 65536LL));
    result_.maximumHeight = static_cast<int>(std::clamp(integer(text(service, "MaxHeight")).value_or(0), 0LL, 65536LL));
    serviceAddress_ = attribute(child(service, "OnlineResource"), "href");
  }

  void readRequest(const pugi::xml_node& request) {
    pugi::xml_node getMap = child(request, "GetMap");
    getMap = getMap ? getMap : child(request, "Map");  // 1.0.0
    for (const pugi::xml_node& format : children(getMap, "Format")) {
      formats_.push_back(text(format));
      for (const pugi::xml_node& old : format.children()) {  // 1.0.0 has <Format><PNG/><JPEG/></Format>
        if (old.type() == pugi::node_element) {
          formats_.emplace_back(localName(old));
        }
      }
    }
    std::erase(formats_, std::string());
    pugi::xml_node get;  // some name the address for Post in an element of its own, and first
    for (const pugi::xml_node& platform : children(getMap, "DCPType")) {
      get = get ? get : child(platform, "HTTP/Get");
    }
    std::string address = attribute(child(get, "OnlineResource"), "href");
    address = address.empty() ? attribute(get, "onlineResource") : address;
    address = address.empty() ? serviceAddress_ : address;
    result_.mapAddress = address.empty() ? document_.where() : resolvedUrl(document_.where(), repairedUrl(address));
  }

  void readLayer(const pugi::xml_node& node, const CapabilitiesLayer& parent) {
    CapabilitiesLayer layer = parent;
    layer.identifier = text(node, "Name");
    layer.title = text(node, "Title");
    layer.abstract = text(node, "Abstract");
    if (layer.title.empty()) {
      layer.title = layer.identifier;
    }
    readPlaces(node, layer);
    const std::optional<Extent> fromDegrees = layer.extent;
    if (!layer.extent) {
      layer.extent = extentOfBoxes(layer.boundingBoxes);
    }
    readDimensions(node, layer);
    readRest(node, layer);
    layer.obstacle.clear();
    if (layer.identifier.empty()) {
      layer.obstacle = "it is a heading for other layers";
    } else if (!layer.formats.empty() &&
               std::none_of(layer.formats.begin(), layer.formats.end(),
                            [](const std::string& format) { return formatRank(format).has_value(); })) {
      layer.obstacle = "none of its formats is an image that can be read here";
    }
    result_.layers.push_back(layer);
    layer.extent = fromDegrees;  // children have boxes of their own
    layer.path.push_back(layer.title);
    for (const pugi::xml_node& inner : children(node, "Layer")) {
      readLayer(inner, layer);
    }
  }

  static void readCrsNames(const pugi::xml_node& node, CapabilitiesLayer& layer) {
    std::vector<std::string> names;
    for (const pugi::xml_node& entry : node.children()) {
      if (isNamed(entry, "SRS") || isNamed(entry, "CRS")) {
        std::vector<std::string> some = split(text(entry), " \t\r\n,");
        names.insert(names.end(), std::make_move_iterator(some.begin()), std::make_move_iterator(some.end()));
      }
    }
    layer.crs = layer.crs.with(std::move(names));
  }

  void readPlaces(const pugi::xml_node& node, CapabilitiesLayer& layer) {
    readCrsNames(node, layer);
    pugi::xml_node geographic = child(node, "EX_GeographicBoundingBox");
    geographic = geographic ? geographic : child(node, "LatLonBoundingBox");
    if (const std::optional<Extent> degrees = readGeographicBox(geographic)) {
      const std::optional<Extent> extent = extentFromDegrees(*degrees);
      if (extent) {
        layer.extent = extent;
      } else {
        result_.problems.push_back(document_.placeOf(geographic) + ": the extent of '" + layer.title + "' is no place");
      }
    }
    std::vector<std::pair<std::string, Extent>> boxes;  // its own before those that it inherits
    const auto isSameCrs = [](const auto& a, const auto& b) { return a.first == b.first; };
    for (const pugi::xml_node& entry : children(node, "BoundingBox")) {
      const std::string crs = attribute(entry, isThree_ ? "CRS" : "SRS");
      const std::string other = attribute(entry, isThree_ ? "SRS" : "CRS");
      if (const std::optional<Extent> box = readBox(entry); box && !(crs + other).empty()) {
        putOrReplace(boxes, std::pair{crs.empty() ? other : crs, *box}, isSameCrs);
      }
    }
    for (std::pair<std::string, Extent>& inherited : layer.boundingBoxes) {
      if (std::none_of(boxes.begin(), boxes.end(), [&](const auto& own) { return isSameCrs(own, inherited); })) {
        boxes.push_back(std::move(inherited));
      }
    }
    layer.boundingBoxes = std::move(boxes);
  }

  /// By the first box that gives some.
  [[nodiscard]] std::optional<Extent> extentOfBoxes(const std::vector<std::pair<std::string, Extent>>& boxes) const {
    for (const auto& [name, box] : boxes) {
      if (const auto crs = MapCrs::of(name, document_.where())) {
        if (const auto extent = extentOfBox(*crs, isThree_ && crs->isNorthingFirst() ? axesExchanged(box) : box)) {
          return extent;
        }
      }
    }
    return std::nullopt;
  }

  static void readDimensions(const pugi::xml_node& node, CapabilitiesLayer& layer) {
    const auto sameName = [](const LayerDimension& a, const LayerDimension& b) {
      return equalIgnoringCase(a.name, b.name);
    };
    for (const bool isExtent : {false, true}) {
      for (const pugi::xml_node& entry : children(node, isExtent ? "Extent" : "Dimension")) {
        LayerDimension dimension{attribute(entry, "name")};
        const auto known = std::find_if(layer.dimensions.begin(), layer.dimensions.end(),
                                        [&](const LayerDimension& d) { return sameName(d, dimension); });
        const bool isKnown = known != layer.dimensions.end();
        if (isExtent && isKnown) {
          dimension.units = known->units;
        } else {
          dimension.units = attribute(entry, "units");
        }
        dimension.values = text(entry);
        dimension.defaultValue = attribute(entry, "default");
        dimension.isNearestValue = boolean(attribute(entry, "nearestValue")).value_or(false);
        dimension.hasCurrent = boolean(attribute(entry, "current")).value_or(false);
        // A declaration without values keeps those that were inherited.
        const bool isBare = dimension.values.empty() && dimension.defaultValue.empty();
        if (!dimension.name.empty() && !(isKnown && isBare)) {
          putOrReplace(layer.dimensions, std::move(dimension), sameName);
        }
      }
    }
  }

  static double metresOfScale(const pugi::xml_node& node, std::string_view denominator, std::string_view hint) {
    if (const auto scale = number(text(node, denominator)); scale && *scale > 0) {
      return *scale * pixelOfScale;
    }
    const auto diagonal = number(attribute(child(node, "ScaleHint"), hint));
    return diagonal && *diagonal > 0 && *diagonal < 1e8 ? *diagonal / std::numbers::sqrt2 : 0.0;
  }

  static void readRest(const pugi::xml_node& node, CapabilitiesLayer& layer) {
    for (const pugi::xml_node& style : children(node, "Style")) {
      if (const std::string name = text(style, "Name"); !name.empty()) {
        putOrReplace(layer.styles, LayerStyle{name, text(style, "Title")},
                     [](const LayerStyle& a, const LayerStyle& b) { return a.identifier == b.identifier; });
      }
    }
    if (const pugi::xml_node attribution = child(node, "Attribution")) {
      layer.attribution = text(attribution, "Title");
    }
    if (const double finest = metresOfScale(node, "MinScaleDenominator", "min"); finest > 0) {
      layer.finestPixelMetres = finest;
    }
    if (const double coarsest = metresOfScale(node, "MaxScaleDenominator", "max"); coarsest > 0) {
      layer.coarsestPixelMetres = coarsest;
    }
    layer.isOpaque = boolean(attribute(node, "opaque")).value_or(layer.isOpaque);
    layer.isWholeOnly = boolean(attribute(node, "noSubsets")).value_or(layer.isWholeOnly);
    const auto size = [&](std::string_view name, int inherited) {
      return static_cast<int>(std::clamp(integer(attribute(node, name)).value_or(inherited), 0LL, 65536LL));
    };
    layer.fixedWidth = size("fixedWidth", layer.fixedWidth);
    layer.fixedHeight = size("fixedHeight", layer.fixedHeight);
  }

  const XmlDocument& document_;
  Capabilities result_;
  bool isThree_ = false;
  std::vector<std::string> formats_;
  std::string serviceAddress_;
};

}  // namespace

Result<Capabilities> readWmsCapabilities(const XmlDocument& document) {
  return WmsReader(document).read();
}

}  // namespace meridian::globebrowsing

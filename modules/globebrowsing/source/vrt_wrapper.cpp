#include "globebrowsing/source/vrt_wrapper.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "globebrowsing/source/service_text.h"
#include "globebrowsing/source/tile_pyramid.h"
#include "globebrowsing/source/xml_document.h"

namespace meridian::globebrowsing {

namespace {

struct Band {
  std::string file;
  bool isRelative = false;
  int number = 1;
  bool isAlphaFromNoData = false;    ///< 255 wherever there are data
  std::optional<double> noData{};    ///< of the source's values, which are not copied
  std::optional<double> declared{};  ///< NoDataValue: of the band's own values
  std::optional<double> scale{};
  std::optional<double> offset{};
  std::array<double, 4> from{};  ///< x, y, width, height
  std::array<double, 4> to{};
  bool isPart = false;  ///< `from` is less than all of the source
};

std::optional<std::array<double, 4>> rectangle(const pugi::xml_node& node) {
  const auto x = number(attribute(node, "xOff"));
  const auto y = number(attribute(node, "yOff"));
  const auto width = number(attribute(node, "xSize"));
  const auto height = number(attribute(node, "ySize"));
  if (!x || !y || !width || !height || *width <= 0 || *height <= 0) {
    return std::nullopt;
  }
  return std::array{*x, *y, *width, *height};
}

bool isMaskTable(const std::string& table) {
  std::string plain;
  for (const char c : table) {
    plain += c == ' ' ? "" : std::string(1, c);
  }
  return plain == "0:0,1:255,255:255";
}

/// What the band says of its own values. False where it is more than a service can say.
bool readMeaning(const pugi::xml_node& node, Band& band) {
  band.scale = number(text(node, "Scale"));
  band.offset = number(text(node, "Offset"));
  band.declared = number(text(node, "NoDataValue"));
  if (band.declared && band.noData && *band.declared != *band.noData) {
    return false;  // one value becomes another
  }
  if (boolean(text(node, "HideNoDataValue")).value_or(false)) {
    band.declared.reset();
    band.noData.reset();  // it is replaced by itself, and shown
  }
  return true;
}

/// Nothing: the band is made in a way that is not ours.
std::optional<Band> readBand(const pugi::xml_node& node) {
  if (!attribute(node, "subClass").empty()) {
    return std::nullopt;
  }
  pugi::xml_node source;
  for (const pugi::xml_node& part : node.children()) {
    if (isNamed(part, "SimpleSource") || isNamed(part, "ComplexSource")) {
      if (source) {
        return std::nullopt;
      }
      source = part;
    } else if (localName(part).ends_with("Source") || isNamed(part, "ColorTable")) {
      return std::nullopt;
    }
  }
  const auto from = rectangle(child(source, "SrcRect"));
  const auto to = rectangle(child(source, "DstRect"));
  if (!source || !from || !to) {
    return std::nullopt;
  }
  Band band;
  band.file = text(source, "SourceFilename");
  band.isRelative = boolean(attribute(child(source, "SourceFilename"), "relativeToVRT")).value_or(false);
  band.number = static_cast<int>(integer(text(source, "SourceBand")).value_or(1));
  band.from = *from;
  band.to = *to;
  const pugi::xml_node size = child(source, "SourceProperties");
  band.isPart = (*from)[2] < number(attribute(size, "RasterXSize")).value_or(0.0) ||
                (*from)[3] < number(attribute(size, "RasterYSize")).value_or(0.0);
  band.noData = number(text(source, "NODATA"));
  const bool isAlpha = equalIgnoringCase(text(node, "ColorInterp"), "Alpha");
  for (const pugi::xml_node& part : source.children()) {
    const bool isPlain = isNamed(part, "SourceFilename") || isNamed(part, "SourceBand") ||
                         isNamed(part, "SourceProperties") || isNamed(part, "SrcRect") || isNamed(part, "DstRect") ||
                         isNamed(part, "NODATA") || part.type() != pugi::node_element;
    if (isPlain) {
      continue;
    }
    const bool isConstant = (isNamed(part, "ScaleOffset") && number(text(part)) == 255.0) ||
                            (isNamed(part, "ScaleRatio") && number(text(part)) == 0.0);
    if (!isAlpha || !(isConstant || (isNamed(part, "LUT") && isMaskTable(text(part))))) {
      return std::nullopt;
    }
    band.isAlphaFromNoData = true;
    if (isNamed(part, "LUT")) {
      band.noData = 0.0;
    }
  }
  if ((band.isAlphaFromNoData && !band.noData) || !readMeaning(node, band)) {
    return std::nullopt;
  }
  return band;
}

bool isSamePlace(const Band& a, const Band& b) {
  return a.file == b.file && a.isRelative == b.isRelative && a.from == b.from && a.to == b.to;
}

/// Why a band cannot be one of the wrapper's, by what has been read before; empty: it can.
std::string objection(const VrtWrapper& wrapper, const Band& first, const Band& band) {
  if (wrapper.makesAlpha || !isSamePlace(first, band) ||
      (!band.isAlphaFromNoData && band.number != wrapper.bands + 1)) {
    return "the VRT does more than pass a service's bands on";
  }
  const bool isOther = wrapper.noData && band.noData && *wrapper.noData != *band.noData;
  if (isOther || (!band.isAlphaFromNoData && first.declared != band.declared)) {
    return "the VRT's bands differ in what is no data";
  }
  return {};
}

}  // namespace

Result<VrtDescription> readVrtWrapper(const std::string& content, const std::string& where) {
  const auto leftToGdal = [](std::string reason) { return VrtDescription{std::nullopt, std::move(reason)}; };
  const std::string doesMore = "the VRT does more than pass a service's bands on";
  auto document = XmlDocument::parse(content, where);
  if (!document) {
    return tl::make_unexpected(std::move(document.error()));
  }
  const pugi::xml_node root = document->root();
  const std::vector<std::string> transform = split(text(root, "GeoTransform"), ", \n\t");
  const std::vector<pugi::xml_node> nodes = children(root, "VRTRasterBand");
  if (!isNamed(root, "VRTDataset") || !attribute(root, "subClass").empty() || transform.size() != 6 || nodes.empty() ||
      child(root, "MaskBand")) {
    return leftToGdal(doesMore);
  }
  std::array<double, 6> affine{};
  for (std::size_t i = 0; i < affine.size(); ++i) {
    affine[i] = number(transform[i]).value_or(std::nan(""));
  }
  VrtWrapper wrapper;
  std::optional<Band> first;
  for (const pugi::xml_node& node : nodes) {
    const std::optional<Band> band = readBand(node);
    if (!band) {
      return leftToGdal(doesMore);
    }
    first = first ? first : band;
    if (std::string other = objection(wrapper, *first, *band); !other.empty()) {
      return leftToGdal(std::move(other));
    }
    wrapper.bands += band->isAlphaFromNoData ? 0 : 1;
    wrapper.makesAlpha = band->isAlphaFromNoData;
    wrapper.noData = band->noData ? band->noData : wrapper.noData;
  }
  const bool isUpright = affine[1] > 0 && affine[2] == 0 && affine[4] == 0 && affine[5] < 0;
  if (wrapper.bands == 0 || first->file.empty() || first->from[0] != 0 || first->from[1] != 0 || !isUpright) {
    return leftToGdal(doesMore);
  }
  if (first->declared) {
    wrapper.noData = first->declared;
  }
  wrapper.scale = first->scale;
  wrapper.offset = first->offset;
  wrapper.source = first->file;
  wrapper.isRelative = first->isRelative;
  wrapper.pixelWidth = affine[1] * first->to[2] / first->from[2];
  wrapper.pixelHeight = -affine[5] * first->to[3] / first->from[3];
  wrapper.left = affine[0] + affine[1] * first->to[0];
  wrapper.top = affine[3] + affine[5] * first->to[1];
  wrapper.isPart = first->isPart;
  wrapper.right = affine[0] + affine[1] * (first->to[0] + first->to[2]);
  wrapper.bottom = affine[3] + affine[5] * (first->to[1] + first->to[3]);
  return VrtDescription{std::move(wrapper), {}};
}

std::optional<TileService> wrapped(const VrtWrapper& wrapper, TileService inner) {
  if (inner.matrices.empty()) {
    return std::nullopt;
  }
  const TileMatrix& finest = inner.matrices.front();
  const auto isSame = [](double a, double b, double tolerance) { return std::abs(a - b) <= tolerance; };
  const double span = std::max(inner.east - inner.west, inner.north - inner.south);
  if (!isSame(wrapper.pixelWidth, finest.pixelWidth, 1e-6 * finest.pixelWidth) ||
      !isSame(wrapper.pixelHeight, finest.pixelHeight, 1e-6 * finest.pixelHeight) ||
      !isSame(wrapper.left, finest.left, 1e-6 * span) || !isSame(wrapper.top, finest.top, 1e-6 * span)) {
    return std::nullopt;
  }
  // The service may end sooner: windows of GIBS run beyond the globe.
  const Extent shown{inner.west, std::max(inner.south, wrapper.bottom), std::min(inner.east, wrapper.right),
                     inner.north};
  const bool isPart = inner.east - shown.east > 1e-6 * span || shown.south - inner.south > 1e-6 * span;
  const std::size_t levels = inner.matrices.size();
  // Its addresses count the levels, so that none may go.
  if (isPart && (!setMatrices(inner, inner.matrices, shown) || inner.matrices.size() != levels)) {
    return std::nullopt;
  }
  inner.bands = wrapper.bands;
  if (wrapper.noData) {
    inner.noData = wrapper.noData;
    inner.isNoDataTransparent = true;
  }
  const bool hasMeaning = wrapper.scale || wrapper.offset;
  inner.heightScale = hasMeaning ? std::optional(wrapper.scale.value_or(1.0)) : std::nullopt;
  inner.heightOffset = hasMeaning ? std::optional(wrapper.offset.value_or(0.0)) : std::nullopt;
  return inner;
}

}  // namespace meridian::globebrowsing

#include "globebrowsing/source/gdal_wms.h"

#include <algorithm>
#include <cmath>

#include <cpl_conv.h>
#include <cpl_string.h>
#include <fmt/format.h>

#include "globebrowsing/source/gdal_wms_parts.h"
#include "globebrowsing/source/map_crs.h"
#include "globebrowsing/source/service_text.h"
#include "globebrowsing/source/tile_pyramid.h"

namespace meridian::globebrowsing {

namespace {

constexpr std::int64_t largestRaster = 2147483647;  // GDAL's

/// The element's number, `otherwise` when there is no such element, an error for anything else.
template <class Read>
auto valueOf(const XmlDocument& document, const pugi::xml_node& parent, std::string_view name, Read read,
             std::remove_cvref_t<decltype(*read(""))> otherwise) -> Result<decltype(otherwise)> {
  const pugi::xml_node node = child(parent, name);
  if (!node || text(node).empty()) {
    return otherwise;
  }
  if (auto value = read(text(node))) {
    return *value;
  }
  return failure(fmt::format("{} is '{}', no number", name, text(node).substr(0, 40)), document.placeOf(node));
}

/// Reads numbers one after another; the first error stays.
class WindowReader {
 public:
  explicit WindowReader(const XmlDocument& document) : document_(document) {}

  void real(const pugi::xml_node& parent, std::string_view name, double& value) {
    keep(valueOf(
             document_, parent, name, [](std::string_view t) { return number(t); }, value),
         value);
  }
  template <class Integer>
  void whole(const pugi::xml_node& parent, std::string_view name, Integer& value) {
    long long wide = static_cast<long long>(value);
    keep(valueOf(
             document_, parent, name, [](std::string_view t) { return integer(t); }, wide),
         wide);
    value = static_cast<Integer>(std::clamp<long long>(wide, -largestRaster, largestRaster));
  }
  [[nodiscard]] const std::optional<Error>& error() const { return error_; }

 private:
  template <class T>
  void keep(Result<T> read, T& value) {
    if (read) {
      value = *read;
    } else if (!error_) {
      error_ = std::move(read.error());
    }
  }

  const XmlDocument& document_;
  std::optional<Error> error_;
};

int automaticOverviews(const GdalWindow& window) {
  const double smallest = std::max(32, std::min(window.blockWidth, window.blockHeight));
  const double levels = std::log2(static_cast<double>(std::min(window.width, window.height)) / smallest);
  return std::clamp(static_cast<int>(std::ceil(levels)), 0, 32);
}

Result<GdalWindow> readWindow(const XmlDocument& document, const GdalMiniDriver& driver) {
  const pugi::xml_node root = document.root();
  const pugi::xml_node node = child(root, "DataWindow");
  if (!node && driver.needsWindow) {
    return failure("the description has no DataWindow", document.placeOf(root), "add <DataWindow>");
  }
  GdalWindow window = driver.defaults;
  WindowReader reader(document);
  reader.whole(root, "BlockSizeX", window.blockWidth);
  reader.whole(root, "BlockSizeY", window.blockHeight);
  reader.real(node, "UpperLeftX", window.left);
  reader.real(node, "UpperLeftY", window.top);
  reader.real(node, "LowerRightX", window.right);
  reader.real(node, "LowerRightY", window.bottom);
  reader.whole(node, "SizeX", window.width);
  reader.whole(node, "SizeY", window.height);
  reader.whole(node, "TileX", window.tileX);
  reader.whole(node, "TileY", window.tileY);
  int level = window.level.value_or(-1);
  reader.whole(node, "TileLevel", level);
  std::int64_t countX = driver.defaultTileCount;
  std::int64_t countY = driver.defaultTileCount;
  reader.whole(node, "TileCountX", countX);
  reader.whole(node, "TileCountY", countY);
  int overviews = driver.defaultOverviews;
  reader.whole(root, "OverviewCount", overviews);
  if (reader.error()) {
    return tl::make_unexpected(*reader.error());
  }
  const std::string place = document.placeOf(node ? node : root);
  const bool hasLevel = level >= 0;
  if (level > 30) {
    return failure(fmt::format("TileLevel is {}", level), place, "give one of 0 to 30");
  }
  if (window.width == 0 || window.height == 0) {
    if (!hasLevel) {
      return failure("the DataWindow has neither SizeX and SizeY nor TileLevel", place);
    }
    // In double first: the product may not fit, and then is no raster.
    const auto pixels = [&](std::int64_t count, int block) {
      const double product = std::ldexp(static_cast<double>(count) * block, level);
      return product <= static_cast<double>(largestRaster) ? static_cast<std::int64_t>(product) : 0;
    };
    window.width = pixels(countX, window.blockWidth);
    window.height = pixels(countY, window.blockHeight);
  }
  if (window.blockWidth < 1 || window.blockHeight < 1 || window.width < 1 || window.height < 1 ||
      window.width > largestRaster || window.height > largestRaster) {
    return failure("the sizes of DataWindow and blocks make no raster", place, "check sizes, tile counts and level");
  }
  window.level = hasLevel ? std::optional(level) : std::nullopt;
  window.overviews = overviews >= 0 ? overviews : hasLevel ? level : automaticOverviews(window);
  return window;
}

Result<bool> readTopOrigin(const XmlDocument& document) {
  const pugi::xml_node node = child(document.root(), "DataWindow/YOrigin");
  const std::string origin = lowerCase(text(node));
  if (!origin.empty() && origin != "top" && origin != "bottom" && origin != "default") {
    return failure("YOrigin is '" + origin + "'", document.placeOf(node), "write top, bottom or default");
  }
  return origin == "top";
}

/// A metre or two of map is no globe's data: numbers this small are degrees.
bool isPlainlyDegrees(const GdalWindow& window) {
  return std::max(std::abs(window.left), std::abs(window.right)) <= 1080.0 &&
         std::max(std::abs(window.top), std::abs(window.bottom)) <= 360.0;
}

Result<std::string> crsOf(const XmlDocument& document, const GdalMiniDriver& driver, const GdalWindow& window) {
  if (isPlainlyDegrees(window)) {
    return std::string();
  }
  const pugi::xml_node node = child(document.root(), "Projection");
  if (!text(node).empty()) {
    return MapCrs::of(text(node), document.placeOf(node)).map([](const MapCrs& crs) { return crs.definition(); });
  }
  if (driver.crs.empty() && std::max(std::abs(window.left), std::abs(window.right)) <= 1.01 * webMercatorHalfWidth) {
    return std::string("EPSG:3857");
  }
  return driver.crs;
}

std::vector<TileMatrix> matricesOf(const GdalWindow& window, const GdalMiniDriver& driver) {
  std::vector<TileMatrix> matrices;
  for (int step = 0; step <= window.overviews; ++step) {
    const double scale = std::ldexp(1.0, -step);
    const auto width = std::int64_t{std::llround(static_cast<double>(window.width) * scale)};
    const auto height = std::int64_t{std::llround(static_cast<double>(window.height) * scale)};
    const int level = window.level.value_or(0) - step;
    if (width == 0 || height == 0 || (level < 0 && !driver.asksForWindows)) {
      break;
    }
    TileMatrix matrix;
    matrix.identifier = std::to_string(driver.asksForWindows ? window.overviews - step : level);
    matrix.tileWidth = window.blockWidth;
    matrix.tileHeight = window.blockHeight;
    if (driver.asksForWindows) {  // GDAL clamps what it asks for to the raster
      matrix.tileWidth = static_cast<int>(std::min<std::int64_t>(matrix.tileWidth, width));
      matrix.tileHeight = static_cast<int>(std::min<std::int64_t>(matrix.tileHeight, height));
    }
    matrix.pixelWidth = (window.right - window.left) / static_cast<double>(width);
    matrix.pixelHeight = (window.top - window.bottom) / static_cast<double>(height);
    matrix.firstColumn = window.tileX >> step;
    matrix.firstRow = window.tileY >> step;
    matrix.left = window.left - static_cast<double>(matrix.firstColumn) * matrix.tileWidth * matrix.pixelWidth;
    matrix.top = window.top + static_cast<double>(matrix.firstRow) * matrix.tileHeight * matrix.pixelHeight;
    matrix.lastColumn = matrix.firstColumn + (width + matrix.tileWidth - 1) / matrix.tileWidth - 1;
    matrix.lastRow = matrix.firstRow + (height + matrix.tileHeight - 1) / matrix.tileHeight - 1;
    matrices.push_back(matrix);
  }
  return matrices;
}

/// What of the window holds data, by the element Extent of our own documents; all of it without one.
Result<Extent> readExtent(const XmlDocument& document, const GdalWindow& window) {
  const Extent whole{window.left, window.bottom, window.right, window.top};
  const pugi::xml_node node = child(document.root(), "Extent");
  if (!node) {
    return whole;
  }
  Extent extent = whole;
  WindowReader reader(document);
  reader.real(node, "UpperLeftX", extent.west);
  reader.real(node, "UpperLeftY", extent.north);
  reader.real(node, "LowerRightX", extent.east);
  reader.real(node, "LowerRightY", extent.south);
  if (reader.error()) {
    return tl::make_unexpected(*reader.error());
  }
  extent = {std::max(extent.west, whole.west), std::max(extent.south, whole.south), std::min(extent.east, whole.east),
            std::min(extent.north, whole.north)};
  if (!(extent.west < extent.east) || !(extent.south < extent.north)) {
    return failure("the Extent has nothing of the DataWindow", document.placeOf(node),
                   "give its corners in the units of the DataWindow, or leave it out");
  }
  return extent;
}

void readRequestSettings(const pugi::xml_node& root, TileService& service, std::vector<std::string>& notes) {
  for (const std::string& code : split(text(root, "ZeroBlockHttpCodes"), ", ")) {
    const long long status = integer(code).value_or(0);
    if (status < 100 || status > 599) {
      notes.push_back("ZeroBlockHttpCodes has '" + code + "', which is no HTTP status");
    } else if (status != 204 && std::count(service.emptyStatuses.begin(), service.emptyStatuses.end(), status) == 0) {
      service.emptyStatuses.push_back(static_cast<int>(status));
    }
  }
  service.isExceptionEmpty = boolean(text(root, "ZeroBlockOnServerException")).value_or(false);
  const auto header = [&](const char* name, const std::string& value) {
    if (!value.empty() && value.find_first_of("\r\n") == std::string::npos) {
      service.headers.push_back(std::string(name) + ": " + value);
    }
  };
  header("User-Agent", text(root, "UserAgent"));
  header("Referer", text(root, "Referer"));
  header("Accept", text(root, "Accept"));
  if (const std::string user = text(root, "UserPwd"); !user.empty()) {
    char* encoded = CPLBase64Encode(static_cast<int>(user.size()), reinterpret_cast<const GByte*>(user.data()));
    header("Authorization", std::string("Basic ") + encoded);
    CPLFree(encoded);
  }
  if (boolean(text(root, "UnsafeSSL")).value_or(false)) {
    notes.emplace_back("UnsafeSSL is ignored: certificates are always verified");
  }
}

void readValues(const pugi::xml_node& root, TileService& service, std::vector<std::string>& notes) {
  service.bands = static_cast<int>(std::clamp(integer(text(root, "BandsCount")).value_or(3), 0LL, 65535LL));
  const std::vector<std::string> noData = split(attribute(child(root, "DataValues"), "NoData"), " ,");
  if (!noData.empty()) {
    service.noData = number(noData.front());
    service.isNoDataTransparent = service.noData.has_value();
    if (std::any_of(noData.begin(), noData.end(), [&](const std::string& other) { return other != noData.front(); })) {
      notes.emplace_back("DataValues has a NoData for each band; the first is taken for all");
    }
  }
}

}  // namespace

Result<GdalDescription> readGdalWms(const std::string& content, const std::string& where) {
  auto document = XmlDocument::parse(content, where);
  if (!document) {
    return tl::make_unexpected(std::move(document.error()));
  }
  const pugi::xml_node root = document->root();
  GdalDescription description;
  if (!isNamed(root, "GDAL_WMS")) {
    description.reason = "the document is a <" + std::string(localName(root)) + ">, not a <GDAL_WMS>";
    return description;
  }
  const pugi::xml_node serviceNode = child(root, "Service");
  if (!serviceNode) {
    return failure("the description has no Service", document->placeOf(root), "add <Service name=\"TMS\">");
  }
  auto isTopOrigin = readTopOrigin(*document);
  if (!isTopOrigin) {
    return tl::make_unexpected(std::move(isTopOrigin.error()));
  }
  auto driver = readMiniDriver(*document, serviceNode, *isTopOrigin);
  if (!driver) {
    return tl::make_unexpected(std::move(driver.error()));
  }
  if (!*driver) {
    description.reason = "the service '" + attribute(serviceNode, "name") + "' is asked through GDAL";
    return description;
  }
  auto window = readWindow(*document, **driver);
  if (!window) {
    return tl::make_unexpected(std::move(window.error()));
  }
  if (!(window->right > window->left) || !(window->top > window->bottom)) {
    description.reason = "the DataWindow runs westward or upward";
    return description;
  }
  auto extent = readExtent(*document, *window);
  if (!extent) {
    return tl::make_unexpected(std::move(extent.error()));
  }
  auto crs = crsOf(*document, **driver, *window);
  if (!crs) {
    return tl::make_unexpected(std::move(crs.error()));
  }
  TileService service;
  service.where = where;
  service.name = text(root, "Name").empty() ? text(serviceNode, "Layers") : text(root, "Name");
  service.crs = std::move(*crs);
  if (service.crs.empty()) {
    *extent = {extent->west, std::max(extent->south, -90.0), std::min(extent->east, extent->west + 360.0),
               std::min(extent->north, 90.0)};
  }
  readRequestSettings(root, service, description.notes);
  readValues(root, service, description.notes);
  if (auto set = setMatrices(service, matricesOf(*window, **driver), *extent); !set) {
    return tl::make_unexpected(std::move(set.error()));
  }
  TileUrl url = std::move((*driver)->url);
  std::vector<std::int64_t> rowCounts;
  for (const TileMatrix& matrix : service.matrices) {
    rowCounts.push_back(std::llround((window->top - window->bottom) / (matrix.tileHeight * matrix.pixelHeight)));
  }
  url.setRowCounts(std::move(rowCounts));
  service.url = TileUrl::bind(std::move(url), service.matrices);
  description.service = std::move(service);
  return description;
}

}  // namespace meridian::globebrowsing

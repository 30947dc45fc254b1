#include "globebrowsing/source/gdal_wms_writer.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "globebrowsing/source/capabilities_parts.h"
#include "globebrowsing/source/gdal_wms.h"
#include "globebrowsing/source/service_description.h"
#include "globebrowsing/source/service_text.h"

namespace meridian::globebrowsing {

namespace {

std::string escapedXml(const std::string& text) {
  return replaceAll(replaceAll(replaceAll(text, "&", "&amp;"), "<", "&lt;"), ">", "&gt;");
}

/// A matrix's name; of one that is named by an address (TMS) its last part.
std::string levelOf(const TileMatrix& matrix) {
  return matrix.identifier.substr(matrix.identifier.rfind('/') + 1);
}

/// The numbers of a tile in an address replaced by GDAL's words, when exactly that is what its address is made of:
/// found by asking for two tiles that have no number in common.
std::optional<std::string> numbersAsWords(const TileService& service, std::size_t matrix, std::int64_t column,
                                          std::int64_t row, std::int64_t writtenRow) {
  std::string address = service.url({matrix, column, row});
  const std::string level = levelOf(service.matrices[matrix]);
  // Numbers that stand alone between separators only.
  const auto word = [&](const std::string& number, const std::string& name) {
    for (std::size_t at = address.rfind(number); at != std::string::npos && at > 0;
         at = address.rfind(number, at - 1)) {
      const auto isDigit = [&](std::size_t i) {
        return i < address.size() && std::isalnum(static_cast<unsigned char>(address[i])) != 0;
      };
      if (!isDigit(at - 1) && !isDigit(at + number.size())) {
        address.replace(at, number.size(), name);
        return true;
      }
    }
    return false;
  };
  if (word(std::to_string(column), "${x}") && word(std::to_string(writtenRow), "${y}") && word(level, "${z}")) {
    return address;
  }
  return std::nullopt;
}

struct Window {
  double left = 0.0;
  double top = 0.0;
  double right = 0.0;
  double bottom = 0.0;
  bool isTopOrigin = true;  ///< rows count from the north
};

/// The address that holds for tiles all over the finest level, in GDAL's words; rows count from the south where
/// their number is given. Nothing: there is no such address.
std::optional<std::string> commonAddress(const TileService& service, std::optional<std::int64_t> rowCount) {
  const TileMatrix& finest = service.matrices.front();
  std::optional<std::string> address;
  for (std::int64_t step = 0; step < 40; ++step) {
    const std::int64_t column = finest.firstColumn + step * (finest.lastColumn - finest.firstColumn) / 40;
    const std::int64_t row = finest.lastRow - step * (finest.lastRow - finest.firstRow) / 120;
    const std::int64_t written = rowCount ? *rowCount - 1 - row : row;
    if (column == written || std::to_string(column) == levelOf(finest) || std::to_string(written) == levelOf(finest)) {
      continue;  // which number is which cannot be seen
    }
    const std::optional<std::string> found = numbersAsWords(service, 0, column, row, written);
    if (!found || (address && *address != *found)) {
      return std::nullopt;
    }
    address = found;
  }
  return address;
}

/// The levels are 0, 1 ... n, each half of the one before, from one corner.
bool isRegular(const TileService& service) {
  const std::size_t count = service.matrices.size();
  const TileMatrix& coarsest = service.matrices.back();
  for (std::size_t i = 0; i < count; ++i) {
    const TileMatrix& matrix = service.matrices[i];
    const double scale = std::ldexp(1.0, static_cast<int>(count - 1 - i));
    const double corner = 1e-6 * coarsest.pixelWidth * coarsest.tileWidth;
    if (levelOf(matrix) != std::to_string(count - 1 - i) || matrix.tileWidth != coarsest.tileWidth ||
        matrix.tileHeight != coarsest.tileHeight ||
        std::abs(matrix.pixelWidth * scale / coarsest.pixelWidth - 1) > 1e-6 ||
        std::abs(matrix.pixelHeight * scale / coarsest.pixelHeight - 1) > 1e-6 ||
        std::abs(matrix.left - coarsest.left) > corner || std::abs(matrix.top - coarsest.top) > corner) {
      return false;
    }
  }
  return true;
}

/// The shortest text that is read as the same number.
std::string exact(double value) {
  return fmt::format("{}", value);
}

std::string corners(double left, double top, double right, double bottom) {
  return fmt::format(
      "    <UpperLeftX>{}</UpperLeftX><UpperLeftY>{}</UpperLeftY>\n"
      "    <LowerRightX>{}</LowerRightX><LowerRightY>{}</LowerRightY>\n",
      exact(left), exact(top), exact(right), exact(bottom));
}

std::string document(const TileService& service, const std::string& element, const Window& window,
                     const std::string& level) {
  const TileMatrix& finest = service.matrices.front();
  std::string codes;
  for (const int status : service.emptyStatuses) {
    codes += (codes.empty() ? "" : ",") + std::to_string(status);
  }
  return fmt::format(
      "<GDAL_WMS>\n  {}\n  <DataWindow>\n{}    {}\n    <YOrigin>{}</YOrigin>\n  </DataWindow>\n"
      "  <Extent>\n{}  </Extent>\n  <OverviewCount>{}</OverviewCount>\n  <Projection>{}</Projection>\n"
      "  <BlockSizeX>{}</BlockSizeX><BlockSizeY>{}</BlockSizeY>\n  <BandsCount>{}</BandsCount>\n"
      "  <ZeroBlockHttpCodes>{}</ZeroBlockHttpCodes>\n</GDAL_WMS>",
      element, corners(window.left, window.top, window.right, window.bottom), level,
      window.isTopOrigin ? "top" : "bottom", corners(service.west, service.north, service.east, service.south),
      service.matrices.size() - 1, service.crs.empty() ? "EPSG:4326" : escapedXml(service.crs), finest.tileWidth,
      finest.tileHeight, service.bands > 0 ? service.bands : 4, codes);
}

/// Whole tiles of the coarsest level, so that both programs lay out the same pyramid.
Window windowOf(const TileMatrix& coarsest, std::int64_t firstColumn, std::int64_t firstRow) {
  const double width = coarsest.tileWidth * coarsest.pixelWidth;
  const double height = coarsest.tileHeight * coarsest.pixelHeight;
  return {coarsest.left + static_cast<double>(firstColumn) * width,
          coarsest.top - static_cast<double>(firstRow) * height,
          coarsest.left + static_cast<double>(coarsest.lastColumn + 1) * width,
          coarsest.top - static_cast<double>(coarsest.lastRow + 1) * height};
}

/// Whether two matrices have the same tiles; services round their numbers, by less than can be seen.
bool haveSameTiles(const TileMatrix& a, const TileMatrix& b) {
  constexpr double tolerance = 1e-3;  // of a tile
  const double width = a.tileWidth * a.pixelWidth;
  const double height = a.tileHeight * a.pixelHeight;
  const auto isNear = [&](double x, double y, double size) { return std::abs(x - y) <= tolerance * size; };
  const auto westOf = [](const TileMatrix& matrix, std::int64_t column) {
    return matrix.left + static_cast<double>(column) * matrix.tileWidth * matrix.pixelWidth;
  };
  const auto northOf = [](const TileMatrix& matrix, std::int64_t row) {
    return matrix.top - static_cast<double>(row) * matrix.tileHeight * matrix.pixelHeight;
  };
  return a.tileWidth == b.tileWidth && a.tileHeight == b.tileHeight &&
         isNear(westOf(a, a.firstColumn), westOf(b, b.firstColumn), width) &&
         isNear(westOf(a, a.lastColumn + 1), westOf(b, b.lastColumn + 1), width) &&
         isNear(northOf(a, a.firstRow), northOf(b, b.firstRow), height) &&
         isNear(northOf(a, a.lastRow + 1), northOf(b, b.lastRow + 1), height) &&
         a.lastColumn - a.firstColumn == b.lastColumn - b.firstColumn &&
         a.lastRow - a.firstRow == b.lastRow - b.firstRow;
}

bool haveSameTiles(const TileService& a, const TileService& b) {
  return a.crs == b.crs && std::equal(a.matrices.begin(), a.matrices.end(), b.matrices.begin(), b.matrices.end(),
                                      [](const TileMatrix& x, const TileMatrix& y) { return haveSameTiles(x, y); });
}

/// Whether the tiles in the corners of every matrix have the same addresses.
bool haveSameAddresses(const TileService& a, const TileService& b) {
  for (std::size_t i = 0; i < a.matrices.size(); ++i) {
    const TileMatrix& matrix = a.matrices[i];
    for (const std::int64_t column : {matrix.firstColumn, matrix.lastColumn}) {
      for (const std::int64_t row : {matrix.firstRow, matrix.lastRow}) {
        if (a.url({i, column, row}) != b.url({i, column, row})) {
          return false;
        }
      }
    }
  }
  return true;
}

Error cannotBeWritten(const TileService& service, const std::string& why) {
  return {"the tiles of '" + service.name + "' cannot be described to GDAL: " + why, service.where,
          "name the layer by its capabilities"};
}

/// The document, when reading it gives the service's tiles again.
Result<std::string> confirmed(std::string document, const TileService& service, bool areNumbered) {
  const Result<GdalDescription> read = readGdalWms(document, service.where);
  if (!read) {
    return tl::make_unexpected(read.error());
  }
  if (!read->service || !haveSameTiles(service, *read->service)) {
    return tl::make_unexpected(cannotBeWritten(service, "a window and an extent do not tell their levels and limits"));
  }
  if (areNumbered && !haveSameAddresses(service, *read->service)) {
    return tl::make_unexpected(cannotBeWritten(service, "their addresses are not made of level, column and row"));
  }
  return document;
}

/// The document, when the capabilities that it names give that layer with all that it chooses.
Result<std::string> confirmedBy(const Capabilities& capabilities, std::string document, const TileService& service) {
  const Result<ServiceDescription> read = describeService(document, service.where);
  if (!read) {
    return tl::make_unexpected(read.error());
  }
  if (!read->reference) {
    return tl::make_unexpected(cannotBeWritten(service, "the document does not refer to its capabilities"));
  }
  return serviceOf(*read->reference, capabilities).and_then([&](const TileService& again) {
    return haveSameTiles(service, again)
               ? Result<std::string>(std::move(document))
               : tl::make_unexpected(cannotBeWritten(service, "its capabilities have another layer of that name"));
  });
}

/// A WMS: its parameters are elements, and the rest of its address stays.
std::string elementOfMaps(const Capabilities& capabilities, const TileService& service, bool followsTime) {
  const std::string address = service.url({0, service.matrices[0].firstColumn, service.matrices[0].firstRow});
  const auto parameter = [&](std::string_view name) { return parameterOf(address, name).value_or(""); };
  const bool isNew = isWmsThree(capabilities.version);
  std::string server(withoutQuery(address) + "?");
  for (const std::string& part : split(address.substr(std::min(address.find('?') + 1, address.size())), "&")) {
    const std::string name = part.substr(0, part.find('='));
    // The value is that of the day on which this is written.
    const bool isOwn = isGetMapParameter(name) || (followsTime && lowerCase(name) == "time");
    server += isOwn ? std::string() : part + "&";
  }
  const std::string crs = parameter(isNew ? "crs" : "srs");
  const auto known = MapCrs::of(replaceAll(crs, "%3A", ":"), capabilities.url);
  const bool isTurned = isNew && known && known->isNorthingFirst();
  std::string element = "<Service name=\"WMS\">\n";
  for (const auto& [name, value] :
       std::vector<std::pair<std::string, std::string>>{{"Version", capabilities.version},
                                                        {"ServerUrl", server},
                                                        {isNew ? "CRS" : "SRS", crs},
                                                        {"BBoxOrder", isTurned ? "yxYX" : "xyXY"},
                                                        {"ImageFormat", parameter("format")},
                                                        {"Layers", parameter("layers")},
                                                        {"Styles", parameter("styles")},
                                                        {"Transparent", parameter("transparent")}}) {
    if (!value.empty()) {
      element += fmt::format("    <{0}>{1}</{0}>\n", name, escapedXml(value));
    }
  }
  element += "  </Service>";
  if (followsTime) {
    element += "\n  <GetCapabilitiesUrl>" + escapedXml(capabilities.url) + "</GetCapabilitiesUrl>";
  }
  return element;
}

}  // namespace

Result<std::string> gdalWmsOf(const TileService& service) {
  if (service.matrices.empty() || !isRegular(service)) {
    return tl::make_unexpected(
        cannotBeWritten(service, "their levels are not 0, 1, 2 and so on, each half of the one before"));
  }
  const TileMatrix& coarsest = service.matrices.back();
  const std::int64_t columns = coarsest.lastColumn + 1;
  const std::int64_t rows = coarsest.lastRow + 1;
  std::optional<std::string> address = commonAddress(service, std::nullopt);
  const bool isTop = address.has_value();
  address = address ? address : commonAddress(service, rows << (service.matrices.size() - 1));
  if (!address) {
    return tl::make_unexpected(cannotBeWritten(service, "their addresses are not made of level, column and row"));
  }
  Window window = windowOf(coarsest, 0, 0);
  window.isTopOrigin = isTop;
  const std::string level =
      fmt::format("<TileLevel>{}</TileLevel><TileCountX>{}</TileCountX><TileCountY>{}</TileCountY>",
                  service.matrices.size() - 1, columns, rows);
  return confirmed(
      document(service, "<Service name=\"TMS\"><ServerUrl>" + escapedXml(*address) + "</ServerUrl></Service>", window,
               level),
      service, true);
}

Result<std::string> gdalWmsOfMaps(const Capabilities& capabilities, const TileService& service, bool followsTime) {
  const TileMatrix& coarsest = service.matrices.back();
  const std::int64_t columns = coarsest.lastColumn - coarsest.firstColumn + 1;
  const std::int64_t rows = coarsest.lastRow - coarsest.firstRow + 1;
  const std::size_t finer = service.matrices.size() - 1;
  const std::string size = fmt::format("<SizeX>{}</SizeX><SizeY>{}</SizeY>", (columns * coarsest.tileWidth) << finer,
                                       (rows * coarsest.tileHeight) << finer);
  std::string written = document(service, elementOfMaps(capabilities, service, followsTime),
                                 windowOf(coarsest, coarsest.firstColumn, coarsest.firstRow), size);
  Result<std::string> document = confirmed(std::move(written), service, false);
  return document && followsTime ? confirmedBy(capabilities, std::move(*document), service) : document;
}

}  // namespace meridian::globebrowsing

#include "globebrowsing/gibs.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "globebrowsing/script_arguments.h"
#include "host/api/log.h"

namespace meridian::globebrowsing {

namespace {

using Arguments = std::span<const Value>;

constexpr std::string_view timePlaceholder = "${OpenSpaceTimeId}";

/// The deepest levels of the tile matrix sets in degrees.
constexpr std::array<std::pair<std::string_view, int>, 8> deepestLevels{
    {{"2km", 5}, {"1km", 6}, {"500m", 7}, {"250m", 8}, {"125m", 9}, {"62.5m", 10}, {"31.25m", 11}, {"15.625m", 12}}};
/// The one layer of JPEG files with a single band.
constexpr std::string_view greyLayer = "ASTER_GDEM_Greyscale_Shaded_Relief";

Result<std::vector<std::string>> textsOf(Arguments arguments) {
  std::vector<std::string> texts;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    auto one = text(arguments[i], fmt::format("argument {}", i + 1));
    if (!one) {
      return tl::make_unexpected(one.error());
    }
    texts.push_back(std::move(*one));
  }
  return texts;
}

/// As scripts get it: "" for what is wrong.
ScriptResult documentOrNothing(const Result<std::string>& document) {
  if (!document) {
    log::error("{}", document.error().message());
  }
  return std::vector<Value>{document.value_or(std::string())};
}

/// The description of times that temporal layers took up to version 0.17, around a document for one of them.
std::string olderTemporalDocument(const std::vector<std::string>& arguments, const std::string& document) {
  const std::string format = arguments.size() > 6 ? arguments[6] : "YYYY-MM-DD";
  return fmt::format(
      "<OpenSpaceTemporalGDALDataset><OpenSpaceTimeStart>{}</OpenSpaceTimeStart><OpenSpaceTimeEnd>{}</OpenSpaceTimeEnd>"
      "<OpenSpaceTimeResolution>{}</OpenSpaceTimeResolution><OpenSpaceTimeIdFormat>{}</OpenSpaceTimeIdFormat>{}"
      "</OpenSpaceTemporalGDALDataset>",
      arguments[1], arguments[2], arguments[3], format, document);
}

ScriptResult createTemporal(Arguments given) {
  const auto arguments = textsOf(given);
  if (!arguments) {
    return tl::make_unexpected(arguments.error());
  }
  const std::vector<std::string>& a = *arguments;
  const std::string date(timePlaceholder);
  if (a.size() == 3) {
    return documentOrNothing(gibsDocument({a[0], date, a[1], a[2]}));
  }
  if (a.size() < 6) {
    return failure(
        "createTemporalGibsGdalXml takes 3 arguments (layer, resolution, format), or 6 to 7 (layer, start, "
        "end, step, resolution, format, time format?)");
  }
  return documentOrNothing(gibsDocument({a[0], date, a[4], a[5]}).map([&](const std::string& document) {
    return olderTemporalDocument(a, document);
  }));
}

ScriptResult addGibsLayer(Host& host, Arguments given) {
  const auto arguments = textsOf(given);
  if (!arguments) {
    return tl::make_unexpected(arguments.error());
  }
  const std::vector<std::string>& a = *arguments;
  const auto document = gibsDocument({a[0], std::string(timePlaceholder), a[1], a[2]});
  if (!document) {
    return tl::make_unexpected(document.error());
  }
  const Value time = Table{{}, {{"Start", a[3]}, {"End", a[4] == "Present" ? "Today" : a[4]}}};
  const Value prototyped =
      Table{{}, {{"Time", time}, {"TemporalResolution", "1d"}, {"TimeFormat", "YYYY-MM-DD"}, {"Prototype", *document}}};
  const Value layer = Table{{},
                            {{"Identifier", a[0]},
                             {"Name", a[0]},
                             {"Enabled", true},
                             {"Type", "TemporalTileProvider"},
                             {"Mode", "Prototyped"},
                             {"Prototyped", prototyped}}};
  return none(addLayerFromScript(host, "Earth", "ColorLayers", layer));
}

}  // namespace

Result<std::string> gibsDocument(const GibsLayer& layer) {
  const auto level = std::find_if(deepestLevels.begin(), deepestLevels.end(),
                                  [&](const auto& each) { return each.first == layer.resolution; });
  if (level == deepestLevels.end()) {
    return failure(fmt::format("GIBS has no resolution \"{}\"", layer.resolution), layer.name,
                   "use one of: 2km, 1km, 500m, 250m, 125m, 62.5m, 31.25m, 15.625m");
  }
  if (layer.format != "jpg" && layer.format != "png") {
    return failure(fmt::format("GIBS has no format \"{}\"", layer.format), layer.name, "use jpg or png");
  }
  const int bands = layer.format == "png" ? 4 : (layer.name == greyLayer ? 1 : 3);
  return fmt::format(
      "<GDAL_WMS><Service name=\"TMS\"><ServerUrl>https://gibs.earthdata.nasa.gov/wmts/epsg4326/best/{}/default/{}/{}/"
      "${{z}}/${{y}}/${{x}}.{}</ServerUrl></Service><DataWindow><UpperLeftX>-180.0</UpperLeftX>"
      "<UpperLeftY>90</UpperLeftY><LowerRightX>396.0</LowerRightX><LowerRightY>-198</LowerRightY>"
      "<TileLevel>{}</TileLevel><TileCountX>2</TileCountX><TileCountY>1</TileCountY><YOrigin>top</YOrigin>"
      "</DataWindow><Projection>EPSG:4326</Projection><BlockSizeX>512</BlockSizeX><BlockSizeY>512</BlockSizeY>"
      "<BandsCount>{}</BandsCount><UnsafeSSL>true</UnsafeSSL><ZeroBlockHttpCodes>400,204,404</ZeroBlockHttpCodes>"
      "<ZeroBlockOnServerException>true</ZeroBlockOnServerException><Timeout>5</Timeout></GDAL_WMS>",
      layer.name, layer.date, layer.resolution, layer.format, level->second, bands);
}

std::vector<ScriptFunction> gibsFunctions(Host& host) {
  return {{"createGibsGdalXml", "layer, date, resolution, format", "The description of a GIBS layer at a date", 4, 4,
           [](Arguments given) -> ScriptResult {
             const auto a = textsOf(given);
             return a ? documentOrNothing(gibsDocument({(*a)[0], (*a)[1], (*a)[2], (*a)[3]}))
                      : tl::make_unexpected(a.error());
           }},
          {"createTemporalGibsGdalXml", "layer, resolution, format",
           "The description of a GIBS layer, with a place for the date", 3, 7,
           [](Arguments given) { return createTemporal(given); }},
          {"addGibsLayer", "layer, resolution, format, start, end", "Adds a daily GIBS layer to the Earth", 5, 5,
           [&host](Arguments given) { return addGibsLayer(host, given); }}};
}

}  // namespace meridian::globebrowsing

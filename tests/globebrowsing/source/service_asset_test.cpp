// What is written of a layer, read again: it asks for the tiles that the capabilities allow, no more and no fewer.
#include "globebrowsing/source/service_asset.h"

#include <set>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "globebrowsing/source/service_description.h"
#include "globebrowsing/source/service_text.h"
#include "service_fixture.h"

namespace meridian::globebrowsing {
namespace {

using namespace test;
using testing::HasSubstr;
using testing::StartsWith;

std::string writtenFor(const Capabilities& capabilities, const CapabilitiesLayer& layer) {
  const auto asset = assetOf(capabilities, layer, {}, {"Earth", "ColorLayers"});
  EXPECT_TRUE(asset) << asset.error().message();
  return asset ? *asset->table.find("FilePath")->string() : std::string();
}

TileService readAgain(const std::string& path, const Capabilities& capabilities) {
  auto described = describeService(path, "a.asset:1");
  EXPECT_TRUE(described) << path;
  if (!described || (!described->service && !described->reference)) {
    ADD_FAILURE() << path;
    return {};
  }
  if (described->service) {
    EXPECT_TRUE(openWithGdal(path)) << path;  // and so OpenSpace can
    return std::move(*described->service);
  }
  EXPECT_EQ(described->reference->url, capabilities.url);
  auto service = serviceOf(*described->reference, capabilities);
  EXPECT_TRUE(service) << service.error().message();
  return service ? std::move(*service) : TileService{};
}

/// Where a matrix's tiles begin and end, in tiles from a place on the ground, and how many there are.
std::array<double, 6> placeOf(const TileMatrix& matrix) {
  const double width = matrix.tileWidth * matrix.pixelWidth;
  const double height = matrix.tileHeight * matrix.pixelHeight;
  return {matrix.left / width + static_cast<double>(matrix.firstColumn),
          matrix.left / width + static_cast<double>(matrix.lastColumn + 1),
          matrix.top / height - static_cast<double>(matrix.firstRow),
          matrix.top / height - static_cast<double>(matrix.lastRow + 1),
          static_cast<double>(matrix.tileWidth),
          static_cast<double>(matrix.tileHeight)};
}

/// A tile's address without the order of its parameters; coordinates rounded.
std::multiset<std::string> partsOf(const std::string& url) {
  std::multiset<std::string> parts;
  for (const std::string& part : split(url.substr(url.find('?') == std::string::npos ? 0 : url.find('?')), "?&")) {
    if (!lowerCase(part).starts_with("bbox")) {
      parts.insert(lowerCase(part));
    }
  }
  return parts;
}

/// The ledger: every tile of every matrix may be asked for by either or by neither.
void comesBack(const Capabilities& capabilities, const CapabilitiesLayer& layer, const std::string& begin) {
  SCOPED_TRACE(layer.title);
  const auto service = serviceOf(capabilities, layer);
  ASSERT_TRUE(service) << service.error().message();
  const std::string path = writtenFor(capabilities, layer);
  EXPECT_THAT(path, StartsWith(begin));
  const TileService again = readAgain(path, capabilities);
  ASSERT_EQ(service->matrices.size(), again.matrices.size()) << path;
  EXPECT_EQ(service->crs, again.crs);
  for (std::size_t i = 0; i < service->matrices.size(); ++i) {
    const TileMatrix& ours = service->matrices[i];
    const TileMatrix& theirs = again.matrices[i];
    const std::array<double, 6> a = placeOf(ours);
    const std::array<double, 6> b = placeOf(theirs);
    for (std::size_t side = 0; side < a.size(); ++side) {
      EXPECT_NEAR(a[side], b[side], 2e-3) << "level " << i << ", side " << side << "\n" << path;
    }
    EXPECT_EQ(ours.lastColumn - ours.firstColumn, theirs.lastColumn - theirs.firstColumn) << i;
    EXPECT_EQ(ours.lastRow - ours.firstRow, theirs.lastRow - theirs.firstRow) << i;
    EXPECT_EQ(partsOf(service->url({i, ours.firstColumn, ours.lastRow})),
              partsOf(again.url({i, theirs.firstColumn, theirs.lastRow})));
    EXPECT_EQ(partsOf(service->url({i, ours.lastColumn, ours.firstRow})),
              partsOf(again.url({i, theirs.lastColumn, theirs.firstRow})));
  }
  const double pixel = service->matrices.front().pixelWidth;
  EXPECT_NEAR(service->west, again.west, pixel);
  EXPECT_NEAR(service->south, again.south, pixel);
  EXPECT_NEAR(service->east, again.east, pixel);
  EXPECT_NEAR(service->north, again.north, pixel);
}

void comesBack(const Capabilities& capabilities, const std::string& layer, const std::string& begin) {
  const CapabilitiesLayer* found = capabilities.find(layer);
  ASSERT_NE(found, nullptr) << layer;
  comesBack(capabilities, *found, begin);
}

TEST(ServiceAsset, RealLayersComeBack) {
  MERIDIAN_NEEDS(sharedData("capabilities"));
  comesBack(realCapabilities("wmts_eox_maps.xml"), "bluemarble", "<GDAL_WMS>");
  comesBack(realCapabilities("wmts_nasa_trek_mars_themis.xml"), "THEMIS_NightIR_ControlledMosaics_100m_v2_oct2018",
            "<GDAL_WMS>");
  comesBack(realCapabilities("wmts_pdok_nl.xml"), "brtachtergrondkaart", "WMTS:");
  comesBack(realCapabilities("wms130_gibs_onearth.xml"), "NASA_GIBS_EPSG4326", "<GDAL_WMS>");
  comesBack(realCapabilities("wms111_noaa_nowcoast_forecasts.xml"), "world_countries_label", "<GDAL_WMS>");
  comesBack(realCapabilities("tms_ne2_webmercator_tilemapresource.xml", "http://h/t/tilemapresource.xml"),
            "ne2-webmerc.tif", "<GDAL_WMS>");
  const std::string services = "http://h/arcgis/rest/services/";
  const Capabilities cache = realCapabilities("arcgis_mapserver_fused_cache.json", services + "A/MapServer?f=json");
  comesBack(cache, cache.layers.front(), "ArcGIS:http://h/arcgis/rest/services/A/MapServer?f=json");
  const Capabilities images = realCapabilities("arcgis_imageserver_tile.json", services + "B/ImageServer?f=json");
  comesBack(images, images.layers.front(), "ArcGIS:");
}

TEST(ServiceAsset, EveryLayerOfRealCapabilitiesCanBeAdded) {
  MERIDIAN_NEEDS(sharedData("capabilities"));
  std::size_t count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(sharedData("capabilities"))) {
    const auto capabilities = parseCapabilities(bytesOf(entry.path()), "http://h/rest/services/A/MapServer?f=json");
    if (!capabilities) {
      continue;
    }
    std::size_t ofDocument = 0;
    for (const CapabilitiesLayer& layer : capabilities->layers) {
      if (layer.identifier.empty() || !serviceOf(*capabilities, layer) || ++ofDocument > 12) {
        continue;
      }
      SCOPED_TRACE(entry.path().filename());
      ++count;
      if (layer.timeDimension() == nullptr) {
        const std::string path = writtenFor(*capabilities, layer);
        comesBack(*capabilities, layer, path.substr(0, 3));
      } else {
        EXPECT_NE(writtenFor(*capabilities, layer), "");
      }
    }
  }
  EXPECT_GT(count, 50U);
}

constexpr const char* wms =
    "<WMS_Capabilities "
    "version='1.3.0'><Service><MaxWidth>2048</MaxWidth></Service><Capability><Request><GetMap><Format>"
    "image/png</Format><DCPType><HTTP><Get><OnlineResource xmlns:xlink='http://www.w3.org/1999/xlink' "
    "xlink:href='http://h/wms?map=m'/></Get></HTTP></DCPType></GetMap></Request><Layer><Title>All</Title>";

std::string box(double west, double south, double east, double north) {
  return fmt::format(
      "<EX_GeographicBoundingBox><westBoundLongitude>{}</westBoundLongitude><eastBoundLongitude>{}</eastBoundLongitude>"
      "<southBoundLatitude>{}</southBoundLatitude><northBoundLatitude>{}</northBoundLatitude>"
      "</EX_GeographicBoundingBox>",
      west, east, south, north);
}

TEST(ServiceAsset, RegionalMapsAreNotAskedForElsewhere) {
  for (const char* crs : {"CRS:84", "EPSG:4326", "EPSG:3857", "EPSG:3035"}) {
    for (const char* scales :
         {"", "<MaxScaleDenominator>1000000</MaxScaleDenominator><MinScaleDenominator>5000</MinScaleDenominator>"}) {
      SCOPED_TRACE(std::string(crs) + scales);
      const auto capabilities =
          parse(std::string(wms) + "<Layer><Name>swiss</Name><Title>Swiss</Title><CRS>" + crs + "</CRS>" +
                box(5.87, 45.81, 10.53, 47.83) + scales + "</Layer></Layer></Capability></WMS_Capabilities>");
      ASSERT_TRUE(capabilities);
      comesBack(*capabilities, "swiss", "<GDAL_WMS>");
    }
  }
  const auto pacific = parse(std::string(wms) + "<Layer><Name>fiji</Name><Title>Fiji</Title><CRS>CRS:84</CRS>" +
                             box(176, -21, -178, -12) + "</Layer></Layer></Capability></WMS_Capabilities>");
  ASSERT_TRUE(pacific);
  comesBack(*pacific, "fiji", "<GDAL_WMS>");
}

TEST(ServiceAsset, MapsThatLookLikeDegreesAreNamedByTheirCapabilities) {
  const auto capabilities =
      parse(std::string(wms) + "<Layer><Name>pole</Name><Title>Pole</Title><CRS>EPSG:3031</CRS>" +
            box(-180, -90, 180, -89.9) +
            "<BoundingBox CRS='EPSG:3031' minx='-300' miny='-300' maxx='300' maxy='300'/></Layer></Layer></Capability>"
            "</WMS_Capabilities>");
  ASSERT_TRUE(capabilities);
  comesBack(*capabilities, "pole", "WMS:http://example.org/service,layer=\"pole\"");
}

std::string tileMap(const std::string& srs, const std::string& boxAndOrigin, int first, int levels, double coarsest) {
  std::string sets;
  for (int level = first; level < first + levels; ++level) {
    sets += fmt::format("<TileSet href='{0}' units-per-pixel='{1}' order='{0}'/>", level,
                        coarsest / std::ldexp(1.0, level));
  }
  return "<TileMap version='1.0.0'><Title>t</Title><SRS>" + srs + "</SRS>" + boxAndOrigin +
         "<TileFormat width='256' height='256' mime-type='image/png' extension='png'/><TileSets>" + sets +
         "</TileSets></TileMap>";
}

TEST(ServiceAsset, RegionalTileMapsAreNotAskedForElsewhere) {
  const std::string swiss =
      "<BoundingBox minx='5.87' miny='45.81' maxx='10.53' maxy='47.83'/><Origin x='-180' y='-90'/>";
  comesBack(*parse(tileMap("EPSG:4326", swiss, 0, 8, 0.703125), "http://h/t/"), "t", "");
  comesBack(*parse(tileMap("EPSG:4326", swiss, 5, 3, 0.703125), "http://h/t/"), "t", "TMS:http://h/t/");
  comesBack(*parse(tileMap("EPSG:4326", swiss, 5, 3, 0.703125), "http://h/a,b/"), "t", "TMS:\"http://h/a,b/\"");
  const std::string world = "<BoundingBox minx='-180' miny='-90' maxx='180' maxy='90'/><Origin x='-180' y='-90'/>";
  comesBack(*parse(tileMap("EPSG:4326", world, 0, 8, 0.703125), "http://h/t/"), "t", "<GDAL_WMS>");
}

std::string cache(double west, double south, double east, double north, const std::string& levels, double factor,
                  const std::string& origin = R"("x":-180,"y":90)") {
  std::string lods;
  double resolution = 0.703125;
  for (int level = 0; level < 10; ++level, resolution /= factor) {
    lods += fmt::format(R"({}{{"level":{},"resolution":{}}})", level == 0 ? "" : ",", level, resolution);
  }
  return fmt::format(
      R"({{"currentVersion":10.8,"mapName":"M","tileInfo":{{"rows":256,"cols":256,"format":"PNG","origin":{{{}}},)"
      R"("spatialReference":{{"wkid":4326}},"lods":[{}]}},{}"fullExtent":{{"xmin":{},"ymin":{},"xmax":{},"ymax":{},)"
      R"("spatialReference":{{"wkid":4326}}}}}})",
      origin, lods, levels, west, south, east, north);
}

TEST(ServiceAsset, RegionalCachesAreNotAskedForElsewhere) {
  const std::string url = "http://h/arcgis/rest/services/F/C/MapServer?f=json";
  comesBack(*parse(cache(5.87, 45.81, 10.53, 47.83, "", 2), url), "M", "<GDAL_WMS>");
  comesBack(*parse(cache(-180, -90, 180, 90, "", 2), url), "M", "<GDAL_WMS>");
  comesBack(*parse(cache(5.87, 45.81, 10.53, 47.83, R"("minLOD":3,"maxLOD":6,)", 2), url), "M", "ArcGIS:" + url);
  comesBack(*parse(cache(5.87, 45.81, 10.53, 47.83, "", 2.5), url), "M", "ArcGIS:" + url);
  // Esri's own corner, far beyond the turn.
  comesBack(*parse(cache(5.87, 45.81, 10.53, 47.83, "", 2, R"("x":-400,"y":400)"), url), "M", "<GDAL_WMS>");
}

TEST(ServiceAsset, LimitsThatAreNotTheExtentsAreNamedByTheCapabilities) {
  std::string matrices;
  std::string limits;
  for (int level = 0; level < 6; ++level) {
    const int size = 1 << level;
    matrices += fmt::format(
        "<TileMatrix><ows:Identifier>{}</ows:Identifier><ScaleDenominator>{}</ScaleDenominator><TopLeftCorner>"
        "-20037508.3427892 20037508.3427892</TopLeftCorner><TileWidth>256</TileWidth><TileHeight>256</TileHeight>"
        "<MatrixWidth>{}</MatrixWidth><MatrixHeight>{}</MatrixHeight></TileMatrix>",
        level, 559082264.0287178 / size, size, size);
    limits += fmt::format(
        "<TileMatrixLimits><TileMatrix>{}</TileMatrix><MinTileRow>{}</MinTileRow><MaxTileRow>{}</MaxTileRow>"
        "<MinTileCol>0</MinTileCol><MaxTileCol>{}</MaxTileCol></TileMatrixLimits>",
        level, level == 4 ? 3 : 0, size - 1, size - 1);
  }
  const auto documentOf = [&](const std::string& limitsOfSet) {
    return parse(
        "<Capabilities xmlns='http://www.opengis.net/wmts/1.0' xmlns:ows='http://www.opengis.net/ows/1.1' "
        "version='1.0.0'><Contents><Layer><ows:Title>L</ows:Title><ows:WGS84BoundingBox><ows:LowerCorner>5.87 45.81"
        "</ows:LowerCorner><ows:UpperCorner>40 60</ows:UpperCorner></ows:WGS84BoundingBox><ows:Identifier>l"
        "</ows:Identifier><Style isDefault='true'><ows:Identifier>s</ows:Identifier></Style><Format>image/png</Format>"
        "<TileMatrixSetLink><TileMatrixSet>g</TileMatrixSet>" +
        limitsOfSet +
        "</TileMatrixSetLink><ResourceURL format='image/png' resourceType='tile' template='http://h/{Style}/"
        "{TileMatrix}/{TileRow}/{TileCol}.png'/></Layer><TileMatrixSet><ows:Identifier>g</ows:Identifier>"
        "<ows:SupportedCRS>urn:ogc:def:crs:EPSG::3857</ows:SupportedCRS>" +
        matrices + "</TileMatrixSet></Contents></Capabilities>");
  };
  const auto plain = documentOf("");
  ASSERT_TRUE(plain) << plain.error().message();
  comesBack(*plain, "l", "<GDAL_WMS>");
  const auto limited = documentOf("<TileMatrixSetLimits>" + replaceAll(limits, "<MinTileRow>3", "<MinTileRow>5") +
                                  "</TileMatrixSetLimits>");
  ASSERT_TRUE(limited) << limited.error().message();
  comesBack(*limited, "l", "WMTS:");
}

TEST(ServiceAsset, PatternsAndExportsAreNamedByTheirCapabilities) {
  const auto patterns = parse(
      "<WMS_Tile_Service version=\"0.1.0\"><TiledPatterns><OnlineResource xlink:href=\"http://onearth/wms.cgi?\"/>"
      "<TiledGroup><Name>Global SRTM</Name><LatLonBoundingBox minx=\"-180\" miny=\"-60\" maxx=\"180\" maxy=\"84\"/>"
      "<TilePattern>request=GetMap&amp;layers=srtm&amp;srs=EPSG:4326&amp;width=512&amp;height=512&amp;"
      "bbox=-180,88,-178,90&amp;format=image/png&amp;styles=</TilePattern></TiledGroup></TiledPatterns>"
      "</WMS_Tile_Service>",
      "http://onearth/wms.cgi?request=GetTileService");
  ASSERT_TRUE(patterns) << patterns.error().message();
  comesBack(*patterns, "Global SRTM", "WMS:http://onearth/wms.cgi?request=GetTileService,layer=\"Global SRTM\"");
  const auto maps = parse(
      R"({"currentVersion":10.8,"mapName":"M","capabilities":"Map","fullExtent":{"xmin":-10,"ymin":40,"xmax":10,
          "ymax":50,"spatialReference":{"wkid":4326}},"layers":[{"id":0,"name":"zero"},{"id":3,"name":"three"}]})",
      "http://h/arcgis/rest/services/M/MapServer?f=json");
  ASSERT_TRUE(maps) << maps.error().message();
  comesBack(*maps, "M", "ArcGIS:http://h/arcgis/rest/services/M/MapServer?f=json");
  comesBack(*maps, "3", "ArcGIS:http://h/arcgis/rest/services/M/MapServer?f=json,layer=\"3\"");
  const auto asset = assetOf(*maps, *maps->find("3"), {}, {"Earth", "ColorLayers"});
  EXPECT_EQ(*asset->table.find("Identifier"), Value("three"));
}

TEST(ServiceAsset, WhatNoTextCanNameIsRefused) {
  const auto two = parse(
      R"({"currentVersion":10.8,"mapName":"M","capabilities":"Map","fullExtent":{"xmin":-10,"ymin":40,"xmax":10,
          "ymax":50,"spatialReference":{"wkid":4326}}})",
      "http://h/arcgis/rest/services/M/MapServer?f=json");
  ASSERT_TRUE(two);
  LayerChoices choices;
  choices.isTransparent = false;
  const auto asset = assetOf(*two, two->layers.front(), choices, {"Earth", "ColorLayers"});
  ASSERT_FALSE(asset);
  EXPECT_THAT(asset.error().message(), HasSubstr("background"));
}

TEST(ServiceAsset, OfAFilesRelativeAddressesNothingIsWritten) {
  const std::string world = "<BoundingBox minx='-180' miny='-90' maxx='180' maxy='90'/><Origin x='-180' y='-90'/>";
  const std::string relative = tileMap("EPSG:4326", world, 0, 3, 0.703125);
  const auto file = parse(relative, "/data/tilemapresource.xml");
  ASSERT_TRUE(file);
  EXPECT_THAT(file->layers.front().obstacle, HasSubstr("the document's own address"));
  EXPECT_FALSE(assetOf(*file, file->layers.front(), {}, {"Earth", "ColorLayers"}));
  const auto absolute = parse(replaceAll(relative, "href='", "href='http://h/t/"), "/data/tilemapresource.xml");
  ASSERT_TRUE(absolute);
  comesBack(*absolute, "t", "<GDAL_WMS>");
  const auto cached = parse(cache(-180, -90, 180, 90, "", 2), "/data/cache.json");
  ASSERT_TRUE(cached);
  EXPECT_THAT(cached->layers.front().obstacle, HasSubstr("the document's own address"));
}

}  // namespace
}  // namespace meridian::globebrowsing

#include "globebrowsing/source/capabilities.h"
#include "globebrowsing/source/tile_decoder.h"
#include "picture_fixture.h"
#include "tile_service_fixture.h"

namespace meridian::globebrowsing {
namespace {

using namespace test;

TEST(ArcGisServices, DynamicMapsAreAskedForByWindow) {
  const auto capabilities = parse(
      R"({"currentVersion":10.8,"mapName":"M","capabilities":"Map,Query","maxImageWidth":4096,"maxImageHeight":4096,
          "fullExtent":{"xmin":-10,"ymin":40,"xmax":10,"ymax":50,"spatialReference":{"wkid":4326}},
          "timeInfo":{"timeExtent":[0,86400000],"defaultTimeInterval":6,"defaultTimeIntervalUnits":"esriTimeUnitsHours"},
          "layers":[{"id":0,"name":"zero"},{"id":3,"name":"three"}],"copyrightText":"C"})",
      "http://h/arcgis/rest/services/M/MapServer?f=json");
  ASSERT_TRUE(capabilities) << capabilities.error().message();
  ASSERT_EQ(capabilities->layers.size(), 3U);
  EXPECT_EQ(capabilities->layers[0].timeDimension()->values, "1970-01-01T00:00:00Z/1970-01-02T00:00:00Z/PT6H");
  LayerChoices choices;
  choices.time = "1970-01-01T06:00:00Z";
  const TileService service = serviceOfLayer(*capabilities, "3", choices);
  const std::string url = service.url({service.matrices.size() - 1, 0, 0});
  for (const char* part : {"http://h/arcgis/rest/services/M/MapServer/export?", "bbox=-180,-90,0,90", "size=512,512",
                           "bboxSR=4326", "layers=show:3", "time=21600000", "f=image"}) {
    EXPECT_NE(url.find(part), std::string::npos) << part << " in " << url;
  }
  EXPECT_EQ(service.attribution, "C");
  const auto list =
      parse(R"({"folders":["F"],"services":[{"name":"F/A","type":"MapServer"},{"name":"B","type":"GPServer"}]})",
            "http://h/arcgis/rest/services?f=json");
  ASSERT_TRUE(list);
  ASSERT_EQ(list->layers.size(), 2U);
  EXPECT_EQ(list->layers[1].document, "http://h/arcgis/rest/services/F/A/MapServer?f=json");
}

std::string imageServer(const std::string& rest) {
  return R"({"currentVersion":10.9,"name":"Relief","capabilities":"Image,Metadata","maxImageWidth":4096,
             "maxImageHeight":4096,"extent":{"xmin":-180,"ymin":-90,"xmax":180,"ymax":90,
             "spatialReference":{"wkid":4326}},"serviceDataType":"esriImageServiceDataTypeElevation",)" +
         rest + "}";
}

TileService imageServiceOf(const std::string& rest, const LayerChoices& choices = {}) {
  const auto capabilities = parse(imageServer(rest), "http://h/arcgis/rest/services/Relief/ImageServer?f=json");
  EXPECT_TRUE(capabilities) << (capabilities ? "" : capabilities.error().message());
  return capabilities ? serviceOfLayer(*capabilities, "0:image", choices) : TileService{};
}

TEST(ArcGisServices, ValuesOfMoreThanEightBitsAreAskedForAsTheyAre) {
  const TileService service = imageServiceOf(R"("pixelType":"F32","bandCount":1,"noDataValue":-9999)");
  const TileAddress tile{service.matrices.size() - 1, 1, 0};
  const std::string picture = service.url(tile);
  EXPECT_NE(picture.find("format=png32"), std::string::npos) << picture;
  EXPECT_EQ(picture.find("pixelType"), std::string::npos) << picture;
  ASSERT_TRUE(service.heightUrl);
  EXPECT_EQ(service.heightUrl(tile),
            "http://h/arcgis/rest/services/Relief/ImageServer/exportImage?bbox=0,-90,180,90&size=512,512&bboxSR=4326&"
            "imageSR=4326&f=image&format=tiff&pixelType=F32");
  EXPECT_EQ(service.noData, -9999.0);
  EXPECT_FALSE(service.isNoDataTransparent) << "the picture is the server's";
  const TileService bands = imageServiceOf(R"("pixelType":"S16","bandCount":3)");
  ASSERT_TRUE(bands.heightUrl);
  EXPECT_TRUE(bands.heightUrl(tile).ends_with("&format=tiff&pixelType=F32&bandIds=0")) << bands.heightUrl(tile);
  EXPECT_LT(bands.noData.value_or(0.0), -3.4e38);
  for (const char* colours : {R"("pixelType":"U8","bandCount":3)", R"("pixelType":"U1")", R"("bandCount":3)"}) {
    EXPECT_FALSE(imageServiceOf(colours).heightUrl) << colours;
  }
  LayerChoices chosen;
  chosen.format = "jpg";
  EXPECT_FALSE(imageServiceOf(R"("pixelType":"F32")", chosen).heightUrl) << "somebody wants that format";
}

/// A server of floats, which has none in the west of each tile, and of the pictures that it makes of those.
TEST(ArcGisServices, HeightsAreThoseOfTheFloatsAndColoursThoseOfThePicture) {
  const TileService service = imageServiceOf(R"("pixelType":"F32","bandCount":1)");
  Worker worker;
  const auto fetcher = std::make_shared<FakeFetcher>([](const std::string& url) -> Result<Fetched> {
    const bool isPicture = url.find("format=png32") != std::string::npos;
    const auto value = [&](int band, int column, int /*row*/) {
      const bool isHole = column < 256;
      return isPicture ? (band == 3 ? 255.0 : 50.0) : isHole ? -3.4028234663852886e38 : 6543.25;
    };
    Fetched fetched{200};
    fetched.body = std::make_shared<const Bytes>(makePicture(
        {isPicture ? "PNG" : "GTiff", 512, 512, isPicture ? 4 : 1, isPicture ? GDT_Byte : GDT_Float32}, value));
    return fetched;
  });
  const auto store = std::make_shared<SourceTileStore>(
      SourceTileStore::Parts{fetcher, [&](std::function<void()> task) { worker.post(std::move(task)); }, decodeTile});
  const auto source = TiledServiceSource::make(service, store);
  ASSERT_TRUE(source) << source.error().message();
  const GeodeticTiling tiling = earth();
  const auto heights = waitFor((*source)->heightTask(tiling, {}, heightLayout));
  ASSERT_TRUE(heights) << heights.error().message();
  EXPECT_FLOAT_EQ(heights->metres[65U * 131 + 98], 6543.25F);
  EXPECT_TRUE(std::isnan(heights->metres[65U * 131 + 33])) << "the lowest float is no height";
  const auto colours = waitFor((*source)->colourTask(tiling, {}, colourLayout));
  ASSERT_TRUE(colours) << colours.error().message();
  EXPECT_EQ(colours->rgba[4U * (264 * 528 + 264)], 50);
}

}  // namespace
}  // namespace meridian::globebrowsing

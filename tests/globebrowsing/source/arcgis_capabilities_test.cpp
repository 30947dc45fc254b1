#include "globebrowsing/source/capabilities.h"
#include "service_fixture.h"

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

}  // namespace
}  // namespace meridian::globebrowsing

#include "globebrowsing/source/capabilities.h"
#include "service_fixture.h"

namespace meridian::globebrowsing {
namespace {

using namespace test;

TEST(Tms, RowsCountFromTheSouth) {
  const Capabilities capabilities =
      realCapabilities("tms_ne2_webmercator_tilemapresource.xml", "http://h/t/tilemapresource.xml");
  if (capabilities.layers.empty()) {
    GTEST_SKIP() << "NOT TESTED: no shared data; set MERIDIAN_SHARED_DATA";
  }
  const TileService service = serviceOfLayer(capabilities, capabilities.layers[0].identifier);
  EXPECT_EQ(service.crs, "EPSG:3857");
  ASSERT_EQ(service.matrices.size(), 8U);
  EXPECT_EQ(service.url({7, 0, 0}), "http://h/t/0/0/0.png");
  EXPECT_EQ(service.url({6, 1, 0}), "http://h/t/1/1/1.png");
  EXPECT_NEAR(service.matrices[6].top, webMercatorHalfWidth, 1.0);
}

std::string tileMap(const std::string& srs, const std::string& box, const std::string& sets) {
  return "<TileMap version=\"1.0.0\"><Title>t</Title><SRS>" + srs + "</SRS>" + box +
         "<TileFormat width=\"256\" height=\"256\" mime-type=\"image/png\" extension=\"png\"/>" + sets + "</TileMap>";
}

TEST(Tms, GeodeticProfilesOfBothKinds) {
  const std::string box =
      "<BoundingBox minx=\"-180\" miny=\"-90\" maxx=\"180\" maxy=\"90\"/><Origin x=\"-180\" y=\"-90\"/>";
  const auto compatible = parse(tileMap("EPSG:4326", box,
                                        "<TileSets profile=\"global-geodetic\"><TileSet href=\"0\" "
                                        "units-per-pixel=\"0.703125\" order=\"0\"/><TileSet href=\"1\" "
                                        "units-per-pixel=\"0.3515625\" order=\"1\"/></TileSets>"),
                                "http://h/tilemapresource.xml");
  ASSERT_TRUE(compatible);
  const TileService two = serviceOfLayer(*compatible, "t");
  EXPECT_EQ(two.matrices[1].lastColumn, 1);
  EXPECT_EQ(two.matrices[1].lastRow, 0);
  EXPECT_EQ(two.url({0, 3, 0}), "http://h/1/3/1.png");
  // One tile of 360 degrees: half of it lies beyond the pole.
  const auto single = parse(tileMap("EPSG:4326", box,
                                    "<TileSets profile=\"geodetic\"><TileSet href=\"0\" units-per-pixel=\"1.40625\" "
                                    "order=\"0\"/></TileSets>"));
  const TileService one = serviceOfLayer(*single, "t");
  EXPECT_EQ(one.matrices[0].lastColumn, 0);
  EXPECT_DOUBLE_EQ(one.matrices[0].top, 270.0);
  EXPECT_DOUBLE_EQ(one.north, 90.0);
  EXPECT_EQ(one.url({0, 0, 0}), "http://example.org/0/0/0.png");
}

TEST(Tms, ListsNameOtherDocuments) {
  const auto list = parse(
      "<TileMapService version=\"1.0.0\"><Title>s</Title><TileMaps><TileMap title=\"a\" srs=\"EPSG:4326\" "
      "href=\"http://h/a\"/><TileMap title=\"b\" href=\"b/\"/></TileMaps></TileMapService>",
      "http://h/tms/1.0.0");
  ASSERT_TRUE(list);
  ASSERT_EQ(list->layers.size(), 2U);
  EXPECT_EQ(list->layers[1].document, "http://h/tms/b/");
  EXPECT_FALSE(serviceOf(*list, list->layers[0]));
}

TEST(TiledWms, PatternsAreLevels) {
  // As JPL's OnEarth wrote them (GDAL's driver page has this group).
  const auto capabilities = parse(
      "<WMS_Tile_Service version=\"0.1.0\"><Service><Title>OnEarth</Title></Service><TiledPatterns>"
      "<OnlineResource xlink:href=\"http://onearth/wms.cgi?\"/><TiledGroup><Name>Global SRTM</Name><Title>SRTM</Title>"
      "<LatLonBoundingBox minx=\"-180\" miny=\"-60\" maxx=\"180\" maxy=\"84\"/><TilePattern><![CDATA[\n"
      "request=GetMap&layers=srtm&srs=EPSG:4326&width=512&height=512&bbox=-180,88,-178,90&format=image/png&styles=\n"
      "request=GetMap&layers=srtm&srs=EPSG:4326&width=512&height=512&bbox=-180,88,-178,90&format=image/png\n"
      "]]></TilePattern><TilePattern><![CDATA[request=GetMap&layers=srtm&srs=EPSG:4326&width=512&height=512&"
      "bbox=-180,86,-176,90&format=image/png&styles=]]></TilePattern></TiledGroup></TiledPatterns></WMS_Tile_Service>");
  ASSERT_TRUE(capabilities) << capabilities.error().message();
  const TileService service = serviceOfLayer(*capabilities, "Global SRTM");
  ASSERT_EQ(service.matrices.size(), 2U);
  EXPECT_EQ(service.matrices[0].firstRow, 3);
  EXPECT_EQ(service.matrices[0].lastColumn, 179);
  const std::string url = service.url({1, 1, 2});
  EXPECT_EQ(url.substr(0, 23), "http://onearth/wms.cgi?");
  EXPECT_NE(url.find("bbox=-176,78,-172,82"), std::string::npos) << url;
}

}  // namespace
}  // namespace meridian::globebrowsing

// What servers write against the letter of the standards, and how much of it.

#include <numbers>

#include <gtest/gtest.h>

#include "globebrowsing/source/capabilities.h"
#include "service_fixture.h"

namespace meridian::globebrowsing {

namespace {

using test::parse;

TileService serviceOfOnly(const Result<Capabilities>& capabilities, const LayerChoices& choices = {}) {
  EXPECT_TRUE(capabilities) << (capabilities ? "" : capabilities.error().message());
  if (!capabilities || capabilities->layers.empty()) {
    return {};
  }
  auto service = serviceOf(*capabilities, capabilities->layers.front(), choices);
  EXPECT_TRUE(service) << (service ? "" : service.error().message());
  return service ? std::move(*service) : TileService{};
}

std::string matrixSet(const std::string& name, const std::string& crs, const std::string& corner, const char* scale,
                      int columns, int rows) {
  return "<TileMatrixSet><Identifier>" + name + "</Identifier><SupportedCRS>" + crs +
         "</SupportedCRS><TileMatrix><Identifier>0</Identifier><ScaleDenominator>" + scale +
         "</ScaleDenominator><TopLeftCorner>" + corner +
         "</TopLeftCorner><TileWidth>256</TileWidth><TileHeight>256</TileHeight><MatrixWidth>" +
         std::to_string(columns) + "</MatrixWidth><MatrixHeight>" + std::to_string(rows) +
         "</MatrixHeight></TileMatrix></TileMatrixSet>";
}

std::string degrees(const std::string& corner = "90 -180") {
  return matrixSet("d", "urn:ogc:def:crs:EPSG::4326", corner, "279541132.0143589", 2, 1);
}

std::string boundingBox(const std::string& element, const std::string& box) {
  return "<" + element + "><LowerCorner>" + box.substr(0, box.find(';')) + "</LowerCorner><UpperCorner>" +
         box.substr(box.find(';') + 1) + "</UpperCorner></" + element.substr(0, element.find(' ')) + ">";
}

std::string wmts(const std::string& box, const std::string& links, const std::string& rest, const std::string& sets) {
  return "<Capabilities version=\"1.0.0\"><OperationsMetadata><Operation name=\"GetTile\"><DCP><HTTP><Post "
         "href=\"http://h/post\"/></HTTP></DCP><DCP><HTTP><Get href=\"http://h/kvp?\"/></HTTP></DCP></Operation>"
         "</OperationsMetadata><Contents><Layer><Identifier>a</Identifier>" +
         (box.empty() ? "" : boundingBox("WGS84BoundingBox", box)) +
         "<Style><Identifier>s</Identifier></Style><Format>image/png</Format>"
         "<TileMatrixSetLink>" +
         links + "</TileMatrixSetLink>" + rest + "</Layer>" + sets + "</Contents></Capabilities>";
}

const std::string linkToDegrees = "<TileMatrixSet>d</TileMatrixSet>";

struct Box {
  const char* what;
  std::string crs;  ///< as an attribute of the element
  const char* corners;
  std::string set;
  Extent expected;  ///< in units of the set
};

/// Of a layer without degrees. EPSG:2180 and EPSG:3035 have their northing first.
class OddWmtsBox : public testing::TestWithParam<Box> {};

const std::string poland = matrixSet("p", "urn:ogc:def:crs:EPSG::2180", "850000 140000", "10000000", 1, 1);
const std::string europe = matrixSet("e", "urn:ogc:def:crs:EPSG::3035", "3200000 4200000", "1000000", 2, 2);
const Extent warsaw{500000, 200000, 700000, 400000};

}  // namespace

TEST(OddWmts, OneLinkMayNameSeveralSets) {
  const auto capabilities = parse(
      wmts("-180 -80;180 80", linkToDegrees + "<TileMatrixSet>m</TileMatrixSet>", {},
           degrees() + matrixSet("m", "EPSG:3857", "-20037508.342789 20037508.342789", "559082264.0287178", 1, 1)));
  LayerChoices choices;
  choices.matrixSet = "m";
  EXPECT_EQ(serviceOfOnly(capabilities, choices).crs, "EPSG:3857");
}

TEST(OddWmts, TheAddressForGetMayComeAfterThatForPost) {
  const TileService service = serviceOfOnly(parse(wmts("-180 -90;180 90", linkToDegrees, {}, degrees())));
  ASSERT_EQ(service.matrices.size(), 1U);
  EXPECT_EQ(service.url({0, 1, 0}).substr(0, 13), "http://h/kvp?");
}

TEST(OddWmts, ImagesAreAskedForByKeysWhereOnlyOtherTilesHaveAddresses) {
  const std::string vectors =
      "<Format>application/x-protobuf</Format><ResourceURL resourceType=\"tile\" format=\"application/x-protobuf\" "
      "template=\"http://h/{TileMatrix}/{TileRow}/{TileCol}.pbf\"/>";
  const TileService service = serviceOfOnly(parse(wmts("-180 -90;180 90", linkToDegrees, vectors, degrees())));
  ASSERT_EQ(service.matrices.size(), 1U);
  EXPECT_NE(service.url({0, 1, 0}).find("FORMAT=image/png"), std::string::npos) << service.url({0, 1, 0});
}

TEST(OddWmts, ExtentsBesideTheSetsTurnLoseNothing) {
  struct Case {
    const char* box;
    const char* corner;
    double west;
    double east;
  };
  for (const Case& test : {Case{"0 -90;360 90", "90 -180", -180, 180},      // what lies west of 0 is asked for, too
                           Case{"170 -40;-170 -20", "90 -180", -180, 180},  // both ends
                           Case{"190 -40;200 -20", "90 -180", -170, -160},  // moved
                           Case{"-180 -40;180 20", "90 0", 0, 360},         // a set from 0
                           Case{"-20 -40;-10 -20", "90 0", 340, 350}, Case{"10 -40;20 -20", "90 -180", 10, 20}}) {
    SCOPED_TRACE(std::string(test.box) + " in " + test.corner);
    const TileService service = serviceOfOnly(parse(wmts(test.box, linkToDegrees, {}, degrees(test.corner))));
    EXPECT_NEAR(service.west, test.west, 1e-6);
    EXPECT_NEAR(service.east, test.east, 1e-6);
  }
}

TEST_P(OddWmtsBox, PlacesTheLayer) {
  const Box& test = GetParam();
  const std::string name = test.set.substr(test.set.find("<Identifier>") + 12, 1);
  for (const char* degreesToo : {"", "0 0;0 0"}) {
    const auto capabilities = parse(wmts(degreesToo, "<TileMatrixSet>" + name + "</TileMatrixSet>",
                                         boundingBox("BoundingBox" + test.crs, test.corners), test.set));
    const TileService service = serviceOfOnly(capabilities);
    EXPECT_NEAR(service.west, test.expected.west, 1e-6) << test.what;
    EXPECT_NEAR(service.south, test.expected.south, 1e-6) << test.what;
    EXPECT_NEAR(service.east, test.expected.east, 1e-6) << test.what;
    EXPECT_NEAR(service.north, test.expected.north, 1e-6) << test.what;
  }
}

INSTANTIATE_TEST_SUITE_P(
    OfOrders, OddWmtsBox,
    testing::Values(
        Box{"authority's order", " crs=\"urn:ogc:def:crs:EPSG::2180\"", "200000 500000;400000 700000", poland, warsaw},
        Box{"authority's order", " crs=\"http://www.opengis.net/def/crs/EPSG/0/2180\"", "200000 500000;400000 700000",
            poland, warsaw},
        Box{"easting first", " crs=\"EPSG:2180\"", "500000 200000;700000 400000", poland, warsaw},
        Box{"the set's CRS", "", "200000 500000;400000 700000", poland, warsaw},
        Box{"beside the set in the authority's order",
            " crs=\"urn:ogc:def:crs:EPSG::3035\"",
            "4250000 3100000;4300000 3150000",
            europe,
            {4250000, 3100000, 4300000, 3150000}},
        Box{"degrees for metres",
            " crs=\"urn:ogc:def:crs:EPSG::4326\"",
            "-45 10;45 20",
            matrixSet("m", "EPSG:3857", "-20037508.342789 20037508.342789", "559082264.0287178", 1, 1),
            {10 * webMercatorHalfWidth / 180, -5621521.486192066, 20 * webMercatorHalfWidth / 180, 5621521.486192066}},
        Box{"metres for degrees",
            " crs=\"urn:ogc:def:crs:EPSG::3857\"",
            "1113194.9079327358 -5621521.486192066;2226389.8158654715 5621521.486192066",
            degrees(),
            {10, -45, 20, 45}},
        Box{"no place", " crs=\"EPSG:3857\"", "0 0;0 0", degrees(), {-180, -90, 180, 90}},
        Box{"no place", " crs=\"urn:ogc:def:crs:EPSG::2180\"", "7 7;7 7", poland, {140000, 133200, 856800, 850000}},
        Box{"no CRS that is known", " crs=\"urn:x:y\"", "0 0;9 9", degrees(), {-180, -90, 180, 90}}));

TEST(OddWmts, DegreesCountBeforeBoxes) {
  const TileService service =
      serviceOfOnly(parse(wmts("5 48;15 55", linkToDegrees,
                               boundingBox("BoundingBox crs=\"urn:ogc:def:crs:EPSG::4326\"", "0 0;9 9"), degrees())));
  EXPECT_NEAR(service.west, 5, 1e-9);
  EXPECT_NEAR(service.north, 55, 1e-9);
}

TEST(OddWmts, CornersInTheOtherOrderAreTurnedWhereNothingElseFits) {
  // ETRS89 / LAEA Europe has its northing first; here the easting is.
  const TileService turned =
      serviceOfOnly(parse(wmts("5 48;15 55", "<TileMatrixSet>e</TileMatrixSet>", {},
                               matrixSet("e", "urn:ogc:def:crs:EPSG::3035", "3800000 4200000", "10000000", 2, 2))));
  ASSERT_EQ(turned.matrices.size(), 1U);
  EXPECT_EQ(turned.matrices[0].left, 4200000) << "as it should be read";
  const TileService odd =
      serviceOfOnly(parse(wmts("-112 38;-108 43", "<TileMatrixSet>m</TileMatrixSet>", {},
                               matrixSet("m", "EPSG:3857", "6000000 -13000000", "10000000", 2, 2))));
  ASSERT_EQ(odd.matrices.size(), 1U);
  EXPECT_EQ(odd.matrices[0].left, -13000000);
  EXPECT_EQ(odd.matrices[0].top, 6000000);
}

TEST(OddWms, TheAddressForGetMayComeAfterThatForPost) {
  const TileService service = serviceOfOnly(
      parse("<WMT_MS_Capabilities version=\"1.1.1\"><Service><OnlineResource href=\"http://h/about\"/></Service>"
            "<Capability><Request><GetMap><Format>image/png</Format><DCPType><HTTP><Post><OnlineResource "
            "href=\"http://h/post\"/></Post></HTTP></DCPType><DCPType><HTTP><Get><OnlineResource "
            "href=\"http://h/get\"/></Get></HTTP></DCPType></GetMap></Request><Layer><Name>a</Name>"
            "<SRS>EPSG:4326</SRS></Layer></Capability></WMT_MS_Capabilities>"));
  ASSERT_FALSE(service.matrices.empty());
  EXPECT_EQ(service.url({service.matrices.size() - 1, 0, 0}).substr(0, 13), "http://h/get?");
}

TEST(OddWms, BoxesAreFoundByAnyNameOfTheirCrs) {
  const TileService service = serviceOfOnly(
      parse("<WMS_Capabilities version=\"1.3.0\"><Capability><Layer><Name>a</Name><CRS>epsg:3031</CRS>"
            "<BoundingBox CRS=\"EPSG:3031\" minx=\"-1000\" miny=\"-1000\" maxx=\"1000\" maxy=\"1000\"/></Layer>"
            "</Capability></WMS_Capabilities>"));
  EXPECT_EQ(service.west, -1000);
  EXPECT_EQ(service.north, 1000);
}

TEST(OddWms, BoxesPlaceLayersWithoutDegrees) {
  const auto capabilities = parse(
      "<WMS_Capabilities version=\"1.3.0\"><Capability><Layer><Name>a</Name><CRS>EPSG:4326</CRS><BoundingBox "
      "CRS=\"EPSG:4326\" minx=\"40\" miny=\"-10\" maxx=\"50\" "
      "maxy=\"20\"/><Layer><Name>b</Name></Layer><Layer><Name>c</Name>"
      "<BoundingBox CRS=\"CRS:84\" minx=\"5\" miny=\"45\" maxx=\"6\" maxy=\"46\"/></Layer></Layer>"
      "</Capability></WMS_Capabilities>");
  const TileService service = serviceOfOnly(capabilities);
  EXPECT_NEAR(service.west, -10, 1e-9);
  EXPECT_NEAR(service.north, 50, 1e-9);
  ASSERT_TRUE(capabilities->find("b")->extent);
  EXPECT_EQ(capabilities->find("b")->extent->west, capabilities->layers.front().extent->west);
  ASSERT_TRUE(capabilities->find("c")->extent);
  EXPECT_NEAR(180.0 / std::numbers::pi * capabilities->find("c")->extent->west, 5, 1e-9)
      << "its own box, not the one it inherits";
}

// GeoServer lists every CRS that it knows for every layer. Each name is looked at once, whatever their number: what
// compares all with all takes longer than a test may.
TEST(OddWms, ReadsVeryManyCrsNames) {
  std::string names;
  for (int code = 0; code < 500'000; ++code) {
    names += "<SRS>X:" + std::to_string(code) + "</SRS>";
  }
  const auto capabilities = parse("<WMT_MS_Capabilities version=\"1.1.1\"><Capability><Layer><Name>a</Name>" + names +
                                  "<SRS>EPSG:4326</SRS></Layer></Capability></WMT_MS_Capabilities>");
  EXPECT_EQ(serviceOfOnly(capabilities).crs, "");
}

TEST(OddArcGis, BoxesHaveTheirEastingFirst) {
  LayerChoices choices;
  choices.crs = "EPSG:2180";
  const TileService service = serviceOfOnly(
      parse(R"({"currentVersion":10.8,"mapName":"M","capabilities":"Map","fullExtent":{"xmin":500000,"ymin":200000,
                "xmax":700000,"ymax":400000,"spatialReference":{"wkid":2180}}})",
            "http://h/arcgis/rest/services/M/MapServer?f=json"),
      choices);
  EXPECT_EQ(service.west, 500000);
  EXPECT_EQ(service.north, 400000);
  const std::string url = service.url({service.matrices.size() - 1, 0, 0});
  EXPECT_NE(url.find("bboxSR=2180&imageSR=2180"), std::string::npos) << url;
}

TEST(OddArcGis, ServicesWithoutMapsSaySo) {
  const std::string extent =
      "\"fullExtent\":{\"xmin\":0,\"ymin\":0,\"xmax\":9,\"ymax\":9,\"spatialReference\":{\"wkid\":4326}}";
  const auto obstacle = [&](const std::string& more) {
    const auto capabilities = parse("{" + more + extent + "}", "http://h/rest/services/A/FeatureServer?f=json");
    EXPECT_TRUE(capabilities);
    return capabilities ? capabilities->layers.front().obstacle : std::string();
  };
  EXPECT_EQ(obstacle("\"capabilities\":\"Map,Query\","), "");
  EXPECT_EQ(obstacle("\"capabilities\":\"Image\","), "");
  EXPECT_EQ(obstacle(""), "");
  EXPECT_NE(obstacle("\"capabilities\":\"Query,Sync\",").find("Query,Sync"), std::string::npos);
  EXPECT_NE(obstacle("\"capabilities\":\"Map\",\"type\":\"Feature Layer\",").find("layer of a service"),
            std::string::npos);
}

TEST(OddXml, BytesMayBeginWithTheMarkOfUtf16) {
  for (const char* mark : {"\xFF\xFE", "\xFE\xFF"}) {
    const auto capabilities = parse(std::string(mark) +
                                    "<WMT_MS_Capabilities version=\"1.1.1\"><Capability><Layer><Name>a</Name></Layer>"
                                    "</Capability></WMT_MS_Capabilities>");
    ASSERT_TRUE(capabilities) << capabilities.error().message();
    EXPECT_EQ(capabilities->layers.size(), 1U);
  }
}

}  // namespace meridian::globebrowsing

// What servers write against the letter of the standards, and how much of it.

#include <chrono>

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

std::string wmts(const std::string& box, const std::string& links, const std::string& rest, const std::string& sets) {
  return "<Capabilities version=\"1.0.0\"><OperationsMetadata><Operation name=\"GetTile\"><DCP><HTTP><Post "
         "href=\"http://h/post\"/></HTTP></DCP><DCP><HTTP><Get href=\"http://h/kvp?\"/></HTTP></DCP></Operation>"
         "</OperationsMetadata><Contents><Layer><Identifier>a</Identifier><WGS84BoundingBox><LowerCorner>" +
         box.substr(0, box.find(';')) + "</LowerCorner><UpperCorner>" + box.substr(box.find(';') + 1) +
         "</UpperCorner></WGS84BoundingBox><Style><Identifier>s</Identifier></Style><Format>image/png</Format>"
         "<TileMatrixSetLink>" +
         links + "</TileMatrixSetLink>" + rest + "</Layer>" + sets + "</Contents></Capabilities>";
}

const std::string linkToDegrees = "<TileMatrixSet>d</TileMatrixSet>";

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

// GeoServer lists every CRS that it knows for every layer. Each name is looked at once, whatever their number: what
// compares all with all takes minutes here.
TEST(OddWms, ManyCrsNamesTakeNoLonger) {
  std::string names;
  for (int code = 0; code < 150'000; ++code) {
    names += "<SRS>X:" + std::to_string(code) + "</SRS>";
  }
  const auto begin = std::chrono::steady_clock::now();
  const auto capabilities = parse("<WMT_MS_Capabilities version=\"1.1.1\"><Capability><Layer><Name>a</Name>" + names +
                                  "<SRS>EPSG:4326</SRS></Layer></Capability></WMT_MS_Capabilities>");
  EXPECT_EQ(serviceOfOnly(capabilities).crs, "");
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(10));
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

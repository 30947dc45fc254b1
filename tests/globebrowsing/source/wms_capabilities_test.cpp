#include <functional>

#include "globebrowsing/source/capabilities.h"
#include "globebrowsing/source/service_text.h"
#include "service_fixture.h"
#include "support/allocation_count.h"

namespace meridian::globebrowsing {
namespace {

using namespace test;

TEST(Ledger, NoMapIsAskedForThatTheWmsForbids) {
  MERIDIAN_NEEDS(sharedData("capabilities"));
  for (const auto& entry : std::filesystem::directory_iterator(sharedData("capabilities"))) {
    const std::string file = entry.path().filename().string();
    if (!file.starts_with("wms1")) {
      continue;
    }
    SCOPED_TRACE(file);
    const Capabilities capabilities = realCapabilities(file);
    for (const CapabilitiesLayer& layer : capabilities.layers) {
      for (const std::string& crs : layer.crs.names()) {
        LayerChoices choices;
        choices.crs = crs;
        const auto service =
            layer.obstacle.empty() ? serviceOf(capabilities, layer, choices) : tl::make_unexpected(Error{});
        if (!service) {
          continue;
        }
        for (const TileAddress& address : cornersOf(*service)) {
          const std::string url = service->url(address);
          const auto value = [&](const char* name) {
            return replaceAll(parameterOf(url, name).value_or("missing"), "%20", " ");
          };
          EXPECT_EQ(url.find_first_of("{} "), std::string::npos) << url;
          EXPECT_EQ(value("version"), capabilities.version);
          EXPECT_EQ(value("request"), "GetMap");
          EXPECT_EQ(value("layers"), percentEncoded(layer.identifier));
          EXPECT_EQ(value(capabilities.version == "1.3.0" ? "crs" : "srs"), percentEncoded(crs, ":"));
          EXPECT_NE(std::find(layer.formats.begin(), layer.formats.end(), replaceAll(value("format"), "%3B", ";")),
                    layer.formats.end())
              << url;
          if (capabilities.maximumWidth > 0) {
            EXPECT_LE(std::stoi(value("width")), capabilities.maximumWidth);
          }
          const std::vector<std::string> box = split(value("bbox"), ",");
          ASSERT_EQ(box.size(), 4U);
          EXPECT_LT(*number(box[0]), *number(box[2])) << url;
          EXPECT_LT(*number(box[1]), *number(box[3])) << url;
          // The tile and the extent have points in common.
          const TileMatrix& matrix = service->matrices[address.matrix];
          const double west = matrix.left + static_cast<double>(address.column) * matrix.tileWidth * matrix.pixelWidth;
          EXPECT_LT(west, service->east);
          EXPECT_GT(west + matrix.tileWidth * matrix.pixelWidth, service->west);
        }
      }
    }
  }
}

// ---- What services write.

std::string wms(const std::string& version, const std::string& layers, const std::string& service = {}) {
  const std::string root = version == "1.3.0" ? "WMS_Capabilities" : "WMT_MS_Capabilities";
  return "<" + root + " version=\"" + version + "\"><Service><Title>T</Title>" + service +
         "</Service><Capability><Request><GetMap><Format>image/jpeg</Format><Format>image/png</Format><DCPType><HTTP>"
         "<Get><OnlineResource xlink:href=\"http://h/w?map=a&amp;\"/></Get></HTTP></DCPType></GetMap></Request>" +
         layers + "</Capability></" + root + ">";
}

const std::string worldBox =
    "<EX_GeographicBoundingBox><westBoundLongitude>-180</westBoundLongitude><eastBoundLongitude>180"
    "</eastBoundLongitude><southBoundLatitude>-90</southBoundLatitude><northBoundLatitude>90</northBoundLatitude>"
    "</EX_GeographicBoundingBox>";

TEST(Wms, AxesGoByVersionAndCrs) {
  struct Case {
    const char* version;
    const char* crs;
    const char* box;
  };
  const std::string oldBox = "<LatLonBoundingBox minx=\"-180\" miny=\"-90\" maxx=\"180\" maxy=\"90\"/>";
  for (const Case& test : {Case{"1.1.1", "EPSG:4326", "BBOX=0,-90,180,90"},
                           {"1.3.0", "EPSG:4326", "BBOX=-90,0,90,180"},
                           {"1.3.0", "CRS:84", "BBOX=0,-90,180,90"},
                           {"1.3.0", "EPSG:4258", "BBOX=-90,0,90,180"},
                           {"1.3.0", "urn:ogc:def:crs:EPSG::4326", "BBOX=-90,0,90,180"}}) {
    const std::string tag = std::string(test.version) == "1.3.0" ? "CRS" : "SRS";
    const auto capabilities = parse(wms(test.version, "<Layer><Name>a</Name><Title>A</Title><" + tag + ">" + test.crs +
                                                          "</" + tag + ">" + worldBox + oldBox + "</Layer>"));
    ASSERT_TRUE(capabilities) << capabilities.error().message();
    const TileService service = serviceOfLayer(*capabilities, "a");
    const std::string url = service.url({service.matrices.size() - 1, 1, 0});
    EXPECT_NE(url.find(test.box), std::string::npos) << url;
    EXPECT_EQ(url.substr(0, 17), "http://h/w?map=a&");
    EXPECT_EQ(service.crs, "");
  }
}

TEST(Wms, PolarMapsAreLaidOutInTheirOwnBox) {
  // EPSG:3031's axes are easting and northing; EPSG:2180's (Poland) northing first.
  const auto capabilities = parse(
      wms("1.3.0",
          "<Layer><Name>a</Name><CRS>EPSG:3031</CRS><BoundingBox CRS=\"EPSG:3031\" minx=\"-4194304\" miny=\"-4194304\" "
          "maxx=\"4194304\" maxy=\"4194304\"/></Layer><Layer><Name>b</Name><CRS>EPSG:2180</CRS><BoundingBox "
          "CRS=\"EPSG:2180\" minx=\"100000\" miny=\"200000\" maxx=\"800000\" maxy=\"860000\"/></Layer>"));
  ASSERT_TRUE(capabilities);
  const TileService polar = serviceOfLayer(*capabilities, "a");
  EXPECT_EQ(polar.crs, "EPSG:3031");
  EXPECT_NE(polar.url({polar.matrices.size() - 1, 0, 0}).find("BBOX=-4194304,-4194304,4194304,4194304"),
            std::string::npos);
  const TileService poland = serviceOfLayer(*capabilities, "b");
  EXPECT_DOUBLE_EQ(poland.west, 200000);
  EXPECT_DOUBLE_EQ(poland.north, 800000);
  EXPECT_NE(poland.url({poland.matrices.size() - 1, 0, 0}).find("BBOX=100000,200000,"), std::string::npos);
}

TEST(Wms, LayersInherit) {
  const auto capabilities = parse(wms(
      "1.1.1",
      "<Layer><Title>Root</Title><SRS>EPSG:4326 EPSG:3857</SRS><LatLonBoundingBox minx=\"-10\" miny=\"40\" maxx=\"10\" "
      "maxy=\"50\"/><Attribution><Title>Me</Title></Attribution><Style><Name>s</Name></Style>"
      "<Dimension name=\"time\" units=\"ISO8601\"/><Extent name=\"time\" default=\"2001\" "
      "nearestValue=\"1\">2000/2002/P1Y"
      "</Extent><Layer><Name>a</Name><Title>A</Title><SRS>EPSG:3031</SRS><Style><Name>t</Name></Style>"
      "<Extent name=\"time\">2005</Extent><Layer opaque=\"1\"><Name>b</Name></Layer></Layer></Layer>"));
  ASSERT_TRUE(capabilities);
  ASSERT_EQ(capabilities->layers.size(), 3U);
  const CapabilitiesLayer& b = *capabilities->find("b");
  EXPECT_EQ(b.crs.names(), (std::vector<std::string>{"EPSG:4326", "EPSG:3031", "EPSG:3857"}));
  EXPECT_EQ(b.path, (std::vector<std::string>{"Root", "A"}));
  EXPECT_EQ(b.styles.size(), 2U);
  EXPECT_EQ(b.attribution, "Me");
  EXPECT_EQ(b.title, "b");
  ASSERT_NE(b.timeDimension(), nullptr);
  EXPECT_EQ(b.timeDimension()->values, "2005");
  EXPECT_EQ(b.timeDimension()->units, "ISO8601");
  ASSERT_TRUE(b.extent);
  EXPECT_NEAR(b.extent->west, -10 * degree, 1e-12);
  const TileService service = serviceOfLayer(*capabilities, "b");
  EXPECT_EQ(service.attribution, "Me");
  const std::string url = service.url({0, service.matrices[0].firstColumn, service.matrices[0].firstRow});
  EXPECT_NE(url.find("FORMAT=image/jpeg"), std::string::npos) << url;  // opaque
  EXPECT_NE(url.find("TIME=2005"), std::string::npos) << url;          // it names no default
  EXPECT_FALSE(capabilities->layers[0].obstacle.empty());
}

/// Allocations for a document whose layers inherit so many CRSs and have one of their own besides, and for its
/// services.
std::size_t allocationsFor(int layers, int names) {
  std::string document = "<Layer><Title>Root</Title>" + worldBox;
  for (int name = 0; name < names; ++name) {  // too long for a string without an allocation
    document += "<CRS>urn:ogc:def:crs:EPSG::" + std::to_string(100'000 + name) + "</CRS>";
  }
  for (int layer = 0; layer < layers; ++layer) {
    const std::string number = std::to_string(1000 + layer);
    document +=
        "<Layer><Name>" + number + "</Name><CRS>urn:ogc:def:crs:X::" + number + "</CRS><CRS>CRS:84</CRS></Layer>";
  }
  document = wms("1.3.0", document + "</Layer>");
  const std::size_t before = allocationsOfThisThread();
  const auto capabilities = parse(document);
  EXPECT_TRUE(capabilities);
  for (int layer = 0; layer < layers; ++layer) {
    const CapabilitiesLayer& read = capabilities->layers[static_cast<std::size_t>(layer) + 1];
    EXPECT_TRUE(serviceOf(*capabilities, read));
    EXPECT_TRUE(read.crs.contains("urn:ogc:def:crs:X::" + read.identifier));
  }
  return allocationsOfThisThread() - before;
}

// GeoServer lists thousands of CRSs, and all its layers inherit them: the names are there once.
TEST(Wms, LayersShareTheCrsNamesThatTheyInherit) {
  constexpr int few = 100;  // and more than are looked at for a service
  const std::size_t oneLayer = allocationsFor(1, 2000) - allocationsFor(1, few);
  const std::size_t manyLayers = allocationsFor(100, 2000) - allocationsFor(100, few);
  EXPECT_LT(manyLayers, 2 * oneLayer);
}

TEST(Wms, ChoicesAreKeptToWhatThereIs) {
  const auto capabilities = parse(wms(
      "1.3.0",
      "<Layer><Name>a &amp; b</Name><CRS>CRS:84</CRS>" + worldBox +
          "<Style><Name>dark</Name></Style><Dimension name=\"time\" units=\"ISO8601\" default=\"2002-01-01\">"
          "2001-01-01,2002-01-01</Dimension><Dimension name=\"elevation\" units=\"m\" default=\"0\">0,100</Dimension>"
          "<Dimension name=\"band\" units=\"\" default=\"1\">1,2</Dimension></Layer>",
      "<MaxWidth>400</MaxWidth><MaxHeight>300</MaxHeight>"));
  ASSERT_TRUE(capabilities);
  const CapabilitiesLayer& layer = *capabilities->find("a & b");
  LayerChoices choices;
  choices.style = "dark";
  choices.format = "image/PNG";
  choices.time = "2001-01-01";
  choices.dimensions = {{"elevation", "100"}, {"Band", "2"}};
  choices.parameters = {{"token", "x y"}};
  choices.isTransparent = false;
  const TileService service = serviceOfLayer(*capabilities, "a & b", choices);
  const std::string url = service.url({0, service.matrices[0].firstColumn, service.matrices[0].firstRow});
  for (const char* part : {"LAYERS=a%20%26%20b&", "STYLES=dark&", "FORMAT=image/png&", "TIME=2001-01-01",
                           "ELEVATION=100", "DIM_band=2", "token=x%20y", "TRANSPARENT=FALSE", "WIDTH=300&HEIGHT=300"}) {
    EXPECT_NE(url.find(part), std::string::npos) << part << " in " << url;
  }
  for (const auto& spoil : std::initializer_list<std::function<void(LayerChoices&)>>{
           [](LayerChoices& c) { c.style = "light"; }, [](LayerChoices& c) { c.format = "image/x"; },
           [](LayerChoices& c) { c.crs = "EPSG:2056"; }, [](LayerChoices& c) { c.dimensions["elevation"] = "7"; }}) {
    LayerChoices bad;
    spoil(bad);
    EXPECT_FALSE(serviceOf(*capabilities, layer, bad));
  }
}

TEST(Wms, FixedSizesAreAskedForOnce) {
  const auto capabilities = parse(
      wms("1.3.0", "<Layer fixedWidth=\"600\" fixedHeight=\"300\" noSubsets=\"1\"><Name>a</Name><CRS>CRS:84</CRS>" +
                       worldBox + "</Layer><Layer noSubsets=\"1\"><Name>b</Name><CRS>CRS:84</CRS>" + worldBox +
                       "</Layer>"));
  const TileService fixed = serviceOfLayer(*capabilities, "a");
  ASSERT_EQ(fixed.matrices.size(), 1U);
  EXPECT_NE(fixed.url({0, 0, 0}).find("BBOX=-180,-90,180,90&WIDTH=600&HEIGHT=300"), std::string::npos);
  const TileService whole = serviceOfLayer(*capabilities, "b");
  ASSERT_EQ(whole.matrices.size(), 1U);
  EXPECT_EQ(whole.matrices[0].tileWidth, 2 * whole.matrices[0].tileHeight);
}

TEST(Wms, ReadsWhatIsOddAndMissing) {
  // Prefixes, a BOM, CDATA, case, attributes without prefix, version 1.0.0's formats, exchanged and crossing extents.
  const auto odd = parse(
      "\xEF\xBB\xBF<?xml version=\"1.0\"?><wms:WMS_CAPABILITIES version=\"1.3.0\"><wms:Service/><wms:Capability>"
      "<wms:Request><wms:GetMap><wms:DCPType><wms:HTTP><wms:Get><wms:OnlineResource href=\"/w\"/></wms:Get></wms:HTTP>"
      "</wms:DCPType></wms:GetMap></wms:Request><wms:Layer queryable=\"TRUE\" opaque=\"False\"><wms:Name>"
      "<![CDATA[a]]></wms:Name><wms:LatLonBoundingBox minx=\"170\" miny=\"-20\" maxx=\"-170\" maxy=\"20\"/></wms:Layer>"
      "</wms:Capability></wms:WMS_CAPABILITIES>");
  ASSERT_TRUE(odd) << odd.error().message();
  EXPECT_NEAR(odd->layers[0].extent->east, 190 * degree, 1e-12);
  const TileService service = serviceOfLayer(*odd, "a");
  EXPECT_EQ(service.url({0, service.matrices[0].firstColumn, service.matrices[0].firstRow}).substr(0, 21),
            "http://example.org/w?");
  const auto old = parse(
      "<WMT_MS_Capabilities version=\"1.0.0\"><Capability><Request><Map><Format><PNG/><JPEG/></Format><DCPType><HTTP>"
      "<Get onlineResource=\"http://h/old\"/></HTTP></DCPType></Map></Request><Layer><Name>a</Name><SRS>EPSG:4326</SRS>"
      "</Layer></Capability></WMT_MS_Capabilities>");
  ASSERT_TRUE(old);
  EXPECT_EQ(old->layers[0].formats, (std::vector<std::string>{"PNG", "JPEG"}));
  EXPECT_NE(serviceOfLayer(*old, "a").url({0, 0, 0}).find("http://h/old?"), std::string::npos);
}

}  // namespace
}  // namespace meridian::globebrowsing

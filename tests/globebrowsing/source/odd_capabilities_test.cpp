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

}  // namespace

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

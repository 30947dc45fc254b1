// What GDAL asks servers itself, on loopback.
#include "globebrowsing/source/gdal_network.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include <cpl_conv.h>
#include <gmock/gmock.h>

#include "raster_fixture.h"
#include "support/fault_server.h"

namespace meridian::globebrowsing::test {
namespace {

using testing::HasSubstr;
using Fault = FaultServer::Reply::Fault;

class GdalNetwork : public testing::Test {
 protected:
  void SetUp() override { setGdalNetwork(options_); }
  void TearDown() override { setGdalNetwork({}); }

  void goOffline(bool isOffline) {
    options_.cache.mode = isOffline ? CacheMode::CacheOnly : CacheMode::ReadWrite;
    setGdalNetwork(options_);
  }
  /// A service whose description GDAL itself has to fetch.
  [[nodiscard]] std::string tiledWms(const std::string& more = {}) const {
    return "<GDAL_WMS><Service name=\"TiledWMS\"><ServerUrl>" + server_.url("/wms?") +
           "</ServerUrl><TiledGroupName>A</TiledGroupName></Service>" + more + "</GDAL_WMS>";
  }
  /// One whose tiles it asks for.
  [[nodiscard]] std::string tms() const {
    return "<GDAL_WMS><Service name=\"TMS\"><ServerUrl>" + server_.url("/${z}/${x}/${y}.png") +
           "</ServerUrl></Service><DataWindow><UpperLeftX>-180</UpperLeftX><UpperLeftY>90</UpperLeftY><LowerRightX>180"
           "</LowerRightX><LowerRightY>-90</LowerRightY><TileLevel>3</TileLevel><TileCountX>2</TileCountX><TileCountY>1"
           "</TileCountY><YOrigin>top</YOrigin></DataWindow><Projection>EPSG:4326</Projection><BandsCount>3"
           "</BandsCount><BlockSizeX>64</BlockSizeX><BlockSizeY>64</BlockSizeY></GDAL_WMS>";
  }
  [[nodiscard]] static std::string vrt(const std::string& source) {
    return "<VRTDataset rasterXSize=\"8\" rasterYSize=\"4\"><SRS>EPSG:4326</SRS><GeoTransform>-180,45,0,90,0,-45"
           "</GeoTransform><VRTRasterBand dataType=\"Byte\" band=\"1\"><ComplexSource><SourceFilename>" +
           source +
           "</SourceFilename><SourceProperties RasterXSize=\"8\" RasterYSize=\"4\" DataType=\"Byte\" BlockXSize=\"8\" "
           "BlockYSize=\"4\"/><SourceBand>1</SourceBand></ComplexSource></VRTRasterBand></VRTDataset>";
  }
  [[nodiscard]] static std::string escaped(std::string text) {
    for (std::size_t at = 0; (at = text.find('<', at)) != std::string::npos;) {
      text.replace(at, 1, "&lt;");
    }
    return text;
  }

  FaultServer server_;
  NetworkOptions options_;
};

TEST_F(GdalNetwork, SaysWhoWeAre) {
  options_.userAgent = "Meridian/test";
  setGdalNetwork(options_);
  for (const std::string& path : {tiledWms(), "/vsicurl/" + server_.url("/a.tif")}) {
    const std::size_t before = server_.count();
    EXPECT_FALSE(RasterSource::open({path}));
    ASSERT_GT(server_.count(), before) << path;
    EXPECT_EQ(server_.requests().back().headers.at("user-agent"), "Meridian/test") << path;
  }
  const auto source = open({tms()});
  ASSERT_TRUE(source);
  static_cast<void>(source->colours(earth(), {0, 0, 0, 0}, {8, 0}, {}));
  EXPECT_EQ(server_.requests().back().headers.at("user-agent"), "Meridian/test");
}

TEST_F(GdalNetwork, GivesAStalledServerUp) {
  server_.onAnything([](const FaultServer::Request&) { return FaultServer::Reply{.fault = Fault::StallAtOnce}; });
  options_.limits.totalTime = std::chrono::milliseconds(300);
  setGdalNetwork(options_);
  EXPECT_FALSE(RasterSource::open({"/vsicurl/" + server_.url("/a.tif")}));
  options_.limits = {.stallTime = std::chrono::seconds(1)};
  setGdalNetwork(options_);
  EXPECT_FALSE(RasterSource::open({tiledWms()}));
  EXPECT_GE(server_.count(), 2U);
}

TEST_F(GdalNetwork, AsksNobodyOffline) {
  goOffline(true);
  const std::string file = ::testing::TempDir() + "gdal_network_test.xml";
  std::ofstream(file) << tiledWms();
  for (const std::string& path :
       {tiledWms(), "/vsicurl/" + server_.url("/a.tif"), vrt("/vsicurl/" + server_.url("/b.tif")), vrt(escaped(tms())),
        vrt(escaped(vrt(file))), file, "OGCAPI:" + server_.url("/"), "WMS:" + server_.url("/"),
        server_.url("/c.tif")}) {
    const auto source = RasterSource::open({path, "the.asset:3"});
    ASSERT_FALSE(source) << path;
    EXPECT_THAT(source.error().message(), HasSubstr("cache-only")) << path;
    EXPECT_THAT(source.error().message(), HasSubstr("127.0.0.1")) << path;
    EXPECT_THAT(source.error().where, "the.asset:3");
  }
  EXPECT_EQ(server_.count(), 0U);
  // What the eye does not find in a path, GDAL's own functions refuse.
  EXPECT_EQ(openWithGdal("/vsicurl/" + server_.url("/d.tif")), nullptr);
  EXPECT_EQ(openWithGdal(tiledWms()), nullptr);
  EXPECT_EQ(server_.count(), 0U);
  EXPECT_EQ(server_.connections(), 0U);
  std::remove(file.c_str());
}

TEST_F(GdalNetwork, ReadsFilesOffline) {
  goOffline(true);
  const MadeRaster made({8, 4, {-180, 45, 0, 90, 0, -45}, GDT_Byte}, [](int, int, int) { return 100; });
  EXPECT_NE(open({made.path()}), nullptr);
  EXPECT_NE(open({vrt(made.path())}), nullptr);
}

TEST_F(GdalNetwork, WhatIsOpenAsksNobodyOfflineAndGoesOnAfterwards) {
  const auto source = open({tms()});
  ASSERT_TRUE(source);
  goOffline(true);
  const std::size_t before = server_.count();
  const auto colours = source->colours(earth(), {0, 0, 0, 0}, {8, 0}, {});
  ASSERT_FALSE(colours);
  EXPECT_THAT(colours.error().message(), HasSubstr("cache-only"));
  EXPECT_EQ(server_.count(), before);
  goOffline(false);
  static_cast<void>(source->colours(earth(), {0, 0, 0, 0}, {8, 0}, {}));
  EXPECT_GT(server_.count(), before);
}

TEST_F(GdalNetwork, CertificatesAreAlwaysVerified) {
  // As OpenSpace writes it for GIBS: a description that is opened is opened without.
  const std::string careless = tiledWms("<UnsafeSSL>true</UnsafeSSL>");
  EXPECT_EQ(withVerifiedCertificates(careless), tiledWms());
  const std::string file = testing::TempDir() + "careless.wms";
  std::ofstream(file) << careless;
  EXPECT_EQ(withVerifiedCertificates(file), tiledWms());
  EXPECT_FALSE(gdalReach(withVerifiedCertificates(file)).isUnverified);
  const auto source = RasterSource::open({vrt(escaped(careless))});
  ASSERT_FALSE(source) << "what a VRT names is GDAL's to read";
  EXPECT_THAT(source.error().message(), HasSubstr("UnsafeSSL"));
  EXPECT_EQ(server_.count(), 0U);
  std::remove(file.c_str());
  EXPECT_STREQ(CPLGetConfigOption("GDAL_HTTP_UNSAFESSL", ""), "NO");
}

TEST_F(GdalNetwork, LooksAtADescriptionOnceAndAtRastersNotAtAll) {
  const std::string file = testing::TempDir() + "itself.vrt";
  std::string sources;
  for (int band = 0; band < 40; ++band) {
    sources += "<A><SourceFilename>" + file + "</SourceFilename></A>";
  }
  std::ofstream(file) << "<VRTDataset>" << sources << "</VRTDataset>";
  EXPECT_FALSE(gdalReach(file).server) << "and it ends";
  const std::string raster = testing::TempDir() + "raster.tif";
  std::ofstream(raster) << tms();
  EXPECT_FALSE(gdalReach(vrt(raster)).server);
  const std::string large = testing::TempDir() + "large.vrt";
  std::ofstream(large) << "<VRTDataset>" << std::string(std::size_t{5} << 20, ' ') << "<A><SourceFilename>"
                       << server_.url("/a.tif") << "</SourceFilename></A></VRTDataset>";
  EXPECT_THAT(gdalReach(large).server.value_or(""), HasSubstr("a.tif"));
  for (const std::string& each : {file, raster, large}) {
    std::remove(each.c_str());
  }
}

TEST_F(GdalNetwork, OfMosaicsThatAreTooLargeItSaysThatItDoesNotKnow) {
  goOffline(true);
  const std::string mosaic = testing::TempDir() + "mosaic.vrt";
  std::ofstream(mosaic) << "<VRTDataset>" << std::string(std::size_t{5} << 20, ' ') << "</VRTDataset>";
  EXPECT_TRUE(checkReach(gdalReach(mosaic), "the.asset:3")) << "it names no server";
  std::filesystem::resize_file(mosaic, (std::size_t{64} << 20) + 1);  // takes no room on the disk
  EXPECT_FALSE(gdalReach(mosaic).server);
  const Result<void> checked = checkReach(gdalReach(mosaic), "the.asset:3");
  ASSERT_FALSE(checked);
  EXPECT_THAT(checked.error().message(), HasSubstr("mosaic.vrt' has more than 64 MiB"));
  EXPECT_THAT(checked.error().message(), HasSubstr("not known"));
  EXPECT_THAT(checked.error().message(), HasSubstr("cache-only"));
  goOffline(false);
  EXPECT_TRUE(checkReach(gdalReach(mosaic), "the.asset:3"));
  std::remove(mosaic.c_str());
}

TEST_F(GdalNetwork, HandsOnWhatIsSetAndCanBeTakenBack) {
  options_.limits = {
      .connectTime = std::chrono::milliseconds(2500), .stallTime = std::chrono::seconds(9), .minimumSpeed = 11};
  options_.certificateFile = "/some/ca.pem";
  setGdalNetwork(options_);
  EXPECT_STREQ(CPLGetConfigOption("GDAL_HTTP_CONNECTTIMEOUT", ""), "2.5");
  EXPECT_STREQ(CPLGetConfigOption("GDAL_HTTP_TIMEOUT", ""), "120");
  EXPECT_STREQ(CPLGetConfigOption("GDAL_HTTP_LOW_SPEED_TIME", ""), "9");
  EXPECT_STREQ(CPLGetConfigOption("GDAL_HTTP_LOW_SPEED_LIMIT", ""), "11");
  EXPECT_STREQ(CPLGetConfigOption("GDAL_CURL_CA_BUNDLE", ""), "/some/ca.pem");
  setGdalNetwork({});
  EXPECT_STREQ(CPLGetConfigOption("GDAL_CURL_CA_BUNDLE", "none"), "none");
}

}  // namespace
}  // namespace meridian::globebrowsing::test

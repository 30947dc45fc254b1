// VRTs over a service as gdal_translate and gdalbuildvrt write them.
#include <gdal_utils.h>
#include <gmock/gmock.h>
#include <unistd.h>

#include "globebrowsing/source/gdal_runtime.h"
#include "globebrowsing/source/service_description.h"
#include "service_fixture.h"

namespace meridian::globebrowsing {
namespace {

using namespace test;
using testing::HasSubstr;

class VrtTools : public testing::Test {
 protected:
  VrtTools() : folder_(std::filesystem::path(testing::TempDir()) / ("meridian_vrt_tools_" + std::to_string(getpid()))) {
    initializeGdal();
    std::filesystem::create_directories(folder_);
    write("a.wms", "<DataValues NoData=\"7\"/>");
  }
  ~VrtTools() override { std::filesystem::remove_all(folder_); }

  void write(const std::string& name, const std::string& rest) const {
    std::ofstream(path(name))
        << "<GDAL_WMS><Service name=\"TMS\"><ServerUrl>http://127.0.0.1:9/${z}/${x}/${y}.png</ServerUrl></Service>"
           "<DataWindow><UpperLeftX>-180</UpperLeftX><UpperLeftY>90</UpperLeftY><LowerRightX>180</LowerRightX>"
           "<LowerRightY>-90</LowerRightY><TileLevel>3</TileLevel><TileCountX>2</TileCountX><TileCountY>1</TileCountY>"
           "<YOrigin>top</YOrigin></DataWindow><Projection>EPSG:4326</Projection><BlockSizeX>256</BlockSizeX>"
           "<BlockSizeY>256</BlockSizeY><BandsCount>3</BandsCount>"
        << rest << "</GDAL_WMS>";
  }
  [[nodiscard]] std::string path(const std::string& name) const { return (folder_ / name).string(); }

  static char** listOf(const std::vector<std::string>& words) {
    char** list = nullptr;
    for (const std::string& word : words) {
      list = CSLAddString(list, word.c_str());
    }
    return list;
  }
  /// Both read no pixels, so that nothing is asked of the network.
  void translate(const std::string& from, const std::string& to, std::vector<std::string> options) const {
    options.insert(options.begin(), {"-of", "VRT"});
    char** list = listOf(options);
    GDALTranslateOptions* parsed = GDALTranslateOptionsNew(list, nullptr);
    const GDALDatasetUniquePtr source = openWithGdal(path(from));
    ASSERT_TRUE(source);
    GDALDatasetUniquePtr made(
        GDALDataset::FromHandle(GDALTranslate(path(to).c_str(), GDALDataset::ToHandle(source.get()), parsed, nullptr)));
    EXPECT_TRUE(made) << to;
    GDALTranslateOptionsFree(parsed);
    CSLDestroy(list);
  }
  void build(const std::string& from, const std::string& to, const std::vector<std::string>& options) const {
    char** list = listOf(options);
    GDALBuildVRTOptions* parsed = GDALBuildVRTOptionsNew(list, nullptr);
    char** names = listOf({path(from)});
    GDALDatasetUniquePtr made(
        GDALDataset::FromHandle(GDALBuildVRT(path(to).c_str(), 1, nullptr, names, parsed, nullptr)));
    EXPECT_TRUE(made) << to;
    GDALBuildVRTOptionsFree(parsed);
    CSLDestroy(names);
    CSLDestroy(list);
  }
  [[nodiscard]] ServiceDescription describe(const std::string& name) const {
    auto described = describeService(path(name), "a.asset:1");
    EXPECT_TRUE(described) << (described ? "" : described.error().message());
    return described ? std::move(*described) : ServiceDescription{};
  }

  std::filesystem::path folder_;
};

TEST_F(VrtTools, WhatTranslateSaysOfTheBandsCounts) {
  translate("a.wms", "t.vrt", {"-a_nodata", "0", "-a_scale", "0.5", "-a_offset", "10"});
  const ServiceDescription described = describe("t.vrt");
  ASSERT_TRUE(described.service) << described.reason;
  EXPECT_EQ(described.service->noData, 0.0) << "in place of the inner 7";
  EXPECT_TRUE(described.service->isNoDataTransparent);
  EXPECT_EQ(described.service->heightScale, 0.5);
  EXPECT_EQ(described.service->heightOffset, 10.0);
  EXPECT_EQ(described.service->bands, 3);
  EXPECT_EQ(described.service->url({0, 5, 2}), "http://127.0.0.1:9/3/5/2.png");
  translate("a.wms", "scale.vrt", {"-a_scale", "2"});
  EXPECT_EQ(describe("scale.vrt").service->heightScale, 2.0);
  EXPECT_EQ(describe("scale.vrt").service->heightOffset, 0.0);
  EXPECT_EQ(describe("scale.vrt").service->noData, 7.0) << "copied";
  translate("a.wms", "plain.vrt", {});
  EXPECT_FALSE(describe("plain.vrt").service->heightScale);
}

TEST_F(VrtTools, ScalesOfVrtsWithinVrtsAreTheOutermostAlone) {
  translate("a.wms", "inner.vrt", {"-a_scale", "0.5", "-a_offset", "10"});
  translate("inner.vrt", "copied.vrt", {});
  EXPECT_EQ(describe("copied.vrt").service->heightScale, 0.5);
  EXPECT_EQ(describe("copied.vrt").service->heightOffset, 10.0);
  translate("inner.vrt", "replaced.vrt", {"-a_scale", "3"});
  translate("inner.vrt", "both.vrt", {"-a_scale", "3", "-a_offset", "1"});
  for (const char* name : {"copied.vrt", "replaced.vrt", "both.vrt"}) {
    const GDALDatasetUniquePtr file = openWithGdal(path(name));
    ASSERT_TRUE(file);
    const ServiceDescription described = describe(name);
    ASSERT_TRUE(described.service) << name << ": " << described.reason;
    EXPECT_EQ(described.service->heightScale, file->GetRasterBand(1)->GetScale()) << name;
    EXPECT_EQ(described.service->heightOffset, file->GetRasterBand(1)->GetOffset()) << name;
  }
}

TEST_F(VrtTools, WhatBuildvrtWritesIsTheService) {
  write("plain.wms", "");
  build("plain.wms", "b.vrt", {"-srcnodata", "0"});
  EXPECT_THAT(textOf(path("b.vrt")), HasSubstr("OverviewList"));
  const ServiceDescription described = describe("b.vrt");
  ASSERT_TRUE(described.service) << described.reason;
  EXPECT_EQ(described.service->noData, 0.0);
  EXPECT_TRUE(described.service->isNoDataTransparent);
  build("plain.wms", "hidden.vrt", {"-srcnodata", "0", "-hidenodata"});
  ASSERT_TRUE(describe("hidden.vrt").service);
  EXPECT_FALSE(describe("hidden.vrt").service->noData) << "its black is black";
  translate("plain.wms", "t.vrt", {"-a_scale", "0.5", "-a_offset", "10"});
  build("t.vrt", "over.vrt", {});
  ASSERT_TRUE(describe("over.vrt").service) << describe("over.vrt").reason;
  EXPECT_EQ(describe("over.vrt").service->heightScale, 0.5);
  EXPECT_EQ(describe("over.vrt").service->heightOffset, 10.0);
}

TEST_F(VrtTools, OfAServiceThatIsCroppedOnlyThatPartIsThere) {
  translate("a.wms", "quarter.vrt", {"-projwin", "-180", "90", "0", "0"});
  const ServiceDescription quarter = describe("quarter.vrt");
  ASSERT_TRUE(quarter.service) << quarter.reason;
  EXPECT_EQ(quarter.service->west, -180.0);
  EXPECT_EQ(quarter.service->south, 0.0);
  EXPECT_EQ(quarter.service->east, 0.0);
  EXPECT_EQ(quarter.service->north, 90.0);
  EXPECT_EQ(quarter.service->matrices.size(), 4U);
  EXPECT_EQ(quarter.service->matrices.front().lastColumn, 7);
  EXPECT_EQ(quarter.service->matrices.front().lastRow, 3);
  EXPECT_EQ(quarter.service->url({0, 5, 2}), "http://127.0.0.1:9/3/5/2.png");
  EXPECT_EQ(quarter.service->url({3, 0, 0}), "http://127.0.0.1:9/0/0/0.png");
  translate("a.wms", "window.vrt", {"-srcwin", "0", "0", "300", "2048"});
  const ServiceDescription window = describe("window.vrt");
  ASSERT_TRUE(window.service) << window.reason;
  EXPECT_NEAR(window.service->east, -180.0 + 300 * 360.0 / 4096, 1e-9);
  EXPECT_EQ(window.service->south, -90.0);
  EXPECT_EQ(window.service->matrices.front().lastColumn, 1);
  translate("a.wms", "whole.vrt", {});
  EXPECT_EQ(describe("whole.vrt").service->east, 180.0);
  EXPECT_EQ(describe("whole.vrt").service->matrices.front().lastColumn, 15);
  translate("quarter.vrt", "eighth.vrt", {"-srcwin", "0", "0", "1024", "1024"});
  ASSERT_TRUE(describe("eighth.vrt").service) << describe("eighth.vrt").reason;
  EXPECT_EQ(describe("eighth.vrt").service->east, -90.0);
}

TEST_F(VrtTools, WhatAServiceCannotSayIsLeftToGdal) {
  build("a.wms", "differ.vrt", {"-srcnodata", "0 1 2"});
  EXPECT_FALSE(describe("differ.vrt").service);
  EXPECT_THAT(describe("differ.vrt").reason, HasSubstr("differ in what is no data"));
  build("a.wms", "moved.vrt", {"-srcnodata", "0", "-vrtnodata", "255"});
  EXPECT_FALSE(describe("moved.vrt").service) << "0 becomes 255";
  EXPECT_FALSE(describe("moved.vrt").reason.empty());
  translate("a.wms", "stretched.vrt", {"-scale", "0", "100", "0", "255"});
  EXPECT_FALSE(describe("stretched.vrt").service);
  write("series.wms", "<GetCapabilitiesUrl>http://127.0.0.1:9/wms</GetCapabilitiesUrl>");
  translate("series.wms", "series.vrt", {"-a_scale", "2"});
  EXPECT_FALSE(describe("series.vrt").reference) << "its scale would be lost";
  EXPECT_THAT(describe("series.vrt").reason, HasSubstr("capabilities"));
}

TEST_F(VrtTools, OfALayerOfCapabilitiesAllIsPassedOnOrNothing) {
  write("series.wms", "<GetCapabilitiesUrl>http://127.0.0.1:9/wms</GetCapabilitiesUrl>");
  translate("series.wms", "plain.vrt", {});
  EXPECT_TRUE(describe("plain.vrt").reference) << describe("plain.vrt").reason;
  build("series.wms", "built.vrt", {"-srcnodata", "0"});
  translate("series.wms", "none.vrt", {"-a_nodata", "0"});
  translate("series.wms", "part.vrt", {"-projwin", "-180", "90", "0", "0"});
  translate("series.wms", "moved.vrt", {"-a_ullr", "-90", "45", "90", "-45"});
  std::ofstream(path("alpha.vrt"))
      << R"(<VRTDataset rasterXSize="4096" rasterYSize="2048"><GeoTransform>-180,0.087890625,0,90,0,-0.087890625
         </GeoTransform><VRTRasterBand band="1"><SimpleSource><SourceFilename relativeToVRT="1">series.wms
         </SourceFilename><SourceBand>1</SourceBand><SrcRect xOff="0" yOff="0" xSize="4096" ySize="2048"/><DstRect
         xOff="0" yOff="0" xSize="4096" ySize="2048"/></SimpleSource></VRTRasterBand><VRTRasterBand band="2">
         <ColorInterp>Alpha</ColorInterp><ComplexSource><SourceFilename relativeToVRT="1">series.wms</SourceFilename>
         <SourceBand>1</SourceBand><SrcRect xOff="0" yOff="0" xSize="4096" ySize="2048"/><DstRect xOff="0" yOff="0"
         xSize="4096" ySize="2048"/><ScaleOffset>255</ScaleOffset><ScaleRatio>0</ScaleRatio><NODATA>0</NODATA>
         </ComplexSource></VRTRasterBand></VRTDataset>)";
  for (const char* name : {"built.vrt", "none.vrt", "part.vrt", "moved.vrt", "alpha.vrt"}) {
    const ServiceDescription described = describe(name);
    EXPECT_FALSE(described.reference || described.service) << name;
    EXPECT_THAT(described.reason, HasSubstr("capabilities")) << name;
  }
}

}  // namespace
}  // namespace meridian::globebrowsing

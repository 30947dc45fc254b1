#include "globebrowsing/source/gdal_wms.h"

#include <map>
#include <regex>
#include <set>

#include <cpl_error.h>

#include "globebrowsing/source/service_text.h"
#include "globebrowsing/source/vrt_wrapper.h"
#include "ledger_server.h"
#include "service_fixture.h"

namespace meridian::globebrowsing {
namespace {

using namespace test;

std::vector<std::string> realFiles(const std::string& extension) {
  std::vector<std::string> files;
  const std::string folder = sharedData("gdal_wms_xml");
  if (std::filesystem::exists(folder)) {
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
      if (entry.path().extension() == extension) {
        files.push_back(entry.path().string());
      }
    }
  }
  std::sort(files.begin(), files.end());
  return files;
}

TileService serviceIn(const std::string& text) {
  auto read = readGdalWms(text, "test.wms");
  EXPECT_TRUE(read) << (read ? "" : read.error().message());
  EXPECT_TRUE(read && read->service) << (read ? read->reason : "") << text;
  return read && read->service ? *read->service : TileService{};
}

std::string tms(const std::string& window, const std::string& rest = {}) {
  return "<GDAL_WMS><Service name=\"TMS\"><ServerUrl>http://HOST/a/${z}/${x}/${y}.png</ServerUrl></Service>"
         "<DataWindow>" +
         window + "</DataWindow>" + rest + "<BlockSizeX>256</BlockSizeX><BlockSizeY>256</BlockSizeY></GDAL_WMS>";
}

const std::string wholeWorld =
    "<UpperLeftX>-180</UpperLeftX><UpperLeftY>90</UpperLeftY><LowerRightX>180</LowerRightX>"
    "<LowerRightY>-90</LowerRightY>";

/// Path and query of an address; the query's parameters by lower-case name, numbers with eight decimals.
std::pair<std::string, std::map<std::string, std::string>> partsOf(std::string address) {
  if (const std::size_t scheme = address.find("://"); scheme != std::string::npos) {
    address = address.substr(address.find('/', scheme + 3));
  }
  std::map<std::string, std::string> parameters;
  const std::size_t question = address.find('?');
  for (const std::string& part :
       question == std::string::npos ? std::vector<std::string>{} : split(address.substr(question + 1), "&")) {
    const std::size_t equals = part.find('=');
    std::string value = equals == std::string::npos ? "" : replaceAll(part.substr(equals + 1), "%2C", ",");
    if (lowerCase(part.substr(0, equals)) == "bbox") {
      std::string rounded;
      for (const std::string& side : split(value, ",")) {
        rounded += std::to_string(std::round(*number(side) * 1e6) / 1e6 + 0.0) + ",";
      }
      value = rounded;
    }
    if (!value.empty()) {
      parameters[lowerCase(part.substr(0, equals))] = replaceAll(value, "%3A", ":");
    }
  }
  return {address.substr(0, question), parameters};
}

/// Compares levels, sizes, places and addresses with what GDAL says and does of the same document. `text` has its
/// server on HOST.
void agreeWithGdal(const std::string& name, std::string text) {
  SCOPED_TRACE(name);
  static LedgerServer ledger;
  text = replaceAll(text, "HOST", ledger.host());
  // GDAL takes what the ledger does not have for blank then.
  text = std::regex_replace(text, std::regex("<ZeroBlockHttpCodes>[^<]*</ZeroBlockHttpCodes>"), "");
  text = replaceAll(text, "</GDAL_WMS>", "<ZeroBlockHttpCodes>404</ZeroBlockHttpCodes></GDAL_WMS>");
  const TileService service = serviceIn(text);
  ASSERT_FALSE(service.matrices.empty());
  const GDALDatasetUniquePtr dataset = openWithGdal(text);
  ASSERT_TRUE(dataset);
  GDALRasterBand& band = *dataset->GetRasterBand(1);
  std::array<double, 6> transform{};
  ASSERT_EQ(dataset->GetGeoTransform(transform.data()), CE_None);
  ASSERT_EQ(service.matrices.size(), static_cast<std::size_t>(band.GetOverviewCount()) + 1);
  EXPECT_EQ(service.bands, dataset->GetRasterCount());
  for (std::size_t step = 0; step < service.matrices.size(); ++step) {
    const TileMatrix& matrix = service.matrices[step];
    GDALRasterBand& level = step == 0 ? band : *band.GetOverview(static_cast<int>(step) - 1);
    const double scaleX = dataset->GetRasterXSize() / static_cast<double>(level.GetXSize());
    const double scaleY = dataset->GetRasterYSize() / static_cast<double>(level.GetYSize());
    EXPECT_NEAR(matrix.pixelWidth, transform[1] * scaleX, 1e-12 * std::abs(transform[0]));
    EXPECT_NEAR(matrix.pixelHeight, -transform[5] * scaleY, 1e-12 * std::abs(transform[3]));
    EXPECT_NEAR(matrix.left + static_cast<double>(matrix.firstColumn) * matrix.tileWidth * matrix.pixelWidth,
                transform[0], 1e-6);
    int blockWidth = 0;
    int blockHeight = 0;
    level.GetBlockSize(&blockWidth, &blockHeight);
    EXPECT_EQ(matrix.tileWidth, std::min(blockWidth, level.GetXSize()) < blockWidth && text.find("\"WMS\"") != text.npos
                                    ? level.GetXSize()
                                    : blockWidth);
    std::vector<std::uint8_t> block(static_cast<std::size_t>(blockWidth) * static_cast<std::size_t>(blockHeight) * 8);
    for (const auto& [column, row] : {std::pair{matrix.firstColumn, matrix.firstRow},
                                      {(matrix.firstColumn + matrix.lastColumn) / 2, matrix.lastRow}}) {
      (void)ledger.take();
      dataset->FlushCache();
      CPLPushErrorHandler(CPLQuietErrorHandler);
      EXPECT_EQ(level.ReadBlock(static_cast<int>(column - matrix.firstColumn), static_cast<int>(row - matrix.firstRow),
                                block.data()),
                CE_None);
      CPLPopErrorHandler();
      const std::vector<std::string> asked = ledger.take();
      ASSERT_FALSE(asked.empty());
      const bool isClamped = (column == matrix.lastColumn || row == matrix.lastRow) && matrix.lastColumn > 0 &&
                             text.find("\"WMS\"") != std::string::npos;
      if (!isClamped) {
        // GDAL 3.6 forgets the & before L in WorldWind's addresses.
        const std::string target = std::regex_replace(asked.front(), std::regex("(T=[^&]*)L="), "$1&L=");
        EXPECT_EQ(partsOf(service.url({step, column, row})), partsOf(target)) << target;
      }
    }
  }
}

TEST(GdalWms, RealDescriptionsAreAskedForAsGdalDoes) {
  const std::vector<std::string> files = realFiles(".wms");
  if (files.empty()) {
    GTEST_SKIP() << "NOT TESTED: no gdal_wms_xml in the shared data; set MERIDIAN_SHARED_DATA";
  }
  EXPECT_GE(files.size(), 30U);
  for (const std::string& file : files) {
    const std::string text = std::regex_replace(textOf(file), std::regex("https?://[^/<]+"), "http://HOST");
    agreeWithGdal(file, text);
  }
  for (const std::string& file : realFiles(".xml")) {
    agreeWithGdal(file, std::regex_replace(textOf(file), std::regex("https?://[^/<]+"), "http://HOST"));
  }
}

TEST(GdalWms, AddressesAreGdals) {
  const std::string top = "<TileLevel>5</TileLevel><TileCountX>2</TileCountX><TileCountY>1</TileCountY>";
  const std::string mercator =
      "<UpperLeftX>-20037508.34</UpperLeftX><UpperLeftY>20037508.34</UpperLeftY><LowerRightX>20037508.34</LowerRightX>"
      "<LowerRightY>-20037508.34</LowerRightY><TileLevel>18</TileLevel><TileCountX>1</TileCountX>"
      "<TileCountY>1</TileCountY>";
  agreeWithGdal("rows from the south, which is the default", tms(wholeWorld + top));
  agreeWithGdal("rows from the south", tms(wholeWorld + top + "<YOrigin>bottom</YOrigin>"));
  agreeWithGdal("rows from the north", tms(wholeWorld + top + "<YOrigin>top</YOrigin>"));
  agreeWithGdal("Web Mercator", tms(mercator + "<YOrigin>top</YOrigin>", "<Projection>EPSG:3857</Projection>"));
  agreeWithGdal("odd sizes", tms(wholeWorld + "<SizeX>5000</SizeX><SizeY>2600</SizeY><TileLevel>4</TileLevel>"
                                              "<YOrigin>top</YOrigin>"));
  agreeWithGdal("an offset", tms(wholeWorld + top + "<TileX>64</TileX><TileY>32</TileY><YOrigin>top</YOrigin>"));
  agreeWithGdal("few overviews", tms(wholeWorld + top + "<YOrigin>top</YOrigin>", "<OverviewCount>2</OverviewCount>"));
  agreeWithGdal("parts by name",
                "<GDAL_WMS><Service name=\"TMS\"><ServerUrl>http://HOST/tms</ServerUrl><Layer>blue</Layer>"
                "<Format>png</Format></Service><DataWindow>" +
                    wholeWorld + top +
                    "</DataWindow><BlockSizeX>256</BlockSizeX><BlockSizeY>256</BlockSizeY></GDAL_WMS>");
  agreeWithGdal("TileService",
                "<GDAL_WMS><Service name=\"TileService\"><Version>1</Version>"
                "<ServerUrl>http://HOST/getTile?</ServerUrl><Dataset>za.johannesburg</Dataset></Service><DataWindow>" +
                    wholeWorld + top +
                    "</DataWindow><BlockSizeX>512</BlockSizeX><BlockSizeY>512</BlockSizeY></GDAL_WMS>");
  agreeWithGdal("WorldWind",
                "<GDAL_WMS><Service name=\"WorldWind\"><ServerUrl>http://HOST/tile.aspx?</ServerUrl>"
                "<Layer>105</Layer></Service><DataWindow>" +
                    wholeWorld +
                    "<SizeX>16384</SizeX><SizeY>8192</SizeY><TileLevel>4</TileLevel></DataWindow>"
                    "<BlockSizeX>512</BlockSizeX><BlockSizeY>512</BlockSizeY></GDAL_WMS>");
  agreeWithGdal("Virtual Earth",
                "<GDAL_WMS><Service name=\"VirtualEarth\"><ServerUrl>http://HOST/a${quadkey}.jpeg?g=90"
                "</ServerUrl></Service></GDAL_WMS>");
  const std::string window = "<DataWindow>" + wholeWorld + "<SizeX>8192</SizeX><SizeY>4096</SizeY></DataWindow>";
  agreeWithGdal("WMS 1.1.1",
                "<GDAL_WMS><Service name=\"WMS\"><Version>1.1.1</Version><ServerUrl>http://HOST/cgi?map=/a.map&amp;"
                "</ServerUrl><SRS>EPSG:4326</SRS><ImageFormat>image/png</ImageFormat><Layers>a,b</Layers>"
                "<Styles>x</Styles><Transparent>true</Transparent></Service>" +
                    window + "<BlockSizeX>512</BlockSizeX><BlockSizeY>512</BlockSizeY></GDAL_WMS>");
  agreeWithGdal("WMS 1.3.0",
                "<GDAL_WMS><Service name=\"WMS\"><Version>1.3.0</Version><ServerUrl>http://HOST/cgi</ServerUrl>"
                "<CRS>EPSG:4326</CRS><BBoxOrder>yxYX</BBoxOrder><ImageFormat>image/jpeg</ImageFormat><Layers>a</Layers>"
                "</Service>" +
                    window + "<BlockSizeX>512</BlockSizeX><BlockSizeY>512</BlockSizeY></GDAL_WMS>");
  agreeWithGdal("ArcGIS",
                "<GDAL_WMS><Service name=\"AGS\"><ServerUrl>http://HOST/arcgis/rest/services/A/MapServer</ServerUrl>"
                "<SRS>EPSG:4326</SRS><ImageFormat>png</ImageFormat><Layers>show:0</Layers></Service>" +
                    window + "<BlockSizeX>512</BlockSizeX><BlockSizeY>512</BlockSizeY></GDAL_WMS>");
}

TEST(GdalWms, DegreesAreDegreesWhateverTheProjection) {
  const std::string equirectangular =
      "<Projection>PROJCS[\"Equirectangular Moon\",GEOGCS[\"GCS_Moon\",DATUM[\"D_Moon\",SPHEROID[\"Moon\",1737400,0]],"
      "PRIMEM[\"Reference_Meridian\",0],UNIT[\"degree\",0.0174532925199433]],PROJECTION[\"Equirectangular\"],"
      "PARAMETER[\"standard_parallel_1\",0],PARAMETER[\"central_meridian\",0],UNIT[\"metre\",1]]</Projection>";
  const TileService service = serviceIn(
      tms(wholeWorld + "<TileLevel>3</TileLevel><TileCountX>2</TileCountX><YOrigin>top</YOrigin>", equirectangular));
  EXPECT_EQ(service.crs, "");
  EXPECT_DOUBLE_EQ(service.west, -180.0);
  EXPECT_DOUBLE_EQ(service.north, 90.0);
}

TEST(GdalWms, NothingBeyondTheGlobeIsAskedFor) {
  // GIBS: the tiles of the window reach to 396 degrees and -198.
  const TileService service = serviceIn(
      "<GDAL_WMS><Service name=\"TMS\"><ServerUrl>http://HOST/${z}/${y}/${x}.jpg</ServerUrl></Service><DataWindow>"
      "<UpperLeftX>-180.0</UpperLeftX><UpperLeftY>90</UpperLeftY><LowerRightX>396.0</LowerRightX>"
      "<LowerRightY>-198</LowerRightY><TileLevel>3</TileLevel><TileCountX>2</TileCountX><TileCountY>1</TileCountY>"
      "<YOrigin>top</YOrigin></DataWindow><BlockSizeX>512</BlockSizeX><BlockSizeY>512</BlockSizeY></GDAL_WMS>");
  // GIBS's own TileMatrixSet 2km has 10 x 5 tiles of 36 degrees there, and 3 x 2, 2 x 1 above.
  ASSERT_EQ(service.matrices.size(), 4U);
  EXPECT_EQ(service.matrices[0].lastColumn, 9);
  EXPECT_EQ(service.matrices[0].lastRow, 4);
  EXPECT_EQ(service.matrices[1].lastColumn, 4);
  EXPECT_EQ(service.matrices[1].lastRow, 2);
  EXPECT_EQ(service.matrices[3].lastColumn, 1);
  EXPECT_EQ(service.matrices[3].lastRow, 0);
  EXPECT_DOUBLE_EQ(service.east, 180.0);
  EXPECT_DOUBLE_EQ(service.south, -90.0);
}

TEST(GdalWms, ReadsWhatBelongsToTheRequest) {
  auto read = readGdalWms(
      tms(wholeWorld + "<TileLevel>1</TileLevel>",
          "<ZeroBlockHttpCodes>404, "
          "400</ZeroBlockHttpCodes><ZeroBlockOnServerException>True</ZeroBlockOnServerException>"
          "<UserAgent>me</UserAgent><Referer>http://there</Referer><UnsafeSSL>true</UnsafeSSL>"
          "<UserPwd>a:b</UserPwd><BandsCount>1</BandsCount><DataValues NoData=\"0\" Min=\"1\" Max=\"255\"/>"),
      "test.wms");
  ASSERT_TRUE(read && read->service);
  EXPECT_EQ(read->service->emptyStatuses, (std::vector<int>{404, 400}));
  EXPECT_TRUE(read->service->isExceptionEmpty);
  EXPECT_EQ(read->service->headers,
            (std::vector<std::string>{"User-Agent: me", "Referer: http://there", "Authorization: Basic YTpi"}));
  EXPECT_EQ(read->service->noData, 0.0);
  EXPECT_TRUE(read->service->isNoDataTransparent);
  EXPECT_EQ(read->service->bands, 1);
  ASSERT_EQ(read->notes.size(), 1U);
  EXPECT_NE(read->notes[0].find("UnsafeSSL"), std::string::npos);
}

TEST(GdalWms, RepairsWhatRealFilesHaveWrong) {
  std::string text = tms(wholeWorld + "<TileLevel>1</TileLevel>");
  text = replaceAll(replaceAll(text, "ServerUrl", "ServerURL"), "http://HOST", " http:/HOST");
  EXPECT_EQ(serviceIn(text).url({1, 0, 0}), "http://HOST/a/0/0/0.png");
}

TEST(GdalWms, OneTileIsAlwaysAskedOfTheSameServer) {
  const TileService service = serviceIn(
      "<GDAL_WMS><Service name=\"VirtualEarth\"><ServerUrl>http://t${server_num}.h/${quadkey}</ServerUrl></Service>"
      "</GDAL_WMS>");
  std::set<std::string> servers;
  for (std::int64_t column = 0; column < 16; ++column) {
    const std::string url = service.url({0, column, 3});
    EXPECT_EQ(url, service.url({0, column, 3}));
    servers.insert(url.substr(0, url.find('.')));
  }
  EXPECT_EQ(servers, (std::set<std::string>{"http://t0", "http://t1", "http://t2", "http://t3"}));
}

TEST(GdalWms, AxesOfThreeGoByTheCrs) {
  const std::string text =
      "<GDAL_WMS><Service name=\"WMS\"><Version>1.3.0</Version><ServerUrl>http://h/s</ServerUrl><CRS>CRSNAME</CRS>"
      "<Layers>a</Layers></Service><DataWindow>" +
      wholeWorld +
      "<SizeX>512</SizeX><SizeY>256</SizeY></DataWindow><BlockSizeX>512</BlockSizeX>"
      "<BlockSizeY>256</BlockSizeY></GDAL_WMS>";
  EXPECT_NE(serviceIn(replaceAll(text, "CRSNAME", "EPSG:4326")).url({0, 0, 0}).find("bbox=-90,-180,90,180"),
            std::string::npos);
  EXPECT_NE(serviceIn(replaceAll(text, "CRSNAME", "CRS:84")).url({0, 0, 0}).find("bbox=-180,-90,180,90"),
            std::string::npos);
}

TEST(GdalWms, LeavesToGdalWhatIsGdals) {
  const auto reason = [](const std::string& text) {
    auto read = readGdalWms(text, "test.wms");
    EXPECT_TRUE(read) << read.error().message();
    EXPECT_FALSE(read->service);
    return read->reason;
  };
  EXPECT_NE(reason("<VRTDataset rasterXSize=\"1\"/>").find("VRTDataset"), std::string::npos);
  EXPECT_NE(reason("<GDAL_WMS><Service name=\"IIP\"><ServerUrl>http://h</ServerUrl></Service></GDAL_WMS>").find("IIP"),
            std::string::npos);
  EXPECT_NE(reason(tms("<UpperLeftX>180</UpperLeftX><LowerRightX>-180</LowerRightX><TileLevel>1</TileLevel>"))
                .find("westward"),
            std::string::npos);
}

TEST(GdalWms, EachMistakeIsToldWithItsPlace) {
  struct Case {
    std::string text;
    std::string says;
  };
  for (const Case& test : std::vector<Case>{
           {"<GDAL_WMS>", "test.wms:1"},
           {"", "empty"},
           {"<GDAL_WMS/>", "no Service"},
           {"<GDAL_WMS><Service name=\"TMS\"/></GDAL_WMS>", "no ServerUrl"},
           {"<GDAL_WMS><Service><ServerUrl>http://h</ServerUrl></Service></GDAL_WMS>", "names no service"},
           {tms(wholeWorld), "TileLevel"},
           {tms(wholeWorld + "\n<TileLevel>x</TileLevel>"), "test.wms:2"},
           {tms(wholeWorld + "<TileLevel>31</TileLevel>"), "31"},
           {tms(wholeWorld + "<TileLevel>30</TileLevel>"), "no raster"},
           {tms(wholeWorld + "<TileLevel>1</TileLevel><YOrigin>middle</YOrigin>"), "middle"},
           {tms(wholeWorld + "<SizeX>-4</SizeX><SizeY>5</SizeY>"), "no raster"},
           {tms("<UpperLeftX>-2e7</UpperLeftX><LowerRightX>2e7</LowerRightX><TileLevel>1</TileLevel>",
                "<Projection>EPSG:1</Projection>"),
            "EPSG:1"}}) {
    const auto read = readGdalWms(test.text, "test.wms");
    ASSERT_FALSE(read) << test.text;
    EXPECT_NE(read.error().message().find(test.says), std::string::npos) << read.error().message();
  }
}

TEST(VrtWrapper, RealOnesWrapTheirSibling) {
  const std::vector<std::string> files = realFiles(".vrt");
  if (files.empty()) {
    GTEST_SKIP() << "NOT TESTED: no gdal_wms_xml in the shared data; set MERIDIAN_SHARED_DATA";
  }
  for (const std::string& file : files) {
    SCOPED_TRACE(file);
    auto read = readVrtWrapper(textOf(file), file);
    ASSERT_TRUE(read && read->wrapper);
    EXPECT_EQ(read->wrapper->source, std::filesystem::path(file).stem().string() + ".wms");
    EXPECT_TRUE(read->wrapper->isRelative);
    EXPECT_TRUE(read->wrapper->makesAlpha);
    EXPECT_EQ(read->wrapper->noData, 0.0);
    EXPECT_EQ(read->wrapper->left, -180.0);
  }
}

TEST(GdalWms, AnExtentNarrowsTheWindow) {
  const auto read = [](const std::string& extent) {
    std::string document = tms(wholeWorld + "<SizeX>1024</SizeX><SizeY>512</SizeY><TileLevel>1</TileLevel>");
    return readGdalWms(document.insert(document.find("<DataWindow>"), extent), "a.wms");
  };
  const auto corner =
      read("<Extent><UpperLeftX>10</UpperLeftX><UpperLeftY>47.83</UpperLeftY><LowerRightX>300</LowerRightX></Extent>");
  ASSERT_TRUE(corner) << corner.error().message();
  ASSERT_TRUE(corner->service);
  EXPECT_EQ(corner->service->west, 10.0);
  EXPECT_EQ(corner->service->south, -90.0) << "what is not said is the window's";
  EXPECT_EQ(corner->service->east, 180.0) << "nor is there more than the window";
  EXPECT_EQ(corner->service->north, 47.83);
  EXPECT_EQ(corner->service->matrices.front().firstColumn, 2);
  const auto wrong = read("<Extent><UpperLeftX>ten</UpperLeftX></Extent>");
  ASSERT_FALSE(wrong);
  EXPECT_NE(wrong.error().message().find("a.wms:"), std::string::npos) << wrong.error().message();
  EXPECT_NE(wrong.error().what.find("'ten'"), std::string::npos);
  EXPECT_FALSE(read("<Extent><UpperLeftX>200</UpperLeftX></Extent>"));
  EXPECT_FALSE(read("<Extent><UpperLeftX>20</UpperLeftX><LowerRightX>10</LowerRightX></Extent>"));
}

std::string vrt(const std::string& transform, const std::string& to, const std::string& alpha) {
  const std::string place = "<SrcRect xOff=\"0\" yOff=\"0\" xSize=\"1024\" ySize=\"512\"/>" + to;
  const std::string file = "<SourceFilename relativeToVRT=\"1\">a.wms</SourceFilename><SourceBand>1</SourceBand>";
  return "<VRTDataset rasterXSize=\"1024\" rasterYSize=\"512\"><GeoTransform>" + transform +
         "</GeoTransform><VRTRasterBand dataType=\"Byte\" band=\"1\"><ColorInterp>Gray</ColorInterp><ComplexSource>" +
         file + place +
         "<NODATA>0</NODATA></ComplexSource></VRTRasterBand><VRTRasterBand dataType=\"Byte\" band=\"2\">"
         "<ColorInterp>Alpha</ColorInterp><ComplexSource>" +
         file + place + alpha + "</ComplexSource></VRTRasterBand></VRTDataset>";
}

TEST(VrtWrapper, OnlyWhatPassesBandsOnIsOurs) {
  const std::string there = "<DstRect xOff=\"0\" yOff=\"0\" xSize=\"1024\" ySize=\"512\"/>";
  const std::string plain = "-180, 0.3515625, 0, 90, 0, -0.3515625";
  const std::string constant = "<ScaleOffset>255</ScaleOffset><ScaleRatio>0</ScaleRatio><NODATA>0</NODATA>";
  const TileService inner =
      serviceIn(tms(wholeWorld + "<SizeX>1024</SizeX><SizeY>512</SizeY><TileLevel>1</TileLevel>"));
  const auto shown = [&](const std::string& text) {
    const auto read = readVrtWrapper(text, "a.vrt");
    EXPECT_TRUE(read);
    return read && read->wrapper ? wrapped(*read->wrapper, inner) : std::nullopt;
  };
  const auto service = shown(vrt(plain, there, constant));
  ASSERT_TRUE(service);
  EXPECT_TRUE(service->isNoDataTransparent);
  EXPECT_EQ(service->bands, 1);
  EXPECT_TRUE(shown(vrt(plain, there, "<LUT>0:0,1:255,255:255</LUT>")));
  // Mars's ctx_blended: the service is 1792 columns into a window that begins at -810 degrees.
  EXPECT_TRUE(shown(vrt("-810, 0.3515625, 0, 90, 0, -0.3515625",
                        "<DstRect xOff=\"1792\" yOff=\"0\" xSize=\"1024\" ySize=\"512\"/>", constant)));
  EXPECT_FALSE(shown(vrt("-90, 0.3515625, 0, 90, 0, -0.3515625", there, constant)));
  EXPECT_EQ(service->east, 180.0);
  EXPECT_EQ(service->south, -90.0);
  EXPECT_FALSE(shown(vrt(plain, there, "<LUT>0:0,128:255,255:255</LUT>")));
  EXPECT_FALSE(shown(vrt(plain, there, "<ScaleOffset>10</ScaleOffset><NODATA>0</NODATA>")));
  EXPECT_FALSE(shown("<VRTDataset subClass=\"VRTWarpedDataset\"/>"));
  EXPECT_FALSE(readVrtWrapper("<VRTDataset", "a.vrt"));
}

}  // namespace
}  // namespace meridian::globebrowsing

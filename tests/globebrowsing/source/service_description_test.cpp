#include "globebrowsing/source/service_description.h"

#include "globebrowsing/source/service_asset.h"
#include "globebrowsing/source/service_text.h"
#include "globebrowsing/source/url_template.h"
#include "service_fixture.h"

namespace meridian::globebrowsing {
namespace {

using namespace test;

ServiceDescription describe(const std::string& path) {
  auto described = describeService(path, "a.asset:1");
  EXPECT_TRUE(described) << (described ? "" : described.error().message());
  return described ? std::move(*described) : ServiceDescription{};
}

TEST(UrlTemplate, FillsInWhatWebMapsWrite) {
  struct Case {
    const char* address;
    const char* expected;  ///< of level 3, column 5, row 2
  };
  for (const Case& test : {Case{"https://h/{z}/{x}/{y}.png", "https://h/3/5/2.png"},
                           {"https://h/{zoom}/{x}/{-y}.png", "https://h/3/5/5.png"},
                           {"https://h/{z}/{x}/{y}{r}.png?k={k}", "https://h/3/5/2.png?k={k}"},
                           {"https://h/{q}", "https://h/121"},
                           {"https://{switch:p,q}.h/{z}/{x}/{y}", "https://q.h/3/5/2"},
                           {"https://{a-c}.h/{z}/{x}/{y}", "https://b.h/3/5/2"}}) {
    auto service = serviceOf(UrlTemplate{test.address, "n", "w", "EPSG:3857", false, 256, 0, 3});
    ASSERT_TRUE(service) << service.error().message();
    EXPECT_TRUE(isUrlTemplate(test.address));
    EXPECT_EQ(service->url({0, 5, 2}), test.expected);
    EXPECT_EQ(service->crs, "EPSG:3857");
  }
  auto geodetic =
      serviceOf(UrlTemplate{"https://h/{z}/{x}/{y}", "", "", "EPSG:4326", true, 512, 1, 2, {}, Extent{0, 0, 45, 45}});
  ASSERT_TRUE(geodetic);
  EXPECT_EQ(geodetic->crs, "");
  ASSERT_EQ(geodetic->matrices.size(), 2U);
  EXPECT_EQ(geodetic->matrices[0].firstColumn, 4);
  EXPECT_EQ(geodetic->matrices[0].lastColumn, 4);
  EXPECT_EQ(geodetic->url({0, 4, 1}), "https://h/2/4/2");
  const auto box =
      serviceOf(UrlTemplate{"https://h/?w={width}&b={bbox-epsg-3857}", "", "", "EPSG:3857", false, 256, 0, 3});
  ASSERT_TRUE(box);
  const std::string url = box->url({0, 5, 2});
  EXPECT_EQ(url.substr(0, 20), "https://h/?w=256&b=5");
  const std::vector<std::string> sides = split(url.substr(url.find("b=") + 2), ",");
  ASSERT_EQ(sides.size(), 4U);
  const double tile = webMercatorHalfWidth / 4;
  EXPECT_NEAR(*number(sides[0]), tile, 1e-6);
  EXPECT_NEAR(*number(sides[1]), tile, 1e-6);
  EXPECT_NEAR(*number(sides[2]), 2 * tile, 1e-6);
  EXPECT_NEAR(*number(sides[3]), 2 * tile, 1e-6);
  EXPECT_FALSE(serviceOf(UrlTemplate{"https://h/{x}/{y}"}));
  EXPECT_FALSE(serviceOf(UrlTemplate{"https://h/{z}/{x}/{y}", "", "", "EPSG:3857", false, 0}));
  EXPECT_FALSE(isUrlTemplate("http://h/${z}/${x}/${y}"));
  EXPECT_FALSE(isUrlTemplate("/a/{z}/b"));
}

TEST(ServiceDescription, TellsWhatAFilePathIs) {
  EXPECT_TRUE(describe("https://h/{z}/{x}/{y}.png").service);
  EXPECT_TRUE(describe("<GDAL_WMS><Service name=\"TMS\"><ServerUrl>http://h/${z}/${x}/${y}</ServerUrl></Service>"
                       "<DataWindow><TileLevel>1</TileLevel></DataWindow></GDAL_WMS>")
                  .service);
  const ServiceDescription wmts =
      describe("WMTS:https://h/WMTSCapabilities.xml,layer=\"a,b\",tilematrixset=250m,style=\"dark\"");
  ASSERT_TRUE(wmts.reference);
  EXPECT_EQ(wmts.reference->url, "https://h/WMTSCapabilities.xml");
  EXPECT_EQ(wmts.reference->layer, "a,b");
  EXPECT_EQ(wmts.reference->choices.matrixSet, "250m");
  EXPECT_EQ(wmts.reference->choices.style, "dark");
  const ServiceDescription document =
      describe("<GDAL_WMTS><GetCapabilitiesUrl>https://h/c.xml</GetCapabilitiesUrl><Layer>x</Layer></GDAL_WMTS>");
  ASSERT_TRUE(document.reference);
  EXPECT_EQ(document.reference->layer, "x");
  const ServiceDescription esri = describe("https://h/arcgis/rest/services/A/MapServer?f=json");
  ASSERT_TRUE(esri.reference);
  EXPECT_EQ(esri.reference->url, "https://h/arcgis/rest/services/A/MapServer?f=json");
  for (const char* other : {"/no/such/file.tif", "NETCDF:\"a.nc\":b", "/vsicurl/http://h/a.tif", "<VRTDataset/>",
                            "WMS:http://h/w?REQUEST=DescribeLayer", "https://h/a.tif"}) {
    const ServiceDescription gdal = describe(other);
    EXPECT_FALSE(gdal.service || gdal.reference) << other;
    EXPECT_FALSE(gdal.reason.empty());
  }
  EXPECT_FALSE(describeService("<GDAL_WMS>", "a.asset:1"));
}

TEST(ServiceDescription, CapabilitiesOfEveryKindAreReferredTo) {
  struct Case {
    const char* text;
    CapabilitiesKind kind;
    const char* url;
    const char* layer;
  };
  using Kind = CapabilitiesKind;
  for (const Case& test :
       {Case{"TMS:http://h/t/", Kind::Tms, "http://h/t/", ""},
        {"tms:http://h/t,layer=\"a, b\"", Kind::Tms, "http://h/t", "a, b"},
        {"TMS:\"http://h/a,b\",layer=c", Kind::Tms, "http://h/a,b", "c"},
        {"http://h/t/TileMapResource.xml", Kind::Tms, "http://h/t/TileMapResource.xml", ""},
        {"ArcGIS:http://h/A/MapServer/,layer=3", Kind::ArcGis, "http://h/A/MapServer?f=json", "3"},
        {"ArcGIS:http://h/A/MapServer?f=pjson&token=t", Kind::ArcGis, "http://h/A/MapServer?token=t&f=json", ""},
        {"https://h/A/ImageServer/", Kind::ArcGis, "https://h/A/ImageServer?f=json", ""},
        {"https://h/A/MapServer//?f=json", Kind::ArcGis, "https://h/A/MapServer?f=json", ""},
        {"https://h/1.0.0/WMTSCapabilities.xml", Kind::Wmts, "https://h/1.0.0/WMTSCapabilities.xml", ""},
        {"https://h/w?Service=wmts&Request=GetCapabilities", Kind::Wmts,
         "https://h/w?Service=wmts&Request=GetCapabilities", ""},
        {"WMS:http://h/w?REQUEST=GetTileService,layer=c", Kind::TiledWms, "http://h/w?REQUEST=GetTileService", "c"},
        {"WMS:http://h/w?request=GetTileService", Kind::TiledWms, "http://h/w?request=GetTileService", ""},
        {"WMS:http://h/w?REQUEST=GetCapabilities", Kind::Wms, "http://h/w?REQUEST=GetCapabilities", ""}}) {
    const ServiceDescription described = describe(test.text);
    ASSERT_TRUE(described.reference) << test.text << ": " << described.reason;
    EXPECT_EQ(described.reference->kind, test.kind) << test.text;
    EXPECT_EQ(described.reference->url, test.url) << test.text;
    EXPECT_EQ(described.reference->layer, test.layer) << test.text;
    EXPECT_EQ(mayHaveTimes(test.text), test.kind == Kind::Wms || test.kind == Kind::Wmts) << test.text;
  }
}

TEST(ServiceDescription, ATiledWmsIsAskedForItsPatterns) {
  const auto document = [](const std::string& server, const std::string& more) {
    return "<GDAL_WMS><Service name='TiledWMS'><ServerUrl>" + server +
           "</ServerUrl><TiledGroupName>Global SRTM</TiledGroupName>" + more + "</Service></GDAL_WMS>";
  };
  const auto plain = describe(document("http://h/wms.cgi?", "")).reference;
  ASSERT_TRUE(plain);
  EXPECT_EQ(plain->kind, CapabilitiesKind::TiledWms);
  EXPECT_EQ(plain->url, describe("WMS:http://h/wms.cgi?request=GetTileService,layer=a").reference->url);
  EXPECT_EQ(plain->layer, "Global SRTM");
  EXPECT_EQ(plain->choices.time, "");
  const auto timed =
      describe(document("http://h/wms.cgi?map=a&amp;", "<Change key='${time}'>2009-10-01</Change>")).reference;
  ASSERT_TRUE(timed);
  EXPECT_EQ(timed->url, "http://h/wms.cgi?map=a&request=GetTileService");
  EXPECT_EQ(timed->choices.time, "2009-10-01");
  for (const char* gdals :
       {"<Configuration>&lt;WMS_Tile_Service/&gt;</Configuration>", "<Change key='${layer}'>a</Change>"}) {
    const ServiceDescription left = describe(document("http://h/wms.cgi?", gdals));
    EXPECT_FALSE(left.reference || left.service) << gdals;
    EXPECT_FALSE(left.reason.empty()) << gdals;
  }
  EXPECT_FALSE(describe("<GDAL_WMS><Service name='TiledWMS'><ServerUrl>http://h/w?</ServerUrl></Service>"
                        "<UserPwd>a:b</UserPwd></GDAL_WMS>")
                   .reference);
}

TEST(ServiceDescription, FilesOfCapabilitiesAreReferredTo) {
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "meridian_capabilities_files";
  std::filesystem::create_directories(folder);
  const std::string path = (folder / "a.xml").string();
  const auto isReference = [&](const std::string& content) {
    std::ofstream(path, std::ios::binary) << content;
    const Result<ServiceDescription> described = describeService(path, "a.asset:1");
    return described && described->reference && described->reference->url == path;
  };
  EXPECT_TRUE(isReference("<TileMap/>"));
  EXPECT_TRUE(isReference("\xEF\xBB\xBF<?xml version='1.0'?>\n<!-- <a> -->\n<wmts:Capabilities xmlns:wmts='w'>"));
  EXPECT_TRUE(isReference("<!DOCTYPE WMT_MS_Capabilities SYSTEM 'x' [ <!ELEMENT V EMPTY> ]>\n<WMT_MS_Capabilities >"));
  EXPECT_TRUE(isReference("<WMS_Capabilities>" + std::string(5 << 20, ' ') + "</WMS_Capabilities>")) << "large ones";
  std::string wide;
  for (const char c : std::string("<WMS_Tile_Service/>")) {
    wide += {c, '\0'};
  }
  EXPECT_TRUE(isReference("\xFF\xFE" + wide)) << "UTF-16";
  EXPECT_FALSE(isReference("<kml><TileMap/></kml>"));
  EXPECT_FALSE(isReference("<!-- TileMap"));
  EXPECT_FALSE(isReference("<"));
  EXPECT_FALSE(isReference(""));
  std::filesystem::remove_all(folder);
}

TEST(ServiceDescription, OfAServersAddressOnlyWhatIsNoPartOfGetMapIsKept) {
  const auto parametersOf = [](const std::string& server) {
    return describe("<GDAL_WMS><Service name='WMS'><ServerUrl>" + server +
                    "</ServerUrl><Layers>ice</Layers></Service><GetCapabilitiesUrl>https://h/c</GetCapabilitiesUrl>"
                    "</GDAL_WMS>")
        .reference->choices.parameters;
  };
  EXPECT_TRUE(parametersOf("https://h/wms").empty());
  EXPECT_TRUE(parametersOf("https://h/wms?").empty());
  const auto kept = parametersOf("https://h/wms?SERVICE=WMS&amp;Version=1.1.1&amp;key=a%20b&amp;LAYERS=x");
  ASSERT_EQ(kept.size(), 1U);
  EXPECT_EQ(kept.front(), std::pair(std::string("key"), std::string("a b")));
}

TEST(ServiceDescription, AWrittenLayerFollowsTimeAlsoWithoutADefault) {
  const auto capabilities = parse(
      "<WMS_Capabilities version='1.3.0'><Capability><Request><GetMap><Format>image/png</Format><DCPType><HTTP><Get>"
      "<OnlineResource xmlns:xlink='http://www.w3.org/1999/xlink' xlink:href='http://h/wms?'/></Get></HTTP></DCPType>"
      "</GetMap></Request><Layer><Title>All</Title><CRS>CRS:84</CRS><EX_GeographicBoundingBox><westBoundLongitude>-180"
      "</westBoundLongitude><eastBoundLongitude>180</eastBoundLongitude><southBoundLatitude>-90</southBoundLatitude>"
      "<northBoundLatitude>90</northBoundLatitude></EX_GeographicBoundingBox><Layer><Name>ice</Name><Title>Ice</Title>"
      "<Dimension name='time' units='ISO8601'>2001-01-01/2003-01-01/P1Y</Dimension></Layer></Layer></Capability>"
      "</WMS_Capabilities>");
  ASSERT_TRUE(capabilities) << capabilities.error().message();
  const auto asset = assetOf(*capabilities, capabilities->layers.back(), {}, {"Earth", "ColorLayers"});
  ASSERT_TRUE(asset) << asset.error().message();
  const std::string& path = *asset->table.find("FilePath")->string();
  const ServiceDescription again = describe(path);
  ASSERT_TRUE(again.reference) << path;
  EXPECT_EQ(again.reference->choices.time, "") << path;
}

TEST(ServiceDescription, AWrittenLayerIsFoundWhateverItsNamesHave) {
  const auto capabilities = parse(
      "<WMS_Capabilities version='1.3.0'><Capability><Request><GetMap><Format>image/png; mode=8bit</Format><DCPType>"
      "<HTTP><Get><OnlineResource xmlns:xlink='http://www.w3.org/1999/xlink' xlink:href='http://h/wms?'/></Get></HTTP>"
      "</DCPType></GetMap></Request><Layer><Title>All</Title><CRS>CRS:84</CRS><EX_GeographicBoundingBox>"
      "<westBoundLongitude>-180</westBoundLongitude><eastBoundLongitude>180</eastBoundLongitude><southBoundLatitude>-90"
      "</southBoundLatitude><northBoundLatitude>90</northBoundLatitude></EX_GeographicBoundingBox><Layer>"
      "<Name>ns:ice</Name><Title>Ice</Title><Style><Name>boxfill/rainbow</Name></Style><Dimension name='time' "
      "units='ISO8601'>2001-01-01/2003-01-01/P1Y</Dimension></Layer></Layer></Capability></WMS_Capabilities>");
  ASSERT_TRUE(capabilities) << capabilities.error().message();
  LayerChoices choices;
  choices.style = "boxfill/rainbow";
  const auto asset = assetOf(*capabilities, capabilities->layers.back(), choices, {"Earth", "ColorLayers"});
  ASSERT_TRUE(asset) << asset.error().message();
  const std::string& path = *asset->table.find("FilePath")->string();
  EXPECT_EQ(path.substr(0, 10), "<GDAL_WMS>") << path;
  const ServiceDescription again = describe(path);
  ASSERT_TRUE(again.reference) << path;
  EXPECT_EQ(again.reference->layer, "ns:ice");
  EXPECT_EQ(again.reference->choices.style, "boxfill/rainbow");
  EXPECT_EQ(again.reference->choices.format, "image/png; mode=8bit");
  const auto service = serviceOf(*again.reference, *capabilities);
  ASSERT_TRUE(service) << service.error().message();
  EXPECT_NE(service->url({0, 0, 0}).find("LAYERS=ns%3Aice&STYLES=boxfill%2Frainbow&"), std::string::npos)
      << service->url({0, 0, 0});
}

TEST(ServiceDescription, GetMapAddressesAreLayers) {
  const ServiceDescription old = describe(
      "WMS:http://h/w?map=m&SERVICE=WMS&VERSION=1.1.1&REQUEST=GetMap&LAYERS=a,b&STYLES=&SRS=EPSG:4326&"
      "BBOX=-180,-90,180,90&FORMAT=image/jpeg");
  ASSERT_TRUE(old.service);
  const std::string url = old.service->url({old.service->matrices.size() - 1, 1, 0});
  EXPECT_EQ(url,
            "http://h/w?map=m&SERVICE=WMS&VERSION=1.1.1&REQUEST=GetMap&LAYERS=a%2Cb&STYLES=&SRS=EPSG:4326&"
            "BBOX=0,-90,180,90&WIDTH=512&HEIGHT=512&FORMAT=image/jpeg");
  const ServiceDescription three =
      describe("WMS:http://h/w?VERSION=1.3.0&LAYERS=a&CRS=EPSG:4326&BBOX=-10,20,30,60&FORMAT=image/png");
  ASSERT_TRUE(three.service);
  EXPECT_NEAR(three.service->west, 20.0, 1e-9);
  EXPECT_NEAR(three.service->north, 30.0, 1e-9);
}

TEST(ServiceDescription, EscapesInGetMapAddressesAreReadOnce) {
  const ServiceDescription escaped = describe(
      "WMS:http://h/w?VERSION=1.1.1&LAYERS=ns%3Aice%2cfog%20a&STYLES=boxfill%2Frainbow%2C&SRS=EPSG%3a4326&"
      "BBOX=%2D10%2c20%2C30%2C60&FORMAT=image%2fpng&TRANSPARENT=TRUE");
  ASSERT_TRUE(escaped.service);
  EXPECT_NEAR(escaped.service->west, -10.0, 1e-9);
  EXPECT_NEAR(escaped.service->north, 60.0, 1e-9);
  const std::string url = escaped.service->url({0, 0, 0});
  for (const char* part :
       {"LAYERS=ns%3Aice%2Cfog%20a&", "STYLES=boxfill%2Frainbow%2C&", "SRS=EPSG:4326&", "FORMAT=image/png&"}) {
    EXPECT_NE(url.find(part), std::string::npos) << part << " in " << url;
  }
}

TEST(ServiceDescription, RealVrtsNeedTheirSibling) {
  const std::string path = sharedData("gdal_wms_xml/earth/moon/nasa-treks/LRO_LROC_DEM/Marius_Hills.vrt");
  MERIDIAN_NEEDS(path);
  // The sibling is not among the shared data: it is made here, by what the VRT says of it.
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "meridian_vrt_wrapper";
  std::filesystem::create_directories(folder);
  std::filesystem::copy_file(path, folder / "Marius_Hills.vrt", std::filesystem::copy_options::overwrite_existing);
  EXPECT_FALSE(describe((folder / "Marius_Hills.vrt").string()).service);
  std::ofstream(folder / "Marius_Hills.wms")
      << "<GDAL_WMS><Service name=\"TMS\"><ServerUrl>http://h/${z}/${y}/${x}.png</ServerUrl></Service><DataWindow>"
         "<TileCountX>2</TileCountX><TileCountY>1</TileCountY><TileLevel>13</TileLevel><YOrigin>top</YOrigin>"
         "</DataWindow><BlockSizeX>256</BlockSizeX><BlockSizeY>256</BlockSizeY></GDAL_WMS>";
  const ServiceDescription whole = describe((folder / "Marius_Hills.vrt").string());
  ASSERT_TRUE(whole.service) << whole.reason;
  EXPECT_TRUE(whole.service->isNoDataTransparent);
  EXPECT_EQ(whole.service->bands, 3);
  EXPECT_EQ(whole.service->url({0, 16383, 8191}), "http://h/13/8191/16383.png");
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace meridian::globebrowsing

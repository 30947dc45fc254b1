// MapServer and MapProxy: servers that nobody here has written.
#include <future>

#include "globebrowsing/source/service_asset.h"
#include "service_stage.h"

namespace meridian::globebrowsing {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::Not;

/// MapServer takes the nearest pixel: half of one of the raster's beside it. (Its RESAMPLE=BILINEAR is wrong in the
/// last column of a raster.)
constexpr int tolerance = 4;

class MapServersTest : public ServiceTest {
 protected:
  void SetUp() override {
    for (const char* program : {"/usr/bin/python3", "/usr/bin/mapserv", "/usr/bin/mapproxy-util"}) {
      if (!std::filesystem::exists(program)) {
        GTEST_SKIP() << program << " is missing; install python3, cgi-mapserver and mapproxy";
      }
    }
    writeMapFile();
    writeProxy();
    server = std::make_unique<ServerProcess>(
        std::vector<std::string>{"/usr/bin/python3", MERIDIAN_SOURCE_FOLDER "/tests/service/map_servers.py",
                                 std::to_string(port), folder.string()},
        port);
  }
  [[nodiscard]] std::string base() const { return "http://127.0.0.1:" + std::to_string(port); }
  [[nodiscard]] std::vector<std::string> requests() const {
    std::ifstream file(folder / "requests");
    std::vector<std::string> lines;
    for (std::string line; std::getline(file, line);) {
      lines.push_back(line);
    }
    return lines;
  }
  /// What a browser of layers would write into an asset after reading these capabilities.
  std::string filePathOf(ServiceStage& stage, const std::string& url, const std::string& layerName,
                         const LayerChoices& choices = {}) {
    std::promise<Result<Fetched>> arrived;
    const auto pending =
        stage.fetcher->fetch({.url = url}, [&](Result<Fetched> answer) { arrived.set_value(std::move(answer)); });
    const auto fetched = arrived.get_future().get();
    EXPECT_TRUE(fetched) << fetched.error().message();
    const auto capabilities = parseCapabilities(*fetched->body, url);
    EXPECT_TRUE(capabilities) << capabilities.error().message();
    const CapabilitiesLayer* layer = capabilities->find(layerName);
    if (layer == nullptr) {
      ADD_FAILURE() << "no layer " << layerName;
      return {};
    }
    const auto asset = assetOf(*capabilities, *layer, choices, {"Earth"});
    EXPECT_TRUE(asset) << asset.error().message();
    return asset ? *asset->table.find("FilePath")->string() : std::string();
  }

  int port = freePort();
  std::unique_ptr<ServerProcess> server;

 private:
  void writeMapFile() const {
    std::ofstream(folder / "mapserver.conf") << "CONFIG\n  ENV\n  END\nEND\n";
    std::ofstream(folder / "world.map")
        << "MAP\n  NAME 'World'\n  EXTENT -180 -90 180 90\n  SIZE 512 256\n  MAXSIZE 4096\n"
           "  PROJECTION 'init=epsg:4326' END\n  WEB METADATA\n    'wms_title' 'World'\n    'wms_srs' 'EPSG:4326 "
           "EPSG:3857'\n    'wms_enable_request' '*'\n    'wms_onlineresource' '"
        << base()
        << "/mapserv'\n  END END\n  OUTPUTFORMAT NAME 'png' DRIVER 'AGG/PNG' MIMETYPE 'image/png' "
           "IMAGEMODE RGBA EXTENSION 'png' TRANSPARENT ON END\n"
           "  LAYER\n    NAME 'world'\n    TYPE RASTER\n    STATUS ON\n    DATA '"
        << raster()
        << "'\n    PROJECTION 'init=epsg:4326' END\n    EXTENT -180 -90 180 90\n"
           "    METADATA 'wms_title' 'The world' 'wms_extent' '-180 -90 180 90' END\n  END\nEND\n";
  }
  void writeProxy() const {
    std::ofstream(folder / "mapproxy.yaml")
        << "services:\n  tms:\n    use_grid_names: true\n    origin: 'nw'\n  wmts:\n    kvp: true\n    restful: true\n"
           "layers:\n  - name: world\n    title: The world\n    sources: [cache]\n"
           "grids:\n  degrees:\n    srs: 'EPSG:4326'\n    origin: nw\n    bbox: [-180, -90, 180, 90]\n"
           "    min_res: 0.703125\n    num_levels: 8\n"
           "caches:\n  cache:\n    grids: [degrees]\n    sources: [server]\n    format: image/png\n"
           "    request_format: image/png\n    image:\n      resampling_method: bilinear\n"
           "sources:\n  server:\n    type: wms\n    req:\n      url: "
        << base()
        << "/mapserv\n      layers: world\n    supported_srs: ['EPSG:4326']\n    coverage:\n      bbox: [-180, -90, "
           "180, 90]\n"
           "      srs: 'EPSG:4326'\n"
           "globals:\n  cache:\n    base_dir: '"
        << (folder / "proxy").string() << "'\n    lock_dir: '" << (folder / "locks").string()
        << "'\n  image:\n    paletted: false\n";
  }
};

TEST_F(MapServersTest, WmsOfEitherVersion) {
  for (const char* version : {"1.1.1", "1.3.0"}) {
    SCOPED_TRACE(version);
    ServiceStage stage;
    const std::string url = base() + "/mapserv?SERVICE=WMS&REQUEST=GetCapabilities&VERSION=" + version;
    const std::string filePath = filePathOf(stage, url, "world");
    EXPECT_THAT(filePath, HasSubstr("GDAL_WMS"));
    expectRaster(stage, stage.open(filePath), tolerance);
    EXPECT_THAT(requests(), Contains(testing::AllOf(HasSubstr("GetMap"), HasSubstr(version))));
  }
}

TEST_F(MapServersTest, AGetMapRequest) {
  ServiceStage stage;
  const auto layer = stage.open("WMS:" + base() +
                                "/mapserv?SERVICE=WMS&VERSION=1.1.1&REQUEST=GetMap&LAYERS=world&SRS=EPSG:4326&"
                                "BBOX=-180,-90,180,90&FORMAT=image/png&STYLES=");
  expectRaster(stage, layer, tolerance, {{0, 1, 0, 1}, {1, 2, 0, 1}});
}

TEST_F(MapServersTest, WmtsWhoseCapabilitiesAreFetchedFirst) {
  ServiceStage stage;
  const auto layer = stage.open("WMTS:" + base() + "/mapproxy/wmts/1.0.0/WMTSCapabilities.xml,layer=world");
  expectRaster(stage, layer, tolerance);
  EXPECT_THAT(requests(), Contains("/mapproxy/wmts/1.0.0/WMTSCapabilities.xml").Times(1));
}

TEST_F(MapServersTest, Tms) {
  ServiceStage stage;
  std::string map = base() + "/mapproxy/tms/1.0.0/world/degrees";
  const std::string filePath = filePathOf(stage, map, "The world");
  expectRaster(stage, stage.open(filePath), tolerance);
}

TEST_F(MapServersTest, AProviderByLevelFetchesTheCapabilitiesOfItsParts) {
  ServiceStage stage;
  const std::string wmts = "WMTS:" + base() + "/mapproxy/wmts/1.0.0/WMTSCapabilities.xml,layer=world";
  Table levels;
  levels.list = {tableOf({{"MaxLevel", 2}, {"TileProvider", tableOf({{"FilePath", wmts}})}}),
                 tableOf({{"MaxLevel", 20}, {"TileProvider", tableOf({{"FilePath", raster()}})}})};
  expectRaster(stage, stage.open({{"Type", "TileProviderByLevel"}, {"LevelTileProviders", levels}}), tolerance);
}

}  // namespace
}  // namespace meridian::globebrowsing

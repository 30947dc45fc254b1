// MapServer and MapProxy: servers that nobody here has written.
#include "map_servers_stage.h"

namespace meridian::globebrowsing {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::Not;

/// MapServer takes the nearest pixel: half of one of the raster's beside it. (Its RESAMPLE=BILINEAR is wrong in the
/// last column of a raster.)
constexpr int tolerance = 4;

class MapServersTest : public MapServersStage {
 protected:
  void SetUp() override {
    MapServersStage::SetUp();
    if (IsSkipped()) {
      return;
    }
    writeMapFile("  LAYER\n    NAME 'world'\n    TYPE RASTER\n    STATUS ON\n    DATA '" + raster() +
                 "'\n    PROJECTION 'init=epsg:4326' END\n    EXTENT -180 -90 180 90\n"
                 "    METADATA 'wms_title' 'The world' 'wms_extent' '-180 -90 180 90' END\n  END\n");
    writeProxy();
    start();
  }

 private:
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

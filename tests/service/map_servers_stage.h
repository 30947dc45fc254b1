#pragma once

#include <future>

#include "globebrowsing/source/service_asset.h"
#include "service_stage.h"

namespace meridian::globebrowsing {

/// A test with MapServer and, where there is a mapproxy.yaml, MapProxy. The test writes their files, then starts them.
class MapServersStage : public ServiceTest {
 protected:
  void SetUp() override {
    for (const char* program : {"/usr/bin/python3", "/usr/bin/mapserv", "/usr/bin/mapproxy-util"}) {
      if (!std::filesystem::exists(program)) {
        GTEST_SKIP() << program << " is missing; install python3, cgi-mapserver and mapproxy";
      }
    }
  }
  void start() {
    server = std::make_unique<ServerProcess>(
        std::vector<std::string>{"/usr/bin/python3", MERIDIAN_SOURCE_FOLDER "/tests/service/map_servers.py",
                                 std::to_string(port), folder.string()},
        port);
  }
  [[nodiscard]] std::string base() const { return "http://127.0.0.1:" + std::to_string(port); }
  /// A map file of these layers.
  void writeMapFile(const std::string& layers) const {
    std::ofstream(folder / "mapserver.conf") << "CONFIG\n  ENV\n  END\nEND\n";
    std::ofstream(folder / "world.map")
        << "MAP\n  NAME 'World'\n  EXTENT -180 -90 180 90\n  SIZE 512 256\n  MAXSIZE 4096\n"
           "  PROJECTION 'init=epsg:4326' END\n  WEB METADATA\n    'wms_title' 'World'\n    'wms_srs' 'EPSG:4326 "
           "EPSG:3857'\n    'wms_enable_request' '*'\n    'wms_onlineresource' '"
        << base()
        << "/mapserv'\n  END END\n  OUTPUTFORMAT NAME 'png' DRIVER 'AGG/PNG' MIMETYPE 'image/png' "
           "IMAGEMODE RGBA EXTENSION 'png' TRANSPARENT ON END\n"
        << layers << "END\n";
  }
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
};

}  // namespace meridian::globebrowsing

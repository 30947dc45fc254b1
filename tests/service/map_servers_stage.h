#pragma once

#include <future>
#include <utility>

#include <unistd.h>

#include "globebrowsing/source/service_asset.h"
#include "service_stage.h"

namespace meridian::globebrowsing {

/// A test with MapServer behind fcgiwrap and, where there is a mapproxy.yaml, MapProxy; nginx hands /mapserv and
/// /mapproxy on to them, and writes down what it is asked for. The test writes their files, then starts them.
class MapServersStage : public ServiceTest {
 protected:
  void SetUp() override {
    for (const char* program :
         {"/usr/bin/mapserv", "/usr/sbin/fcgiwrap", "/usr/bin/mapproxy-util", "/usr/sbin/nginx"}) {
      if (!std::filesystem::exists(program)) {
        GTEST_SKIP() << program << " is missing; install cgi-mapserver, fcgiwrap, mapproxy and nginx-light";
      }
    }
  }
  void start() {
    using Command = std::vector<std::string>;
    const int mapServerPort = freePort();
    mapServer = std::make_unique<ServerProcess>(
        Command{"/usr/sbin/fcgiwrap", "-s", "tcp:127.0.0.1:" + std::to_string(mapServerPort)}, mapServerPort);
    int mapProxyPort = 0;
    if (std::filesystem::exists(folder / "mapproxy.yaml")) {
      mapProxyPort = freePort();
      mapProxy = std::make_unique<ServerProcess>(
          Command{"/usr/bin/python3", MERIDIAN_SOURCE_FOLDER "/tests/service/map_proxy.py",
                  std::to_string(mapProxyPort), (folder / "mapproxy.yaml").string()},
          mapProxyPort);
    }
    writeNginxConfiguration(mapServerPort, mapProxyPort);
    const std::string prefix = folder.string() + "/";
    server = std::make_unique<ServerProcess>(
        Command{"/usr/sbin/nginx", "-p", prefix, "-c", prefix + "nginx.conf", "-e", prefix + "nginx.log"}, port);
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
  std::unique_ptr<ServerProcess> mapServer;
  std::unique_ptr<ServerProcess> mapProxy;
  std::unique_ptr<ServerProcess> server;

 private:
  /// Without a port there is no MapProxy.
  void writeNginxConfiguration(int mapServerPort, int mapProxyPort) const {
    std::ofstream file(folder / "nginx.conf");
    file << (::geteuid() == 0 ? "user root;\n" : "")
         << "daemon off;\nworker_processes 1;\npid nginx.pid;\nevents { worker_connections 512; }\nhttp {\n"
            "  log_format target '$request_uri';\n  access_log requests target;\n";
    for (const char* kind : {"client_body", "proxy", "fastcgi", "uwsgi", "scgi"}) {
      file << "  " << kind << "_temp_path temp_" << kind << ";\n";
    }
    file << "  server {\n    listen 127.0.0.1:" << port
         << ";\n    location = /mapserv {\n      fastcgi_pass 127.0.0.1:" << mapServerPort << ";\n";
    const std::vector<std::pair<std::string, std::string>> parameters{
        {"SCRIPT_FILENAME", "/usr/bin/mapserv"},
        {"SCRIPT_NAME", "/mapserv"},
        {"REQUEST_METHOD", "$request_method"},
        {"QUERY_STRING", "$query_string"},
        {"SERVER_NAME", "127.0.0.1"},
        {"SERVER_PORT", std::to_string(port)},
        {"MS_MAPFILE", (folder / "world.map").string()},
        {"MAPSERVER_CONFIG_FILE", (folder / "mapserver.conf").string()}};
    for (const auto& [name, value] : parameters) {
      file << "      fastcgi_param " << name << " " << value << ";\n";
    }
    file << "    }\n";
    if (mapProxyPort != 0) {
      file << "    location /mapproxy {\n      proxy_pass http://127.0.0.1:" << mapProxyPort
           << ";\n      proxy_set_header Host $http_host;\n    }\n";
    }
    file << "  }\n}\n";
  }
};

}  // namespace meridian::globebrowsing

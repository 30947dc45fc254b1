#include "globebrowsing/module.h"

#include "globebrowsing/globe_services.h"
#include "globebrowsing/layer_panel.h"
#include "globebrowsing/map_server_panel.h"
#include "globebrowsing/map_servers.h"
#include "globebrowsing/renderable_globe.h"
#include "globebrowsing/script_library.h"

namespace meridian::globebrowsing {

namespace {

class GlobeBrowsingModule final : public Module {
 public:
  GlobeBrowsingModule() : Module("GlobeBrowsing", "Globe browsing", "Planets and moons from map data") {}

  Result<void> initialize(Host& host) override {
    services_ = std::make_unique<GlobeServices>(*this, host.statistics(), host.paths().cache);
    services_->setTokenFolder([&host](std::string_view name) { return host.pathToken(name); });
    servers_.setLoader(
        [this](const MapServer& server, std::function<void(MapServers::Offer)> done) {
          services_->capabilities().load(server, std::move(done));
        },
        [this] { services_->capabilities().deliver(); });
    host.registerRenderable("RenderableGlobe", [this](const RenderableRequest& request) {
      return RenderableGlobe::create(request, *services_);
    });
    host.registerScriptLibrary(makeScriptLibrary(host, servers_));
    host.registerPanel(std::make_unique<LayerPanel>(host));
    host.registerPanel(std::make_unique<MapServerPanel>(host, servers_));
    return {};
  }

 private:
  MapServers servers_;
  std::unique_ptr<GlobeServices> services_;
};

}  // namespace

std::unique_ptr<Module> makeModule() {
  return std::make_unique<GlobeBrowsingModule>();
}

}  // namespace meridian::globebrowsing

#include "globebrowsing/map_servers.h"

#include <utility>

#include "host/api/log.h"

namespace meridian::globebrowsing {

void MapServers::add(MapServer server) {
  const std::string name = server.name;
  const unsigned generation = ++generation_;
  Offer notYet = failure(loader_ ? "its capabilities have not arrived yet" : "capabilities are not loaded", server.url,
                         loader_ ? "ask again" : "write the layer's FilePath into an asset");
  Known& known =
      servers_.insert_or_assign(name, Known{std::move(server), std::move(notYet), loader_ != nullptr, generation})
          .first->second;
  if (!loader_) {
    return;
  }
  const MapServer asked = known.server;
  loader_(asked, [this, name, generation](Offer offer) {
    const auto found = servers_.find(name);
    if (found == servers_.end() || found->second.generation != generation) {
      return;
    }
    if (!offer) {
      log::error("map server {}: {}", name, offer.error().message());
    } else if (!offer->message.empty()) {
      log::warning("map server {}: {}", name, offer->message);
    }
    found->second.offer = std::move(offer);
    found->second.isLoading = false;
  });
}

bool MapServers::remove(std::string_view name) {
  const auto found = servers_.find(name);
  if (found == servers_.end()) {
    return false;
  }
  servers_.erase(found);
  return true;
}

const MapServer* MapServers::find(std::string_view name) const {
  const auto found = servers_.find(name);
  return found == servers_.end() ? nullptr : &found->second.server;
}

std::vector<MapServer> MapServers::all() const {
  std::vector<MapServer> found;
  for (const auto& [name, known] : servers_) {
    found.push_back(known.server);
  }
  return found;
}

bool MapServers::isLoading(std::string_view name) const {
  const auto found = servers_.find(name);
  return found != servers_.end() && found->second.isLoading;
}

bool MapServers::stillLoads(std::string_view name) {
  if (deliver_) {
    deliver_();
  }
  return isLoading(name);
}

std::vector<MapServer> MapServers::of(std::string_view globe) const {
  std::vector<MapServer> found;
  for (const auto& [name, known] : servers_) {
    if (known.server.globe == globe) {
      found.push_back(known.server);
    }
  }
  return found;
}

const MapServers::Offer& MapServers::offered(std::string_view name) const {
  const auto found = servers_.find(name);
  if (found == servers_.end()) {
    static const Offer unknown =
        failure("there is no map server of that name", {}, "name it with loadWMSCapabilities first");
    return unknown;
  }
  return found->second.offer;
}

}  // namespace meridian::globebrowsing

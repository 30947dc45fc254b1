#pragma once

#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "host/api/error.h"

namespace meridian::globebrowsing {

/// A map service that a user or an asset named for a globe, to take layers from.
struct MapServer {
  std::string name;
  std::string globe;
  std::string url;  ///< of its capabilities, as given
};

/// A layer that a server offers: `url` is what an asset writes as `FilePath`.
struct OfferedLayer {
  std::string name;
  std::string url;
};

/// The servers by name, and what they offer as far as that is known. Render thread only.
class MapServers {
 public:
  using Offer = Result<std::vector<OfferedLayer>>;
  /// Begins to load a server's capabilities, and calls `done` on the render thread when they are there or failed; never
  /// blocks. `done` may be called after the server was removed, but not after the MapServers have gone.
  using Loader = std::function<void(const MapServer& server, std::function<void(Offer)> done)>;

  /// Without a loader servers are kept, and what they offer stays unknown.
  void setLoader(Loader loader) { loader_ = std::move(loader); }

  /// Replaces a server of the same name, and has its capabilities loaded.
  void add(MapServer server);
  /// Whether there was one.
  bool remove(std::string_view name);
  [[nodiscard]] const MapServer* find(std::string_view name) const;
  /// Of that globe, in alphabetical order.
  [[nodiscard]] std::vector<MapServer> of(std::string_view globe) const;
  /// What the server offers. Errors: no such server; not loaded yet; why it could not be.
  [[nodiscard]] Offer offered(std::string_view name) const;

 private:
  struct Known {
    MapServer server;
    Offer offer;
    unsigned generation = 0;  ///< so that answers for a former server of the name are dropped
  };
  Loader loader_;
  std::map<std::string, Known, std::less<>> servers_;
  unsigned generation_ = 0;
};

}  // namespace meridian::globebrowsing

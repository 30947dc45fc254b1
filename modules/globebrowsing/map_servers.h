#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "globebrowsing/source/map_crs.h"
#include "host/api/error.h"
#include "host/api/value.h"

namespace meridian::globebrowsing {

/// A map service that a user or an asset named for a globe, to take layers from.
struct MapServer {
  std::string name;
  std::string globe;
  std::string url;  ///< of its capabilities, as given
};

/// A layer that a server offers.
struct OfferedLayer {
  std::string name;
  std::string url;                 ///< what an asset writes as `FilePath`; empty: it cannot be shown
  std::string obstacle{};          ///< why not
  std::optional<Extent> extent{};  ///< radians
  std::string times{};             ///< values and intervals, as the service lists them
  std::string attribution{};
  struct Style {
    std::string name;
    Value table;  ///< the layer's, for addLayer
  };
  std::vector<Style> styles{};  ///< the service's default first; at least one of a layer that can be shown
};

struct ServerOffer {
  std::vector<OfferedLayer> layers{};
  std::string message{};  ///< what of its documents is missing, and why; empty: nothing
};

/// The servers by name, and what they offer as far as that is known. Render thread only.
class MapServers {
 public:
  using Offer = Result<ServerOffer>;
  /// Begins to load a server's capabilities, and calls `done` on the render thread when they are there or failed; never
  /// blocks. `done` may be called after the server was removed, but not after the MapServers have gone.
  using Loader = std::function<void(const MapServer& server, std::function<void(Offer)> done)>;

  /// Without a loader servers are kept, and what they offer stays unknown. `deliver` has it call what has arrived.
  void setLoader(Loader loader, std::function<void()> deliver = {}) {
    loader_ = std::move(loader);
    deliver_ = std::move(deliver);
  }

  /// Replaces a server of the same name, and has its capabilities loaded.
  void add(MapServer server);
  /// Whether there was one.
  bool remove(std::string_view name);
  [[nodiscard]] const MapServer* find(std::string_view name) const;
  /// All, in alphabetical order.
  [[nodiscard]] std::vector<MapServer> all() const;
  /// Of that globe, in alphabetical order.
  [[nodiscard]] std::vector<MapServer> of(std::string_view globe) const;
  /// What the server offers; good until servers change or answer. Errors: no such server; not loaded yet; why it could
  /// not be.
  [[nodiscard]] const Offer& offered(std::string_view name) const;
  /// Whether its capabilities are on their way.
  [[nodiscard]] bool isLoading(std::string_view name) const;
  /// The same, after what has arrived was taken in: for who waits, where perhaps no globe is drawn.
  [[nodiscard]] bool stillLoads(std::string_view name);

 private:
  struct Known {
    MapServer server;
    Offer offer;
    bool isLoading = false;
    unsigned generation = 0;  ///< so that answers for a former server of the name are dropped
  };
  Loader loader_;
  std::function<void()> deliver_;
  std::map<std::string, Known, std::less<>> servers_;
  unsigned generation_ = 0;
};

}  // namespace meridian::globebrowsing

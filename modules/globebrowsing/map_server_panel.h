#pragma once

#include <memory>
#include <string>
#include <vector>

#include "globebrowsing/map_servers.h"
#include "globebrowsing/renderable_globe.h"
#include "host/api/module.h"
#include "host/api/panel.h"
#include "host/api/property.h"

namespace meridian::globebrowsing {

/// The known map servers and the layers that they offer, to be added to a globe while it runs, and what was added, to
/// be written as an asset.
class MapServerPanel final : public Panel {
 public:
  /// Of a server that offers hundreds no more are listed; the filter finds the others.
  static constexpr std::size_t mostListed = 40;

  /// Both outlive the panel.
  MapServerPanel(Host& host, MapServers& servers);
  [[nodiscard]] std::string title() const override { return "Map servers"; }
  void build(PanelBuilder& builder) override;

 private:
  void updateGlobes();
  void buildNewServer(PanelBuilder& builder);
  void buildServer(PanelBuilder& builder, const MapServer& server);
  void buildOffer(PanelBuilder& builder, const MapServer& server, const ServerOffer& serverOffer);
  void buildLayer(PanelBuilder& builder, const MapServer& server, const OfferedLayer& layer);
  void buildAdded(PanelBuilder& builder);
  void add(const MapServer& server, const OfferedLayer& layer, const OfferedLayer::Style& style);
  void write();
  [[nodiscard]] RenderableGlobe* globe() const;
  [[nodiscard]] LayerGroupId group() const { return static_cast<LayerGroupId>(group_.get()); }

  Host& host_;
  MapServers& servers_;
  std::unique_ptr<OptionProperty> globe_;  ///< null without globes
  OptionProperty group_;
  StringProperty url_{{"Url", "Capabilities", "Address or file of a map server's capabilities; Enter takes it"}};
  StringProperty name_{{"Name", "Name", "What the server is to be called; else its address"}};
  StringProperty filter_{{"Filter", "Filter", "Part of a layer's name; Enter takes it"}};
  StringProperty file_{{"File", "File", "The asset to be written, below ${SYNC}, ${CACHE} or ${TEMPORARY}"},
                       "${SYNC}/added_layers.asset"};
  std::string done_;    ///< what was done last
  std::string failed_;  ///< or why it was not
};

}  // namespace meridian::globebrowsing

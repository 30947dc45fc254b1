#pragma once

#include "host/api/module.h"
#include "host/api/panel.h"

namespace meridian::globebrowsing {

/// Every globe's layers: toggle, opacity, blending, settings, and what is wrong with them.
class LayerPanel final : public Panel {
 public:
  /// `host` outlives the panel.
  explicit LayerPanel(Host& host) : host_(host) {}
  [[nodiscard]] std::string title() const override { return "Layers"; }
  void build(PanelBuilder& builder) override;

 private:
  Host& host_;
};

}  // namespace meridian::globebrowsing

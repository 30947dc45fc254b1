#include "globebrowsing/layer_panel.h"

#include "globebrowsing/renderable_globe.h"

namespace meridian::globebrowsing {

namespace {

void buildLayer(PanelBuilder& builder, Layer& layer) {
  if (!builder.beginSection(layer.name() + "##" + layer.identifier())) {
    return;
  }
  builder.property(layer.enabled);
  builder.property(layer.opacity);
  builder.property(layer.blendMode);
  for (Property* property : layer.settingsOwner.properties()) {
    builder.property(*property);
  }
  builder.text(layer.status.get());
  if (!layer.lastError.get().empty()) {
    builder.warning(layer.lastError.get());
  }
  builder.endSection();
}

void buildGlobe(PanelBuilder& builder, RenderableGlobe& globe) {
  builder.property(globe.enabled);
  builder.property(globe.performShading);
  builder.property(globe.useAccurateNormals);
  for (const LayerGroupId group : allLayerGroups) {
    const auto& layers = globe.layers().group(group).layers();
    if (!layers.empty() && builder.beginSection(name(group))) {
      for (const auto& layer : layers) {
        buildLayer(builder, *layer);
      }
      builder.endSection();
    }
  }
}

}  // namespace

void LayerPanel::build(PanelBuilder& builder) {
  for (const std::string& node : host_.nodes()) {
    if (auto* globe = dynamic_cast<RenderableGlobe*>(host_.renderable(node))) {
      if (builder.beginSection(node)) {
        buildGlobe(builder, *globe);
        builder.endSection();
      }
    }
  }
}

}  // namespace meridian::globebrowsing

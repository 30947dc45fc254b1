#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "host/api/error.h"
#include "host/api/frame_context.h"
#include "host/api/ground.h"
#include "host/api/property.h"
#include "host/api/property_owner.h"
#include "host/api/value.h"

namespace meridian::graphics {
class Graphics;  // host/graphics/graphics.h: programs, pools, limits. Known here by name only.
}

namespace meridian {

/// What a scene-graph node shows. Made by a factory from an asset's `Renderable` table: cheaply, without OpenGL,
/// network or raster reads, so that assets can be validated anywhere.
///
/// All calls come on the render thread, in this order: initializeGraphics once, then per frame update once and, if it
/// is enabled, draw once per view, then deinitializeGraphics once. update and draw never wait for disk, network or a
/// shader compiler.
class Renderable : public PropertyOwner {
 public:
  explicit Renderable(std::string type);

  /// As the asset calls it: "RenderableGlobe".
  [[nodiscard]] const std::string& type() const { return typeName.get(); }

  virtual Result<void> initializeGraphics(graphics::Graphics& /*graphics*/) { return {}; }
  virtual void deinitializeGraphics() {}
  virtual void update(const FrameContext& /*frame*/) {}
  /// Draws into the bound framebuffer, whose viewport is set; leaves the default GL state behind.
  virtual void draw(const FrameContext& /*frame*/, std::size_t /*view*/) {}

  /// Metres; 0 when nothing is known. What the near and far limits of navigation start from.
  [[nodiscard]] virtual double boundingSphere() const { return 0.0; }
  /// Null unless it is something to stand on.
  [[nodiscard]] virtual Ground* ground() { return nullptr; }
  /// The identifier of the node whose light falls on it; empty: the host decides.
  [[nodiscard]] virtual std::string_view lightSourceNode() const { return {}; }
  /// Appends whom the data are to be credited to that the last frame showed, those that are in the list already left
  /// out. Asked for every frame; the texts are good until the next update.
  virtual void addAttributions(std::vector<std::string_view>& /*list*/) const {}

  /// What `--validate` counts and lists.
  struct Contents {
    struct Layer {
      std::string name;  ///< "ColorLayers.BlueMarble"; "ColorLayers[3]" of one that was refused and has no name
      std::optional<Error> unusable;  ///< why its provider cannot be built, or its local data do not exist
    };
    std::size_t globes = 0;
    std::vector<Layer> layers;  ///< those that were refused, too
    std::vector<Error> notes;   ///< what is no error, but may be a mistake: keys that nothing knows
  };
  [[nodiscard]] virtual Contents contents() const { return {}; }

  BoolProperty enabled{{"Enabled", "Enabled", "Whether it is drawn"}, true};
  FloatProperty opacity{{"Opacity", "Opacity", "0 is invisible, 1 opaque"}, 1.0, {0.0, 1.0}};
  FloatProperty fade{{"Fade", "Fade", "Multiplies Opacity; what scripts use to fade"}, 1.0, {0.0, 1.0}};
  StringProperty typeName{{"Type", "Type", "As the asset calls it", true}};

  /// 0 is invisible, 1 opaque: what it is drawn with.
  [[nodiscard]] double effectiveOpacity() const { return opacity.get() * fade.get(); }
};

/// What a factory gets beside the table.
struct RenderableRequest {
  Value table;             ///< the asset's `Renderable`
  std::string where;       ///< file and line of the asset, for errors
  std::string folder;      ///< of the asset file; relative paths start there
  std::string identifier;  ///< of the node
};

using RenderableFactory = std::function<Result<std::unique_ptr<Renderable>>(const RenderableRequest&)>;

inline Renderable::Renderable(std::string type) : PropertyOwner("Renderable") {
  typeName.put(std::move(type));
  for (Property* property : std::initializer_list<Property*>{&typeName, &enabled, &opacity, &fade}) {
    addProperty(*property);
  }
}

}  // namespace meridian

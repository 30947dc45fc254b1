#pragma once

#include <array>
#include <cstddef>
#include <string>

#include <glm/vec4.hpp>

#include "globebrowsing/gpu/composite_kind.h"
#include "globebrowsing/layers/structure_key.h"
#include "host/graphics/graphics.h"

namespace meridian::globebrowsing {

/// Where programs that compose find what they draw with: shaders/gpu/compose.frag.
namespace composition_bindings {
inline constexpr GLuint layerBlock = 2;      ///< layerFields() of each part
inline constexpr GLuint placementBlock = 3;  ///< PlacementHead, then a Placement of each part
inline constexpr GLenum colourFormat = GL_RGBA8;

struct Placement {
  glm::vec4 transform{0.0F};
  float slot = -1.0F;
  float pixel = 0.0F;
  int ramp = 0;
  int stops = 0;
};
static_assert(sizeof(Placement) == 32);

struct PlacementHead {
  glm::vec4 background{0.0F};
  int count = 0;
  int waterFrom = 0;
  std::array<int, 2> padding{};
};
static_assert(sizeof(PlacementHead) == 32);
}  // namespace composition_bindings

/// The programs that compose. For each structure key one is generated and built in the background. Until it is ready
/// one that loops over the layers at run time composes, but not with a software renderer: that runs all branches, and
/// takes longer for a composite (120 ms for three layers; their own program 8) than a frame may, while the own program
/// is there in about half a second. Settings are uniforms and never recompile.
///
/// After a structure's own program a second is built that takes less than half as long, for composites whose tiles lie
/// in them texel for texel and whose layers' settings change nothing: most composites. It draws the same, and nothing
/// ever waits for it. Owned by Composer. Render thread only.
class CompositionPrograms {
 public:
  /// As many layers as the looping program takes; more wait for the program of their own.
  static constexpr std::size_t loopLayers = 64;

  explicit CompositionPrograms(graphics::Graphics& graphics);

  /// Once, before all else: asks for those that do not depend on layers. Errors: shader templates missing or wrong.
  Result<void> request();
  /// Whether the looping program may stand in, instead of what the renderer suggests.
  void setLooping(bool loops);
  /// Asks for the program of that kind's structure. Cheap when nothing changed.
  void setStructure(CompositeKind kind, const StructureKey& key);

  /// The structure's own, or the looping one if that may stand in; 0 while none is ready. For parts that are unchanged
  /// the program made for those, where it is ready.
  [[nodiscard]] GLuint program(CompositeKind kind, bool areUnchanged = false) const;
  /// Draws a half-size level; 0 while it is not ready, and then so are all others.
  [[nodiscard]] GLuint halfSize() const { return graphics_.programs().ready(halfSize_); }
  /// Whether the structure's own program is ready.
  [[nodiscard]] bool isOwnReady(CompositeKind kind) const;
  /// Whether it is being built.
  [[nodiscard]] bool isOwnPending(CompositeKind kind) const;
  /// Whether nothing composes that kind, nor ever will: programs cannot be built.
  [[nodiscard]] bool hasFailed(CompositeKind kind) const;
  /// Then the compiler's complaint, else empty.
  [[nodiscard]] std::string error(CompositeKind kind) const;

 private:
  struct Kind {
    StructureKey key;
    graphics::ProgramHandle program;
    graphics::ProgramHandle unchanged;
    bool requested = false;
  };

  enum class Parts { Any, Unchanged };
  [[nodiscard]] Result<graphics::ProgramDescription> describe(std::string key, std::size_t layers, std::string body,
                                                              Parts parts) const;
  [[nodiscard]] graphics::ProgramHandle request(const StructureKey& key, Parts parts);
  /// Whether the looping program may compose that kind.
  [[nodiscard]] bool mayLoop(const Kind& kind) const { return loops_ && kind.key.layers().size() <= loopLayers; }

  graphics::Graphics& graphics_;
  bool loops_;
  std::array<Kind, compositeKindCount> kinds_;
  graphics::ProgramDescription loopDescription_;
  graphics::ProgramHandle loop_;  ///< empty until it may be needed
  graphics::ProgramHandle halfSize_;
};

}  // namespace meridian::globebrowsing

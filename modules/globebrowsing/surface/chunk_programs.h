#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "globebrowsing/gpu/composite_kind.h"
#include "host/graphics/graphics.h"

namespace meridian::globebrowsing {

/// What the program that draws chunks depends on, beside the layers, which are composed before.
struct ChunkProgramKey {
  bool shading = true;
  bool accurateNormals = false;
  bool night = false;
  bool overlay = false;
  bool water = false;
  bool edges = false;
  bool blended = false;                 ///< not in the text: drivers make other machine code for it
  std::optional<CompositeKind> fade{};  ///< the kind of which some chunks mix two composites

  [[nodiscard]] std::string text() const;
  bool operator==(const ChunkProgramKey&) const = default;
};

/// Where chunk programs find what they draw with.
namespace chunk_bindings {
inline constexpr GLuint viewBlock = 0;
inline constexpr GLuint chunkBlock = 1;
inline constexpr GLuint compositeUnit = 0;
inline constexpr GLuint normalUnit = 1;
/// Source over destination, by the source's alpha: the blending of a translucent globe.
void enableBlending();
}  // namespace chunk_bindings

/// What one chunk takes of the programs of a key.
struct ChunkProgramUse {
  bool night = true;   ///< night layers may show
  bool fades = false;  ///< it mixes two composites
  auto operator<=>(const ChunkProgramUse&) const = default;
};

/// The program that draws chunks, and where there are night layers a cheaper one without them for chunks in full
/// daylight: software renderers fetch every texture that a program names. While a layer fades, both once more for
/// chunks that mix two composites. Built in the background; until those of a new key are ready, those of the last draw.
/// Render thread only.
class ChunkPrograms {
 public:
  explicit ChunkPrograms(graphics::Graphics& graphics) : graphics_(graphics) {}

  /// Asks for the programs of that key. Cheap when nothing changed. Errors: shader templates.
  [[nodiscard]] Result<void> set(const ChunkProgramKey& key);
  /// Has those built that the key draws with while a layer of any kind fades, before one does. Cheap when that was
  /// done.
  void prepareFades();
  /// Whether that was done for what draws now.
  [[nodiscard]] bool hasPreparedFades() const { return !prepared_.empty() && preparedKey_ == unfaded(drawn_.key); }
  /// Whether what draws now are the programs of the key asked for. One that was finished since set() draws nothing yet.
  [[nodiscard]] bool ready() const { return drawsWanted_; }
  /// The compiler's complaint, or empty.
  [[nodiscard]] std::string error() const;

  /// Of what draws now. The programs are 0 while nothing is ready yet.
  [[nodiscard]] const ChunkProgramKey& key() const { return drawn_.key; }
  [[nodiscard]] GLuint program(const ChunkProgramUse& use) const {
    return graphics_.programs().ready(drawn_.programs[place(use)]);
  }

 private:
  struct Set {
    ChunkProgramKey key;
    std::array<graphics::ProgramHandle, 4> programs;  ///< by use; some are the same
  };
  [[nodiscard]] static std::size_t place(const ChunkProgramUse& use) {
    return (use.night ? 1U : 0U) + (use.fades ? 2U : 0U);
  }
  [[nodiscard]] static ChunkProgramKey unfaded(ChunkProgramKey key) {
    key.fade.reset();
    return key;
  }
  [[nodiscard]] bool isReady(const Set& set) const;
  using Urgency = graphics::ProgramCache::Urgency;
  [[nodiscard]] Result<Set> requestAll(const ChunkProgramKey& key, Urgency urgency);
  [[nodiscard]] Result<graphics::ProgramHandle> request(ChunkProgramKey key, const ChunkProgramUse& use,
                                                        Urgency urgency);

  graphics::Graphics& graphics_;
  Set wanted_;
  Set drawn_;  ///< the last that was ready
  bool drawsWanted_ = false;
  ChunkProgramKey preparedKey_;
  std::vector<Set> prepared_;  ///< of preparedKey_, with fades
};

}  // namespace meridian::globebrowsing

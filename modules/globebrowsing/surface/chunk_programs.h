#pragma once

#include <string>

#include "host/graphics/graphics.h"

namespace meridian::globebrowsing {

/// What the program that draws chunks depends on, beside the layers, which are composed before.
struct ChunkProgramKey {
  bool shading = true;
  bool accurateNormals = false;
  bool night = false;
  bool overlay = false;
  bool edges = false;
  bool blended = false;  ///< not in the text: drivers make other machine code for it

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

/// The program that draws chunks, and where there are night layers a cheaper one without them for chunks in full
/// daylight: software renderers fetch every texture that a program names. Built in the background; until those of a new
/// key are ready, those of the last draw. Render thread only.
class ChunkPrograms {
 public:
  explicit ChunkPrograms(graphics::Graphics& graphics) : graphics_(graphics) {}

  /// Asks for the programs of that key. Cheap when nothing changed. Errors: shader templates.
  [[nodiscard]] Result<void> set(const ChunkProgramKey& key);
  /// Whether the programs of the key asked for are ready.
  [[nodiscard]] bool ready() const { return isReady(wanted_); }
  /// The compiler's complaint, or empty.
  [[nodiscard]] std::string error() const;

  /// Of what draws now. The programs are 0 while nothing is ready yet.
  [[nodiscard]] const ChunkProgramKey& key() const { return drawn_.key; }
  [[nodiscard]] GLuint full() const { return graphics_.programs().ready(drawn_.full); }
  [[nodiscard]] GLuint daylight() const { return graphics_.programs().ready(drawn_.daylight); }

 private:
  struct Pair {
    ChunkProgramKey key;
    graphics::ProgramHandle full;
    graphics::ProgramHandle daylight;  ///< the same as full without night layers
  };
  [[nodiscard]] bool isReady(const Pair& pair) const;
  [[nodiscard]] Result<graphics::ProgramHandle> request(const ChunkProgramKey& key);

  graphics::Graphics& graphics_;
  Pair wanted_;
  Pair drawn_;  ///< the last that was ready
};

}  // namespace meridian::globebrowsing

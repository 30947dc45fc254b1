#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "host/graphics/gl_objects.h"

namespace meridian::globebrowsing {

/// Uniform blocks that live for one frame, written straight into mapped memory: drivers wait when a buffer that a draw
/// still reads is written by command. Three frames may be under way.
class UniformRing {
 public:
  /// `alignment`: of a block's offset, as the driver asks.
  UniformRing(std::size_t bytesPerFrame, std::size_t alignment);

  void beginFrame();
  void endFrame();

  /// Makes room for that many bytes more in this frame, on a larger buffer if need be.
  void reserve(std::size_t bytes);
  /// Bytes that a block of that size takes.
  [[nodiscard]] std::size_t aligned(std::size_t bytes) const {
    return (bytes + alignment_ - 1) / alignment_ * alignment_;
  }

  /// A block's place in the buffer. There must be room (reserve).
  struct Block {
    std::byte* bytes = nullptr;
    GLintptr offset = 0;
    GLsizeiptr size = 0;
  };
  [[nodiscard]] Block take(std::size_t bytes);
  void bind(GLuint binding, const Block& block) const;

  template <class T>
  void writeAndBind(GLuint binding, const T& value) {
    const Block block = take(sizeof(T));
    *reinterpret_cast<T*>(block.bytes) = value;
    bind(binding, block);
  }

 private:
  void allocate(std::size_t bytesPerFrame);

  static constexpr std::size_t framesUnderWay = 3;
  std::size_t alignment_;
  std::size_t capacity_ = 0;  ///< of one frame
  graphics::Buffer buffer_;
  std::byte* mapped_ = nullptr;
  std::array<graphics::Fence, framesUnderWay> fences_;
  std::size_t segment_ = 0;
  std::size_t used_ = 0;
};

}  // namespace meridian::globebrowsing

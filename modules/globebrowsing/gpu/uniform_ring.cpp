#include "globebrowsing/gpu/uniform_ring.h"

#include <algorithm>
#include <cassert>
#include <chrono>

namespace meridian::globebrowsing {

UniformRing::UniformRing(std::size_t bytesPerFrame, std::size_t alignment)
    : alignment_(std::max<std::size_t>(alignment, 16)) {
  allocate(bytesPerFrame);
}

void UniformRing::allocate(std::size_t bytesPerFrame) {
  capacity_ = aligned(bytesPerFrame);
  constexpr GLbitfield access = GL_MAP_WRITE_BIT | GL_MAP_PERSISTENT_BIT | GL_MAP_COHERENT_BIT;
  const auto bytes = static_cast<GLsizeiptr>(capacity_ * framesUnderWay);
  buffer_ = graphics::Buffer(bytes, nullptr, access);
  mapped_ = static_cast<std::byte*>(glMapNamedBufferRange(buffer_.id(), 0, bytes, access));
  fences_ = {};
  used_ = 0;
}

void UniformRing::beginFrame() {
  segment_ = (segment_ + 1) % framesUnderWay;
  // Three frames ago; it has long passed unless the driver runs that far behind, and then waiting is right.
  fences_[segment_].wait(std::chrono::seconds(1));
  used_ = 0;
}

void UniformRing::endFrame() {
  fences_[segment_] = graphics::Fence::insert();
}

void UniformRing::reserve(std::size_t bytes) {
  if (used_ + bytes > capacity_) {
    // What this frame has bound already keeps the old buffer alive in the driver.
    allocate(std::max(2 * capacity_, bytes));
  }
}

UniformRing::Block UniformRing::take(std::size_t bytes) {
  const std::size_t size = aligned(bytes);
  assert(used_ + size <= capacity_);
  const std::size_t offset = segment_ * capacity_ + used_;
  used_ += size;
  return {mapped_ + offset, static_cast<GLintptr>(offset), static_cast<GLsizeiptr>(size)};
}

void UniformRing::bind(GLuint binding, const Block& block) const {
  glBindBufferRange(GL_UNIFORM_BUFFER, binding, buffer_.id(), block.offset, block.size);
}

}  // namespace meridian::globebrowsing

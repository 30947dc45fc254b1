#include "host/graphics/frame_fence.h"

#include <algorithm>
#include <cassert>

namespace meridian::graphics {

void FrameFence::mark(std::size_t framesAhead) {
  assert(framesAhead >= 1 && framesAhead < depth);
  fences_[next_] = Fence::insert();
  next_ = (next_ + 1) % depth;
  const Fence& oldest = fences_[(next_ + depth - 1 - std::min(framesAhead, depth - 1)) % depth];
  oldest.wait(std::chrono::seconds(1));
}

bool FrameFence::wait(std::chrono::nanoseconds limit) {
  // Commands end in their order: the last fence speaks for all.
  return fences_[(next_ + depth - 1) % depth].wait(limit);
}

}  // namespace meridian::graphics

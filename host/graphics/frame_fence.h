#pragma once

#include <array>
#include <chrono>
#include <cstddef>

#include "host/graphics/gl_objects.h"

namespace meridian::graphics {

/// Where frames end on the GPU: for timing frames without a window, and to keep the CPU from running ahead.
class FrameFence {
 public:
  /// After the last command of a frame. Waits when more than `framesAhead` (1 to 3) earlier frames are unfinished.
  void mark(std::size_t framesAhead = 2);
  /// Waits until every marked frame is drawn, at most `limit`; whether it was.
  bool wait(std::chrono::nanoseconds limit = std::chrono::seconds(10));

 private:
  static constexpr std::size_t depth = 4;
  std::array<Fence, depth> fences_;
  std::size_t next_ = 0;
};

}  // namespace meridian::graphics

#include "host/api/statistics.h"

namespace meridian {

void Statistics::endFrame() {
  // Doubling from here on keeps growth out of all but a handful of frames.
  if (frames_.capacity() == 0) {
    frames_.reserve(1 << 14);
  }
  frames_.push_back(frame);
  frame = {};
}

}  // namespace meridian

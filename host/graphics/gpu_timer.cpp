#include "host/graphics/gpu_timer.h"

#include <cassert>

namespace meridian::graphics {

GpuTimer::GpuTimer() {
  for (Query& query : queries_) {
    query = Query::create(GL_TIME_ELAPSED);
  }
}

void GpuTimer::begin() {
  assert(!open_);
  if (count_ < depth) {
    glBeginQuery(GL_TIME_ELAPSED, queries_[(first_ + count_) % depth].id());
    open_ = true;
  }
}

void GpuTimer::end() {
  if (open_) {
    glEndQuery(GL_TIME_ELAPSED);
    ++count_;
    open_ = false;
  }
}

std::optional<double> GpuTimer::take() {
  if (count_ == 0) {
    return std::nullopt;
  }
  const std::optional<std::uint64_t> nanoseconds = queries_[first_].result();
  if (!nanoseconds) {
    return std::nullopt;
  }
  first_ = (first_ + 1) % depth;
  --count_;
  return static_cast<double>(*nanoseconds) * 1e-6;
}

}  // namespace meridian::graphics

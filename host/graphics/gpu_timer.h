#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "host/graphics/gl_objects.h"

namespace meridian::graphics {

/// Milliseconds that the GPU spends between begin and end, without ever waiting for it: results come some frames later,
/// and a span is left out when too many are under way. Uses GL_TIME_ELAPSED, so spans cannot overlap or nest.
class GpuTimer {
 public:
  GpuTimer();
  void begin();
  void end();
  /// The oldest result not yet taken, once it is there.
  [[nodiscard]] std::optional<double> take();

 private:
  static constexpr std::size_t depth = 8;
  std::array<Query, depth> queries_;
  std::size_t first_ = 0;
  std::size_t count_ = 0;
  bool open_ = false;
};

}  // namespace meridian::graphics

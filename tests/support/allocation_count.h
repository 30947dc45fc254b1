#pragma once

#include <cstddef>

namespace meridian {

/// How often the calling thread has called operator new since it began. A program that links allocation_count.cpp has
/// its global operator new and delete replaced.
[[nodiscard]] std::size_t allocationsOfThisThread();

}  // namespace meridian

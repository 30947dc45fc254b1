#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

namespace meridian::globebrowsing {

/// What a job makes and the cache keeps: pixels, heights, meshes. Immutable once published, so any thread may read it.
class TileData {
 public:
  virtual ~TileData() = default;
  /// Of memory, for the cache's budget.
  [[nodiscard]] virtual std::size_t bytes() const = 0;
};

using TileDataPointer = std::shared_ptr<const TileData>;

}  // namespace meridian::globebrowsing

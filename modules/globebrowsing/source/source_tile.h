#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <new>
#include <span>
#include <utility>
#include <vector>

#include "globebrowsing/network/fetcher.h"
#include "globebrowsing/source/raster_reader.h"
#include "globebrowsing/source/tile_service.h"

namespace meridian::globebrowsing {

/// Leaves the elements of a vector that is resized as they are: megabytes that are written next are not zeroed first.
template <class T>
struct UninitialisedAllocator : std::allocator<T> {
  template <class U>
  struct rebind {
    using other = UninitialisedAllocator<U>;
  };
  void construct(T* place) noexcept { ::new (static_cast<void*>(place)) T; }
  template <class... Arguments>
  void construct(T* place, Arguments&&... arguments) {
    ::new (static_cast<void*>(place)) T(std::forward<Arguments>(arguments)...);
  }
};
using ByteVector = std::vector<std::uint8_t, UninitialisedAllocator<std::uint8_t>>;

enum class PixelKind : std::uint8_t { Colours, Heights };

/// A decoded tile of a service; of its pixels, those of one kind.
struct SourceTile {
  int width = 0;
  int height = 0;
  ByteVector rgba{};             ///< width * height * 4
  std::vector<float> heights{};  ///< metres; not-a-number where there are none

  [[nodiscard]] std::span<const Rgba> pixels(const Rgba*) const {
    return {reinterpret_cast<const Rgba*>(rgba.data()), rgba.size() / sizeof(Rgba)};
  }
  [[nodiscard]] std::span<const float> pixels(const float*) const { return heights; }
  [[nodiscard]] std::size_t bytes() const { return sizeof(*this) + rgba.size() + heights.size() * sizeof(float); }
};
using SourceTilePointer = std::shared_ptr<const SourceTile>;

/// An answer's body (never null) for a tile of service.matrices[matrix] -> pixels; null when it says that there is
/// nothing. On a worker.
using TileDecoder =
    std::function<Result<SourceTilePointer>(const TileService&, std::size_t matrix, PixelKind, const Fetched&)>;

}  // namespace meridian::globebrowsing

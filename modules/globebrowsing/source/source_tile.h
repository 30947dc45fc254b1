#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <new>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "globebrowsing/network/fetcher.h"
#include "globebrowsing/source/raster_reader.h"
#include "globebrowsing/source/tile_service.h"
#include "host/api/error.h"

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

/// Why a body gave no pixels.
struct TileError : Error {
  TileError(Error error, bool isOnOurSide = false) : Error(std::move(error)), isOurs(isOnOurSide) {}

  /// The body may be good: what speaks against it is our description of the service or our limits, and with others it
  /// can be a tile.
  bool isOurs = false;
};
template <class T>
using TileResult = tl::expected<T, TileError>;
/// As failure(), of what isOurs.
[[nodiscard]] inline tl::unexpected<TileError> ownFailure(std::string what, std::string where, std::string remedy) {
  return tl::make_unexpected(TileError({std::move(what), std::move(where), std::move(remedy)}, true));
}

/// An answer's body (never null) for a tile of service.matrices[matrix] -> pixels; null when it says that there is
/// nothing. On a worker.
using TileDecoder =
    std::function<TileResult<SourceTilePointer>(const TileService&, std::size_t matrix, PixelKind, const Fetched&)>;

}  // namespace meridian::globebrowsing

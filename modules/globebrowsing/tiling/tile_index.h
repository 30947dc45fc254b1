#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>

namespace meridian::globebrowsing {

/// Names one tile of a tiling. x counts columns eastward (or along the face's u), y rows from the north (or the face's
/// v = 0), both from 0 within the root.
struct TileIndex {
  std::uint8_t root = 0;
  std::uint8_t level = 0;
  std::uint32_t x = 0;
  std::uint32_t y = 0;

  auto operator<=>(const TileIndex&) const = default;
};

/// No tiling is deeper: 2^-23 of an Earth radius is under a metre, 8 more levels reach below a centimetre.
inline constexpr int maximumLevel = 30;

/// "2/14/1021/77": root, level, x, y; for messages.
[[nodiscard]] std::string toString(const TileIndex& index);

}  // namespace meridian::globebrowsing

template <>
struct std::hash<meridian::globebrowsing::TileIndex> {
  std::size_t operator()(const meridian::globebrowsing::TileIndex& index) const noexcept;
};

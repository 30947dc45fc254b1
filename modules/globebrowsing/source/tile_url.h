#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "globebrowsing/source/tile_service.h"

namespace meridian::globebrowsing {

/// What stands in a tile's address for the tile.
enum class UrlPart : std::uint8_t {
  Literal,
  Matrix,      ///< the matrix's identifier, escaped
  MatrixAsIs,  ///< the identifier of a matrix that is named by an address
  Column,      ///< likewise the next three
  Row,         ///< from the north
  RowFromSouth,
  ColumnInThrees,  ///< 000/012/345
  RowInThrees,     ///< from the north
  RowFromSouthInThrees,
  QuadKey,  ///< Bing's: a digit a level, from the coarsest; matrices' identifiers are levels
  Server,   ///< one of a list, the same for the same tile
  West,     ///< of the tile, in units of the CRS; likewise the next three
  South,
  East,
  North,
  Width,  ///< pixels of a tile
  Height
};

/// An address with places for a tile's numbers, cut up once. Immutable; safe from any thread.
class TileUrl {
 public:
  struct Piece {
    UrlPart part = UrlPart::Literal;
    std::string text{};  ///< of a Literal
  };
  /// A placeholder as it is written, and what it stands for: {"${x}", {{UrlPart::Column}}}.
  struct Placeholder {
    std::string_view written;
    std::vector<Piece> pieces;
  };

  /// Cuts `address` at the placeholders; what is none of them stays. Compared without case.
  [[nodiscard]] static TileUrl cut(std::string_view address, const std::vector<Placeholder>& placeholders);

  /// What there is of servers for UrlPart::Server.
  void setServers(std::vector<std::string> servers) { servers_ = std::move(servers); }
  /// Rows that the whole matrix has, one number a matrix: for RowFromSouth.
  void setRowCounts(std::vector<std::int64_t> counts) { rowCounts_ = std::move(counts); }

  [[nodiscard]] bool has(UrlPart part) const;
  [[nodiscard]] std::string operator()(const TileAddress& address, const TileMatrix& matrix) const;

  /// What TileService::url wants: the addresses of tiles of these matrices.
  [[nodiscard]] static std::function<std::string(const TileAddress&)> bind(TileUrl url,
                                                                           std::vector<TileMatrix> matrices);

 private:
  std::vector<Piece> pieces_;
  std::vector<std::string> servers_;
  std::vector<std::int64_t> rowCounts_;
};

}  // namespace meridian::globebrowsing

#include "globebrowsing/source/tile_url.h"

#include <algorithm>
#include <cassert>
#include <memory>

#include <fmt/format.h>

#include "globebrowsing/source/service_text.h"

namespace meridian::globebrowsing {

namespace {

std::string inThrees(std::int64_t value) {
  return fmt::format("{:03}/{:03}/{:03}", value / 1000000, value / 1000 % 1000, value % 1000);
}

std::string quadKey(const TileAddress& address, const TileMatrix& matrix) {
  const long long level = std::clamp(integer(matrix.identifier).value_or(0), 0LL, 62LL);
  std::string key;
  for (long long bit = level - 1; bit >= 0; --bit) {
    key += static_cast<char>('0' + ((address.column >> bit) & 1) + 2 * ((address.row >> bit) & 1));
  }
  return key;
}

}  // namespace

TileUrl TileUrl::cut(std::string_view address, const std::vector<Placeholder>& placeholders) {
  TileUrl url;
  std::string literal;
  const auto flush = [&] {
    if (!literal.empty()) {
      url.pieces_.push_back({UrlPart::Literal, std::move(literal)});
      literal.clear();
    }
  };
  while (!address.empty()) {
    const auto found = std::find_if(placeholders.begin(), placeholders.end(), [&](const Placeholder& placeholder) {
      return equalIgnoringCase(address.substr(0, placeholder.written.size()), placeholder.written);
    });
    if (found == placeholders.end()) {
      literal += address.front();
      address.remove_prefix(1);
      continue;
    }
    for (const Piece& piece : found->pieces) {
      if (piece.part == UrlPart::Literal) {
        literal += piece.text;
      } else {
        flush();
        url.pieces_.push_back(piece);
      }
    }
    address.remove_prefix(found->written.size());
  }
  flush();
  return url;
}

bool TileUrl::has(UrlPart part) const {
  return std::any_of(pieces_.begin(), pieces_.end(), [&](const Piece& piece) { return piece.part == part; });
}

std::string TileUrl::operator()(const TileAddress& address, const TileMatrix& matrix) const {
  const auto southRow = [&] {
    assert(address.matrix < rowCounts_.size());
    return rowCounts_[address.matrix] - 1 - address.row;
  };
  const double width = matrix.tileWidth * matrix.pixelWidth;
  const double height = matrix.tileHeight * matrix.pixelHeight;
  std::string result;
  for (const Piece& piece : pieces_) {
    switch (piece.part) {
      case UrlPart::Literal:
        result += piece.text;
        break;
      case UrlPart::Matrix:
        result += percentEncoded(matrix.identifier, ":");
        break;
      case UrlPart::MatrixAsIs:
        result += matrix.identifier;
        break;
      case UrlPart::Column:
        result += std::to_string(address.column);
        break;
      case UrlPart::Row:
        result += std::to_string(address.row);
        break;
      case UrlPart::RowFromSouth:
        result += std::to_string(southRow());
        break;
      case UrlPart::ColumnInThrees:
        result += inThrees(address.column);
        break;
      case UrlPart::RowInThrees:
        result += inThrees(address.row);
        break;
      case UrlPart::RowFromSouthInThrees:
        result += inThrees(southRow());
        break;
      case UrlPart::QuadKey:
        result += quadKey(address, matrix);
        break;
      case UrlPart::Server:
        if (!servers_.empty()) {
          result += servers_[static_cast<std::size_t>(address.column + address.row) % servers_.size()];
        }
        break;
      case UrlPart::West:
        result += decimal(matrix.left + static_cast<double>(address.column) * width);
        break;
      case UrlPart::East:
        result += decimal(matrix.left + static_cast<double>(address.column + 1) * width);
        break;
      case UrlPart::North:
        result += decimal(matrix.top - static_cast<double>(address.row) * height);
        break;
      case UrlPart::South:
        result += decimal(matrix.top - static_cast<double>(address.row + 1) * height);
        break;
      case UrlPart::Width:
        result += std::to_string(matrix.tileWidth);
        break;
      case UrlPart::Height:
        result += std::to_string(matrix.tileHeight);
        break;
    }
  }
  return result;
}

std::function<std::string(const TileAddress&)> TileUrl::bind(TileUrl url, std::vector<TileMatrix> matrices) {
  struct Bound {
    TileUrl url;
    std::vector<TileMatrix> matrices;
  };
  auto bound = std::make_shared<const Bound>(Bound{std::move(url), std::move(matrices)});
  return [bound](const TileAddress& address) {
    assert(address.matrix < bound->matrices.size());
    return bound->url(address, bound->matrices[address.matrix]);
  };
}

}  // namespace meridian::globebrowsing

#include "globebrowsing/source/tile_plan.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "globebrowsing/source/resample_parts.h"

namespace meridian::globebrowsing {

namespace {

std::unique_ptr<Projection> cloneOf(const ServicePyramid& pyramid) {
  const Projection* projection = pyramid.pyramid().georeference.projection();
  return projection != nullptr ? std::make_unique<Projection>(projection->clone()) : nullptr;
}

bool contains(const PixelWindow& outer, const PixelWindow& inner) {
  return inner.x >= outer.x && inner.y >= outer.y && inner.x + inner.width <= outer.x + outer.width &&
         inner.y + inner.height <= outer.y + outer.height;
}

PixelWindow united(const PixelWindow& a, const PixelWindow& b) {
  const int x = std::min(a.x, b.x);
  const int y = std::min(a.y, b.y);
  return {x, y, std::max(a.x + a.width, b.x + b.width) - x, std::max(a.y + a.height, b.y + b.height) - y};
}

PixelWindow intersection(const PixelWindow& a, const PixelWindow& b) {
  const int x = std::max(a.x, b.x);
  const int y = std::max(a.y, b.y);
  return {x, y, std::max(0, std::min(a.x + a.width, b.x + b.width) - x),
          std::max(0, std::min(a.y + a.height, b.y + b.height) - y)};
}

/// The place of a pixel's centre in full resolution, within the picture.
double placeOf(int pixel, double offset, double scale, int size) {
  return std::clamp((pixel + 0.5 - offset) * scale, 0.0, double{1.0} * size);
}

Taps tapsFor(PixelKind kind, double centre) {
  return kind == PixelKind::Colours ? triangleTaps(centre, 1.0) : cubicTaps(centre, 1.0);
}

}  // namespace

TilePlan::TilePlan(const ServicePyramid& pyramid) : pyramid_(pyramid), projection_(cloneOf(pyramid)) {}

Result<void> TilePlan::fetch(std::size_t level, const UnboundedWindow& window, Rgba* /*out*/,
                             const std::stop_token& /*stop*/) {
  note(level, window);
  return {};
}

Result<void> TilePlan::fetch(std::size_t level, const UnboundedWindow& window, float* /*out*/,
                             const std::stop_token& /*stop*/) {
  note(level, window);
  return {};
}

void TilePlan::note(std::size_t level, const UnboundedWindow& window) {
  if (last_ != nullptr && last_->level == level && contains(last_->pixels, window)) {
    return;
  }
  // Before a window is looked at closely, which takes as long as it is large.
  const double across = double{1.0} * window.width / pyramid_.tileWidth(level);
  const double down = double{1.0} * window.height / pyramid_.tileHeight(level);
  isGivenUp_ = isGivenUp_ || tiles_.size() > mostTiles || std::max(across, 1.0) * std::max(down, 1.0) > mostTiles;
  if (isGivenUp_) {
    tiles_.clear();
    last_ = nullptr;
    return;
  }
  for (const WindowPiece& piece : piecesOf(pyramid(), level, window)) {
    pyramid_.forEachTile(level, piece.from, [&](const TilePart& part) {
      const auto [found, isNew] = tiles_.try_emplace(part.address);
      PlannedTile& tile = found->second;
      if (isNew) {
        tile.isAsked = pyramid_.has(level, part.address);
        tile.isAbsent = !tile.isAsked;
        tile.level = level;
        tile.pixels = part.pixels;
      }
      tile.pixels = united(tile.pixels, part.pixels);
      last_ = &tile;
    });
  }
}

void TilePlan::addStandIns(PixelKind kind) {
  // Stand-ins are of coarser levels only, and are looked at again when they turn out to be absent too.
  for (bool isChanged = true; isChanged && !isGivenUp_;) {
    isChanged = false;
    std::vector<PlannedTile*> known;  // a map's elements stay where they are
    for (auto& [address, tile] : tiles_) {
      known.push_back(&tile);
    }
    for (PlannedTile* one : known) {
      PlannedTile& tile = *one;
      if (isGivenUp_) {
        return;
      }
      if (!tile.isAbsent || tile.standIn == tile.pixels || tile.level + 1 >= pyramid().levels.size()) {
        continue;
      }
      tile.standIn = tile.pixels;
      isChanged = true;
      const PyramidLevel& own = pyramid().levels[tile.level];
      const PyramidLevel& coarser = pyramid().levels[tile.level + 1];
      const auto x = [&](int pixel) {
        return coarser.centreX(placeOf(pixel, own.offsetX, own.scaleX, pyramid().georeference.width()));
      };
      const auto y = [&](int pixel) {
        return coarser.centreY(placeOf(pixel, own.offsetY, own.scaleY, pyramid().georeference.height()));
      };
      const Taps left = tapsFor(kind, x(tile.pixels.x));
      const Taps right = tapsFor(kind, x(tile.pixels.x + tile.pixels.width - 1));
      const Taps upper = tapsFor(kind, y(tile.pixels.y));
      const Taps lower = tapsFor(kind, y(tile.pixels.y + tile.pixels.height - 1));
      note(tile.level + 1,
           {left.first, upper.first, right.first + right.count - left.first, lower.first + lower.count - upper.first});
    }
  }
}

TileMosaic::TileMosaic(const ServicePyramid& pyramid, const PlannedTiles& tiles, const HeightLimits& limits)
    : pyramid_(pyramid), projection_(cloneOf(pyramid)), tiles_(tiles), limits_(limits) {}

template <class Pixel>
Result<void> TileMosaic::fill(const TilePart& part, const PlannedTile& planned, Pixel* out, std::ptrdiff_t stride,
                              const std::stop_token& stop) {
  const PixelWindow needed = intersection(part.pixels, planned.pixels);
  const PyramidLevel& own = pyramid().levels[planned.level];
  if (needed.width == 0 || needed.height == 0 || planned.level + 1 >= pyramid().levels.size()) {
    return {};
  }
  std::vector<double> columns;
  std::vector<double> rows;
  std::vector<Pixel> pixels;
  for (int y = needed.y; y < needed.y + needed.height; ++y) {
    for (int x = needed.x; x < needed.x + needed.width; ++x) {
      columns.push_back(placeOf(x, own.offsetX, own.scaleX, pyramid().georeference.width()));
      rows.push_back(placeOf(y, own.offsetY, own.scaleY, pyramid().georeference.height()));
    }
  }
  Pixel* target = out + (needed.y - part.pixels.y) * stride + (needed.x - part.pixels.x);
  pixels.assign(columns.size(), *target);  // absent, as all that has not been written
  auto done = samplePoints(*this, {planned.level + 1}, columns, rows, pixels.data(), stop);
  for (int y = 0; y < needed.height; ++y) {
    std::copy_n(pixels.begin() + std::ptrdiff_t{1} * y * needed.width, needed.width, target + y * stride);
  }
  return done;
}

template <class Pixel>
Result<void> TileMosaic::assemble(std::size_t level, const UnboundedWindow& window, Pixel* out,
                                  const std::stop_token& stop) {
  Result<void> done;
  for (const WindowPiece& piece : piecesOf(pyramid(), level, window)) {
    pyramid_.forEachTile(level, piece.from, [&](const TilePart& part) {
      const auto found = tiles_.find(part.address);
      if (found == tiles_.end() || !done) {
        return;
      }
      const PlannedTile& planned = found->second;
      Pixel* target = out + std::ptrdiff_t{1} * (piece.row + part.pixels.y - piece.from.y) * window.width +
                      (piece.column + part.pixels.x - piece.from.x);
      if (planned.tile == nullptr) {
        done = fill(part, planned, target, window.width, stop);
        return;
      }
      const std::span<const Pixel> pixels = planned.tile->pixels(out);
      for (int y = 0; y < part.pixels.height; ++y) {
        const auto from = pixels.begin() + std::ptrdiff_t{1} * (part.row + y) * planned.tile->width + part.column;
        std::copy_n(from, part.pixels.width, target + std::ptrdiff_t{1} * y * window.width);
      }
    });
  }
  return done;
}

Result<void> TileMosaic::fetch(std::size_t level, const UnboundedWindow& window, Rgba* out,
                               const std::stop_token& stop) {
  std::fill_n(out, std::ptrdiff_t{1} * window.width * window.height, Rgba{});
  return assemble(level, window, out, stop);
}

Result<void> TileMosaic::fetch(std::size_t level, const UnboundedWindow& window, float* out,
                               const std::stop_token& stop) {
  const std::ptrdiff_t count = std::ptrdiff_t{1} * window.width * window.height;
  std::fill_n(out, count, noHeight);
  auto done = assemble(level, window, out, stop);
  std::replace_if(
      out, out + count,
      [this](float metres) {
        const bool isWild = !std::isnan(metres) && !limits_.hold(metres);
        implausible_ = isWild && !implausible_ ? metres : implausible_;
        return isWild;
      },
      noHeight);
  return done;
}

}  // namespace meridian::globebrowsing

#pragma once

#include <cstddef>
#include <utility>

#include "globebrowsing/source/resample.h"
#include "globebrowsing/streaming/tile_data.h"

namespace meridian::globebrowsing {

/// Colours of one provider on one tile, ready to be uploaded; no pixels where the provider has nothing.
class ColourTile final : public TileData {
 public:
  explicit ColourTile(ColourPixels pixels) : pixels_(std::move(pixels)) {}
  [[nodiscard]] const ColourPixels& pixels() const { return pixels_; }
  [[nodiscard]] std::size_t bytes() const override { return sizeof(*this) + pixels_.rgba.capacity(); }

 private:
  ColourPixels pixels_;
};

/// Heights of one provider on one tile, before settings and composition.
class HeightTile final : public TileData {
 public:
  explicit HeightTile(HeightPixels pixels) : pixels_(std::move(pixels)) {}
  [[nodiscard]] const HeightPixels& pixels() const { return pixels_; }
  [[nodiscard]] std::size_t bytes() const override { return sizeof(*this) + pixels_.metres.capacity() * sizeof(float); }

 private:
  HeightPixels pixels_;
};

}  // namespace meridian::globebrowsing

#pragma once

#include <cstddef>
#include <utility>

#include "globebrowsing/source/resample.h"
#include "globebrowsing/streaming/tile_data.h"

namespace meridian::globebrowsing {

/// Colours of one provider on one tile, ready to be uploaded; no pixels where the provider has nothing.
class ColourTile final : public TileData {
 public:
  explicit ColourTile(ColourPixels pixels) : pixels_(std::move(pixels)), isOpaque_(pixels_.anyOpaque) {
    for (std::size_t alpha = 3; alpha < pixels_.rgba.size() && isOpaque_; alpha += 4) {
      isOpaque_ = pixels_.rgba[alpha] == 255;
    }
  }
  [[nodiscard]] const ColourPixels& pixels() const { return pixels_; }
  /// Whether all of it is: nothing below it is seen.
  [[nodiscard]] bool isOpaque() const { return isOpaque_; }
  [[nodiscard]] std::size_t bytes() const override { return sizeof(*this) + pixels_.rgba.capacity(); }

 private:
  ColourPixels pixels_;
  bool isOpaque_ = false;
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

#include "globebrowsing/providers/single_image_provider.h"

#include <algorithm>
#include <array>
#include <numbers>

namespace meridian::globebrowsing {

namespace {

constexpr double pi = std::numbers::pi;

/// Where the image is taken to lie, so that the resampler can fit it to any layout: far from the antimeridian and the
/// poles, where it would continue on the other side.
constexpr std::array<double, 4> imageDegrees{-90.0, -45.0, 90.0, 45.0};

/// A single tile whose unit square is the image. Beyond the edges the image's outermost pixels go on.
class ImageTiling final : public Tiling {
 public:
  using Tiling::Tiling;
  [[nodiscard]] int rootCount() const override { return 1; }
  [[nodiscard]] Children children(const TileIndex& /*index*/) const override { return {}; }
  [[nodiscard]] std::optional<TileIndex> parent(const TileIndex& /*index*/) const override { return std::nullopt; }
  [[nodiscard]] UnitSquareTransform inParent(const TileIndex& /*index*/) const override { return {}; }
  [[nodiscard]] std::optional<Neighbour> neighbour(const TileIndex& /*index*/, Edge /*edge*/) const override {
    return std::nullopt;
  }
  [[nodiscard]] GeodeticPosition geodetic(const TileIndex& /*index*/, const glm::dvec2& uv) const override {
    const double u = std::clamp(uv.x, 0.0, 1.0);
    const double v = std::clamp(uv.y, 0.0, 1.0);
    return {pi / 2.0 * (0.5 - v), pi * (u - 0.5), 0.0};
  }
  [[nodiscard]] TilePlace locate(double latitude, double longitude, int /*level*/) const override {
    return {TileIndex{}, {longitude / pi + 0.5, 0.5 - 2.0 * latitude / pi}};
  }
  [[nodiscard]] bool isSeparable() const override { return true; }
};

const ImageTiling& imageTiling() {
  static const ImageTiling tiling(*Ellipsoid::fromRadii(glm::dvec3(1.0)));
  return tiling;
}

}  // namespace

const Schema& SingleImageProvider::schema() {
  static const Schema fields(
      {{"FilePath", Schema::Type::String, "an image file, relative to the asset's folder or absolute", true}});
  return fields;
}

Result<std::shared_ptr<TileProvider>> SingleImageProvider::make(const ProviderRequest& request) {
  return std::make_shared<SingleImageProvider>(dataPath(*request.table.find("FilePath")->string(), request.folder),
                                               placeOf(request, "FilePath"));
}

Result<void> SingleImageProvider::check() const {
  return checkData(path_, where_);
}

Result<void> SingleImageProvider::openData() {
  if (Result<void> checked = check(); !checked) {
    return checked;
  }
  RasterDescription description;
  description.path = path_.text;
  description.where = where_;
  description.extentDegrees = imageDegrees;
  return RasterSource::open(description)
      .and_then([this](std::shared_ptr<RasterSource> source) {
        source_ = std::move(source);
        return resampleColours(*source_, imageTiling(), TileIndex{}, colourLayout, {});
      })
      .map([this](ColourPixels colours) { colours_ = std::move(colours); });
}

Result<ColourPixels> SingleImageProvider::makeColours(const Tiling& /*tiling*/, const TileIndex& /*index*/,
                                                      std::stop_token /*stop*/) const {
  return colours_;
}

Result<HeightPixels> SingleImageProvider::makeHeights(const Tiling& /*tiling*/, const TileIndex& /*index*/,
                                                      const TileLayout& layout, std::stop_token stop) const {
  return resampleHeights(*source_, imageTiling(), TileIndex{}, layout, std::move(stop));
}

bool SingleImageProvider::dataOverlap(const Tiling& /*tiling*/, const TileIndex& /*index*/) const {
  return true;
}

bool SingleImageProvider::dataFiner(const Tiling& /*tiling*/, const TileIndex& index,
                                    const TileLayout& /*layout*/) const {
  return index.level < maximumLevel;  // the next level shows the image again, four times smaller
}

}  // namespace meridian::globebrowsing

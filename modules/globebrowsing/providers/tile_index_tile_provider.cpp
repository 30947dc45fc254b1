#include "globebrowsing/providers/tile_index_tile_provider.h"

#include <cmath>

#include <fmt/format.h>

#include "globebrowsing/providers/inner_providers.h"

namespace meridian::globebrowsing {

namespace {

class IndexTiles final : public DrawnTileProvider {
 public:
  explicit IndexTiles(bool unique) : unique_(unique) {}

 private:
  [[nodiscard]] Result<ColourPixels> makeColours(const Tiling& /*tiling*/, const TileIndex& index,
                                                 std::stop_token /*stop*/) const override {
    constexpr Rgba white{255, 255, 255, 255};
    constexpr Rgba black{0, 0, 0, 255};
    constexpr int side = colourLayout.interior;
    constexpr int middle = side / 2;
    TileCanvas canvas(unique_ ? uniqueColour(index) : Rgba{0, 0, 0, 0});
    for (const glm::ivec2& corner : {glm::ivec2(0, 0), glm::ivec2(0, side - 1)}) {
      canvas.rectangle(corner, {side, 1}, white);
      canvas.rectangle({corner.y, corner.x}, {1, side}, white);
    }
    // Level 30 has ten digits: 4 pixels a unit leave room for them.
    canvas.text({middle, middle - 100}, 4, fmt::format("root {}", index.root), white, black);
    canvas.text({middle, middle - 35}, 4, fmt::format("level {}", index.level), white, black);
    canvas.text({middle, middle + 35}, 4, fmt::format("x {}", index.x), white, black);
    canvas.text({middle, middle + 100}, 4, fmt::format("y {}", index.y), white, black);
    return canvas.take();
  }

  bool unique_;
};

}  // namespace

Rgba uniqueColour(const TileIndex& index) {
  // Hues a golden section apart never come near each other soon; rows, columns and levels go on differently.
  const double turns =
      0.618033988749895 * index.x + 0.381966011250105 * 0.5 * index.y + 0.2763932 * index.level + 0.5 * index.root;
  const double hue = 6.0 * (turns - std::floor(turns));
  const auto channel = [hue](double offset) {
    const double distance = std::abs(std::fmod(hue + offset, 6.0) - 3.0);
    return static_cast<std::uint8_t>(std::lround(40.0 + 150.0 * std::min(1.0, std::max(0.0, distance - 1.0))));
  };
  return {channel(0.0), channel(4.0), channel(2.0), 255};
}

const Schema& TileIndexTileProvider::schema() {
  static const Schema fields(
      {{"UniqueBackgroundColors", Schema::Type::Boolean, "whether each tile has a background of a colour of its own"}});
  return fields;
}

Result<std::shared_ptr<TileProvider>> TileIndexTileProvider::make(const ProviderRequest& request) {
  return std::make_shared<TileIndexTileProvider>(
      valueAt(request.table, "UniqueBackgroundColors").boolean().value_or(false));
}

TileIndexTileProvider::TileIndexTileProvider(bool unique)
    : uniqueBackgroundColour({"UniqueBackgroundColor", "Unique background color",
                              "Whether each tile has a background of a colour of its own"},
                             unique) {
  owner_.addProperty(uniqueBackgroundColour);
}

TileStep TileIndexTileProvider::at(const Time& /*now*/) const {
  TileStep step;
  step.id = uniqueBackgroundColour.get() ? 1 : 0;
  return step;
}

Result<std::shared_ptr<TileProvider>> TileIndexTileProvider::make(const Time& /*now*/) const {
  return std::make_shared<IndexTiles>(uniqueBackgroundColour.get());
}

}  // namespace meridian::globebrowsing

#include "globebrowsing/providers/size_reference_tile_provider.h"

#include <vector>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "globebrowsing/providers/inner_providers.h"
#include "globebrowsing/providers/tile_canvas.h"

namespace meridian::globebrowsing {

const Schema& SizeReferenceTileProvider::schema() {
  static const Schema fields({{"Radii", Schema::Type::NumberOrVector3,
                               "the semi-axes in metres of the ellipsoid to measure on; the globe's when absent"}});
  return fields;
}

Result<std::shared_ptr<TileProvider>> SizeReferenceTileProvider::make(const ProviderRequest& request) {
  const Value& radii = valueAt(request.table, "Radii");
  if (radii.isNil()) {
    return std::make_shared<SizeReferenceTileProvider>(std::nullopt);
  }
  const std::vector<double> three = radii.numbers(3).value_or(std::vector<double>(3, radii.number().value_or(0.0)));
  Result<Ellipsoid> ellipsoid = Ellipsoid::fromRadii({three[0], three[1], three[2]});
  if (!ellipsoid) {
    ellipsoid.error().where = placeOf(request, "Radii");
    return tl::make_unexpected(std::move(ellipsoid.error()));
  }
  return std::make_shared<SizeReferenceTileProvider>(*ellipsoid);
}

double SizeReferenceTileProvider::widthOf(const Tiling& tiling, const TileIndex& index) const {
  const Ellipsoid& ellipsoid = ellipsoid_ ? *ellipsoid_ : tiling.ellipsoid();
  constexpr int pieces = 64;
  double length = 0.0;
  glm::dvec3 last = ellipsoid.cartesian(tiling.geodetic(index, {0.0, 0.5}));
  for (int i = 1; i <= pieces; ++i) {
    const glm::dvec3 next = ellipsoid.cartesian(tiling.geodetic(index, {double{1.0} * i / pieces, 0.5}));
    length += glm::distance(last, next);
    last = next;
  }
  return length;
}

std::string SizeReferenceTileProvider::lengthText(double metres) {
  const auto [unit, factor] = metres >= 1000.0 ? std::pair("km", 1e-3)
                              : metres >= 1.0  ? std::pair("m", 1.0)
                                               : std::pair("cm", 100.0);
  const double length = metres * factor;
  return fmt::format("{:.{}f} {}", length, length < 10.0 ? 1 : 0, unit);
}

Result<ColourPixels> SizeReferenceTileProvider::makeColours(const Tiling& tiling, const TileIndex& index,
                                                            std::stop_token /*stop*/) const {
  constexpr Rgba white{255, 255, 255, 255};
  constexpr Rgba black{0, 0, 0, 255};
  constexpr int side = colourLayout.interior;
  constexpr int line = side / 2;
  constexpr int head = 12;
  TileCanvas canvas({0, 0, 0, 0});
  // An arrow from edge to edge.
  canvas.rectangle({0, line - 2}, {side, 5}, black);
  canvas.rectangle({1, line - 1}, {side - 2, 3}, white);
  for (int x = 0; x < head; ++x) {
    const int half = x / 2 + 1;
    canvas.rectangle({x, line - half}, {1, 2 * half + 1}, white);
    canvas.rectangle({side - 1 - x, line - half}, {1, 2 * half + 1}, white);
  }
  canvas.text({side / 2, line - 40}, 5, lengthText(widthOf(tiling, index)), white, black);
  return canvas.take();
}

}  // namespace meridian::globebrowsing

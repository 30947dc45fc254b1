// Onto a tiling whose rows are no parallels and whose columns are no meridians, as faces of a cube are.
#include <cmath>

#include <glm/gtc/matrix_transform.hpp>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "raster_fixture.h"

namespace meridian::globebrowsing {
namespace {

using namespace test;

/// The geodetic tiling turned about the equator's axis at longitude 0, so that its pole lies at 30 degrees north: the
/// body's poles and its antimeridian are inside tiles, and no line of samples keeps a latitude or longitude.
class TurnedTiling final : public Tiling {
 public:
  TurnedTiling() : Tiling(earth().ellipsoid()), inner_(earth()) {}
  [[nodiscard]] int rootCount() const override { return inner_.rootCount(); }
  [[nodiscard]] Children children(const TileIndex& index) const override { return inner_.children(index); }
  [[nodiscard]] std::optional<TileIndex> parent(const TileIndex& index) const override { return inner_.parent(index); }
  [[nodiscard]] UnitSquareTransform inParent(const TileIndex& index) const override { return inner_.inParent(index); }
  [[nodiscard]] std::optional<Neighbour> neighbour(const TileIndex& index, Edge edge) const override {
    return inner_.neighbour(index, edge);
  }
  [[nodiscard]] GeodeticPosition geodetic(const TileIndex& index, const glm::dvec2& uv) const override {
    return turned(inner_.geodetic(index, uv), turn_);
  }
  [[nodiscard]] TilePlace locate(double latitude, double longitude, int level) const override {
    const GeodeticPosition place = turned({latitude, longitude}, glm::transpose(turn_));
    return inner_.locate(place.latitude, place.longitude, level);
  }

 private:
  static GeodeticPosition turned(const GeodeticPosition& place, const glm::dmat3& turn) {
    const glm::dvec3 normal =
        turn * glm::dvec3(std::cos(place.latitude) * std::cos(place.longitude),
                          std::cos(place.latitude) * std::sin(place.longitude), std::sin(place.latitude));
    return {std::atan2(normal.z, std::hypot(normal.x, normal.y)), std::atan2(normal.y, normal.x)};
  }

  GeodeticTiling inner_;
  glm::dmat3 turn_ = glm::dmat3(glm::rotate(glm::dmat4(1.0), 60.0 * degree, glm::dvec3(1.0, 0.0, 0.0)));
};

/// Smooth everywhere on the sphere; metres.
double wave(const GeodeticPosition& place) {
  return 1000.0 * std::sin(2.0 * place.longitude + 0.3) * std::pow(std::cos(place.latitude), 2.0);
}

/// Of all samples of the heights' tile that has the place, the border's too.
double worstError(const RasterSource& source, const Tiling& tiling, const TileIndex& index) {
  const HeightPixels pixels = heights(source, tiling, index);
  const int size = heightLayout.size();
  EXPECT_EQ(pixels.metres.size(), static_cast<std::size_t>(size * size)) << toString(index);
  double worst = 0.0;
  for (std::size_t i = 0; i < pixels.metres.size(); ++i) {
    const glm::dvec2 uv = heightLayout.uv(static_cast<int>(i) % size, static_cast<int>(i) / size);
    const double error = std::abs(double{pixels.metres[i]} - wave(tiling.geodetic(index, uv)));
    worst = error <= worst ? worst : error;  // not-a-number is taken over
  }
  return worst;
}

struct Where {
  double latitude;
  double longitude;
};
constexpr std::array places{Where{90.0, 0.0},  Where{-90.0, 0.0}, Where{89.7, 40.0},   Where{30.0, 179.99},
                            Where{5.0, -0.01}, Where{30.0, 90.0}, Where{-41.0, -100.0}};

TEST(ResampleOntoAnyTiling, HeightsOfAGlobalRaster) {
  for (const double west : {0.0, -180.0}) {
    const double pixel = 0.25;
    const MadeRaster raster({1440, 720, northUp(west, 90, pixel)}, [&](int, int column, int row) {
      return wave({(90 - pixel * (row + 0.5)) * degree, (west + pixel * (column + 0.5)) * degree});
    });
    const auto source = open({raster.path()});
    const TurnedTiling tiling;
    for (const Where& place : places) {
      for (const int level : {0, 2, 4, 7}) {
        const TileIndex index = tileAt(tiling, place.latitude, place.longitude, level);
        // A coarse level's mean lies below the wave.
        EXPECT_LT(worstError(*source, tiling, index), level == 0 ? 1.5 : 0.3)
            << place.latitude << ' ' << place.longitude << ' ' << toString(index);
      }
    }
  }
}

TEST(ResampleOntoAnyTiling, HeightsInAPolarProjection) {
  constexpr int size = 1024;
  constexpr double half = 4194304.0;
  constexpr double pixel = 2 * half / size;
  OGRSpatialReference polar;
  polar.SetFromUserInput("EPSG:3413");
  OGRSpatialReference geographic;
  geographic.SetFromUserInput("EPSG:4326");
  geographic.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  const std::unique_ptr<OGRCoordinateTransformation> toDegrees(OGRCreateCoordinateTransformation(&polar, &geographic));
  const MadeRaster raster({size, size, {-half, pixel, 0, half, 0, -pixel}, GDT_Float64, 1, "EPSG:3413"},
                          [&](int, int column, int row) {
                            double x = -half + pixel * (column + 0.5);
                            double y = half - pixel * (row + 0.5);
                            toDegrees->Transform(1, &x, &y);
                            return wave({y * degree, x * degree});
                          });
  const auto source = open({raster.path()});
  const TurnedTiling tiling;
  for (const Where& place : {Where{90.0, 0.0}, Where{80.0, 179.99}, Where{75.0, -45.0}}) {
    for (const int level : {5, 8}) {
      const TileIndex index = tileAt(tiling, place.latitude, place.longitude, level);
      EXPECT_LT(worstError(*source, tiling, index), 0.3) << place.latitude << ' ' << place.longitude;
    }
  }
  const TileIndex south = tileAt(tiling, -60.0, 0.0, 5);
  EXPECT_FALSE(heights(*source, tiling, south).any);
}

TEST(ResampleOntoAnyTiling, ColoursOfAGlobalRaster) {
  const auto shade = [](const GeodeticPosition& place) { return 127.5 + 0.1 * wave(place); };
  const double pixel = 0.25;
  const MadeRaster raster({1440, 720, northUp(-180, 90, pixel), GDT_Byte}, [&](int, int column, int row) {
    return std::round(shade({(90 - pixel * (row + 0.5)) * degree, (-180 + pixel * (column + 0.5)) * degree}));
  });
  const auto source = open({raster.path()});
  const TurnedTiling tiling;
  const int size = colourLayout.size();
  for (const Where& place : places) {
    for (const int level : {0, 3, 6}) {
      const TileIndex index = tileAt(tiling, place.latitude, place.longitude, level);
      const ColourPixels pixels = colours(*source, tiling, index);
      ASSERT_TRUE(pixels.allOpaque) << toString(index);
      double worst = 0.0;
      for (int i = 0; i < size * size; i += 7) {
        const double expected = shade(tiling.geodetic(index, colourLayout.uv(i % size, i / size)));
        worst = std::max(worst, std::abs(pixels.rgba[static_cast<std::size_t>(4 * i)] - expected));
      }
      // Half a grey level in the raster, half in the result, and what a coarse level's mean lies off.
      EXPECT_LT(worst, 1.5) << place.latitude << ' ' << place.longitude << ' ' << toString(index);
    }
  }
}

}  // namespace
}  // namespace meridian::globebrowsing

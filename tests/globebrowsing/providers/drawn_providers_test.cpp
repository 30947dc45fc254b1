// Providers that draw their tiles: sizes, indices, parallels and meridians.
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "globebrowsing/providers/graticule_tile_provider.h"
#include "globebrowsing/providers/size_reference_tile_provider.h"
#include "globebrowsing/providers/tile_canvas.h"
#include "globebrowsing/providers/tile_index_tile_provider.h"
#include "host/api/property.h"
#include "provider_fixture.h"

namespace meridian::globebrowsing {
namespace {

constexpr double degree = std::numbers::pi / 180.0;

std::shared_ptr<TileProvider> open(Fields fields) {
  auto provider = makeProvider(requestFor(std::move(fields)));
  EXPECT_TRUE(provider) << provider.error().message();
  EXPECT_TRUE((*provider)->check());
  EXPECT_TRUE((*provider)->open());
  return *provider;
}

/// The area as a picture of '#' and '.', one sign for each square of `unit` pixels.
std::string picture(const ColourPixels& pixels, int left, int top, int columns, int rows, int unit) {
  std::string text;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const Colour pixel = pixelAt(pixels, colourLayout.border + left + column * unit + unit / 2,
                                   colourLayout.border + top + row * unit + unit / 2);
      text += pixel[0] == 255 && pixel[3] == 255 ? '#' : '.';
    }
    text += '\n';
  }
  return text;
}

TEST(TileCanvas, WritesLetters) {
  TileCanvas canvas({0, 0, 0, 0});
  canvas.text({100, 100}, 4, "LT", {255, 255, 255, 255}, {0, 0, 0, 255});
  const ColourPixels pixels = canvas.take();
  EXPECT_TRUE(pixels.anyOpaque);
  EXPECT_FALSE(pixels.allOpaque);
  int left = 1000;
  int top = 1000;
  for (int row = 0; row < colourLayout.interior; ++row) {
    for (int column = 0; column < colourLayout.interior; ++column) {
      if (pixelAt(pixels, column + colourLayout.border, row + colourLayout.border)[0] == 255) {
        left = std::min(left, column);
        top = std::min(top, row);
      }
    }
  }
  EXPECT_EQ(picture(pixels, left, top, 11, 7, 4),
            "#.....#####\n"
            "#.......#..\n"
            "#.......#..\n"
            "#.......#..\n"
            "#.......#..\n"
            "#.......#..\n"
            "####....#..\n");
}

TEST(TileCanvas, CutsOffWhatIsOutside) {
  TileCanvas canvas({1, 2, 3, 4});
  canvas.rectangle({-100, -100}, {90, 90}, {255, 0, 0, 255});
  canvas.rectangle({500, 500}, {10000, 10000}, {255, 0, 0, 255});
  canvas.text({0, 0}, 40, std::string(1000, 'W'), {255, 255, 255, 255}, {0, 0, 0, 255});
  canvas.text({256, 256}, 4, "\x01\xff\n", {255, 255, 255, 255}, {0, 0, 0, 255});
  const ColourPixels pixels = canvas.take();
  EXPECT_EQ(pixelAt(pixels, 527, 527), (Colour{255, 0, 0, 255}));
  EXPECT_EQ(pixels.rgba.size(), 4U * 528U * 528U);
}

TEST(SizeReference, MeasuresTheTile) {
  const GeodeticTiling tiling = earthTiling();
  const SizeReferenceTileProvider own(std::nullopt);
  // Parallels of WGS84: a cos(latitude) / sqrt(1 - e2 sin^2(latitude)) metres a radian.
  for (const double latitude : {0.01, 0.5, -1.1, 1.5}) {
    for (const int level : {0, 3, 9, 20}) {
      const TileIndex index = tiling.locate(latitude, 0.3, level).index;
      const GeodeticPosition west = tiling.geodetic(index, {0.0, 0.5});
      const double sine = std::sin(west.latitude);
      const double radius = 6378137.0 * std::cos(west.latitude) / std::sqrt(1.0 - 0.0066943799901413165 * sine * sine);
      const double width = radius * (tiling.geodetic(index, {1.0, 0.5}).longitude - west.longitude);
      EXPECT_NEAR(own.widthOf(tiling, index), width, 1e-3 * width) << latitude << ' ' << level;
    }
  }
  const SizeReferenceTileProvider other(*Ellipsoid::fromRadii(glm::dvec3(1000.0)));
  EXPECT_NEAR(other.widthOf(tiling, tiling.locate(0.0, 0.1, 10).index), std::numbers::pi * 1000.0 / 1024.0, 1e-3);
  EXPECT_EQ(own.lengthText(20037508.0), "20038 km");
  EXPECT_EQ(own.lengthText(1234.0), "1.2 km");
  EXPECT_EQ(own.lengthText(999.4), "999 m");
  EXPECT_EQ(own.lengthText(1.0), "1.0 m");
  EXPECT_EQ(own.lengthText(0.187), "19 cm");
}

TEST(SizeReference, IsATypeWithItsOlderName) {
  const GeodeticTiling tiling = earthTiling();
  for (const Value& radii : {Value(), Value(6.4e6), Value(glm::dvec3(1e6, 2e6, 3e6))}) {
    const auto provider = open({{"Type", "SizeReferenceTileLayer"}, {"Radii", radii}});
    EXPECT_TRUE(provider->overlaps(tiling, {}));
    EXPECT_TRUE(provider->hasFinerColours(tiling, {}));
    EXPECT_TRUE(provider->colours(tiling, {1, 4, 2, 5}, {})->anyOpaque);
    EXPECT_FALSE(provider->heights(tiling, {}, heightLayout, {}));
  }
  const auto bad = makeProvider(requestFor({{"Type", "SizeReferenceTileProvider"}, {"Radii", -1.0}}));
  ASSERT_FALSE(bad);
  EXPECT_EQ(bad.error().where, "mars.asset:4: Layers.ColorLayers[1].Radii");
}

TEST(TileIndexTileProvider, ChangesItsBackgroundWhileItRuns) {
  const GeodeticTiling tiling = earthTiling();
  const auto provider = open({{"Type", "TileIndexTileLayer"}, {"UniqueBackgroundColors", true}});
  const auto tileOf = [&](const TileIndex& index) {
    const auto step = provider->steps()->make({});
    EXPECT_TRUE(step && (*step)->open());
    return *(*step)->colours(tiling, index, {});
  };
  const std::uint64_t before = provider->steps()->at({}).id;
  const ColourPixels coloured = tileOf({1, 3, 2, 4});
  EXPECT_TRUE(coloured.allOpaque);
  EXPECT_NE(coloured.rgba, tileOf({1, 3, 2, 5}).rgba);
  EXPECT_EQ(coloured.rgba, tileOf({1, 3, 2, 4}).rgba);
  ASSERT_TRUE(provider->properties()->property("UniqueBackgroundColor")->set(false));
  EXPECT_NE(provider->steps()->at({}).id, before);
  const ColourPixels plain = tileOf({1, 3, 2, 4});
  EXPECT_TRUE(plain.anyOpaque);
  EXPECT_EQ(pixelAt(plain, 60, 60)[3], 0);
}

TEST(TileIndexTileProvider, NeighboursDiffer) {
  const auto difference = [](const TileIndex& a, const TileIndex& b) {
    const Rgba first = uniqueColour(a);
    const Rgba second = uniqueColour(b);
    return std::abs(first[0] - second[0]) + std::abs(first[1] - second[1]) + std::abs(first[2] - second[2]);
  };
  for (std::uint32_t n = 0; n < 200; ++n) {
    const TileIndex index{0, 12, n, 3 * n};
    EXPECT_GT(difference(index, {0, 12, n + 1, 3 * n}), 40) << n;
    EXPECT_GT(difference(index, {0, 12, n, 3 * n + 1}), 40) << n;
    EXPECT_GT(difference(index, {0, 13, 2 * n, 6 * n}) + difference(index, {0, 12, n + 1, 3 * n}), 40) << n;
  }
}

/// Whether the graticule covers the place, by the tile of that level: 0 to 255.
int lineAt(const TileProvider& provider, double latitudeDegrees, double longitudeDegrees, int level) {
  const GeodeticTiling tiling = earthTiling();
  const TilePlace place = tiling.locate(latitudeDegrees * degree, longitudeDegrees * degree, level);
  const ColourPixels pixels = *provider.colours(tiling, place.index, {});
  const auto at = [](double unit) { return colourLayout.border + static_cast<int>(unit * colourLayout.interior); };
  return pixelAt(pixels, at(place.uv.x), at(place.uv.y))[3];
}

TEST(Graticule, SpacesLinesByLevel) {
  EXPECT_EQ(GraticuleTileProvider::spacingOf(0), 30 * 3600);
  EXPECT_EQ(GraticuleTileProvider::spacingOf(1), 30 * 3600);
  EXPECT_EQ(GraticuleTileProvider::spacingOf(2), 15 * 3600);
  for (int level = 1; level <= maximumLevel; ++level) {
    const int spacing = GraticuleTileProvider::spacingOf(level);
    EXPECT_LE(spacing, GraticuleTileProvider::spacingOf(level - 1));
    EXPECT_EQ(90 * 3600 % spacing, 0) << "the equator, the poles and the prime meridian have lines";
    for (double latitude = 0.0; latitude <= 90.0; latitude += 0.5) {
      const int meridians = GraticuleTileProvider::meridianSpacing(spacing, latitude * degree);
      EXPECT_EQ(meridians % spacing, 0);
      EXPECT_GE(meridians, GraticuleTileProvider::meridianSpacing(spacing, 0.0));
    }
    EXPECT_EQ(GraticuleTileProvider::meridianSpacing(spacing, 0.0), spacing);
    EXPECT_EQ(GraticuleTileProvider::meridianSpacing(spacing, 90.0 * degree), 90 * 3600);
  }
}

TEST(Graticule, DrawsLinesWhereTheyAre) {
  const auto provider = open({{"Type", "GraticuleTileProvider"}, {"LineWidth", 3.0}});
  for (const int level : {1, 5, 11}) {
    const double spacing = GraticuleTileProvider::spacingOf(level) / 3600.0;
    for (const double k : {0.0, 1.0, 2.0}) {
      const double beside = spacing / 2.0;
      EXPECT_EQ(lineAt(*provider, k * spacing + 1e-7, beside, level), 255) << level << ' ' << k;
      EXPECT_EQ(lineAt(*provider, beside, k * spacing + 1e-7, level), 255) << level << ' ' << k;
      EXPECT_EQ(lineAt(*provider, (k + 0.5) * spacing, beside, level), 0) << level << ' ' << k;
    }
  }
  EXPECT_EQ(lineAt(*provider, 89.99, 33.0, 3), 255) << "the pole, where the last meridians meet";
  EXPECT_EQ(lineAt(*provider, 89.5, 45.0, 5), 0) << "only four meridians go to the pole";
}

TEST(Graticule, NeighboursAgreeAndEdgesAreSoft) {
  const GeodeticTiling tiling = earthTiling();
  const auto provider =
      open({{"Type", "GraticuleTileProvider"}, {"LineWidth", 2.0}, {"LineColor", Value(glm::dvec3(1, 0, 0))}});
  const TileIndex index = tiling.locate(0.4, 0.4, 4).index;
  const ColourPixels own = *provider->colours(tiling, index, {});
  const ColourPixels east = *provider->colours(tiling, tiling.neighbour(index, Edge::East)->index, {});
  int soft = 0;
  for (int row = 0; row < own.size; ++row) {
    for (int column = 0; column < 2 * colourLayout.border; ++column) {
      EXPECT_NEAR(pixelAt(own, colourLayout.interior + column, row)[3], pixelAt(east, column, row)[3], 1);
    }
    for (int column = 0; column < own.size; ++column) {
      const Colour pixel = pixelAt(own, column, row);
      soft += pixel[3] > 0 && pixel[3] < 255 ? 1 : 0;
      EXPECT_EQ(pixel[0], 255);
    }
  }
  EXPECT_GT(soft, 500);
}

TEST(Graticule, RefusesWhatIsNoLine) {
  for (const auto& [key, value] : {std::pair("LineWidth", Value(0.0)), std::pair("LineOpacity", Value(2.0)),
                                   std::pair("LineColor", Value("red"))}) {
    const auto made = makeProvider(requestFor({{"Type", "GraticuleTileProvider"}, {key, value}}));
    ASSERT_FALSE(made) << key;
    EXPECT_EQ(made.error().where, std::string("mars.asset:4: Layers.ColorLayers[1].") + key);
  }
}

}  // namespace
}  // namespace meridian::globebrowsing

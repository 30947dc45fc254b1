#include "globebrowsing/source/tiled_service_source.h"

#include <gmock/gmock.h>

#include "tile_service_fixture.h"

namespace meridian::globebrowsing {
namespace {

using namespace test;

/// Smooth on the whole sphere, poles and antimeridian included; in -1..1.
double smooth(const GeodeticPosition& place) {
  const double x = std::cos(place.latitude) * std::cos(place.longitude);
  const double y = std::cos(place.latitude) * std::sin(place.longitude);
  const double z = std::sin(place.latitude);
  return 0.4 * x * y + 0.3 * z * x + 0.3 * y;
}

Texel texelOf(double value) {
  const auto byte = static_cast<std::uint8_t>(std::lround(127.5 + 127.5 * value));
  return {static_cast<float>(4000.0 * value), {byte, static_cast<std::uint8_t>(255 - byte), 77, 255}};
}

std::uint32_t noise(std::int64_t column, std::int64_t row) {
  auto mixed = static_cast<std::uint32_t>(column) * 2654435761U ^ static_cast<std::uint32_t>(row) * 2246822519U;
  mixed ^= mixed >> 15U;
  mixed *= 2654435761U;
  return mixed ^ (mixed >> 13U);
}

Texel noisy(std::int64_t column, std::int64_t row) {
  const std::uint32_t n = noise(column, row);
  const auto byte = [n](unsigned shift) { return static_cast<std::uint8_t>(n >> shift); };
  return {static_cast<float>(n % 9000U), {byte(0), byte(8), byte(16), 255}};
}

/// Longitude and latitude of pixels' centres, by PROJ.
class Inverse {
 public:
  explicit Inverse(const Layout& layout) : layout_(layout) {
    OGRSpatialReference crs;
    crs.SetFromUserInput(layout.crs.empty() ? "EPSG:4326" : layout.crs.c_str());
    crs.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    OGRSpatialReference degrees;
    degrees.SetFromUserInput("EPSG:4326");
    degrees.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    transformation_.reset(OGRCreateCoordinateTransformation(&crs, &degrees));
  }
  [[nodiscard]] GeodeticPosition operator()(std::size_t level, std::int64_t column, std::int64_t row) const {
    const double pixel = std::ldexp(layout_.pixel, static_cast<int>(level));
    double x = layout_.left + (static_cast<double>(column) + 0.5) * pixel;
    double y = layout_.top - (static_cast<double>(row) + 0.5) * pixel;
    if (transformation_ != nullptr) {
      transformation_->Transform(1, &x, &y);
    }
    return {y * degree, x * degree, 0.0};
  }

 private:
  Layout layout_;
  std::unique_ptr<OGRCoordinateTransformation> transformation_;
};

/// The finest matrix as a GeoTIFF.
std::unique_ptr<MadeRaster> rasterOf(const Layout& layout, const std::function<Texel(std::int64_t, std::int64_t)>& at,
                                     bool isHeights) {
  const auto x0 = std::llround((layout.extent[0] - layout.left) / layout.pixel);
  const auto y0 = std::llround((layout.top - layout.extent[3]) / layout.pixel);
  Made made;
  made.width = static_cast<int>(std::llround((layout.extent[2] - layout.extent[0]) / layout.pixel));
  made.height = static_cast<int>(std::llround((layout.extent[3] - layout.extent[1]) / layout.pixel));
  made.transform = {layout.extent[0], layout.pixel, 0, layout.extent[3], 0, -layout.pixel};
  made.type = isHeights ? GDT_Float32 : GDT_Byte;
  made.bands = isHeights ? 1 : 3;
  made.crs = layout.crs.empty() ? "EPSG:4326" : layout.crs;
  return std::make_unique<MadeRaster>(made, [&](int band, int column, int row) {
    const Texel texel = at(x0 + column, y0 + row);
    return isHeights ? double{texel.metres} : static_cast<double>(texel.colour[static_cast<std::size_t>(band)]);
  });
}

struct Place {
  double latitude;
  double longitude;
};

class AnyService : public testing::TestWithParam<Layout> {};

TEST_P(AnyService, GivesWhatTheSameRasterGivesThroughGdal) {
  const Layout& layout = GetParam();
  Served served(layout, [](std::size_t, std::int64_t column, std::int64_t row) { return noisy(column, row); });
  const auto heightRaster = rasterOf(layout, noisy, true);
  const auto colourRaster = rasterOf(layout, noisy, false);
  const auto gdalHeights = open({heightRaster->path()});
  const auto gdalColours = open({colourRaster->path()});
  const GeodeticTiling tiling = earth();
  int compared = 0;
  for (const Place& where : {Place{89.99, 20},
                             {89.99, -179.99},
                             {75, 45},
                             {85.0, 179.99},
                             {30, -179.99},
                             {-12, 179.99},
                             {0.01, 0.01},
                             {46.5, 8.1},
                             {-65, -60},
                             {-84.9, 100},
                             {-89.99, 3}}) {
    // Deeper than the finest matrix anywhere, so that both read that and widen no kernel.
    for (const int level : {7}) {
      const TileIndex index = tileAt(tiling, where.latitude, where.longitude, level);
      SCOPED_TRACE(layout.name + ' ' + toString(index));
      const HeightPixels expected = heights(*gdalHeights, tiling, index);
      const auto made = served.heights(tiling, index);
      ASSERT_TRUE(made) << made.error().message();
      ASSERT_EQ(made->any, expected.any);
      // In degrees, near a pole, a coarser matrix stands for columns that crowd there.
      const bool isCrowded = (layout.crs.empty() || layout.crs == "EPSG:4326") && std::abs(where.latitude) > 30;
      for (std::size_t i = 0; i < expected.metres.size() && !isCrowded; ++i) {
        const int row = static_cast<int>(i) / heightLayout.size();
        const int column = static_cast<int>(i) % heightLayout.size();
        const GeodeticPosition place = tiling.geodetic(index, heightLayout.uv(column, row));
        if (layout.crs == "EPSG:3857" && std::abs(place.longitude) > 179.5 * degree) {
          continue;  // the service goes on at the other side, the raster repeats its edge
        }
        ASSERT_EQ(std::isnan(made->metres[i]), std::isnan(expected.metres[i])) << i;
        if (!std::isnan(expected.metres[i])) {
          ASSERT_NEAR(made->metres[i], expected.metres[i], 0.01) << i;
          ++compared;
        }
      }
      const ColourPixels expectedColours = colours(*gdalColours, tiling, index);
      const auto madeColours = served.colours(tiling, index);
      ASSERT_TRUE(madeColours) << madeColours.error().message();
      ASSERT_EQ(madeColours->anyOpaque, expectedColours.anyOpaque);
      ASSERT_EQ(madeColours->allOpaque, expectedColours.allOpaque);
      const bool isAtSeam = layout.crs == "EPSG:3857" && std::abs(where.longitude) > 179;
      for (std::size_t i = 0; i < expectedColours.rgba.size() && !isCrowded && !isAtSeam; ++i) {
        ASSERT_NEAR(madeColours->rgba[i], expectedColours.rgba[i], 1) << i;
      }
    }
  }
  EXPECT_GT(compared, 10000);
  EXPECT_FALSE(served.flaw);
}

TEST_P(AnyService, IsTrueToTheGlobeAtEveryLevel) {
  const Layout& layout = GetParam();
  const Inverse inverse(layout);
  Served served(layout, [&](std::size_t level, std::int64_t column, std::int64_t row) {
    return texelOf(smooth(inverse(level, column, row)));
  });
  const GeodeticTiling tiling = earth();
  int compared = 0;
  for (const Place& place :
       {Place{89.99, 20}, {75, 45}, {30, -179.99}, {-12, 179.99}, {0.01, 0.01}, {46.5, 8.1}, {-65, -60}, {-89.99, 3}}) {
    for (const int level : {0, 1, 3, 5}) {
      const TileIndex index = tileAt(tiling, place.latitude, place.longitude, level);
      SCOPED_TRACE(layout.name + ' ' + toString(index));
      const auto made = served.heights(tiling, index);
      ASSERT_TRUE(made) << made.error().message();
      // Through PROJ, colours take their time.
      const auto madeColours = level % 4 == 1 ? served.colours(tiling, index) : Result<ColourPixels>(ColourPixels{});
      ASSERT_TRUE(madeColours) << madeColours.error().message();
      for (int row = 0; row < 129 && made->any; ++row) {
        for (int column = 0; column < 129; ++column) {
          const GeodeticPosition at = tiling.geodetic(index, heightLayout.uv(column + 1, row + 1));
          const float metres = made->metres[test::at(heightLayout, column, row)];
          if (!std::isnan(metres)) {
            // The coarsest matrix has pixels of some degrees; kernels there are means.
            ASSERT_NEAR(metres, 4000.0 * smooth(at), level < 2 ? 60.0 : 25.0) << column << ' ' << row;
            ++compared;
          }
        }
      }
      for (int row = 0; row < 512 && madeColours->anyOpaque; row += 7) {
        for (int column = 0; column < 512; column += 7) {
          const GeodeticPosition at = tiling.geodetic(index, colourLayout.uv(column + 8, row + 8));
          const std::uint8_t* pixel = madeColours->rgba.data() + 4 * test::at(colourLayout, column, row);
          if (pixel[3] == 255) {
            ASSERT_NEAR(pixel[0], 127.5 + 127.5 * smooth(at), 3.0) << column << ' ' << row;
          }
        }
      }
    }
  }
  EXPECT_GT(compared, 10000);
}

TEST_P(AnyService, AsksForNoTileThatChangesNothing) {
  const Layout& layout = GetParam();
  std::string changed;  // that tile is served otherwise
  const auto tileOf = [&](std::size_t level, std::int64_t column, std::int64_t row) {
    return std::to_string(level) + '/' + std::to_string(column / layout.tileSize) + '/' +
           std::to_string(row / layout.tileSize);
  };
  const auto serve = [&](std::size_t level, std::int64_t column, std::int64_t row) {
    Texel texel = noisy(column, row);
    if (!changed.empty() && tileOf(level, column, row) == changed) {
      texel.colour[0] ^= 0x80U;
    }
    return texel;
  };
  const GeodeticTiling tiling = earth();
  for (const auto& [place, level] : {std::pair{Place{80, 40}, 4},
                                     {Place{-70, -50}, 3},
                                     {Place{46.9, 8.1}, 4},
                                     {Place{10, 179.9}, 2},
                                     {Place{46.9, 8.1}, 7}}) {
    const TileIndex index = tileAt(tiling, place.latitude, place.longitude, level);
    changed.clear();
    Served served(layout, serve);
    const auto before = served.colours(tiling, index);
    ASSERT_TRUE(before);
    for (const auto& [url, times] : served.fetcher().asked()) {
      EXPECT_EQ(times, 1);
      changed = url;
      Served other(layout, serve);
      const auto after = other.colours(tiling, index);
      ASSERT_TRUE(after);
      EXPECT_NE(before->rgba, after->rgba) << layout.name << ' ' << toString(index) << " asked for " << url;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Services, AnyService, testing::Values(geographic, gibs, mercator, north, south),
                         [](const auto& tested) {
                           std::string name = tested.param.name;
                           std::erase(name, ':');
                           return name;
                         });

/// Tiles of 512 pixels on the very grid of the globe's tiles of level 0 to 3.
const Layout aligned{"aligned", "", -180, 90, 180.0 / 4096, 512, 4, {-180, -90, 180, 90}};

TEST(AlignedService, PassesPixelsThrough) {
  Served served(aligned, [](std::size_t, std::int64_t column, std::int64_t row) { return noisy(column, row); });
  served.store().setBudget(0);  // each tile asks for all that it needs
  const GeodeticTiling tiling = earth();
  for (const Place& place : {Place{10, 10}, {-20, -179.9}, {20, 179.9}, {50, 60}}) {
    const TileIndex index = tileAt(tiling, place.latitude, place.longitude, 3);
    served.fetcher().forget();
    const auto made = served.colours(tiling, index);
    ASSERT_TRUE(made) << made.error().message();
    ASSERT_TRUE(made->allOpaque);
    const std::int64_t left = 4096 * std::int64_t{index.root} + 512 * std::int64_t{index.x};
    const std::int64_t top = 512 * std::int64_t{index.y};
    for (int row = -8; row < 520; ++row) {
      for (int column = -8; column < 520; ++column) {
        const Rgba expected = noisy((left + column + 8192) % 8192, top + row).colour;
        const std::uint8_t* pixel = made->rgba.data() + 4 * at(colourLayout, column, row);
        ASSERT_TRUE(std::equal(expected.begin(), expected.end(), pixel))
            << toString(index) << ' ' << column << ' ' << row;
      }
    }
    EXPECT_EQ(served.fetcher().asked().size(), 9U) << "itself and its eight neighbours, for the border";
  }
}

TEST(AlignedService, StillDoesWhenItsScalesAreRounded) {
  Layout rounded = aligned;
  rounded.pixel *= 1 + 3e-9;  // from a scale denominator of ten digits
  Served served(rounded, [](std::size_t, std::int64_t column, std::int64_t row) { return noisy(column, row); });
  const GeodeticTiling tiling = earth();
  const TileIndex index = tileAt(tiling, 10, 10, 3);
  const auto made = served.colours(tiling, index);
  ASSERT_TRUE(made);
  const std::int64_t left = 4096 * std::int64_t{index.root} + 512 * std::int64_t{index.x};
  for (int i = 0; i < 512; ++i) {
    EXPECT_NEAR(made->rgba[4 * at(colourLayout, i, i)], noisy(left + i, 512 * std::int64_t{index.y} + i).colour[0], 1);
  }
  EXPECT_EQ(served.fetcher().asked().size(), 9U);
}

TEST(Mercator, EndsAt85Degrees) {
  Served served(mercator, [](std::size_t, std::int64_t column, std::int64_t row) { return noisy(column, row); });
  const GeodeticTiling tiling = earth();
  const TileIndex index = tileAt(tiling, 85.05, 10, 5);
  const auto made = served.colours(tiling, index);
  ASSERT_TRUE(made);
  EXPECT_TRUE(made->anyOpaque);
  for (int row = 0; row < 512; ++row) {
    const GeodeticPosition place = tiling.geodetic(index, colourLayout.uv(256, row + 8));
    EXPECT_EQ(made->rgba[4 * at(colourLayout, 248, row) + 3], place.latitude < 85.0511287798 * degree ? 255 : 0);
  }
  served.fetcher().forget();
  const auto pole = served.heights(tiling, tileAt(tiling, 89, 10, 6));
  ASSERT_TRUE(pole);
  EXPECT_FALSE(pole->any);
  EXPECT_TRUE(served.fetcher().asked().empty());
}

TEST(Mercator, TakesCoarserMatricesWhereItStretches) {
  Layout fine = mercator;
  fine.pixel /= 8;
  fine.levels = 7;
  Served served(fine, [](std::size_t, std::int64_t column, std::int64_t row) { return noisy(column, row); });
  served.store().setBudget(0);
  const GeodeticTiling tiling = earth();
  const auto finest = [&](double latitude) {
    served.fetcher().forget();
    EXPECT_TRUE(served.colours(tiling, tileAt(tiling, latitude, 40, 4)));
    std::size_t matrix = 99;
    for (const auto& [url, times] : served.fetcher().asked()) {
      matrix = std::min(matrix, addressOf(url).matrix);
    }
    EXPECT_LT(served.fetcher().asked().size(), 30U);
    return matrix;
  };
  EXPECT_EQ(finest(10), 0U);
  EXPECT_EQ(finest(80), 2U);
}

TEST(Geographic, NeedsFewTilesAtAPoleHoweverDeep) {
  Layout deep = geographic;
  deep.pixel = 180.0 / 1048576;
  deep.levels = 14;
  Served served(deep, [](std::size_t, std::int64_t column, std::int64_t row) { return noisy(column, row); });
  const GeodeticTiling tiling = earth();
  for (const int level : {4, 8, 11}) {
    served.fetcher().forget();
    ASSERT_TRUE(served.colours(tiling, tileAt(tiling, 89.9999, 40, level)));
    EXPECT_LT(served.fetcher().asked().size(), 80U) << level;
  }
}

TEST(Heights, OfServicesAgreeOnSharedEdgesToTheBit) {
  for (const Layout& layout : {geographic, gibs, mercator, north}) {
    Served served(layout, [](std::size_t, std::int64_t column, std::int64_t row) { return noisy(column, row); });
    const GeodeticTiling tiling = earth();
    for (const int level : {2, 4, 5}) {
      for (const Place& place : {Place{84, -179.99}, {61, 60}, {40, 0.01}, {88, 100}}) {
        const TileIndex index = tileAt(tiling, place.latitude, place.longitude, level);
        const auto own = served.heights(tiling, index);
        ASSERT_TRUE(own);
        for (const Edge edge : {Edge::West, Edge::South}) {
          const auto beyond = tiling.neighbour(index, edge);
          if (!beyond || beyond->index.level != index.level || beyond->scale != 1.0 || !own->any) {
            continue;
          }
          const auto other = served.heights(tiling, beyond->index);
          ASSERT_TRUE(other);
          for (int i = 0; i < 129 && other->any; ++i) {
            const float mine = own->metres[edge == Edge::West ? at(heightLayout, 0, i) : at(heightLayout, i, 128)];
            const float theirs = other->metres[edge == Edge::West ? at(heightLayout, 128, i) : at(heightLayout, i, 0)];
            ASSERT_TRUE(mine == theirs || (std::isnan(mine) && std::isnan(theirs)))
                << layout.name << ' ' << toString(index) << ' ' << i << ": " << mine << ' ' << theirs;
          }
        }
      }
    }
  }
}

TEST(PartialService, IsAskedForItsExtentOnly) {
  // The ledger fails on any other request.
  Served served(country, [](std::size_t, std::int64_t, std::int64_t) { return Texel{500.0F, {10, 20, 30, 255}}; });
  const GeodeticTiling tiling = earth();
  EXPECT_TRUE(served.source().overlaps(tiling, tileAt(tiling, 46.5, 8, 4)));
  EXPECT_FALSE(served.source().overlaps(tiling, tileAt(tiling, 10, 8, 4)));
  for (const int level : {0, 3, 5, 8}) {
    const TileIndex index = tileAt(tiling, 46.5, 8, level);
    const auto made = served.colours(tiling, index);
    ASSERT_TRUE(made);
    for (int row = 0; row < 512; row += 3) {
      for (int column = 0; column < 512; column += 3) {
        const GeodeticPosition place = tiling.geodetic(index, colourLayout.uv(column + 8, row + 8));
        const double latitude = place.latitude / degree;
        const double longitude = place.longitude / degree;
        const double slack = 0.05;  // a pixel
        const bool inside = longitude > 5.87 + slack && longitude < 10.53 - slack && latitude > 45.81 + slack &&
                            latitude < 47.83 - slack;
        const bool outside = longitude < 5.87 - slack || longitude > 10.53 + slack || latitude < 45.81 - slack ||
                             latitude > 47.83 + slack;
        const std::uint8_t alpha = made->rgba[4 * at(colourLayout, column, row) + 3];
        ASSERT_TRUE((!inside || alpha == 255) && (!outside || alpha == 0)) << latitude << ' ' << longitude;
      }
    }
  }
  EXPECT_TRUE(served.source().hasDataFiner(tiling, tileAt(tiling, 46.5, 8, 2), colourLayout));
  EXPECT_FALSE(served.source().hasDataFiner(tiling, tileAt(tiling, 46.5, 8, 3), colourLayout));
}

TEST(AbsentTiles, AreDrawnFromTheNextCoarserMatrix) {
  const Inverse inverse(geographic);
  Served served(geographic, [&](std::size_t level, std::int64_t column, std::int64_t row) {
    return texelOf(smooth(inverse(level, column, row)));
  });
  // Every other tile of the finest matrix, and one of the next.
  served.fate = [](const TileAddress& tile) {
    return (tile.matrix == 0 && (tile.column + tile.row) % 2 == 0) || (tile.matrix == 1 && tile.column == 2)
               ? Served::Fate::Missing
               : Served::Fate::Answered;
  };
  const GeodeticTiling tiling = earth();
  const TileIndex index = tileAt(tiling, 20, -60, 2);
  const auto made = served.heights(tiling, index);
  const auto colour = served.colours(tiling, index);
  ASSERT_TRUE(made && colour);
  EXPECT_TRUE(colour->allOpaque);
  EXPECT_FALSE(served.flaw);
  for (int row = 0; row < 129; ++row) {
    for (int column = 0; column < 129; ++column) {
      ASSERT_NEAR(made->metres[at(heightLayout, column, row)],
                  4000.0 * smooth(tiling.geodetic(index, heightLayout.uv(column + 1, row + 1))), 30.0)
          << column << ' ' << row;
    }
  }
}

TEST(AbsentTiles, OfAllMatricesLeaveNothing) {
  Served served(geographic, [](std::size_t, std::int64_t column, std::int64_t row) { return noisy(column, row); });
  served.fate = [](const TileAddress&) { return Served::Fate::Missing; };
  const GeodeticTiling tiling = earth();
  const auto made = served.colours(tiling, tileAt(tiling, 20, -60, 2));
  ASSERT_TRUE(made);
  EXPECT_EQ(made->size, colourLayout.size());
  EXPECT_FALSE(made->anyOpaque);
  EXPECT_FALSE(made->allOpaque);
  EXPECT_TRUE(made->rgba.empty());
  EXPECT_FALSE(served.flaw);
}

TEST(AbsentTiles, ThatTheLimitsExcludeAreNotAskedFor) {
  TileService service = serviceOf(geographic);
  service.matrices[0].firstColumn = service.matrices[0].lastColumn = 3;
  Served served(service, [](std::size_t, std::int64_t, std::int64_t) { return Texel{7.0F, {1, 2, 3, 255}}; });
  const GeodeticTiling tiling = earth();
  const auto made = served.colours(tiling, tileAt(tiling, 20, -30, 1));
  ASSERT_TRUE(made);
  EXPECT_TRUE(made->allOpaque);
  EXPECT_EQ(std::vector(made->rgba.begin(), made->rgba.begin() + 4), (std::vector<std::uint8_t>{1, 2, 3, 255}));
}

TEST(FailedTiles, LeaveTheRestAndAreTold) {
  Served served(geographic, [](std::size_t, std::int64_t, std::int64_t) { return Texel{7.0F, {1, 2, 3, 255}}; });
  served.fate = [](const TileAddress& tile) {
    return tile.matrix == 0 || tile.column != 0 ? Served::Fate::Failed : Served::Fate::Answered;
  };
  const GeodeticTiling tiling = earth();
  const auto some = served.colours(tiling, TileIndex{0, 1, 0, 0});
  ASSERT_TRUE(some);
  EXPECT_TRUE(some->anyOpaque);
  ASSERT_TRUE(served.flaw);
  EXPECT_THAT(served.flaw->message(), testing::HasSubstr("on fire"));
  served.fate = [](const TileAddress&) { return Served::Fate::Failed; };
  const auto none = served.heights(tiling, TileIndex{0, 1, 0, 0});
  ASSERT_FALSE(none);
  EXPECT_THAT(none.error().message(), testing::HasSubstr("on fire"));
}

TEST(TiledServiceSource, SaysWhatIsWrongWithADescription) {
  struct Case {
    const char* what;
    std::function<void(TileService&)> spoil;
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const Case& c :
       {Case{"no tile matrix", [](TileService& s) { s.matrices.clear(); }},
        Case{"no tile matrix",
             [&](TileService& s) {
               for (TileMatrix& matrix : s.matrices) {
                 matrix.pixelWidth = nan;
               }
             }},
        Case{"extent", [](TileService& s) { s.east = s.west; }}, Case{"extent", [&](TileService& s) { s.north = nan; }},
        Case{"extent",
             [](TileService& s) {
               s.south = 100;
               s.north = 200;
             }},
        Case{"CRS", [](TileService& s) { s.crs = "EPSG:999999"; }},
        Case{"addresses", [](TileService& s) { s.url = nullptr; }}}) {
    TileService service = serviceOf(geographic);
    c.spoil(service);
    const auto made = TiledServiceSource::make(service, nullptr);
    ASSERT_FALSE(made) << c.what;
    EXPECT_THAT(made.error().message(), testing::HasSubstr(c.what));
  }
}

TEST(DeepService, ShowsNothingFromAfarInsteadOfAskingForThousandsOfTiles) {
  TileService service = serviceOf(mercator);
  TileMatrix& only = service.matrices.front();
  only.pixelWidth = only.pixelHeight = 2 * mercatorSide / (1 << 30);
  only.lastColumn = only.lastRow = (1 << 22) - 1;
  service.matrices.resize(1);
  Served served(service, [](std::size_t, std::int64_t, std::int64_t) { return Texel{7.0F, {1, 2, 3, 255}}; });
  const GeodeticTiling tiling = earth();
  const auto far = served.colours(tiling, tileAt(tiling, 47, 8, 3));
  ASSERT_TRUE(far);
  EXPECT_FALSE(far->anyOpaque);
  EXPECT_TRUE(served.fetcher().asked().empty());
  const auto near = served.colours(tiling, tileAt(tiling, 47, 8, 21));
  ASSERT_TRUE(near);
  EXPECT_TRUE(near->allOpaque);
  EXPECT_TRUE(served.source().hasDataFiner(tiling, tileAt(tiling, 47, 8, 3), colourLayout));
}

TEST(ServicePyramid, CountsPixelsThatNoIntHolds) {
  // Web Mercator to level 24, whose matrix is 2^32 pixels wide, on a town.
  Layout town{"town",
              "EPSG:3857",
              -mercatorSide,
              mercatorSide,
              2 * mercatorSide / 4294967296.0,
              256,
              25,
              {900000, 5990000, 950000, 6010000}};
  const auto fine = ServicePyramid::of(serviceOf(town));
  ASSERT_TRUE(fine);
  EXPECT_EQ(fine->pyramid().levels.size(), 25U);
  // Of the whole world, the finest levels are left out.
  town.extent = {-mercatorSide, -mercatorSide, mercatorSide, mercatorSide};
  const auto world = ServicePyramid::of(serviceOf(town));
  ASSERT_TRUE(world);
  EXPECT_EQ(world->pyramid().levels.size(), 23U);
  EXPECT_EQ(world->pyramid().georeference.columnsOfTurn(), 1 << 30);
}

}  // namespace
}  // namespace meridian::globebrowsing

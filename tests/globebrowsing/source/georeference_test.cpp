#include "raster_fixture.h"

namespace meridian::globebrowsing {
namespace {

using namespace test;

TEST(RasterSource, TakesARasterWithoutGeoreferenceForTheWholeGlobe) {
  const MadeRaster raster({360, 180, {}, GDT_Byte, 3, ""}, [](int, int column, int) { return column / 2; });
  const auto source = open({raster.path()});
  EXPECT_TRUE(source->info().coversAllLongitudes);
  EXPECT_TRUE(source->info().isGeographic);
  EXPECT_DOUBLE_EQ(source->info().north, 90 * degree);
  const GeodeticTiling tiling = earth();
  // 90 degrees east is column 270.
  const ColourPixels pixels = colours(*source, tiling, tileAt(tiling, 0.1, 90.4, 10));
  EXPECT_NEAR(pixels.rgba[0], 135, 1);
}

TEST(RasterSource, TakesADegreesGeotransformWithoutCrsForGeographic) {
  const MadeRaster raster({100, 100, northUp(20, 30, 0.1), GDT_Float32, 1, ""}, [](int, int, int) { return 5.0; });
  const auto source = open({raster.path()});
  EXPECT_TRUE(source->info().isGeographic);
  EXPECT_NEAR(source->info().west, 20 * degree, 1e-12);
  EXPECT_NEAR(source->info().east, 30 * degree, 1e-12);
  EXPECT_NEAR(source->info().south, 20 * degree, 1e-12);
  EXPECT_NEAR(source->info().north, 30 * degree, 1e-12);
  EXPECT_NEAR(source->info().finestPixelAngle, 0.1 * degree, 1e-12);
}

TEST(RasterSource, LetsTheUserPlaceTheRaster) {
  const MadeRaster raster({100, 100, northUp(20, 30, 0.1), GDT_Float32}, [](int, int, int) { return 5.0; });
  RasterDescription description{raster.path()};
  description.extentDegrees = {170, -10, 190, 10};
  const auto source = open(description);
  EXPECT_NEAR(source->info().west, 170 * degree, 1e-12);
  EXPECT_NEAR(source->info().east, 190 * degree, 1e-12);
  const GeodeticTiling tiling = earth();
  EXPECT_TRUE(source->overlaps(tiling, tileAt(tiling, 0, -175, 5)));
  EXPECT_TRUE(source->overlaps(tiling, tileAt(tiling, 0, 175, 5)));
  EXPECT_FALSE(source->overlaps(tiling, tileAt(tiling, 0, 25, 5)));
  EXPECT_EQ(heights(*source, tiling, tileAt(tiling, 1, -175, 6)).maximum, 5.0F);
}

TEST(RasterSource, AppliesScaleOffsetUnitAndDatum) {
  const Made made{100, 100, northUp(20, 30, 0.1), GDT_Int16};
  const auto finish = [](GDALDataset& dataset) {
    dataset.GetRasterBand(1)->SetScale(0.5);
    dataset.GetRasterBand(1)->SetOffset(100);
  };
  const MadeRaster raster(
      made, [](int, int, int) { return 60.0; }, finish);
  const GeodeticTiling tiling = earth();
  const TileIndex index = tileAt(tiling, 25, 25, 8);
  EXPECT_EQ(heights(*open({raster.path()}), tiling, index).maximum, 130.0F);
  RasterDescription description{raster.path()};
  description.heightDatum = 30.0;
  EXPECT_EQ(heights(*open(description), tiling, index).maximum, 100.0F);
  description.heightScale = 2.0;
  description.heightOffset = 1.0;
  EXPECT_EQ(heights(*open(description), tiling, index).maximum, 91.0F);

  const MadeRaster kilometres(
      made, [](int, int, int) { return 3.0; },
      [](GDALDataset& dataset) { dataset.GetRasterBand(1)->SetUnitType("km"); });
  EXPECT_EQ(heights(*open({kilometres.path()}), tiling, index).maximum, 3000.0F);
}

TEST(RasterSource, ReadsLongitudesThatAreCountedWestward) {
  const MadeRaster raster({360, 180, northUp(0, 90, 1), GDT_Float32, 1, ""},
                          [](int, int column, int) { return column; });
  const std::string crs =
      "GEOGCRS[\"Mars positive west\",DATUM[\"Mars\",ELLIPSOID[\"Mars\",3396190,0]],CS[ellipsoidal,2],"
      "AXIS[\"latitude\",north],AXIS[\"longitude\",west],ANGLEUNIT[\"degree\",0.0174532925199433]]";
  std::string escaped;
  for (const char c : crs) {
    escaped += c == '"' ? "&quot;" : std::string(1, c);
  }
  const std::string vrt =
      "<VRTDataset rasterXSize=\"360\" rasterYSize=\"180\"><SRS dataAxisToSRSAxisMapping=\"2,1\">" + escaped +
      "</SRS><GeoTransform>0,1,0,90,0,-1</GeoTransform><VRTRasterBand dataType=\"Float32\" band=\"1\"><SimpleSource>"
      "<SourceFilename>" +
      raster.path() +
      "</SourceFilename><SourceBand>1</SourceBand></SimpleSource></VRTRasterBand>"
      "</VRTDataset>";
  const auto source = open({vrt, "westward.vrt"});
  ASSERT_NE(source, nullptr);
  const GeodeticTiling tiling = earth();
  // 30 degrees east is 330 degrees west: between the centres of columns 329 and 330.
  const TileIndex index = tileAt(tiling, 0.1, 30, 12);
  const GeodeticPosition corner = tiling.geodetic(index, {0, 0});
  EXPECT_NEAR(heights(*source, tiling, index).metres[at(heightLayout, 0, 0)], 360 - corner.longitude / degree - 0.5,
              1e-3);
}

TEST(RasterSource, TakesAWindowWiderThanTheGlobe) {
  // As some Mars mosaics are described: from -810 degrees on, data in -180..180 only.
  const MadeRaster raster({1440, 180, northUp(-810, 90, 1), GDT_Float32}, [](int, int column, int row) {
    const double longitude = -810 + column + 0.5;
    return longitude > -180 && longitude < 180 ? std::cos(longitude * degree) * (90 - row) : -1e6;
  });
  const auto source = open({raster.path()});
  EXPECT_TRUE(source->info().coversAllLongitudes);
  const GeodeticTiling tiling = earth();
  for (const double longitude : {-179.9, -90.0, 0.0, 179.9}) {
    const HeightPixels pixels = heights(*source, tiling, tileAt(tiling, 10, longitude, 6));
    EXPECT_GT(pixels.minimum, -91.0F) << longitude;
    EXPECT_LT(pixels.maximum, 91.0F) << longitude;
  }
}

TEST(RasterSource, AgreesWithProjOnEquidistantCylindricalMaps) {
  // Read without PROJ; gdalwarp takes the same raster through it.
  const std::string crs = "+proj=eqc +lat_ts=-10 +lon_0=180 +x_0=1000 +y_0=-500 +R=3395582 +units=m";
  const MadeRaster raster({200, 200, {7376380, 500, 0, -860015, 0, -500}, GDT_Float32, 1, crs},
                          [](int, int column, int row) { return column * 3.0 + row * row * 0.1; });
  const auto source = open({raster.path()});
  EXPECT_TRUE(source->info().isGeographic);
  const GeodeticTiling tiling = earth();
  const double latitude = (source->info().south + source->info().north) / 2 / degree;
  const double longitude = (source->info().west + source->info().east) / 2 / degree;
  const TileIndex index = tileAt(tiling, latitude, longitude, 11);
  const HeightPixels pixels = heights(*source, tiling, index);
  const std::vector<double> expected = gdalwarp(raster.path(), tiling, index, heightLayout, "cubic");
  int compared = 0;
  for (int row = 0; row < 129; ++row) {
    for (int column = 0; column < 129; ++column) {
      const double warped = expected[static_cast<std::size_t>(row * 129 + column)];
      if (!std::isnan(warped) && !std::isnan(pixels.metres[at(heightLayout, column, row)])) {
        ASSERT_NEAR(pixels.metres[at(heightLayout, column, row)], warped, 0.01);
        ++compared;
      }
    }
  }
  EXPECT_GT(compared, 5000);
}

}  // namespace
}  // namespace meridian::globebrowsing

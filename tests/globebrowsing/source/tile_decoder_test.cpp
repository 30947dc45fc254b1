#include "globebrowsing/source/tile_decoder.h"

#include <cstdio>
#include <random>

#include <Lerc_c_api.h>

#include "picture_fixture.h"
#include "service_fixture.h"

namespace meridian::globebrowsing {
namespace {

using namespace test;

TileService serviceOfSize(int width, int height) {
  TileService service;
  service.where = "http://h/tile";
  TileMatrix matrix;
  matrix.tileWidth = width;
  matrix.tileHeight = height;
  service.matrices.push_back(matrix);
  return service;
}

DecodedColours colours(const Bytes& bytes, const TileService& service) {
  auto tile = decodeColours(bytes, service, 0);
  EXPECT_TRUE(tile) << (tile ? "" : tile.error().message());
  return tile ? std::move(*tile) : DecodedColours{};
}

DecodedHeights heights(const Bytes& bytes, const TileService& service) {
  auto tile = decodeHeights(bytes, service, 0);
  EXPECT_TRUE(tile) << (tile ? "" : tile.error().message());
  return tile ? std::move(*tile) : DecodedHeights{};
}

std::string errorOf(const Bytes& bytes, const TileService& service) {
  const auto tile = decodeColours(bytes, service, 0);
  EXPECT_FALSE(tile);
  return tile ? "" : tile.error().message();
}

double ramp(int band, int column, int row) {
  return 10 * band + column * 7 + row * 3 + 1;
}

TEST(TileDecoder, LosslessColoursComeOutAsTheyWent) {
  for (const auto& [driver, options] : std::vector<std::pair<const char*, std::vector<std::string>>>{
           {"PNG", {}}, {"GTiff", {}}, {"GTiff", {"COMPRESS=DEFLATE", "TILED=YES"}}, {"WEBP", {"LOSSLESS=YES"}}}) {
    for (int bands = std::string_view(driver) == "WEBP" ? 3 : 1; bands <= 4; ++bands) {
      SCOPED_TRACE(std::string(driver) + " " + std::to_string(bands));
      Picture picture{driver, 16, 8, bands};
      picture.options = options;
      const DecodedColours tile = colours(makePicture(picture, ramp), serviceOfSize(16, 8));
      ASSERT_EQ(tile.rgba.size(), 16U * 8 * 4);
      for (int row = 0; row < 8; ++row) {
        for (int column = 0; column < 16; ++column) {
          const std::uint8_t* rgba = &tile.rgba[static_cast<std::size_t>(row * 16 + column) * 4];
          for (int channel = 0; channel < 3; ++channel) {
            EXPECT_EQ(rgba[channel], ramp(bands >= 3 ? channel : 0, column, row));
          }
          EXPECT_EQ(rgba[3], bands == 2 ? ramp(1, column, row) : bands == 4 ? ramp(3, column, row) : 255);
        }
      }
    }
  }
}

TEST(TileDecoder, PalettesAndSixteenBitsBecomeColours) {
  const auto giveTable = [](GDALDataset& dataset) {
    GDALColorTable table;
    for (short i = 0; i < 256; ++i) {
      const GDALColorEntry entry{static_cast<short>(255 - i), i, 7, static_cast<short>(i == 1 ? 0 : 255)};
      table.SetColorEntry(i, &entry);
    }
    dataset.GetRasterBand(1)->SetColorTable(&table);
  };
  for (const char* driver : {"PNG", "GTiff", "GIF"}) {
    SCOPED_TRACE(driver);
    const DecodedColours tile = colours(makePicture({driver, 16, 8, 1}, ramp, giveTable), serviceOfSize(16, 8));
    ASSERT_FALSE(tile.isEmpty());
    EXPECT_EQ(tile.rgba[4], 255 - 8);
    EXPECT_EQ(tile.rgba[5], 8);
    EXPECT_EQ(tile.rgba[6], 7);
    EXPECT_EQ(tile.rgba[7], 255);
    if (std::string_view(driver) == "PNG") {
      EXPECT_EQ(tile.rgba[3], 0);  // entry 1, by tRNS
    }
  }
  for (const char* driver : {"PNG", "GTiff"}) {
    Picture picture{driver, 16, 8, 1, GDT_UInt16};
    const DecodedColours tile =
        colours(makePicture(picture, [](int, int column, int) { return column * 4369.0; }), serviceOfSize(16, 8));
    EXPECT_EQ(tile.rgba[4 * 15], 255) << driver;
    EXPECT_EQ(tile.rgba[4 * 7], 119) << driver;  // 7 * 4369 / 257
  }
}

TEST(TileDecoder, JpegIsReadAsGdalReadsIt) {
  const std::string path = sharedData("tiles/cesium_NaturalEarthII/1/1/0.jpg");
  MERIDIAN_NEEDS(path);
  const GDALDatasetUniquePtr file = openWithGdal(path);
  const int width = file->GetRasterXSize();
  const int height = file->GetRasterYSize();
  const DecodedColours tile = colours(bytesOf(path), serviceOfSize(width, height));
  std::vector<std::uint8_t> expected(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  for (std::size_t band = 0; band < 3; ++band) {
    ASSERT_EQ(file->GetRasterBand(static_cast<int>(band) + 1)
                  ->RasterIO(GF_Read, 0, 0, width, height, expected.data(), width, height, GDT_Byte, 0, 0, nullptr),
              CE_None);
    int worst = 0;
    for (std::size_t i = 0; i < expected.size(); ++i) {
      worst = std::max(worst, std::abs(expected[i] - tile.rgba[4 * i + band]));
    }
    EXPECT_LE(worst, 1);
  }
  // Grey, and the four inks of printers.
  for (const int bands : {1, 4}) {
    const DecodedColours made =
        colours(makePicture({"JPEG", 16, 8, bands}, [](int, int, int) { return 200; }), serviceOfSize(16, 8));
    EXPECT_FALSE(made.isEmpty()) << bands;
    if (bands == 1) {
      EXPECT_NEAR(made.rgba[0], 200, 1);
      EXPECT_EQ(made.rgba[3], 255);
    }
  }
}

TEST(TileDecoder, NoDataIsTransparentWhereTheServiceSaysSo) {
  const Bytes bytes = makePicture({"PNG", 16, 8, 3}, [](int band, int column, int) { return column == 0 ? 0 : band; });
  TileService service = serviceOfSize(16, 8);
  service.noData = 0.0;
  EXPECT_EQ(colours(bytes, service).rgba[3], 255);
  service.isNoDataTransparent = true;
  const DecodedColours tile = colours(bytes, service);
  EXPECT_EQ(tile.rgba[3], 0);
  EXPECT_EQ(tile.rgba[7], 255);  // (0, 1, 2) is a colour
}

TEST(TileDecoder, HeightsOfRasters) {
  const auto value = [](int, int column, int row) { return column == 0 ? -9999.0 : 1000.5 + column - row; };
  TileService service = serviceOfSize(16, 8);
  const DecodedHeights floats = heights(makePicture({"GTiff", 16, 8, 1, GDT_Float32}, value), service);
  ASSERT_FALSE(floats.isEmpty());
  EXPECT_FLOAT_EQ(floats.metres[1], 1001.5F);
  EXPECT_FLOAT_EQ(floats.metres[0], -9999.0F);
  const DecodedHeights own = heights(makePicture({"GTiff", 16, 8, 1, GDT_Float32}, value,
                                                 [](GDALDataset& d) { d.GetRasterBand(1)->SetNoDataValue(-9999); }),
                                     service);
  EXPECT_TRUE(std::isnan(own.metres[0]));
  service.noData = -9999;
  service.heightScale = 0.5;
  service.heightOffset = 10.0;
  const DecodedHeights told = heights(makePicture({"GTiff", 16, 8, 1, GDT_Int16}, value), service);
  EXPECT_TRUE(std::isnan(told.metres[0]));
  EXPECT_NEAR(told.metres[17], 1000.5 / 2 + 10, 0.3);
  service = serviceOfSize(16, 8);
  const DecodedHeights wide = heights(makePicture({"PNG", 16, 8, 1, GDT_UInt16}, ramp), service);
  EXPECT_FLOAT_EQ(wide.metres[2], 15.0F);
  const DecodedHeights grey = heights(makePicture({"PNG", 16, 8, 1}, ramp), service);
  EXPECT_FLOAT_EQ(grey.metres[2], 15.0F);
}

TEST(TileDecoder, PackedHeightsOfPublishedFormulas) {
  // Mapbox: -10000 + (R 65536 + G 256 + B) 0.1; (1, 134, 160) is 0 m, and Everest's 8848.8 is (2, 224, 72).
  const auto packed = [](std::array<double, 4> pixel, int bands) {
    return makePicture({"PNG", 16, 8, bands},
                       [=](int band, int, int) { return pixel[static_cast<std::size_t>(band)]; });
  };
  TileService service = serviceOfSize(16, 8);
  service.encoding = TileEncoding::MapboxRgb;
  EXPECT_FLOAT_EQ(heights(packed({1, 134, 160, 0}, 3), service).metres[5], 0.0F);
  EXPECT_FLOAT_EQ(heights(packed({2, 224, 72, 0}, 3), service).metres[5], 8848.8F);
  EXPECT_TRUE(std::isnan(heights(packed({2, 224, 72, 0}, 4), service).metres[5]));
  service.encoding = TileEncoding::Terrarium;
  EXPECT_FLOAT_EQ(heights(packed({128, 0, 128, 0}, 3), service).metres[5], 0.5F);
  service.encoding = TileEncoding::PackedFloat;
  EXPECT_FLOAT_EQ(heights(packed({0xC5, 0x7A, 0x04, 0x00}, 4), service).metres[5], -4000.25F);
  EXPECT_TRUE(std::isnan(heights(packed({0x7F, 0xC0, 0, 0}, 4), service).metres[5]));
}

TEST(TileDecoder, RealHeightTilesHaveRealHeights) {
  const std::string terrarium = sharedData("tiles/terrain_rgb/terrarium.png");
  const std::string gale = sharedData("tiles/mmgis_gale/Gale_HiRISE_DEM/16/57775/31917.png");
  MERIDIAN_NEEDS(terrarium);
  MERIDIAN_NEEDS(gale);
  TileService service = serviceOfSize(256, 256);
  service.encoding = TileEncoding::Terrarium;
  for (const float metres : heights(bytesOf(terrarium), service).metres) {
    ASSERT_TRUE(metres > -500.0F && metres < 9000.0F) << metres;
  }
  const GDALDatasetUniquePtr file = openWithGdal(gale);
  service = serviceOfSize(file->GetRasterXSize(), file->GetRasterYSize());
  service.encoding = TileEncoding::PackedFloat;
  int count = 0;
  for (const float metres : heights(bytesOf(gale), service).metres) {
    if (!std::isnan(metres) && metres != 0.0F) {
      ++count;
      ASSERT_TRUE(metres > -5000.0F && metres < -3500.0F) << metres;  // the floor of Gale crater
    }
  }
  EXPECT_GT(count, 100);
}

TEST(TileDecoder, Lerc) {
  const std::string image = sharedData("tiles/lerc/bluemarble_256_256_3_byte.lerc2");
  const std::string world = sharedData("tiles/lerc/world.lerc1");
  MERIDIAN_NEEDS(image);
  const DecodedColours tile = colours(bytesOf(image), serviceOfSize(256, 256));
  ASSERT_FALSE(tile.isEmpty());
  double sum = 0;
  for (const std::uint8_t value : tile.rgba) {
    sum += value;
  }
  EXPECT_GT(sum / static_cast<double>(tile.rgba.size()), 60.0);
  EXPECT_FALSE(heights(bytesOf(world), serviceOfSize(257, 257)).isEmpty());
  // Written by the library, with a hole.
  std::vector<float> values(16 * 8);
  Bytes valid(values.size(), 1);
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i] = static_cast<float>(i) * 1.5F - 20.0F;
  }
  valid[3] = 0;
  Bytes blob(65536);
  unsigned int size = 0;
  ASSERT_EQ(lerc_encode(values.data(), 6, 1, 16, 8, 1, 1, valid.data(), 0.0, blob.data(), 65536, &size), 0U);
  blob.resize(size);
  const DecodedHeights made = heights(blob, serviceOfSize(16, 8));
  ASSERT_EQ(made.metres.size(), values.size());
  EXPECT_TRUE(std::isnan(made.metres[3]));
  EXPECT_FLOAT_EQ(made.metres[100], values[100]);
}

Bytes lercOf(const std::vector<float>& values, int width, int height) {
  Bytes blob(65536);
  unsigned int size = 0;
  EXPECT_EQ(lerc_encode(values.data(), 6, 1, width, height, 1, 0, nullptr, 0.0, blob.data(), 65536, &size), 0U);
  blob.resize(size);
  return blob;
}

TEST(TileDecoder, PointsThatTilesShareBecomePixels) {
  // A plane has in the middle of a pixel what it has there, whichever way it is sampled.
  const auto plane = [](double x, double y) { return static_cast<float>(100.0 + 3.0 * x - 5.0 * y); };
  std::vector<float> points;
  for (int row = 0; row <= 8; ++row) {
    for (int column = 0; column <= 16; ++column) {
      points.push_back(plane(column, row));
    }
  }
  const Bytes blob = lercOf(points, 17, 9);
  const DecodedHeights made = heights(blob, serviceOfSize(16, 8));
  ASSERT_EQ(made.width, 16);
  ASSERT_EQ(made.metres.size(), 128U);
  for (int row = 0; row < 8; ++row) {
    for (int column = 0; column < 16; ++column) {
      ASSERT_FLOAT_EQ(made.metres[static_cast<std::size_t>(row * 16 + column)], plane(column + 0.5, row + 0.5));
    }
  }
  TileService holed = serviceOfSize(16, 8);
  holed.noData = 100.0;  // the first point
  EXPECT_FLOAT_EQ(heights(blob, holed).metres[0], plane(2.0 / 3.0, 2.0 / 3.0)) << "of the other three";
  const DecodedColours picture = colours(blob, serviceOfSize(16, 8));
  ASSERT_EQ(picture.rgba.size(), 4U * 128);
  EXPECT_EQ(picture.rgba[4 * 17], plane(1, 1));
  EXPECT_FALSE(decodeHeights(blob, serviceOfSize(15, 7), 0)) << "two more are an error";
  EXPECT_FALSE(decodeHeights(blob, serviceOfSize(16, 9), 0));
  const Bytes grey = makePicture({"PNG", 17, 9, 1}, ramp);
  EXPECT_FALSE(decodeHeights(grey, serviceOfSize(16, 8), 0)) << "no LERC";
}

TEST(TileDecoder, ARealElevationTileIsThatOfItsMatrix) {
  const std::string world = sharedData("tiles/lerc/world.lerc1");
  MERIDIAN_NEEDS(world);
  const DecodedHeights points = heights(bytesOf(world), serviceOfSize(257, 257));
  const DecodedHeights pixels = heights(bytesOf(world), serviceOfSize(256, 256));
  ASSERT_EQ(pixels.metres.size(), 256U * 256);
  const auto highest = [](const DecodedHeights& tile) {
    float most = 0.0F;
    for (const float metres : tile.metres) {
      most = metres > most ? metres : most;
    }
    return most;
  };
  EXPECT_GT(highest(pixels), 4000.0F);  // Tibet
  EXPECT_LE(highest(pixels), highest(points));
}

TEST(TileDecoder, AnotherSizeNamesTheKeyThatTellsIt) {
  TileService service = serviceOfSize(16, 16);
  EXPECT_NE(errorOf(makePicture({"PNG", 32, 32, 3}, ramp), service).find("description"), std::string::npos);
  service.isSizeGiven = true;
  EXPECT_NE(errorOf(makePicture({"PNG", 32, 32, 3}, ramp), service).find("Tiles = { PixelSize = 32 }"),
            std::string::npos);
  EXPECT_EQ(errorOf(makePicture({"PNG", 32, 16, 3}, ramp), service).find("PixelSize"), std::string::npos)
      << "no size would make it a square";
}

TEST(TileDecoder, TellsOurMistakesFromThoseOfTheService) {
  const auto isOurs = [](const Bytes& bytes, const TileService& service, const ImageLimits& limits = {}) {
    const auto coloured = decodeColours(bytes, service, 0, limits);
    const auto high = decodeHeights(bytes, service, 0, limits);
    EXPECT_FALSE(coloured || high);
    EXPECT_EQ(coloured.error().isOurs, high.error().isOurs);
    return coloured.error().isOurs;
  };
  const TileService service = serviceOfSize(16, 8);
  for (const char* driver : {"PNG", "JPEG", "GTiff"}) {
    const Bytes picture = makePicture({driver, 16, 8, 3}, ramp);
    EXPECT_TRUE(isOurs(picture, serviceOfSize(32, 8))) << driver;
    EXPECT_TRUE(isOurs(picture, service, {15, 1 << 24})) << driver;
    EXPECT_TRUE(isOurs(picture, service, {8192, 127})) << driver;
    const Bytes half(picture.begin(), picture.begin() + static_cast<std::ptrdiff_t>(picture.size() / 4));
    EXPECT_FALSE(isOurs(half, service)) << driver;
  }
  for (const char* said : {"abc",
                           "<ServiceExceptionReport><ServiceException>no</ServiceException>"
                           "</ServiceExceptionReport>"}) {
    EXPECT_FALSE(isOurs(toBytes(said), service)) << said;
  }
}

TEST(TileDecoder, TakesNoBytesForNothingThere) {
  const TileService service = serviceOfSize(256, 256);
  EXPECT_TRUE(colours({}, service).isEmpty());
  EXPECT_TRUE(heights({}, service).isEmpty());
}

TEST(TileDecoder, TellsWhatIsWrong) {
  TileService service = serviceOfSize(256, 256);
  const std::string exception =
      "<ServiceExceptionReport><ServiceException>no such layer</ServiceException></ServiceExceptionReport>";
  EXPECT_NE(errorOf(toBytes(exception), service).find("no such layer"), std::string::npos);
  EXPECT_NE(errorOf(toBytes("abc"), service).find("61 62"), std::string::npos);
  EXPECT_NE(errorOf(makePicture({"PNG", 16, 8, 3}, ramp), service).find("16 x 8 pixels in place of 256 x 256"),
            std::string::npos);
  service.isExceptionEmpty = true;
  EXPECT_TRUE(colours(toBytes(exception), service).isEmpty());
  EXPECT_TRUE(heights(toBytes(exception), service).isEmpty());
  // A VRT in a tile's place would have GDAL read files of this machine.
  service.isExceptionEmpty = false;
  EXPECT_FALSE(errorOf(toBytes("<VRTDataset rasterXSize=\"256\" rasterYSize=\"256\"/>"), service).empty());
}

/// A PNG's size, with the checksum that belongs to it.
Bytes withPngSize(Bytes png, std::uint32_t width, std::uint32_t height) {
  const auto put = [&](std::size_t at, std::uint32_t value) {
    for (std::size_t i = 0; i < 4; ++i) {
      png[at + i] = static_cast<std::uint8_t>(value >> (24 - 8 * i));
    }
  };
  put(16, width);
  put(20, height);
  std::uint32_t crc = 0xFFFFFFFFU;
  for (std::size_t at = 12; at < 29; ++at) {
    crc ^= png[at];
    for (int bit = 0; bit < 8; ++bit) {
      crc = (crc >> 1) ^ ((crc & 1U) != 0 ? 0xEDB88320U : 0U);
    }
  }
  put(29, ~crc);
  return png;
}

TEST(TileDecoder, DoesNotAllocateWhatAHeaderAnnounces) {
  const Bytes png = makePicture({"PNG", 16, 8, 3}, ramp);
  const TileService service = serviceOfSize(16, 8);
  EXPECT_FALSE(errorOf(withPngSize(png, 2'000'000'000, 2'000'000'000), service).empty());
  EXPECT_NE(errorOf(withPngSize(png, 8000, 8000), service).find("more than are decoded"), std::string::npos);
  EXPECT_FALSE(decodeColours(withPngSize(png, 8193, 8), service, 0).error().isOurs) << "whatever the limits";
  Bytes jpeg = makePicture({"JPEG", 16, 8, 3}, ramp);
  for (std::size_t at = 0; at + 9 < jpeg.size(); ++at) {
    if (jpeg[at] == 0xFF && jpeg[at + 1] == 0xC0) {
      jpeg[at + 5] = jpeg[at + 7] = 0xFF;
    }
  }
  EXPECT_NE(errorOf(jpeg, service).find("more than are decoded"), std::string::npos);
  Picture sparse{"GTiff", 30000, 30000, 1};
  sparse.options = {"SPARSE_OK=TRUE", "TILED=YES", "COMPRESS=DEFLATE"};
  GDALAllRegister();
  GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("GTiff");
  char** options = CSLAddString(nullptr, "SPARSE_OK=TRUE");
  GDALDatasetUniquePtr(driver->Create("/vsimem/sparse.tif", 30000, 30000, 1, GDT_Float32, options)).reset();
  CSLDestroy(options);
  vsi_l_offset size = 0;
  GByte* data = VSIGetMemFileBuffer("/vsimem/sparse.tif", &size, TRUE);
  EXPECT_NE(errorOf(Bytes(data, data + size), service).find("more than are decoded"), std::string::npos);
  VSIFree(data);
}

/// Real and made tiles of each format.
std::vector<std::pair<Bytes, TileService>> samples() {
  std::vector<std::pair<Bytes, TileService>> result;
  const auto add = [&](Bytes bytes, int width, int height, TileEncoding encoding = TileEncoding::Image) {
    TileService service = serviceOfSize(width, height);
    service.encoding = encoding;
    service.isExceptionEmpty = true;
    if (!bytes.empty()) {
      result.emplace_back(std::move(bytes), service);
    }
  };
  add(bytesOf(sharedData("tiles/cesium_NaturalEarthII/1/1/0.jpg")), 256, 256);
  add(bytesOf(sharedData("tiles/mmgis_gale/Gale_HiRISE_DEM/16/57775/31917.png")), 32, 32, TileEncoding::PackedFloat);
  add(bytesOf(sharedData("tiles/lerc/bluemarble_256_256_3_byte.lerc2")), 256, 256);
  add(bytesOf(sharedData("tiles/lerc/world.lerc1")), 257, 257);
  add(makePicture({"PNG", 64, 64, 3}, ramp), 64, 64);
  add(makePicture({"PNG", 64, 64, 1, GDT_UInt16}, ramp), 64, 64);
  add(makePicture({"JPEG", 64, 64, 3, GDT_Byte, {"PROGRESSIVE=ON"}}, ramp), 64, 64);
  add(makePicture({"WEBP", 64, 64, 3}, ramp), 64, 64);
  add(makePicture({"GIF", 64, 64, 1}, ramp), 64, 64);
  add(makePicture({"BMP", 64, 64, 3}, ramp), 64, 64);
  add(makePicture({"GTiff", 64, 64, 1, GDT_Float32, {"COMPRESS=DEFLATE"}}, ramp), 64, 64);
  add(toBytes("<ServiceExceptionReport><ServiceException code='a'>b</ServiceException></ServiceExceptionReport>"), 9,
      9);
  add(toBytes("{\"error\":{\"code\":499,\"message\":\"Token\"}}"), 9, 9);
  return result;
}

void decodeBothWays(const Bytes& bytes, const TileService& service) {
  const auto coloured = decodeColours(bytes, service, 0);
  EXPECT_TRUE(!coloured || coloured->isEmpty() ||
              coloured->rgba.size() ==
                  static_cast<std::size_t>(coloured->width) * 4 * static_cast<std::size_t>(coloured->height));
  const auto high = decodeHeights(bytes, service, 0);
  EXPECT_TRUE(!high || high->isEmpty() ||
              high->metres.size() == static_cast<std::size_t>(high->width) * static_cast<std::size_t>(high->height));
}

TEST(TileDecoder, DecodesNoMoreThanItsLimitsAllow) {
  std::size_t refused = 0;
  for (const auto& [bytes, service] : samples()) {
    const TileMatrix& matrix = service.matrices.front();
    const int side = std::max(matrix.tileWidth, matrix.tileHeight);
    const auto whole = decodeColours(bytes, service, 0);
    if (!whole || whole->isEmpty()) {  // heights only, or what a service says in place of an image
      continue;
    }
    const std::int32_t pixels = matrix.tileWidth * matrix.tileHeight;
    EXPECT_TRUE(decodeColours(bytes, service, 0, {side, pixels}));
    for (const ImageLimits& limits : {ImageLimits{side - 1, pixels}, ImageLimits{side, pixels - 1}}) {
      const auto tile = decodeColours(bytes, service, 0, limits);
      ASSERT_FALSE(tile);
      EXPECT_NE(tile.error().message().find("more than are decoded"), std::string::npos) << tile.error().message();
      EXPECT_FALSE(decodeHeights(bytes, service, 0, limits));
      ++refused;
    }
  }
  EXPECT_GT(refused, 8U);
}

TEST(TileDecoder, SurvivesTruncation) {
  for (const auto& [bytes, service] : samples()) {
    for (std::size_t step = 0; step < 40; ++step) {
      const std::size_t size = step < 20 ? step : bytes.size() * (step - 20) / 20;
      const Bytes part(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(std::min(size, bytes.size())));
      decodeBothWays(part, service);
    }
  }
}

TEST(TileDecoder, TruncatedPicturesAreErrors) {
  for (const char* name : {"JPEG", "PNG"}) {
    const Bytes whole =
        makePicture({name, 64, 64, 3}, [](int b, int c, int r) { return (c * 37 + r * 91 + b * 7) % 256; });
    const Bytes half(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(whole.size() / 2));
    EXPECT_NE(errorOf(half, serviceOfSize(64, 64)).find("damaged"), std::string::npos) << name;
  }
}

TEST(TileDecoder, SurvivesFlippedBits) {
  std::mt19937 random(7);
  for (const auto& [bytes, service] : samples()) {
    for (int round = 0; round < 150; ++round) {
      Bytes damaged = bytes;
      // Headers are where the harm is: half of the flips go there.
      const std::size_t reach = round % 2 == 0 ? std::min<std::size_t>(damaged.size(), 64) : damaged.size();
      for (int flip = 0; flip < 1 + round % 8; ++flip) {
        damaged[random() % reach] ^= static_cast<std::uint8_t>(1U << (random() % 8));
      }
      decodeBothWays(damaged, service);
    }
  }
}

}  // namespace
}  // namespace meridian::globebrowsing

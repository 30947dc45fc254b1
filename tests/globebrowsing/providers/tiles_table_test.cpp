// What a layer's table Tiles says, from the table to metres and addresses.
#include "globebrowsing/providers/tiles_table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "../source/picture_fixture.h"
#include "../source/tile_service_fixture.h"
#include "globebrowsing/source/tile_decoder.h"
#include "provider_fixture.h"

namespace meridian::globebrowsing {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::Each;
using testing::HasSubstr;
using testing::Key;
using testing::Not;
using testing::StartsWith;

/// A server of PNGs: `pixel(url)` is the colour of all of a tile.
class TilesTest : public testing::Test {
 protected:
  using Pixel = std::array<int, 3>;

  ProviderRequest request(Fields fields, const std::string& folder = "/data") const {
    ProviderRequest made = requestFor(std::move(fields), folder);
    made.sourceTiles = store_;
    return made;
  }
  static Value tiles(Fields fields) { return tableOf(std::move(fields)); }

  static Result<void> opened(TileProvider& provider) {
    test::prepareFully([&](const std::function<void()>& wake) { return provider.prepare(wake); });
    return provider.open();
  }
  std::shared_ptr<TileProvider> open(Fields fields) const {
    auto made = makeProvider(request(std::move(fields)));
    EXPECT_TRUE(made) << (made ? "" : made.error().message());
    if (!made) {
      return nullptr;
    }
    const Result<void> done = opened(**made);
    EXPECT_TRUE(done) << (done ? "" : done.error().message());
    return done ? *made : nullptr;
  }
  std::string errorOf(Fields fields) const {
    auto made = makeProvider(request(std::move(fields)));
    if (!made) {
      return made.error().message();
    }
    const Result<void> done = opened(**made);
    EXPECT_FALSE(done);
    return done ? "" : done.error().message();
  }
  /// Metres in the middle of a tile of the globe.
  static float metresIn(const TileProvider& provider, const TileIndex& index) {
    const GeodeticTiling tiling = earthTiling();
    const auto made = test::waitFor(provider.heightTask(tiling, index, heightLayout));
    EXPECT_TRUE(made) << (made ? "" : made.error().message());
    const auto size = static_cast<std::size_t>(heightLayout.size());
    return made && !made->metres.empty() ? made->metres[size / 2 * size + size / 2] : -1e9F;
  }
  static TileIndex tileAt(double latitude, double longitude, int level) {
    constexpr double degree = std::numbers::pi / 180.0;
    return earthTiling().locate(latitude * degree, longitude * degree, level).index;
  }

  std::function<Pixel(const std::string&)> pixel = [](const std::string&) { return Pixel{128, 0, 128}; };
  int size = 256;
  test::Worker worker_;
  std::shared_ptr<test::FakeFetcher> fetcher_ =
      std::make_shared<test::FakeFetcher>([this](const std::string& url) -> Result<Fetched> {
        const Pixel colour = pixel(url);
        Fetched fetched{200};
        fetched.body = std::make_shared<const test::Bytes>(test::makePicture(
            {"PNG", size, size, 3}, [&](int band, int, int) { return colour[static_cast<std::size_t>(band)]; }));
        return fetched;
      });
  std::shared_ptr<SourceTileStore> store_ = std::make_shared<SourceTileStore>(SourceTileStore::Parts{
      fetcher_, [this](std::function<void()> task) { worker_.post(std::move(task)); }, decodeTile});
};

constexpr const char* xyz = "https://h/{z}/{x}/{y}.png";

TEST_F(TilesTest, EncodedColoursAreMetres) {
  const TileIndex place = tileAt(46.5, 8.1, 5);
  const auto metres = [&](const char* encoding, Pixel colour, Fields more = {}) {
    pixel = [=](const std::string&) { return colour; };
    // An address of its own for each, so that no tile is another's.
    more["FilePath"] = std::string("https://") + encoding + std::to_string(colour[2]) + ".h/{z}/{x}/{y}.png";
    more["Tiles"] = tiles({{"Encoding", encoding}});
    const auto provider = open(std::move(more));
    return provider ? metresIn(*provider, place) : 0.0F;
  };
  EXPECT_NEAR(metres("Terrarium", {146, 144, 128}), 4752.5F, 0.01F);  // 146 * 256 + 144 + 0.5 - 32768
  EXPECT_NEAR(metres("MapboxRgb", {2, 224, 72}), 8848.8F, 0.01F);
  EXPECT_NEAR(metres("Image", {90, 0, 0}), 90.0F, 0.01F);
  EXPECT_NEAR(metres("Terrarium", {146, 144, 0}, {{"HeightScale", 2.0}, {"HeightDatum", 4.0}}), 9500.0F, 0.01F);
}

TEST_F(TilesTest, EncodingIsOfEveryKindOfService) {
  pixel = [](const std::string&) { return Pixel{146, 144, 128}; };
  const auto provider =
      open({{"FilePath",
             "<GDAL_WMS><Service name=\"TMS\"><ServerUrl>http://h/${z}/${x}/${y}.png</ServerUrl></Service><DataWindow>"
             "<UpperLeftX>-180</UpperLeftX><UpperLeftY>90</UpperLeftY><LowerRightX>180</LowerRightX><LowerRightY>-90"
             "</LowerRightY><TileLevel>4</TileLevel><TileCountX>2</TileCountX><TileCountY>1</TileCountY><YOrigin>top"
             "</YOrigin></DataWindow><BlockSizeX>256</BlockSizeX><BlockSizeY>256</BlockSizeY></GDAL_WMS>"},
            {"Tiles", tiles({{"Encoding", "Terrarium"}})}});
  ASSERT_NE(provider, nullptr);
  EXPECT_NEAR(metresIn(*provider, tileAt(46.5, 8.1, 3)), 4752.5F, 0.01F);
}

TEST_F(TilesTest, ColoursShowThePictureAsItIs) {
  const auto provider = open({{"FilePath", xyz}, {"Tiles", tiles({{"Encoding", "Terrarium"}})}});
  ASSERT_NE(provider, nullptr);
  const GeodeticTiling tiling = earthTiling();
  const auto made = test::waitFor(provider->colourTask(tiling, tileAt(10, 10, 2)));
  ASSERT_TRUE(made) << made.error().message();
  EXPECT_EQ(pixelAt(*made, 200, 200), (Colour{128, 0, 128, 255}));
}

TEST_F(TilesTest, TilesOfAnotherSize) {
  size = 512;
  const TileIndex place = tileAt(10, 10, 3);
  const auto provider = open({{"FilePath", xyz}, {"Tiles", tiles({{"PixelSize", 512}, {"Encoding", "Terrarium"}})}});
  ASSERT_NE(provider, nullptr);
  EXPECT_NEAR(metresIn(*provider, place), 0.5F, 0.01F);
  // With the address alone: what the name of the file says, unless the table says otherwise.
  const auto dense =
      open({{"FilePath", "https://d/{z}/{x}/{y}@2x.png?key=1"}, {"Tiles", tiles({{"Encoding", "Terrarium"}})}});
  ASSERT_NE(dense, nullptr);
  EXPECT_NEAR(metresIn(*dense, place), 0.5F, 0.01F);
  for (const Fields& fields :
       {Fields{{"FilePath", "https://e/{z}/{x}/{y}.png"}}, Fields{{"FilePath", "https://e/@2x/{z}/{x}/{y}.png"}},
        Fields{{"FilePath", "https://f/{z}/{x}/{y}@2x.png"}, {"Tiles", tiles({{"PixelSize", 256}})}}}) {
    const auto wrong = open(fields);
    ASSERT_NE(wrong, nullptr);
    const GeodeticTiling tiling = earthTiling();
    const auto made = test::waitFor(wrong->heightTask(tiling, place, heightLayout));
    ASSERT_FALSE(made);
    EXPECT_THAT(made.error().message(), HasSubstr("Tiles = { PixelSize = 512 }"));
  }
}

TEST_F(TilesTest, RowsAndLevelsAreThoseOfTheTable) {
  const auto asked = [&](Fields settings, const TileIndex& index) {
    fetcher_->forget();
    const auto provider = open({{"FilePath", xyz}, {"Tiles", tiles(std::move(settings))}});
    if (provider != nullptr) {
      static_cast<void>(metresIn(*provider, index));
    }
    return fetcher_->asked();
  };
  // All of the north of the east, which is row 0 from the north of level 1, and row 1 from the south.
  const TileIndex northeast = tileAt(40, 100, 6);
  const auto north = asked({{"FirstLevel", 1}, {"LastLevel", 1}}, northeast);
  EXPECT_THAT(north, Contains(Key("https://h/1/1/0.png")));
  EXPECT_THAT(north, Each(Key(StartsWith("https://h/1/")))) << "no other level";
  const auto south = asked({{"FirstLevel", 1}, {"LastLevel", 1}, {"RowsFromSouth", true}}, northeast);
  EXPECT_THAT(south, Contains(Key("https://h/1/1/1.png")));
  EXPECT_THAT(south, Not(Contains(Key("https://h/1/1/0.png"))));
  // In degrees level 1 has four columns and two rows.
  const auto degrees = asked({{"FirstLevel", 1}, {"LastLevel", 1}, {"Projection", "EPSG:4326"}}, tileAt(40, 100, 6));
  EXPECT_THAT(degrees, Contains(Key("https://h/1/3/0.png")));
}

TEST_F(TilesTest, AnyProjectionWillDoWhoseSquareIsKnown) {
  int number = 0;
  const auto asked = [&](Fields settings, const TileIndex& index) {
    fetcher_->forget();
    settings.insert({{"FirstLevel", 1}, {"LastLevel", 1}});
    // An address of its own for each, so that no tile is another's.
    const std::string address = "https://h" + std::to_string(++number) + "/{z}/{x}/{y}.png";
    const auto provider = open({{"FilePath", address}, {"Tiles", tiles(std::move(settings))}});
    if (provider != nullptr && provider->overlaps(earthTiling(), index)) {
      static_cast<void>(metresIn(*provider, index));
    }
    return fetcher_->asked();
  };
  const auto only = [](const char* path) { return testing::ElementsAre(Key(testing::EndsWith(path))); };
  // Down from the north pole is the meridian 45 west; down from the south pole, 180.
  const Fields north{{"Projection", "EPSG:3413"}};
  const Fields south{{"Projection", "EPSG:3031"}};
  EXPECT_THAT(asked(north, tileAt(75, 2, 7)), only("/1/1/1.png"));
  EXPECT_THAT(asked(north, tileAt(75, 178, 7)), only("/1/0/0.png"));
  EXPECT_THAT(asked(south, tileAt(-75, 47, 7)), only("/1/1/0.png"));
  EXPECT_THAT(asked(south, tileAt(-75, -133, 7)), only("/1/0/1.png"));
  EXPECT_THAT(asked(north, tileAt(20, 2, 7)), testing::IsEmpty()) << "beyond the square";
  EXPECT_THAT(asked({{"Projection", "EPSG:3413"}, {"Square", listOf({0.0, -4e6, 4e6, 0.0})}}, tileAt(75, 2, 7)),
              only("/1/0/0.png"));
  const Value switzerland = listOf({2400000.0, 900000.0, 2912000.0, 1412000.0});
  EXPECT_THAT(asked({{"Projection", "EPSG:2056"}, {"Square", switzerland}}, tileAt(46.95, 7.44, 12)),
              only("/1/0/0.png"));
  const auto says = [&](Fields settings, const char* what) {
    EXPECT_THAT(errorOf({{"FilePath", xyz}, {"Tiles", tiles(std::move(settings))}}), HasSubstr(what));
  };
  says({{"Projection", "EPSG:2056"}}, "give Tiles.Square");
  says({{"Projection", "EPSG:3413"}, {"Square", listOf({0.0, 0.0, 4e6, 3e6})}}, "no square");
  says({{"Projection", "EPSG:3413"}, {"Square", listOf({4e6, 0.0, 0.0, 4e6})}}, "turned around");
  says({{"Square", listOf({0.0, 0.0, 4e6, 4e6})}}, "leave Tiles.Square out");
  says({{"Projection", "EPSG:999999"}}, "EPSG:999999");
}

TEST_F(TilesTest, NothingIsAskedForBeyondTheExtent) {
  const Value extent = listOf({5.0, 45.0, 11.0, 48.0});
  const auto provider = open({{"FilePath", xyz}, {"Tiles", tiles({{"Extent", extent}, {"LastLevel", 6}})}});
  ASSERT_NE(provider, nullptr);
  EXPECT_FALSE(provider->overlaps(earthTiling(), tileAt(-20, 100, 4)));
  EXPECT_TRUE(provider->overlaps(earthTiling(), tileAt(46, 8, 4)));
  static_cast<void>(metresIn(*provider, tileAt(46, 8, 4)));
  const auto asked = fetcher_->asked();
  EXPECT_FALSE(asked.empty());
  for (const auto& [url, count] : asked) {
    int level = 0;
    int column = 0;
    int row = 0;
    ASSERT_EQ(std::sscanf(url.c_str(), "https://h/%d/%d/%d", &level, &column, &row), 3) << url;
    const double tile = 360.0 / (1 << level);
    EXPECT_TRUE(column * tile - 180.0 < 11.0 && (column + 1) * tile - 180.0 > 5.0) << url;
  }
}

TEST_F(TilesTest, SaysWhatIsWrong) {
  struct Case {
    Fields tiles;
    const char* says;
    const char* where;
  };
  for (const Case& c :
       {Case{{{"Encoding", "Png"}}, "use one of: Image, MapboxRgb, Terrarium, PackedFloat", "Encoding"},
        Case{{{"PixelSize", "256"}}, "expected", "PixelSize"}, Case{{{"PixelSize", 0}}, "out of range", "PixelSize"},
        Case{{{"FirstLevel", 1.5}}, "expected", "FirstLevel"}, Case{{{"LastLevel", 31}}, "out of range", "LastLevel"},
        Case{{{"FirstLevel", 5}, {"LastLevel", 4}}, "FirstLevel is 5, and LastLevel 4", "FirstLevel"},
        Case{{{"RowsFromSouth", "yes"}}, "expected", "RowsFromSouth"},
        Case{{{"Extent", listOf({10.0, 0.0, 5.0, 20.0})}}, "turned around", "Extent"},
        Case{{{"Extent", listOf({10.0, 0.0, 20.0, 95.0})}}, "off the map", "Extent"},
        Case{{{"Extent", listOf({10.0, 0.0, 190.0, 20.0})}}, "out of range", "Extent"},
        Case{{{"Extent", listOf({10.0, 0.0, 20.0})}}, "expected", "Extent"}}) {
    EXPECT_THAT(
        errorOf({{"FilePath", xyz}, {"Tiles", tiles(c.tiles)}}),
        AllOf(HasSubstr(c.says), HasSubstr(std::string("mars.asset:4: Layers.ColorLayers[1].Tiles.") + c.where)));
  }
  EXPECT_THAT(errorOf({{"FilePath", xyz}, {"Tiles", true}}), HasSubstr("Tiles"));
  EXPECT_THAT(
      errorOf(
          {{"FilePath", xyz}, {"ExtentDegrees", listOf({0.0, 0.0, 1.0, 1.0})}, {"Tiles", tiles({{"PixelSize", 512}})}}),
      HasSubstr("Tiles.Extent"));
  EXPECT_THAT(
      errorOf({{"FilePath", "https://h/w?b={bbox-epsg-4326}"}, {"Tiles", tiles({{"Projection", "EPSG:3857"}})}}),
      HasSubstr("another projection"));
}

TEST_F(TilesTest, KeysOfTemplatesAreOfNothingElse) {
  const TemporaryFolder folder("tiles");
  const std::string image = writeImage(folder.path() + "/a.ppm", {1, 2, 3});
  for (const char* path : {"WMTS:https://h/c.xml,layer=a", "https://h/arcgis/rest/services/A/ImageServer", "a.tif"}) {
    auto made = makeProvider(
        request({{"FilePath", path}, {"Type", "DefaultTileProvider"}, {"Tiles", tiles({{"LastLevel", 4}})}}));
    ASSERT_TRUE(made) << made.error().message();
    const Result<void> checked = (*made)->check();  // what --validate says
    ASSERT_FALSE(checked) << path;
    EXPECT_THAT(checked.error().message(),
                AllOf(HasSubstr("Tiles.LastLevel"), HasSubstr("ColorLayers[1].Tiles.LastLevel")));
    EXPECT_FALSE(opened(**made));
  }
  EXPECT_THAT(errorOf({{"FilePath", image}, {"Tiles", tiles({{"Encoding", "Terrarium"}})}}),
              HasSubstr("opened as a raster"));
}

TEST_F(TilesTest, InnerProvidersAndSeriesHaveThem) {
  pixel = [](const std::string& url) { return url.find("day") == 8 ? Pixel{146, 144, 128} : Pixel{128, 7, 0}; };
  const auto levels =
      open({{"Type", "TileProviderByLevel"},
            {"LevelTileProviders",
             listOf({tableOf(
                 {{"MaxLevel", 20},
                  {"TileProvider", tableOf({{"FilePath", xyz}, {"Tiles", tiles({{"Encoding", "Terrarium"}})}})}})})}});
  ASSERT_NE(levels, nullptr);
  EXPECT_NEAR(metresIn(*levels, tileAt(10, 10, 3)), 7.0F, 0.01F);

  const auto series = open({{"Type", "TemporalTileProvider"},
                            {"Mode", "Prototyped"},
                            {"Prototyped", tableOf({{"Time", tableOf({{"Start", "2004-01-01"}, {"End", "2004-01-03"}})},
                                                    {"TemporalResolution", "1d"},
                                                    {"TimeFormat", "YYYY-MM-DD"},
                                                    {"Prototype", "https://day/${OpenSpaceTimeId}/{z}/{x}/{y}.png"}})},
                            {"Tiles", tiles({{"Encoding", "Terrarium"}, {"LastLevel", 2}})}});
  ASSERT_NE(series, nullptr);
  const auto step = series->steps()->make(timeOf("2004-01-02T12:00:00"));
  ASSERT_TRUE(step) << step.error().message();
  ASSERT_TRUE(opened(**step));
  EXPECT_NEAR(metresIn(**step, tileAt(10, 10, 3)), 4752.5F, 0.01F);
  EXPECT_THAT(fetcher_->asked(), Contains(Key(StartsWith("https://day/2004-01-02/"))));
}

TEST_F(TilesTest, UnknownKeysAreFoundWhereverTheyAre) {
  const auto found = unknownTilesKeys(request(
      {{"Tiles", tiles({{"Encodnig", "Terrarium"}})},
       {"LevelTileProviders",
        listOf({tableOf({{"TileProvider", tableOf({{"FilePath", xyz}, {"Tiles", tiles({{"Strange", 1}})}})}})})}}));
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0].key.key, "Strange");
  EXPECT_EQ(found[0].where, "mars.asset:4: Layers.ColorLayers[1].LevelTileProviders[1].TileProvider.Tiles");
  EXPECT_EQ(found[1].key.meant, "Encoding");
}

}  // namespace
}  // namespace meridian::globebrowsing

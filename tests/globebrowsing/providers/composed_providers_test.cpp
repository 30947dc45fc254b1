// Providers that are made of others: by date, by level, by index, and a sequence of images.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "globebrowsing/providers/tile_provider_by_index.h"
#include "host/api/property.h"
#include "host/api/property_owner.h"
#include "provider_fixture.h"

namespace meridian::globebrowsing {
namespace {

using testing::HasSubstr;

constexpr Colour red{255, 0, 0, 255};
constexpr Colour green{0, 255, 0, 255};
constexpr Colour blue{0, 0, 255, 255};

class ComposedProvidersTest : public testing::Test {
 protected:
  ComposedProvidersTest() {
    writeImage(folder_.path() + "/a.ppm", {255, 0, 0});
    writeImage(folder_.path() + "/b.ppm", {0, 255, 0});
    writeImage(folder_.path() + "/c.ppm", {0, 0, 255});
  }
  static Value raster(const char* file) { return tableOf({{"Identifier", file}, {"FilePath", file}}); }
  std::shared_ptr<TileProvider> make(Fields fields) {
    auto provider = makeProvider(requestFor(std::move(fields), folder_.path()));
    EXPECT_TRUE(provider) << provider.error().message();
    return *provider;
  }
  std::shared_ptr<TileProvider> open(Fields fields) {
    auto provider = make(std::move(fields));
    const Result<void> opened = provider->open();
    EXPECT_TRUE(opened) << opened.error().message();
    return provider;
  }
  void expectErrors(const std::vector<std::pair<Fields, const char*>>& table) {
    for (const auto& [fields, key] : table) {
      const auto made = makeProvider(requestFor(fields, folder_.path()));
      ASSERT_FALSE(made) << key;
      EXPECT_EQ(made.error().where, std::string("mars.asset:4: Layers.ColorLayers[1].") + key);
    }
  }

  TemporaryFolder folder_{"composed"};
};

TEST_F(ComposedProvidersTest, ByDateShowsTheLatestThatHasBegun) {
  const auto provider = open(
      {{"Type", "TileProviderByDate"},
       {"Providers",
        tableOf({{"2014-06-01", raster("c.ppm")}, {"2004-01-01", raster("b.ppm")}, {"0001-01-01", raster("a.ppm")}})}});
  EXPECT_EQ(middleAt(*provider, "-0100-01-01"), red);
  EXPECT_EQ(middleAt(*provider, "2003-12-31T23:59:59"), red);
  EXPECT_EQ(middleAt(*provider, "2004-01-01"), green);
  EXPECT_EQ(middleAt(*provider, "2999-01-01"), blue);
  const TileStep step = provider->steps()->at(timeOf("2010-01-01"));
  EXPECT_EQ(step.begin.utc(), "2004-01-01T00:00:00.000");
  EXPECT_EQ(step.end.utc(), "2014-06-01T00:00:00.000");
}

TEST_F(ComposedProvidersTest, ByDateGoesThroughTheStepsOfASeries) {
  writeImage(folder_.path() + "/m2005-01.ppm", {255, 0, 0});
  writeImage(folder_.path() + "/m2005-02.ppm", {0, 255, 0});
  const Value series = tableOf({{"Type", "TemporalTileProvider"},
                                {"Mode", "Folder"},
                                {"Folder", tableOf({{"Folder", "."}, {"Format", "m%Y-%m"}})}});
  const auto provider = open(
      {{"Type", "TileProviderByDate"}, {"Providers", tableOf({{"2004", raster("c.ppm")}, {"2005-01-15", series}})}});
  EXPECT_EQ(middleAt(*provider, "2005-01-14"), blue);
  EXPECT_EQ(middleAt(*provider, "2005-01-15"), red);
  EXPECT_EQ(middleAt(*provider, "2005-02-01"), green);
  const TileStep step = provider->steps()->at(timeOf("2005-01-20"));
  EXPECT_EQ(step.begin.utc(), "2005-01-15T00:00:00.000");
  EXPECT_EQ(step.end.utc(), "2005-02-01T00:00:00.000");
  EXPECT_NE(step.id, provider->steps()->at(timeOf("2005-02-20")).id);
}

TEST_F(ComposedProvidersTest, ByDateSaysWhatIsWrong) {
  const auto by = [](Value providers) {
    return Fields{{"Type", "TileProviderByDate"}, {"Providers", std::move(providers)}};
  };
  expectErrors({{by({}), "Providers"},
                {by(tableOf({})), "Providers"},
                {by(tableOf({{"2004-02-30", raster("a.ppm")}})), "Providers[\"2004-02-30\"]"},
                {by(tableOf({{"2004-01-01", 3}})), "Providers[\"2004-01-01\"]"},
                {by(tableOf({{"2004-01-01", tableOf({})}})), "Providers[\"2004-01-01\"].FilePath"},
                {by(tableOf({{"2004-01-01", tableOf({{"Type", "SolidColor"}})}})), "Providers[\"2004-01-01\"].Type"}});
  const auto missing = make(by(tableOf({{"2004-01-01", raster("gone.ppm")}})));
  EXPECT_FALSE(missing->check());
}

Value level(int maximum, Value provider) {
  return tableOf({{"MaxLevel", maximum}, {"TileProvider", std::move(provider)}});
}

TEST_F(ComposedProvidersTest, ByLevelAsksTheProviderOfTheLevel) {
  const GeodeticTiling tiling = earthTiling();
  // Maximum levels include themselves, and follow each other directly; OpenSpace's level 1 are our roots.
  const auto provider =
      open({{"Type", "ByLevelTileLayer"},
            {"LevelTileProviders",
             listOf({level(2, raster("a.ppm")), level(3, raster("b.ppm")), level(9, raster("c.ppm"))})}});
  EXPECT_EQ(provider->steps(), nullptr);
  for (int deep = 0; deep <= 12; ++deep) {
    const TileIndex index = tiling.locate(0.3, 0.3, deep).index;
    EXPECT_TRUE(provider->overlaps(tiling, index));
    EXPECT_EQ(middleOf(*provider, index), deep <= 1 ? red : deep == 2 ? green : blue) << deep;
    // However coarse the images are: until the last provider's turn there is something else below.
    EXPECT_EQ(provider->hasFinerColours(tiling, index), deep <= 2) << deep;
  }
}

TEST_F(ComposedProvidersTest, ByLevelOutlivesAPartThatCannotBeOpened) {
  const GeodeticTiling tiling = earthTiling();
  const auto provider =
      make({{"Type", "TileProviderByLevel"},
            {"LevelTileProviders", listOf({level(2, raster("gone.ppm")), level(3, raster("b.ppm"))})}});
  EXPECT_FALSE(provider->check());
  ASSERT_TRUE(provider->open());
  EXPECT_FALSE(provider->overlaps(tiling, {0, 0, 0, 0}));
  EXPECT_EQ(middleOf(*provider, {0, 2, 1, 1}), green);
  EXPECT_TRUE(provider->hasFinerColours(tiling, {0, 0, 0, 0})) << "to get there";
  const auto none =
      make({{"Type", "TileProviderByLevel"}, {"LevelTileProviders", listOf({level(2, raster("gone.ppm"))})}});
  EXPECT_FALSE(none->open());
}

TEST_F(ComposedProvidersTest, ByLevelTakesItsPartsThroughTime) {
  const Value dated = tableOf(
      {{"Type", "TileProviderByDate"}, {"Providers", tableOf({{"2004", raster("a.ppm")}, {"2005", raster("b.ppm")}})}});
  const auto provider = open(
      {{"Type", "TileProviderByLevel"}, {"LevelTileProviders", listOf({level(1, dated), level(5, raster("c.ppm"))})}});
  ASSERT_NE(provider->steps(), nullptr);
  EXPECT_EQ(middleAt(*provider, "2004-06-01"), red);
  EXPECT_EQ(middleAt(*provider, "2005-06-01"), green);
  EXPECT_EQ(middleAt(*provider, "2005-06-01", {0, 2, 1, 1}), blue);
  EXPECT_EQ(provider->steps()->at(timeOf("2004-06-01")).end.utc(), "2005-01-01T00:00:00.000");
}

TEST_F(ComposedProvidersTest, ByLevelSaysWhatIsWrong) {
  const auto by = [](Value list) {
    return Fields{{"Type", "TileProviderByLevel"}, {"LevelTileProviders", std::move(list)}};
  };
  expectErrors(
      {{by({}), "LevelTileProviders"},
       {by(listOf({})), "LevelTileProviders"},
       {by(listOf({3})), "LevelTileProviders[1]"},
       {by(listOf({level(-1, raster("a.ppm"))})), "LevelTileProviders[1].MaxLevel"},
       {by(listOf({level(1, raster("a.ppm")), tableOf({{"MaxLevel", 3}})})), "LevelTileProviders[2].TileProvider"},
       {by(listOf({level(1, tableOf({{"Type", "Magic"}}))})), "LevelTileProviders[1].TileProvider.Type"}});
}

Value entry(int x, int y, int tileLevel, Value provider) {
  return tableOf(
      {{"Index", tableOf({{"X", x}, {"Y", y}, {"Level", tileLevel}})}, {"TileProvider", std::move(provider)}});
}

TEST_F(ComposedProvidersTest, ByIndexReplacesSingleTiles) {
  const GeodeticTiling tiling = earthTiling();
  // OpenSpace's tile (5, 1) of level 3 is 45..90 degrees east, 0..45 north: ours in the root east.
  const TileIndex replaced = tiling.locate(0.4, 1.2, 2).index;
  const auto provider = open({{"Type", "TileProviderByIndex"},
                              {"DefaultTileProvider", raster("a.ppm")},
                              {"TileProviders", listOf({entry(5, 1, 3, raster("b.ppm"))})}});
  EXPECT_EQ(middleOf(*provider, replaced), green);
  EXPECT_EQ(middleOf(*provider, *tiling.parent(replaced)), red);
  EXPECT_EQ(middleOf(*provider, tiling.locate(0.4, 0.4, 2).index), red);
  EXPECT_EQ(middleOf(*provider, tiling.children(replaced).index[0]), red) << "below it the default again";
  EXPECT_TRUE(provider->hasFinerColours(tiling, *tiling.parent(replaced))) << "to get there";
  EXPECT_TRUE(provider->hasFinerColours(tiling, replaced));
  EXPECT_FALSE(provider->hasFinerColours(tiling, tiling.children(replaced).index[0]));
  // The border is the neighbours'.
  const ColourPixels pixels = *provider->colours(tiling, replaced, {});
  EXPECT_EQ(pixelAt(pixels, 2, 200), red);
  EXPECT_EQ(pixelAt(pixels, 12, 200), green);
  EXPECT_TRUE(pixels.allOpaque);
}

TEST_F(ComposedProvidersTest, ByIndexReplacesAPartOfTheWiderTilesOfThePoles) {
  const GeodeticTiling tiling = earthTiling();
  // At OpenSpace's level 5 the northernmost row has 32 tiles, ours fewer.
  const TileIndex polar = tiling.locate(1.5, 0.3, 4).index;
  const auto cell = TileProviderByIndex::cellOf(16, 0, 5);  // 0 to 11.25 degrees east
  ASSERT_GT(tiling.geodetic(polar, {1.0, 0.5}).longitude, cell.east + 0.1) << "wider than the cell";
  const auto provider =
      open({{"Type", "ByIndexTileLayer"},
            {"DefaultProvider", raster("a.ppm")},
            {"IndexTileProviders", listOf({tableOf({{"TileIndex", tableOf({{"X", 16}, {"Y", 0}, {"Level", 5}})},
                                                    {"TileProvider", raster("b.ppm")}})})}});
  const ColourPixels pixels = *provider->colours(tiling, polar, {});
  for (const double longitude : {0.05, 0.19, 0.21, 0.4}) {
    const double u = longitude / tiling.geodetic(polar, {1.0, 0.5}).longitude;
    EXPECT_EQ(pixelAt(pixels, colourLayout.border + static_cast<int>(u * colourLayout.interior), 250),
              longitude < cell.east ? green : red)
        << longitude;
  }
}

TEST_F(ComposedProvidersTest, ByIndexSaysWhatIsWrong) {
  const auto by = [](Value list) {
    return Fields{
        {"Type", "TileProviderByIndex"}, {"DefaultTileProvider", raster("a.ppm")}, {"TileProviders", std::move(list)}};
  };
  expectErrors({{{{"Type", "TileProviderByIndex"}}, "DefaultTileProvider"},
                {by(listOf({3})), "TileProviders[1].Index"},
                {by(listOf({entry(0, 0, 24, raster("b.ppm"))})), "TileProviders[1].Index.Level"},
                {by(listOf({entry(0, 0, 0, raster("b.ppm"))})), "TileProviders[1].Index"},
                {by(listOf({entry(8, 0, 3, raster("b.ppm"))})), "TileProviders[1].Index"},
                {by(listOf({entry(0, 4, 3, raster("b.ppm"))})), "TileProviders[1].Index"},
                {by(listOf({entry(0, 0, 3, {})})), "TileProviders[1].TileProvider"}});
}

TEST_F(ComposedProvidersTest, ASequenceShowsTheImageOfItsIndex) {
  std::ofstream(folder_.path() + "/.hidden") << "x";
  std::filesystem::create_directory(folder_.path() + "/folder");
  const auto provider = open({{"Type", "ImageSequenceTileLayer"}, {"FolderPath", "."}, {"Index", 1}});
  EXPECT_EQ(middleAt(*provider, "2000-01-01"), green);
  PropertyOwner& properties = *provider->properties();
  const auto step = [&] { return provider->steps()->at({}).id; };
  const std::uint64_t second = step();
  EXPECT_EQ(properties.property("NumberImages")->value(), Value(3));
  EXPECT_EQ(properties.property("CurrentImage")->value(), Value("b.ppm"));
  ASSERT_TRUE(properties.property("Index")->set(0));
  EXPECT_NE(step(), second);
  EXPECT_EQ(middleAt(*provider, "2000-01-01"), red);
  ASSERT_TRUE(properties.property("Index")->set(99));
  EXPECT_EQ(middleAt(*provider, "2000-01-01"), blue) << "the last";
  static_cast<void>(step());
  EXPECT_EQ(properties.property("CurrentImage")->value(), Value("c.ppm"));
  EXPECT_FALSE(properties.property("Index")->set(-1));
  EXPECT_FALSE(properties.property("NumberImages")->set(5));
}

TEST_F(ComposedProvidersTest, ASequenceSaysWhatIsWrong) {
  const auto of = [](Value folder) {
    return Fields{{"Type", "ImageSequenceTileProvider"}, {"FolderPath", std::move(folder)}};
  };
  Fields negative = of(".");
  negative["Index"] = -1;
  expectErrors({{of({}), "FolderPath"}, {negative, "Index"}});
  EXPECT_FALSE(make(of("gone"))->check());
  EXPECT_FALSE(make(of("a.ppm"))->check());
  std::filesystem::create_directory(folder_.path() + "/empty");
  const Result<void> opened = make(of("empty"))->open();
  ASSERT_FALSE(opened);
  EXPECT_THAT(opened.error().message(), HasSubstr("has no files"));
}

}  // namespace
}  // namespace meridian::globebrowsing

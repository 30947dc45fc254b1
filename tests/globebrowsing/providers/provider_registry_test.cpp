#include "globebrowsing/providers/provider_registry.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "provider_fixture.h"

namespace meridian::globebrowsing {
namespace {

using testing::HasSubstr;

TEST(LayerType, HasOpenSpacesNumbersAndOlderNames) {
  struct Case {
    const char* word;
    int number;
  };
  for (const Case& c : {Case{"DefaultTileProvider", 0}, Case{"DefaultTileLayer", 0}, Case{"SingleImageTileLayer", 1},
                        Case{"TemporalTileLayer", 4}, Case{"ByLevelTileLayer", 8}, Case{"SolidColor", 9},
                        Case{"VideoTileProvider", 11}, Case{"GraticuleTileProvider", 12}}) {
    const std::optional<LayerType> type = layerTypeFromName(c.word);
    ASSERT_TRUE(type) << c.word;
    EXPECT_EQ(static_cast<int>(*type), c.number) << c.word;
  }
  EXPECT_FALSE(layerTypeFromName("defaulttileprovider"));
}

TEST(ProviderRegistry, EveryTypeSaysWhatItIsAndWhatItReads) {
  for (const ProviderType& type : providerTypes()) {
    EXPECT_FALSE(type.description.empty());
    ASSERT_NE(type.schema, nullptr);
    for (const Schema::Field& field : type.schema->fields()) {
      EXPECT_FALSE(field.description.empty()) << field.key;
    }
  }
}

TEST(ProviderRegistry, MakesTheDefaultWithoutATypeAndKnowsOlderNames) {
  EXPECT_EQ(*layerTypeOf(requestFor({{"FilePath", "a.tif"}})), LayerType::DefaultTileProvider);
  EXPECT_TRUE(makeProvider(requestFor({{"FilePath", "a.tif"}})));
  EXPECT_TRUE(makeProvider(requestFor({{"Type", "DefaultTileLayer"}, {"FilePath", "a.tif"}})));
  const auto solid = makeProvider(requestFor({{"Type", "SolidColor"}}));
  ASSERT_TRUE(solid);
  EXPECT_FALSE((*solid)->hasTiles());
  EXPECT_TRUE((*solid)->open());
  EXPECT_FALSE((*solid)->heights(earthTiling(), {}, heightLayout, {}));
}

TEST(ProviderRegistry, ListsWhatExistsWhenATypeDoesNot) {
  const auto unknown = makeProvider(requestFor({{"Type", "Magic"}}));
  ASSERT_FALSE(unknown);
  EXPECT_EQ(unknown.error().where, "mars.asset:4: Layers.ColorLayers[1].Type");
  EXPECT_THAT(unknown.error().what, HasSubstr("Magic"));
  EXPECT_THAT(unknown.error().remedy, HasSubstr("DefaultTileProvider, SingleImageProvider, ImageSequenceTileProvider"));
  for (const char* type : {"SpoutImageProvider", "SpoutImageTileLayer", "VideoTileProvider", "VideoTileLayer"}) {
    const auto unsupported = makeProvider(requestFor({{"Type", type}}));
    ASSERT_FALSE(unsupported);
    EXPECT_THAT(unsupported.error().what, HasSubstr("not available"));
  }
  EXPECT_FALSE(makeProvider(requestFor({{"Type", 3.0}})));
}

TEST(ProviderRegistry, RefusesTablesThatDoNotFitTheirType) {
  const std::pair<Fields, const char*> table[] = {
      {{}, "FilePath"},
      {{{"FilePath", 3.0}}, "FilePath"},
      {{{"FilePath", ""}}, "FilePath"},
      {{{"FilePath", "a"}, {"ExtentDegrees", "all"}}, "ExtentDegrees"},
      {{{"FilePath", "a"}, {"ExtentDegrees", Value(glm::dvec4(10.0, -90.0, 10.0, 90.0))}}, "ExtentDegrees"},
      {{{"FilePath", "a"}, {"HeightDatum", true}}, "HeightDatum"},
      {{{"Type", "SingleImageProvider"}}, "FilePath"},
      {{{"Type", "SolidColor"}, {"Color", Value(glm::dvec3(2.0, 0.0, 0.0))}}, "Color"}};
  for (const auto& [fields, key] : table) {
    const auto made = makeProvider(requestFor(fields));
    ASSERT_FALSE(made) << key;
    EXPECT_EQ(made.error().where, std::string("mars.asset:4: Layers.ColorLayers[1].") + key);
  }
}

}  // namespace
}  // namespace meridian::globebrowsing

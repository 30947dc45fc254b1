#include "globebrowsing/layers/layer_group.h"

#include <unordered_set>

#include <gtest/gtest.h>

#include "globebrowsing/layers/structure_key.h"

namespace meridian::globebrowsing {
namespace {

TEST(LayerGroupNames, PresentAndOlderNamesAreKnown) {
  for (const LayerGroupId group : allLayerGroups) {
    const auto named = layerGroupFromName(name(group));
    ASSERT_TRUE(named) << name(group);
    EXPECT_EQ(named->group, group);
    EXPECT_EQ(named->blendMode, BlendMode::Normal);
  }
  EXPECT_EQ(layerGroupFromName("ColorOverlays")->group, LayerGroupId::Overlays);
  EXPECT_EQ(layerGroupFromName("GrayScaleLayers")->group, LayerGroupId::ColorLayers);
  EXPECT_EQ(layerGroupFromName("GrayScaleColorOverlays")->blendMode, BlendMode::Color);
  EXPECT_FALSE(layerGroupFromName("colorlayers"));
}

TEST(LayerGroupNames, BlendModesKeepOpenSpacesNumbers) {
  const std::pair<const char*, int> table[] = {{"Normal", 0}, {"Multiply", 1}, {"MultiplyMix", 2},
                                               {"Add", 3},    {"Subtract", 4}, {"Color", 5}};
  for (const auto& [word, number] : table) {
    EXPECT_EQ(static_cast<int>(blendModeFromName(word).value()), number) << word;
    EXPECT_EQ(name(static_cast<BlendMode>(number)), word);
  }
  EXPECT_FALSE(blendModeFromName("Dodge"));
  EXPECT_EQ(adjustmentFromName("TransferFunction"), Adjustment::None);
}

TEST(StructureKey, IsEqualExactlyWhenTheProgramIs) {
  const LayerStructure plain{};
  const LayerStructure multiplied{LayerGroupId::ColorLayers, Sampling::Tile, BlendMode::Multiply, Adjustment::None};
  const LayerStructure keyed{LayerGroupId::ColorLayers, Sampling::Tile, BlendMode::Normal, Adjustment::ChromaKey};
  const LayerStructure solid{LayerGroupId::ColorLayers, Sampling::SolidColor, BlendMode::Normal, Adjustment::None};
  const LayerStructure overlay{LayerGroupId::Overlays, Sampling::Tile, BlendMode::Normal, Adjustment::None};
  const std::vector<StructureKey> keys{StructureKey{},
                                       StructureKey({plain}),
                                       StructureKey({plain, plain}),
                                       StructureKey({multiplied}),
                                       StructureKey({keyed}),
                                       StructureKey({solid}),
                                       StructureKey({plain, multiplied}),
                                       StructureKey({multiplied, plain}),
                                       StructureKey({overlay})};
  std::unordered_set<std::size_t> hashes;
  std::unordered_set<std::string> texts;
  for (std::size_t i = 0; i < keys.size(); ++i) {
    for (std::size_t j = 0; j < keys.size(); ++j) {
      EXPECT_EQ(keys[i] == keys[j], i == j);
    }
    hashes.insert(std::hash<StructureKey>()(keys[i]));
    texts.insert(keys[i].text());
  }
  EXPECT_EQ(hashes.size(), keys.size());
  EXPECT_EQ(texts.size(), keys.size());
  EXPECT_EQ(keys[4].text(), "ColorLayers:Tile,Normal,ChromaKey");
}

}  // namespace
}  // namespace meridian::globebrowsing

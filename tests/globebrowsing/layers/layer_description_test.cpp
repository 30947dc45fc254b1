#include "globebrowsing/layers/layer_description.h"

#include <array>
#include <string_view>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "layer_fixture.h"

namespace meridian::globebrowsing {
namespace {

TEST(LayerDescription, ReadsEveryKey) {
  const Value table = solidLayer(
      "Relief", {{"Name", "Shaded relief"},
                 {"Description", "From afar"},
                 {"Enabled", true},
                 {"ZIndex", 7},
                 {"Opacity", 0.5},
                 {"Color", Value(glm::dvec3(0.1, 0.2, 0.3))},
                 {"Settings", tableOf({{"Gamma", 1.5}, {"Multiplier", 2.0}, {"Offset", -10.0}, {"Opacity", "old"}})},
                 {"Adjustment", tableOf({{"Type", "ChromaKey"},
                                         {"ChromaKeyColor", Value(glm::dvec3(1.0, 0.0, 1.0))},
                                         {"ChromaKeyTolerance", 0.25}})},
                 {"BlendMode", "MultiplyMix"},
                 {"PadTiles", false}});
  const Result<LayerDescription> read = readLayer(requestFor(table), LayerGroupId::ColorLayers);
  ASSERT_TRUE(read) << read.error().message();
  EXPECT_EQ(read->identifier, "Relief");
  EXPECT_EQ(read->name, "Shaded relief");
  EXPECT_EQ(read->description, "From afar");
  EXPECT_EQ(read->type, LayerType::SolidColor);
  EXPECT_TRUE(read->enabled);
  EXPECT_EQ(read->zIndex, 7);
  EXPECT_EQ(read->opacity, 0.5);
  EXPECT_EQ(read->colour, glm::dvec3(0.1, 0.2, 0.3));
  EXPECT_EQ(read->settings, (LayerSettings{1.5, 2.0, -10.0}));
  EXPECT_EQ(read->adjustment, Adjustment::ChromaKey);
  EXPECT_EQ(read->chromaKeyColour, glm::dvec3(1.0, 0.0, 1.0));
  EXPECT_EQ(read->chromaKeyTolerance, 0.25);
  EXPECT_EQ(read->blendMode, BlendMode::MultiplyMix);
}

TEST(LayerDescription, NotesKeysThatNobodyKnows) {
  const auto notesOf = [](Fields fields) {
    std::vector<std::string> notes;
    for (const Error& note : unknownLayerKeys(requestFor(tableOf(std::move(fields))))) {
      notes.push_back(note.message());
    }
    return notes;
  };
  const Value known = tableOf({{"Encoding", "Terrarium"}, {"PixelSize", 512}});
  EXPECT_TRUE(notesOf({{"Identifier", "a"}, {"FilePath", "a"}, {"Tiles", known}}).empty());
  // Those of the rasters that a series consists of are known to it.
  EXPECT_TRUE(notesOf({{"Type", "TemporalTileProvider"}, {"HeightScale", 2}, {"Tiles", known}}).empty());
  const auto notes = notesOf({{"FilePath", "a"}, {"Tiles", tableOf({{"PixelSzie", 512}})}});
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_THAT(notes[0], testing::HasSubstr("unknown key PixelSzie, did you mean PixelSize"));
  EXPECT_THAT(notes[0], testing::HasSubstr("earth.asset:12: Layer.Tiles"));
}

/// Section c.3 of openspace-formats.md: the keys of every layer, and those that had a meaning once or have one inside
/// OpenSpace only.
constexpr std::array<std::string_view, 17> documentedKeys{
    "Identifier",   "Name",          "Description",         "Type",      "Enabled",  "ZIndex",   "Opacity",
    "Color",        "Settings",      "Adjustment",          "BlendMode", "PadTiles", "Fallback", "GlobeName",
    "LayerGroupID", "CacheSettings", "PerformPreProcessing"};

struct DocumentedType {
  const char* type;
  std::vector<std::string_view> keys;  ///< section c.4, and d.1 of those that follow time
};

TEST(LayerDescription, EveryDocumentedKeyIsUsedOrIgnored) {
  for (const auto& [type, keys] : {
           DocumentedType{"DefaultTileProvider", {"FilePath", "TilePixelSize"}},
           DocumentedType{"SingleImageProvider", {"FilePath"}},
           DocumentedType{"ImageSequenceTileProvider", {"FolderPath", "Index", "TilePixelSize"}},
           DocumentedType{"SizeReferenceTileProvider", {"Radii"}},
           DocumentedType{"TileIndexTileProvider", {"UniqueBackgroundColors"}},
           DocumentedType{"TileProviderByDate", {"Providers"}},
           DocumentedType{"TileProviderByIndex",
                          {"DefaultTileProvider", "TileProviders", "DefaultProvider", "IndexTileProviders"}},
           DocumentedType{"TileProviderByLevel", {"LevelTileProviders"}},
           DocumentedType{"SolidColor", {}},
           DocumentedType{"TemporalTileProvider",
                          {"Mode", "Prototyped", "Folder", "Interpolation", "Colormap", "UseFixedTime", "FixedTime",
                           "FilePath", "TilePixelSize"}},
       }) {
    Fields fields;
    for (const std::string_view key : documentedKeys) {
      fields[std::string(key)] = true;
    }
    for (const std::string_view key : keys) {
      fields[std::string(key)] = true;
    }
    fields["Type"] = type;
    for (const Error& note : unknownLayerKeys(requestFor(tableOf(fields)))) {
      ADD_FAILURE() << type << ": " << note.message();
    }
    fields["CacheSetting"] = true;
    EXPECT_EQ(unknownLayerKeys(requestFor(tableOf(fields))).size(), 1U) << type;
  }
}

TEST(LayerDescription, DefaultsAreTheFormatsDefaults) {
  const Value table = tableOf({{"Identifier", "a"}, {"FilePath", "a.tif"}});
  const Result<LayerDescription> read = readLayer(requestFor(table), LayerGroupId::HeightLayers, BlendMode::Color);
  ASSERT_TRUE(read) << read.error().message();
  EXPECT_EQ(read->type, LayerType::DefaultTileProvider);
  EXPECT_FALSE(read->enabled);
  EXPECT_FALSE(read->zIndex);
  EXPECT_EQ(read->opacity, 1.0);
  EXPECT_TRUE(read->settings.isIdentity());
  EXPECT_EQ(read->adjustment, Adjustment::None);
  EXPECT_EQ(read->blendMode, BlendMode::Color) << "the older group's own mode";
}

struct BadTable {
  const char* what;
  Value table;
  const char* where;
};

class BadLayers : public testing::TestWithParam<BadTable> {};

TEST_P(BadLayers, AreRefusedWithTheirPlace) {
  const Result<LayerDescription> read = readLayer(requestFor(GetParam().table), LayerGroupId::HeightLayers);
  ASSERT_FALSE(read) << GetParam().what;
  EXPECT_EQ(read.error().where, std::string("earth.asset:12: ") + GetParam().where);
  EXPECT_FALSE(read.error().what.empty());
}

INSTANTIATE_TEST_SUITE_P(
    All, BadLayers,
    testing::Values(
        BadTable{"no table", 3.0, "Layer"},
        BadTable{"no identifier", tableOf({{"FilePath", "a.tif"}}), "Layer.Identifier"},
        BadTable{"identifier with a dot", tableOf({{"Identifier", "a.b"}}), "Layer.Identifier"},
        BadTable{"no file", tableOf({{"Identifier", "a"}}), "Layer.FilePath"},
        BadTable{"opacity", tableOf({{"Identifier", "a"}, {"FilePath", "a"}, {"Opacity", 1.5}}), "Layer.Opacity"},
        BadTable{"z", tableOf({{"Identifier", "a"}, {"FilePath", "a"}, {"ZIndex", 0}}), "Layer.ZIndex"},
        BadTable{"mode", tableOf({{"Identifier", "a"}, {"FilePath", "a"}, {"BlendMode", "Dodge"}}), "Layer.BlendMode"},
        BadTable{"type", tableOf({{"Identifier", "a"}, {"Type", "Magic"}}), "Layer.Type"},
        BadTable{"unsupported", tableOf({{"Identifier", "a"}, {"Type", "SpoutImageTileLayer"}}), "Layer.Type"},
        BadTable{"solid height", tableOf({{"Identifier", "a"}, {"Type", "SolidColor"}}), "Layer.Type"},
        BadTable{"settings", tableOf({{"Identifier", "a"}, {"FilePath", "a"}, {"Settings", tableOf({{"Gamma", 6.0}})}}),
                 "Layer.Settings.Gamma"},
        BadTable{"adjustment",
                 tableOf({{"Identifier", "a"}, {"FilePath", "a"}, {"Adjustment", tableOf({{"Type", "Blur"}})}}),
                 "Layer.Adjustment.Type"}),
    [](const auto& bad) {
      std::string name = bad.param.what;
      std::replace(name.begin(), name.end(), ' ', '_');
      return name;
    });

}  // namespace
}  // namespace meridian::globebrowsing

// What is written of a layer makes the same layer again, wherever it is read.
#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "globebrowsing/layers/layer_manager.h"
#include "layer_fixture.h"

namespace meridian::globebrowsing {
namespace {

using testing::ElementsAre;

class LayerTableTest : public testing::Test {
 protected:
  LayerTableTest() {
    std::string pattern = (std::filesystem::temp_directory_path() / "meridian-layer-table-XXXXXX").string();
    folder_ = ::mkdtemp(pattern.data());
  }
  ~LayerTableTest() override { std::filesystem::remove_all(folder_); }

  /// A layer of an asset in that folder.
  Layer& add(Fields table, const std::string& folder) {
    ProviderRequest request = requestFor(tableOf(std::move(table)));
    request.folder = folder;
    const Result<Layer*> added = manager_.addLayer("ColorLayers", request);
    EXPECT_TRUE(added) << (added ? "" : added.error().message());
    return **added;
  }
  /// The same written, and read from an asset elsewhere.
  Layer& again(const Layer& layer) {
    Table table = *layer.table().table();
    table.fields["Identifier"] = layer.identifier() + "Again";
    return add(table.fields, "/elsewhere");
  }
  static std::string textAt(const Value& table, std::initializer_list<const char*> keys) {
    const Value* value = &table;
    for (const char* key : keys) {
      value = value->find(key);
      if (value == nullptr) {
        return "there is no " + std::string(key);
      }
    }
    return value->string() != nullptr ? *value->string() : "no string";
  }
  static Value raster(const std::string& path) { return tableOf({{"FilePath", path}}); }

  std::string folder_;
  LayerManager manager_;
};

TEST_F(LayerTableTest, PathsHoldAnywhere) {
  const auto pathsOf = [&](Fields table, std::initializer_list<const char*> keys) {
    table["Identifier"] = "L";
    const Layer& layer = add(std::move(table), "/data");
    std::string path = textAt(layer.table(), keys);
    layer.remove.fire();
    manager_.update(Time());
    return path;
  };
  const Fields series = {{"Type", "TemporalTileProvider"},
                         {"Mode", "Folder"},
                         {"Folder", tableOf({{"Folder", "days"}, {"Format", "%Y%m%d"}})},
                         {"Colormap", "ramps/ice.png"}};
  EXPECT_EQ(pathsOf(series, {"Colormap"}), "/data/ramps/ice.png");
  EXPECT_EQ(pathsOf(series, {"Folder", "Folder"}), "/data/days");
  EXPECT_EQ(pathsOf(series, {"Folder", "Format"}), "%Y%m%d");
  Fields prototyped = {{"Type", "TemporalTileProvider"},
                       {"Colormap", ""},
                       {"Prototyped", tableOf({{"Time", tableOf({{"Start", "2000-01-01"}, {"End", "2001-01-01"}})},
                                               {"TemporalResolution", "1d"},
                                               {"TimeFormat", "YYYY-MM-DD"},
                                               {"Prototype", "${OpenSpaceTimeId}/a.tif"}})}};
  EXPECT_EQ(pathsOf(prototyped, {"Prototyped", "Prototype"}), "/data/${OpenSpaceTimeId}/a.tif");
  EXPECT_EQ(pathsOf(prototyped, {"Colormap"}), "") << "none";
  EXPECT_EQ(pathsOf({{"Type", "ColorRelief"}, {"ColorRampFile", "ramp.txt"}}, {"ColorRampFile"}), "/data/ramp.txt");
  EXPECT_EQ(pathsOf({{"Type", "ImageSequenceTileProvider"}, {"FolderPath", "../images"}}, {"FolderPath"}), "/images");
  EXPECT_EQ(pathsOf({{"FilePath", "<GDAL_WMS/>"}}, {"FilePath"}), "<GDAL_WMS/>");
  EXPECT_EQ(pathsOf({{"Type", "TileProviderByDate"},
                     {"Providers", tableOf({{"2000-01-01", raster("a.tif")}, {"2001-01-01", raster("/b.tif")}})}},
                    {"Providers", "2000-01-01", "FilePath"}),
            "/data/a.tif");
}

TEST_F(LayerTableTest, WhatWasSaidOfTilesIsWritten) {
  const Layer& layer = add({{"Identifier", "L"},
                            {"FilePath", "https://h/{z}/{x}/{y}.png"},
                            {"Tiles", tableOf({{"Encoding", "Terrarium"},
                                               {"PixelSize", 512},
                                               {"RowsFromSouth", true},
                                               {"Extent", listOf({5.0, 45.0, 11.0, 48.5})}})}},
                           "/data");
  const std::string text = layer.table().toLua();
  for (const char* part : {"Encoding = \"Terrarium\"", "PixelSize = 512", "RowsFromSouth = true", "48.5"}) {
    EXPECT_THAT(text, testing::HasSubstr(part));
  }
  EXPECT_EQ(again(layer).table().find("Tiles")->toLua(), layer.table().find("Tiles")->toLua());
}

TEST_F(LayerTableTest, PathsInListsOfProvidersHoldAnywhere) {
  const Layer& layer =
      add({{"Identifier", "L"},
           {"Type", "TileProviderByLevel"},
           {"LevelTileProviders", listOf({tableOf({{"MaxLevel", 3}, {"TileProvider", raster("coarse.tif")}}),
                                          tableOf({{"MaxLevel", 9}, {"TileProvider", raster("/fine.tif")}})})}},
          "/data");
  const Value written = layer.table();
  const std::vector<Value>& list = written.find("LevelTileProviders")->table()->list;
  ASSERT_EQ(list.size(), 2U);
  EXPECT_EQ(textAt(list[0], {"TileProvider", "FilePath"}), "/data/coarse.tif");
  EXPECT_EQ(textAt(list[1], {"TileProvider", "FilePath"}), "/fine.tif");
}

TEST_F(LayerTableTest, ARampOfAFileIsTheFilesUntilAnotherIsSet) {
  std::ofstream(folder_ + "/ramp.txt") << "0 green\n4000 white\n";
  const auto rampOf = [](Layer& layer) {
    EXPECT_TRUE(layer.provider()->open());
    layer.update(Time());
    EXPECT_EQ(layer.lastError.get(), "");
    return *layer.provider()->properties()->property("ColorRamp")->value().string();
  };
  Layer& layer = add({{"Identifier", "L"}, {"Type", "ColorRelief"}, {"ColorRampFile", "ramp.txt"}}, folder_);
  EXPECT_EQ(rampOf(layer), "0 green\n4000 white\n");
  EXPECT_EQ(textAt(layer.table(), {"ColorRampFile"}), folder_ + "/ramp.txt");
  ASSERT_TRUE(layer.provider()->properties()->property("ColorRamp")->set("0 red; 100 blue"));
  EXPECT_EQ(rampOf(again(layer)), "0 red; 100 blue");

  // Also before the file was read.
  Layer& early = add({{"Identifier", "E"}, {"Type", "Slope"}, {"ColorRampFile", "ramp.txt"}}, folder_);
  ASSERT_TRUE(early.provider()->properties()->property("ColorRamp")->set("0 black; 9 white"));
  EXPECT_EQ(rampOf(again(early)), "0 black; 9 white");
  EXPECT_EQ(rampOf(early), "0 black; 9 white");
}

TEST_F(LayerTableTest, MovedLayersStayWhereTheyAre) {
  add({{"Identifier", "Low"}, {"Type", "SolidColor"}, {"ZIndex", 1}}, "/");
  add({{"Identifier", "High"}, {"Type", "SolidColor"}, {"ZIndex", 2}}, "/");
  const Layer& last = add({{"Identifier", "Last"}, {"Type", "SolidColor"}}, "/");
  EXPECT_EQ(last.table().find("ZIndex"), nullptr) << "it goes on top wherever it is read";
  ASSERT_TRUE(manager_.moveLayer("ColorLayers", "Low", 1));
  ASSERT_TRUE(manager_.moveLayer("ColorLayers", "Last", 0));
  LayerManager read;
  for (const auto& layer : manager_.group(LayerGroupId::ColorLayers).layers()) {
    ASSERT_TRUE(read.addLayer("ColorLayers", requestFor(layer->table())));
  }
  std::vector<std::string> order;
  for (const auto& layer : read.group(LayerGroupId::ColorLayers).layers()) {
    order.push_back(layer->identifier() + std::to_string(layer->zIndex()));
  }
  EXPECT_THAT(order, ElementsAre("Last2", "High2", "Low2"));
}

}  // namespace
}  // namespace meridian::globebrowsing

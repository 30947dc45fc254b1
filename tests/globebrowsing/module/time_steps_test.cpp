#include <fstream>
#include <regex>

#include <gmock/gmock.h>

#include "globe_fixture.h"
#include "globebrowsing/surface/chunked_surface.h"

namespace meridian::globebrowsing {
namespace {

/// Layers whose tiles change with time: what is on the screen while they do.
class TimeStepsTest : public GlobeTest {
 protected:
  static constexpr int months = 12;

  /// A folder of one map for each month of 2004, each of a colour of its own.
  Value monthly(const std::string& identifier, int columns = 512, Fields more = {}, int last = months) {
    std::filesystem::create_directory(folder_ / identifier);
    for (int month = 1; month <= last; ++month) {
      uniformRaster(fmt(identifier + "/m2004-%02d.tif", month), colourOf(month), columns);
    }
    more.insert({{"Identifier", identifier},
                 {"Enabled", true},
                 {"Type", "TemporalTileProvider"},
                 {"Mode", "Folder"},
                 {"Folder", tableOf({{"Folder", identifier}, {"Format", "m%Y-%m"}})}});
    return tableOf(std::move(more));
  }
  static std::string fmt(const std::string& format, int number) {
    std::array<char, 256> text{};
    std::snprintf(text.data(), text.size(), format.c_str(), number);
    return text.data();
  }
  static Pixel colourOf(int month) { return {20 * month, 255 - 20 * month, month % 2 == 0 ? 200 : 50}; }
  static Time dayOf(int month, int day = 10) { return *Time::fromUtc(fmt("2004-%02d-", month) + fmt("%02d", day)); }

  /// The months that the picture shows: each month is its colour, 0 something else within the globe.
  std::vector<int> seen() const {
    std::vector<std::uint8_t> rgba(std::size_t{4} * width * height);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, target_->framebuffer());
    glReadPixels(0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
    std::array<int, months + 1> count{};
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        const double fromMiddle = std::hypot(x - width / 2, y - height / 2);
        if (fromMiddle > discRadius_) {
          continue;
        }
        const std::uint8_t* p = &rgba[4 * (static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x))];
        int found = 0;
        for (int month = 1; month <= months; ++month) {
          const Pixel c = colourOf(month);
          if (std::abs(p[0] - c[0]) < 5 && std::abs(p[1] - c[1]) < 5 && std::abs(p[2] - c[2]) < 5) {
            found = month;
          }
        }
        ++count[static_cast<std::size_t>(found)];
      }
    }
    std::vector<int> all;
    for (int month = 0; month <= months; ++month) {
      if (count[static_cast<std::size_t>(month)] > 0) {
        all.push_back(month);
      }
    }
    return all;
  }

  double discRadius_ = 60.0;  ///< pixels from the middle that are surely globe
};

TEST_F(TimeStepsTest, ExchangesATimeForTheWholeViewAtOnce) {
  time_ = dayOf(1);
  RenderableGlobe& globe = addGlobe({{"ColorLayers", listOf({monthly("M")})}});
  ASSERT_TRUE(settle());
  EXPECT_EQ(seen(), std::vector<int>{1});
  for (const int month : {2, 3, 9, 4, 12, 1}) {
    const int before = seen().front();
    time_ = dayOf(month);
    bool exchanged = false;
    ASSERT_TRUE(settle([&] {
      const std::vector<int> now = seen();
      ASSERT_EQ(now.size(), 1U) << "two times at once, or none";
      EXPECT_THAT(now.front(), testing::AnyOf(before, month));
      EXPECT_FALSE(exchanged && now.front() == before) << "back to the time of before";
      exchanged = now.front() == month;
    }));
    EXPECT_EQ(seen(), std::vector<int>{month});
  }
  EXPECT_EQ(globe.layers().group(LayerGroupId::ColorLayers).find("M")->lastError.get(), "");
}

TEST_F(TimeStepsTest, PlaysWithoutABlankAndWithoutGrowing) {
  time_ = dayOf(1, 1);
  addGlobe({{"ColorLayers", listOf({monthly("M")})}});
  ASSERT_TRUE(settle());
  int last = 1;
  int changes = 0;
  std::size_t most = 0;
  // To December and back, twice, three days a frame; and on, until some months have come.
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(90);
  for (int n = 0; n < 2 * 2 * 110 || (changes <= 4 && std::chrono::steady_clock::now() < end); ++n) {
    time_ = time_ + (n / 110 % 2 == 0 ? 3.0 : -3.0) * 86400.0;
    frame();
    const std::vector<int> now = seen();
    ASSERT_EQ(now.size(), 1U) << "in frame " << n;
    ASSERT_NE(now.front(), 0);
    changes += now.front() != last ? 1 : 0;
    last = now.front();
    most = std::max(most, statistics_.memory.tileCache);
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  EXPECT_GT(changes, 4);
  // Six steps of the few tiles that this view needs; that of all twelve months and more would be.
  EXPECT_LT(most, std::size_t{6} * 24 * 528 * 528 * 4);
  time_ = dayOf(1, 1);
  ASSERT_TRUE(settle());
  EXPECT_EQ(seen(), std::vector<int>{1});
}

TEST_F(TimeStepsTest, StaysWholeWhileTheCameraMoves) {
  time_ = dayOf(1, 1);
  addGlobe({{"ColorLayers", listOf({monthly("M", 1024)})}});
  ASSERT_TRUE(settle());
  for (int n = 0; n < 80; ++n) {
    time_ = time_ + 4.0 * 86400.0;
    const double t = n / 80.0;
    look(0.1 + 0.5 * t, 0.2 + 1.5 * t, 1.5e7 - 5e6 * t);
    frame();
    const std::vector<int> now = seen();
    ASSERT_EQ(now.size(), 1U) << "in frame " << n;
    ASSERT_NE(now.front(), 0);
  }
  ASSERT_TRUE(settle());
  EXPECT_EQ(seen(), std::vector<int>{11});
}

TEST_F(TimeStepsTest, KeepsEachLayerAtItsOwnTime) {
  time_ = dayOf(1);
  const Value fixed = monthly("Fixed", 256, {{"UseFixedTime", true}, {"FixedTime", "2004-05-01"}, {"Opacity", 0.0}});
  RenderableGlobe& globe = addGlobe({{"ColorLayers", listOf({monthly("M", 256), fixed})}});
  ASSERT_TRUE(settle());
  time_ = dayOf(3);
  ASSERT_TRUE(settle());
  EXPECT_EQ(seen(), std::vector<int>{3});
  globe.layers().group(LayerGroupId::ColorLayers).find("Fixed")->opacity.put(1.0);
  ASSERT_TRUE(settle([&] { EXPECT_NE(seen().front(), 1) << "a changed setting does not change the time"; }));
  EXPECT_EQ(seen(), std::vector<int>{5});
  Property* date = globe.layers().propertyAt("ColorLayers.Fixed.TileProvider.FixedTime");
  ASSERT_NE(date, nullptr);
  ASSERT_TRUE(date->set("2004-07-01"));
  ASSERT_TRUE(settle());
  EXPECT_EQ(seen(), std::vector<int>{7});
}

TEST_F(TimeStepsTest, SettingsThatChangeAllTheTimeDoNotHoldTimeUp) {
  time_ = dayOf(1);
  RenderableGlobe& globe = addGlobe({{"ColorLayers", listOf({monthly("M", 256)})}});
  ASSERT_TRUE(settle());
  Layer* layer = globe.layers().group(LayerGroupId::ColorLayers).find("M");
  time_ = dayOf(6);
  EXPECT_TRUE(framesUntil([&] {
    layer->opacity.put(layer->opacity.get() < 1.0 ? 1.0 : 0.999);
    return seen() == std::vector<int>{6};
  }));
}

TEST_F(TimeStepsTest, GoesOnWithoutRoomForTwoTimes) {
  setModuleProperty("TexturePoolSize", 64);
  time_ = dayOf(1);
  look(0.1, 0.2, 6.6e6);
  addGlobe({{"ColorLayers", listOf({monthly("M", 4096, {}, 2)})}});
  ASSERT_TRUE(settle());
  time_ = dayOf(2);
  ASSERT_TRUE(settle([&] {
    const std::vector<int> now = seen();
    EXPECT_NE(now.front(), 0);
  }));
  EXPECT_EQ(seen(), std::vector<int>{2});
  EXPECT_EQ(unsettled(), "") << "what was complete stays so";
}

// As a film does it: each frame is drawn once, waited for without drawing, and drawn again.
TEST_F(TimeStepsTest, SettlesInFramesThatAreNotDrawn) {
  time_ = dayOf(1);
  look(0.1, 0.2, 9e6);
  addGlobe({{"ColorLayers", listOf({monthly("M", 2048, {}, 4)})}});
  ASSERT_TRUE(settle());
  for (const int month : {2, 3, 4, 1}) {
    time_ = dayOf(month);
    frame();
    ASSERT_TRUE(framesUntil([&] { return unsettled().empty(); }, false)) << unsettled();
    frame();
    EXPECT_EQ(unsettled(), "");
    EXPECT_EQ(seen(), std::vector<int>{month});
  }
}

// A script may set the time while the first picture of a film is waited for.
TEST_F(TimeStepsTest, GoesOnBeforeAnythingWasDrawn) {
  time_ = dayOf(1);
  look(0.1, 0.2, 9e6);
  addGlobe({{"ColorLayers", listOf({monthly("M", 2048, {}, 2)})}});
  ASSERT_TRUE(framesUntil([&] { return unsettled().empty(); }, false)) << unsettled();
  time_ = dayOf(2);
  frame(false);
  EXPECT_NE(unsettled(), "");
  ASSERT_TRUE(framesUntil([&] { return unsettled().empty(); }, false)) << unsettled();
  frame();
  EXPECT_EQ(unsettled(), "");
  EXPECT_EQ(seen(), std::vector<int>{2});
}

TEST_F(TimeStepsTest, TheNextTimeIsFilledInFramesThatAreNotDrawn) {
  time_ = dayOf(1);
  look(0.1, 0.2, 9e6);
  RenderableGlobe& globe = addGlobe({{"ColorLayers", listOf({monthly("M", 2048, {}, 2)})}});
  ASSERT_TRUE(settle());
  const CompositeStore& store = dynamic_cast<ChunkedSurface&>(*globe.surface()).tiles().composites();
  const std::uint64_t composed = store.composedCount();
  time_ = dayOf(2);
  frame();
  // Exchanged for nothing, it would be seen in whichever frame is drawn next.
  const auto isShown = [&] { return !std::regex_search(unsettled(), std::regex("another time|being opened")); };
  ASSERT_FALSE(isShown()) << unsettled();
  ASSERT_TRUE(framesUntil(isShown, false));
  EXPECT_GT(store.composedCount(), composed);
  frame();
  EXPECT_EQ(seen(), std::vector<int>{2});
}

TEST_F(TimeStepsTest, AFinerTimeIsNotCompleteInTheFrameThatShowsIt) {
  time_ = dayOf(1);
  look(0.1, 0.2, 9e6);
  const Value layer = monthly("M", 64, {}, 2);
  uniformRaster("M/m2004-02.tif", colourOf(2), 4096);
  addGlobe({{"ColorLayers", listOf({layer})}});
  ASSERT_TRUE(settle());
  time_ = dayOf(2);
  ASSERT_TRUE(settle());
  EXPECT_EQ(unsettled(), "") << "what was complete stays so";
}

TEST_F(TimeStepsTest, AnotherPoolIsFilledBeforeItIsDrawnWhileTimeGoesOn) {
  setModuleProperty("CompositionBudget", 0.1);
  time_ = dayOf(1, 1);
  RenderableGlobe& globe = addGlobe({{"ColorLayers", listOf({monthly("M")})}});
  ASSERT_TRUE(settle());
  for (const int size : {128, 256, 512}) {
    setModuleProperty("TexturePoolSize", size);
    const Surface* before = globe.surface();
    int after = 0;
    ASSERT_TRUE(framesUntil([&] {
      time_ = time_ + (time_ > dayOf(11) ? -300.0 : 10.0) * 86400.0;
      const std::vector<int> now = seen();
      EXPECT_EQ(now.size(), 1U) << "two times at once, or none";
      EXPECT_NE(now.front(), 0);
      after += globe.surface() != before ? 1 : 0;
      return testing::Test::HasFailure() || after > 10;
    }));
  }
}

TEST_F(TimeStepsTest, ASequenceFollowsItsIndex) {
  static_cast<void>(monthly("M", 256));
  const Value sequence =
      tableOf({{"Identifier", "S"}, {"Enabled", true}, {"Type", "ImageSequenceTileProvider"}, {"FolderPath", "M"}});
  RenderableGlobe& globe = addGlobe({{"ColorLayers", listOf({sequence})}});
  ASSERT_TRUE(settle());
  EXPECT_EQ(seen(), std::vector<int>{1});
  Property* index = globe.layers().propertyAt("ColorLayers.S.TileProvider.Index");
  ASSERT_NE(index, nullptr);
  for (const int month : {4, 12, 2}) {
    ASSERT_TRUE(index->set(month - 1));
    ASSERT_TRUE(settle([&] { ASSERT_EQ(seen().size(), 1U); }));
    EXPECT_EQ(seen(), std::vector<int>{month});
  }
}

TEST_F(TimeStepsTest, AMissingTimeShowsWhatIsBelowAndSaysSo) {
  time_ = dayOf(1);
  RenderableGlobe& globe = addGlobe(
      {{"ColorLayers", listOf({fileLayer("Below", uniformRaster("b.tif", colourOf(12))), monthly("M", 256)})}});
  std::ofstream(folder_ / "M/m2004-02.tif") << "damaged";
  ASSERT_TRUE(settle());
  EXPECT_EQ(seen(), std::vector<int>{1});
  time_ = dayOf(2);
  ASSERT_TRUE(settle());
  EXPECT_EQ(seen(), std::vector<int>{12});
  Layer* layer = globe.layers().group(LayerGroupId::ColorLayers).find("M");
  EXPECT_THAT(layer->lastError.get(), testing::HasSubstr("m2004-02.tif"));
  time_ = dayOf(3);
  ASSERT_TRUE(settle());
  EXPECT_EQ(seen(), std::vector<int>{3});
  EXPECT_EQ(layer->lastError.get(), "");
}

TEST_F(TimeStepsTest, HeightsFollowTimeToo) {
  std::filesystem::create_directory(folder_ / "H");
  for (int month = 1; month <= 2; ++month) {
    raster(
        fmt("H/m2004-%02d.tif", month), [&](int, double, double) { return 1000.0 * month; }, 1, GDT_Float32, 64);
  }
  const Value heights = tableOf({{"Identifier", "H"},
                                 {"Enabled", true},
                                 {"Type", "TemporalTileProvider"},
                                 {"Mode", "Folder"},
                                 {"Folder", tableOf({{"Folder", "H"}, {"Format", "m%Y-%m"}})}});
  time_ = dayOf(1);
  RenderableGlobe& globe = addGlobe({{"HeightLayers", listOf({heights})}});
  ASSERT_TRUE(settle());
  EXPECT_NEAR(globe.heightAt(0.1, 0.2), 1000.0, 1e-3);
  time_ = dayOf(2);
  ASSERT_TRUE(settle());
  EXPECT_NEAR(globe.heightAt(0.1, 0.2), 2000.0, 1e-3);
}

TEST_F(TimeStepsTest, LayersThatPlayComeAndGo) {
  time_ = dayOf(1);
  RenderableGlobe& globe =
      addGlobe({{"ColorLayers", listOf({fileLayer("Below", uniformRaster("b.tif", colourOf(12)))})}});
  ASSERT_TRUE(settle());
  const Value layer = monthly("M", 256);
  for (int n = 0; n < 30; ++n) {
    time_ = dayOf(1 + n % 11);
    if (n % 3 == 0) {
      ASSERT_TRUE(globe.layers().addLayer("ColorLayers", {layer, "test", "Layer", folder_.string()}));
    } else if (n % 3 == 1) {
      globe.layers().group(LayerGroupId::ColorLayers).find("M")->reset.fire();
    }
    for (int i = 0; i < n % 5; ++i) {
      frame();
      ASSERT_NE(seen().front(), 0);
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    if (n % 3 == 2) {
      ASSERT_TRUE(globe.layers().deleteLayer("ColorLayers", "M"));
    }
  }
  ASSERT_TRUE(settle());
  EXPECT_EQ(seen(), std::vector<int>{12});
}

}  // namespace
}  // namespace meridian::globebrowsing

#include <string>

#include "globe_fixture.h"
#include "support/allocation_count.h"

namespace meridian::globebrowsing {
namespace {

class SteadyFrameTest : public GlobeTest {
 protected:
  std::size_t allocationsInAFrame() {
    const std::array<View, 1> views{view_};
    const FrameContext context{{}, 0.0, 0.0, ++number_, views};
    graphics_->beginFrame();
    target_->bind();
    target_->clear({0.0F, 0.0F, 0.0F, 1.0F});
    const std::size_t before = allocationsOfThisThread();
    for (const auto& [name, renderable] : host_->renderables) {
      renderable->update(context);
    }
    for (const auto& [name, renderable] : host_->renderables) {
      renderable->draw(context, 0);
    }
    const std::size_t after = allocationsOfThisThread();
    graphics_->endFrame();
    return after - before;
  }
};

TEST_F(SteadyFrameTest, AllocatesNothing) {
  const std::string colours = raster(
      "c.tif", [](int band, double longitude, double) { return 100.0 + 20.0 * band + 0.2 * longitude; }, 3, GDT_Byte,
      2048);
  const std::string heights = raster(
      "h.tif",
      [](int, double longitude, double latitude) {
        return 4000.0 * std::sin(0.3 * longitude) * std::cos(0.2 * latitude);
      },
      1, GDT_Float32, 1024);
  const Value series =
      tableOf({{"Identifier", "T"},
               {"Enabled", true},
               {"Opacity", 0.5},
               {"Type", "TemporalTileProvider"},
               {"Prototyped", tableOf({{"Time", tableOf({{"Start", "2000-01-01"}, {"End", "2001-01-01"}})},
                                       {"TemporalResolution", "1M"},
                                       {"TimeFormat", "YYYY"},
                                       {"Prototype", (folder_ / "s${OpenSpaceTimeId}.tif").string()}})}});
  std::filesystem::copy_file(colours, folder_ / "s2000.tif");
  addGlobe({{"ColorLayers", listOf({fileLayer("A", colours), fileLayer("B", colours, {{"Opacity", 0.5}}), series})},
            {"HeightLayers", listOf({fileLayer("H", heights)})},
            {"NightLayers", listOf({fileLayer("N", colours)})},
            {"Overlays", listOf({solidLayer("O", {1, 1, 0}, {{"Opacity", 0.1}})})}},
           {{"PerformShading", true}, {"UseAccurateNormals", true}});
  const std::size_t before = allocationsOfThisThread();
  { const std::string probe(100, 'x'); }
  ASSERT_GT(allocationsOfThisThread(), before) << "the count works";
  for (const double distance : {2e7, 7e6, 6.45e6}) {
    look(0.5, 0.7, distance);
    ASSERT_TRUE(settle());
    ASSERT_EQ(host_->renderables.begin()->second->ground()->settled(0).reason, "");
    for (int n = 0; n < 3; ++n) {
      frame();
    }
    std::size_t most = 0;
    for (int n = 0; n < 20; ++n) {
      most = std::max(most, allocationsInAFrame());
    }
    EXPECT_GT(statistics_.chunks.drawn, 0U);
    EXPECT_EQ(most, 0U) << "at " << distance;
  }
}

}  // namespace
}  // namespace meridian::globebrowsing

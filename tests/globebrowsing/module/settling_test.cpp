// What a globe says of itself while something is under way: it must not say that it is complete and then change.
#include "../streaming/streamer_fixture.h"
#include "globe_fixture.h"

namespace meridian::globebrowsing {
namespace {

/// With services of its own, whose workers and shares can be seen.
class SettlingTest : public GlobeTest {
 protected:
  void SetUp() override {
    GlobeTest::SetUp();
    if (!graphics_) {
      return;
    }
    services_ = std::make_unique<GlobeServices>(owner_, statistics_, "");
    host_->factories["RenderableGlobe"] = [this](const RenderableRequest& request) {
      return RenderableGlobe::create(request, *services_);
    };
  }
  void TearDown() override {
    openGates();
    GlobeTest::TearDown();
  }
  /// Keeps all workers from everything until openGates().
  void closeGates() {
    for (std::size_t i = 0; i < services_->workers().size(); ++i) {
      gates_.push_back(std::make_unique<Gate>(services_->workers()));
    }
  }
  void openGates() {
    for (const auto& gate : gates_) {
      gate->open();
    }
    gates_.clear();
  }

  PropertyOwner owner_{"Services", "Services", ""};
  std::unique_ptr<GlobeServices> services_;
  std::vector<std::unique_ptr<Gate>> gates_;
};

TEST_F(SettlingTest, ALayerThatWasOpenedAfterTheLastUpdateIsStillBeingOpened) {
  const Pixel below{200, 30, 90};
  const Pixel above{20, 130, 190};
  const std::string heights = raster(
      "h.tif", [](int, double, double) { return 1000.0; }, 1, GDT_Float32, 64);
  RenderableGlobe& globe =
      addGlobe({{"ColorLayers", listOf({fileLayer("Below", uniformRaster("b.tif", below)),
                                        fileLayer("Above", uniformRaster("a.tif", above), {{"Enabled", false}})})},
                {"HeightLayers", listOf({fileLayer("H", heights, {{"Enabled", false}})})}});
  ASSERT_TRUE(settle());
  for (const auto& [group, name] :
       {std::pair(LayerGroupId::ColorLayers, "Above"), std::pair(LayerGroupId::HeightLayers, "H")}) {
    closeGates();
    Layer& layer = *globe.layers().group(group).find(name);
    layer.enabled.put(true);
    frame();
    graphics_->programs().waitAll();
    // Until the layer is not waited for any more, and all that can be made without it has been.
    const auto end = std::chrono::steady_clock::now() + std::chrono::milliseconds(700);
    ASSERT_TRUE(framesUntil([&] { return std::chrono::steady_clock::now() > end; }));
    openGates();
    services_->workers().drain();
    EXPECT_EQ(layer.status.get(), "opening");
    EXPECT_EQ(unsettled(), layer.uri() + " is being opened");
    ASSERT_TRUE(settle());
    EXPECT_EQ(centre(), above);
  }
  EXPECT_NEAR(globe.heightAt(0.1, 0.2), 1000.0, 1e-3);
}

}  // namespace
}  // namespace meridian::globebrowsing

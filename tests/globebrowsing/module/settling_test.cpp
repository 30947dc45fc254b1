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

/// Two globes side by side, one of them near.
class SharesTest : public SettlingTest {
 protected:
  void SetUp() override {
    SettlingTest::SetUp();
    if (graphics_) {
      earth_ = &addGlobe({{"ColorLayers", listOf({solidLayer("Red", {1, 0, 0})})}}, {}, "Earth");
      moon_ = &addGlobe({{"ColorLayers", listOf({solidLayer("Grey", {0.5, 0.5, 0.5})})}}, {}, "Moon");
    }
  }
  void update(RenderableGlobe& globe, double distance) {
    look(0.1, 0.2, distance);
    const std::array<View, 1> views{view_};
    globe.update({time_, 0.0, 0.0, number_, views});
  }
  void frameOf(double earthDistance, double moonDistance) {
    ++number_;
    graphics_->beginFrame();
    update(*earth_, earthDistance);
    update(*moon_, moonDistance);
    graphics_->endFrame();
    statistics_.endFrame();
  }
  [[nodiscard]] bool areSettled() const { return earth_->settled(0).complete && moon_->settled(0).complete; }
  [[nodiscard]] bool framesOfUntil(double earthDistance, double moonDistance, const std::function<bool()>& holds) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(90);
    do {
      frameOf(earthDistance, moonDistance);
      if (holds()) {
        return true;
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    } while (std::chrono::steady_clock::now() < end);
    return false;
  }
  /// And stay so.
  void expectSettled(double earthDistance, double moonDistance) {
    ASSERT_TRUE(framesOfUntil(earthDistance, moonDistance, [&] { return areSettled(); }))
        << earth_->settled(0).reason << moon_->settled(0).reason;
    for (int n = 0; n < 5; ++n) {
      frameOf(earthDistance, moonDistance);
      EXPECT_EQ(earth_->settled(0).reason, "");
      EXPECT_EQ(moon_->settled(0).reason, "");
    }
    EXPECT_FALSE(services_->poolShares().isWaitedFor(earth_));
    EXPECT_FALSE(services_->poolShares().isWaitedFor(moon_));
  }

  static constexpr double near = 1e7;
  static constexpr double middle = 1.5e7;
  static constexpr double far = 2.4e7;
  RenderableGlobe* earth_ = nullptr;
  RenderableGlobe* moon_ = nullptr;
};

TEST_F(SharesTest, AGlobeThatIsToHaveTheLargeShareIsNotSettledBeforeItHasIt) {
  expectSettled(near, middle);
  frameOf(far, middle);  // nothing that the moon wants has changed
  EXPECT_EQ(moon_->settled(0).reason, "the globe moves to textures of another size");
  expectSettled(far, middle);
}

TEST_F(SharesTest, AShareThatIsNotNeededAfterAllIsGivenBack) {
  expectSettled(near, middle);
  ASSERT_TRUE(framesOfUntil(far, middle, [&] { return services_->poolShares().isWaitedFor(earth_); }));
  ASSERT_TRUE(framesOfUntil(far, middle, [&] { return !services_->poolShares().isWaitedFor(earth_); }));
  closeGates();
  frameOf(far, middle);  // the moon takes the share, and cannot fill its textures
  frameOf(near, middle);
  frameOf(near, middle);
  openGates();
  expectSettled(near, middle);
}

}  // namespace
}  // namespace meridian::globebrowsing

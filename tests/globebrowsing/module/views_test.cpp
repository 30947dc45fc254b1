// Globes that several views look at, as the screens of a dome do.
#include "../streaming/streamer_fixture.h"
#include "globe_fixture.h"

namespace meridian::globebrowsing {
namespace {

/// Two views, side by side in one picture, of opposite sides of a globe whose colours are those of its longitudes.
class ViewsTest : public GlobeTest {
 protected:
  using Picture = std::vector<std::uint8_t>;
  static constexpr int half = width / 2;
  static constexpr double here = 0.2;          ///< longitudes that are looked at, radians
  static constexpr double there = here + 3.0;  ///< neither sees what the other does

  void SetUp() override {
    GlobeTest::SetUp();
    if (!graphics_) {
      return;
    }
    services_ = std::make_unique<GlobeServices>(owner_, statistics_, "");
    host_->factories["RenderableGlobe"] = [this](const RenderableRequest& request) {
      return RenderableGlobe::create(request, *services_);
    };
    const std::string file = raster(
        "longitudes.tif", [](int band, double longitude, double) { return colourAt(glm::radians(longitude), band); }, 3,
        GDT_Byte, 4096);
    globe_ = &addGlobe({{"ColorLayers", listOf({fileLayer("Longitudes", file)})}});
    views_ = {viewOf(here, 1.5e7), viewOf(there, radius + 3e5)};
    ASSERT_TRUE(settleBoth());
  }
  void TearDown() override {
    openGates();
    GlobeTest::TearDown();
  }
  static double colourAt(double longitude, int band) { return 128.0 + 100.0 * std::sin(3.0 * longitude + 2.0 * band); }
  View viewOf(double longitude, double distance) {
    look(0.05, longitude, distance);
    view_.size = {half, height};
    view_.clipFromCamera = graphics::reversedInfinitePerspective(0.8, double{half} / height, 1.0);
    return view_;
  }
  void frameOfBoth() {
    const FrameContext context{time_, 0.0, 0.0, ++number_, views_};
    graphics_->beginFrame();
    globe_->update(context);
    target_->bind();
    target_->clear({0.0F, 0.0F, 0.0F, 1.0F});
    for (std::size_t view = 0; view < views_.size(); ++view) {
      glViewport(static_cast<GLint>(view) * half, 0, half, height);
      globe_->draw(context, view);
    }
    graphics_->endFrame();
    statistics_.endFrame();
  }
  [[nodiscard]] bool settleBoth(const std::function<void()>& eachFrame = {}) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(90);
    while (std::chrono::steady_clock::now() < end) {
      frameOfBoth();
      if (eachFrame) {
        eachFrame();
      }
      if (globe_->settled(0).complete && globe_->settled(1).complete) {
        return true;
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return false;
  }
  [[nodiscard]] Picture picture(int view) const {
    Picture rgba(std::size_t{4} * half * height);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, target_->framebuffer());
    glReadPixels(view * half, 0, half, height, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
    return rgba;
  }
  /// In the middle of the view: two for rounding, and for the half pixel, of 15 km from the far view.
  void expectMiddle(int view, double longitude) const {
    const Picture rgba = picture(view);
    for (int band = 0; band < 3; ++band) {
      const std::size_t at = 4 * (std::size_t{height / 2} * half + half / 2) + static_cast<std::size_t>(band);
      EXPECT_NEAR(rgba[at], colourAt(longitude, band), 2.0) << "view " << view << ", band " << band;
    }
  }
  void openGates() {
    for (const auto& gate : gates_) {
      gate->open();
    }
    gates_.clear();
  }
  /// Keeps all workers from everything until openGates().
  void closeGates() {
    for (std::size_t i = 0; i < services_->workers().size(); ++i) {
      gates_.push_back(std::make_unique<Gate>(services_->workers()));
    }
  }

  PropertyOwner owner_{"Services", "Services", ""};
  std::unique_ptr<GlobeServices> services_;
  std::vector<std::unique_ptr<Gate>> gates_;
  RenderableGlobe* globe_ = nullptr;
  std::array<View, 2> views_;
};

TEST_F(ViewsTest, EachShowsWhatItLooksAt) {
  expectMiddle(0, here);
  expectMiddle(1, there);
  const std::array<Picture, 2> together{picture(0), picture(1)};
  // One alone, in the place of either: the same chunks of it are drawn, for what only the other sees is not in it.
  const std::array<View, 2> views = views_;
  for (int view = 0; view < 2; ++view) {
    views_ = {views[static_cast<std::size_t>(view)], views[static_cast<std::size_t>(view)]};
    ASSERT_TRUE(settleBoth());
    EXPECT_EQ(picture(0), picture(1));
    EXPECT_EQ(picture(view), together[static_cast<std::size_t>(view)]) << view;
  }
}

TEST_F(ViewsTest, EachIsCompleteByItself) {
  const Picture before = picture(0);
  const auto expectFirstIsComplete = [&] {
    const Settled first = globe_->settled(0);
    EXPECT_TRUE(first.complete) << first.reason;
    EXPECT_EQ(picture(0), before);
  };
  closeGates();
  views_[1] = viewOf(there + 0.5, radius + 3e5);
  for (int n = 0; n < 5; ++n) {
    frameOfBoth();
    expectFirstIsComplete();
    EXPECT_FALSE(globe_->settled(1).complete) << "its tiles are still to be made";
    EXPECT_FALSE(globe_->settled(1).reason.empty());
    EXPECT_FALSE(globe_->settled(40).complete) << "of a view that selection does not know nothing is promised";
  }
  openGates();
  ASSERT_TRUE(settleBoth(expectFirstIsComplete));
  expectMiddle(1, there + 0.5);

  closeGates();
  std::swap(views_[0], views_[1]);
  frameOfBoth();
  EXPECT_TRUE(globe_->settled(0).complete && globe_->settled(1).complete) << "both views have what they see";
}

}  // namespace
}  // namespace meridian::globebrowsing

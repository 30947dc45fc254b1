// A map service's times on the screen.
#include <algorithm>
#include <chrono>
#include <numeric>

#include "globe_fixture.h"
#include "support/nginx_server.h"
#include "support/timed_pyramid.h"

namespace meridian::globebrowsing {
namespace {

class ServiceTimesTest : public GlobeTest {
 protected:
  void SetUp() override {
    GlobeTest::SetUp();
    if (!graphics_) {
      return;
    }
    if (!NginxServer::isInstalled()) {
      GTEST_SKIP() << "nginx is not installed; install nginx-light";
    }
    setModuleProperty("NetworkCacheMode", "off");
    server_ = std::make_unique<NginxServer>();
    pyramid_.write(server_->root(), server_->http1());
    time_ = TimedPyramid::timeOf(0);
  }
  void TearDown() override {
    GlobeTest::TearDown();
    server_.reset();
  }
  [[nodiscard]] TimedPicture seen() const {
    std::vector<std::uint8_t> rgba(std::size_t{4} * width * height);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, target_->framebuffer());
    glReadPixels(0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
    constexpr double surelyGlobe = 60.0;
    return TimedPicture::look(rgba, width, height, surelyGlobe);
  }

  /// About the middle.
  [[nodiscard]] double meanRed() const {
    constexpr int side = 64;
    std::vector<std::uint8_t> red(std::size_t{side} * side);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, target_->framebuffer());
    glReadPixels((width - side) / 2, (height - side) / 2, side, side, GL_RED, GL_UNSIGNED_BYTE, red.data());
    return std::accumulate(red.begin(), red.end(), 0.0) / static_cast<double>(red.size());
  }

  const TimedPyramid pyramid_{.days = 20, .levels = 2};
  std::unique_ptr<NginxServer> server_;
};

TEST_F(ServiceTimesTest, PlaysThroughDaysAndIsNeverBlank) {
  RenderableGlobe& globe =
      addGlobe({{"ColorLayers", listOf({fileLayer("Days", TimedPyramid::filePath(server_->http1()))})}});
  ASSERT_TRUE(settle());
  EXPECT_EQ(seen().colour, 0);
  int last = 0;
  int changes = 0;
  // Through all days; the slower the longer its workers take, as they may be starved.
  double day = 0.0;
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(90);
  for (int n = 1; day < 19.5; ++n) {
    const bool isHeld = day > 15.0 && changes < 3 && std::chrono::steady_clock::now() < end;
    day = isHeld ? day : std::min(day + 0.0975, 19.5);  // never on the stroke of midnight
    time_ = TimedPyramid::timeOf(day);
    frame();
    const TimedPicture now = seen();
    ASSERT_FALSE(now.isBlank) << "in frame " << n;
    ASSERT_FALSE(now.isMixed) << "in frame " << n;
    ASSERT_GE(now.colour, last) << "back in time in frame " << n;
    ASSERT_LE(now.colour, day) << "ahead of time in frame " << n;
    changes += now.colour != last ? 1 : 0;
    last = now.colour;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  EXPECT_GE(changes, 3);
  ASSERT_TRUE(settle());
  EXPECT_EQ(seen().colour, 19);
  const Layer& layer = *globe.layers().group(LayerGroupId::ColorLayers).find("Days");
  EXPECT_EQ(layer.lastError.get(), "");
  EXPECT_EQ(server_->accessLog().find(" 404 "), std::string::npos) << server_->accessLog();
}

TEST_F(ServiceTimesTest, IsInterpolated) {
  addGlobe({{"ColorLayers",
             listOf({fileLayer("Days", TimedPyramid::filePath(server_->http1()), {{"Interpolation", true}})})}});
  for (const double days : {3.25, 3.75, 4.5, 2.5}) {
    time_ = TimedPyramid::timeOf(days);
    ASSERT_TRUE(settle());
    const std::array<int, 3> first = TimedPyramid::colourOf(static_cast<int>(days));
    const std::array<int, 3> second = TimedPyramid::colourOf(static_cast<int>(days) + 1);
    const double expected = std::lerp(first[0], second[0], days - std::floor(days));
    EXPECT_NEAR(meanRed(), expected, 2.0) << "at day " << days;
  }
}

TEST_F(ServiceTimesTest, JumpsToATimeAndBack) {
  addGlobe({{"ColorLayers", listOf({fileLayer("Days", TimedPyramid::filePath(server_->http1()))})}});
  ASSERT_TRUE(settle());
  for (const int day : {7, 3, 19, 0}) {
    time_ = TimedPyramid::timeOf(day + 0.5);
    ASSERT_TRUE(settle([&] { ASSERT_FALSE(seen().isBlank); }));
    EXPECT_EQ(seen().colour, day);
  }
}

}  // namespace
}  // namespace meridian::globebrowsing

// A globe whose every point has a known colour and height, seen from all over: what is drawn is compared pixel by pixel
// with rays cast in double, so a hole, a seam, a black or misplaced tile or a wrong height cannot hide.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <memory>
#include <numbers>
#include <span>
#include <string>

#include <GeographicLib/Geocentric.hpp>
#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "globe_stage.h"
#include "host/graphics/context.h"
#include "host/graphics/shader_cache_folder.h"
#include "picture_check.h"
#include "smooth_world.h"

namespace meridian::globebrowsing::test {

namespace {

constexpr double degree = std::numbers::pi / 180.0;
constexpr double settleSeconds = 60.0;

/// Where an eye is and looks.
struct ViewCase {
  const char* name;
  double latitude;   ///< degrees, geodetic
  double longitude;  ///< degrees
  double altitude;   ///< metres above the ellipsoid, or above the relief
  bool aboveRelief;
  double heading;            ///< degrees from north by east
  double pitch;              ///< degrees above the horizontal
  double fieldOfView = 0.9;  ///< radians, of the picture's height
};
constexpr bool ground = true;
constexpr bool ellipsoid = false;

constexpr SmoothWorld earth{"Earth", {6378137.0, 6378137.0, 6356752.314245}, 5000.0, 9.0,
                            true,    {35.005, 139.02, 0.0005, 16.0}};
constexpr ViewCase earthViews[] = {
    {"whole disc", 20, 30, 2.5e7, ellipsoid, 0, -90},
    {"a few pixels", 10, 200, 9e8, ellipsoid, 0, -90},
    {"whole disc over the north pole", 90, 0, 2e7, ellipsoid, 0, -90},
    {"whole disc over the south pole", -90, 0, 2e7, ellipsoid, 0, -90},
    {"whole disc over the antimeridian", 0, 180, 2e7, ellipsoid, 0, -90},
    {"limb from afar", -35, 70, 8e6, ellipsoid, 120, -60},
    {"1000 km down", 47, 11, 1e6, ellipsoid, 0, -90},
    {"1000 km oblique", 47, 11, 1e6, ellipsoid, 75, -35},
    {"400 km horizon", 51, -120, 4e5, ellipsoid, 230, -15},
    {"100 km horizon over the equator", 0.2, 18, 1e5, ellipsoid, 0, -10},
    {"equator and prime meridian down", 0, 0, 2e5, ellipsoid, 0, -90},
    {"equator and prime meridian oblique", -0.3, -0.3, 3e4, ellipsoid, 45, -25},
    {"north pole down from 500 km", 90, 0, 5e5, ellipsoid, 0, -90},
    {"north pole down from 20 km", 90, 0, 2e4, ellipsoid, 0, -90},
    {"north pole beside", 89.5, 100, 5e4, ellipsoid, 0, -40},
    {"north pole horizon", 89.9, -60, 1.2e4, ellipsoid, 0, -8},
    {"north pole from 2 km across", 89.99, 33, 2e3, ground, 180, -20},
    {"south pole down from 500 km", -90, 0, 5e5, ellipsoid, 0, -90},
    {"south pole beside", -89.5, 10, 5e4, ellipsoid, 180, -40},
    {"south pole horizon", -89.9, 150, 1.2e4, ellipsoid, 180, -8},
    {"south pole from 100 m", -89.999, 20, 100, ground, 180, -15},
    {"antimeridian from the west", 15, 179.9, 5e4, ellipsoid, 90, -30},
    {"antimeridian from the east", 15, -179.9, 5e4, ellipsoid, 270, -30},
    {"antimeridian along it", -40, 180, 3e4, ellipsoid, 0, -12},
    {"antimeridian down from 100 km", 33, -180, 1e5, ellipsoid, 20, -90},
    {"antimeridian and equator", 0, 180, 3e3, ground, 300, -18},
    {"2 km over a mountain", 28, 86, 2e3, ground, 300, -10},
    {"2 km down", -12, -70, 2e3, ground, 0, -90},
    {"100 m horizon", 60, 25, 100, ground, 90, -2},
    {"100 m over the spot", 35.005, 139.02, 100, ground, 0, -90},
    {"20 m over the spot", 35.0049, 139.0201, 20, ground, 30, -30},
    {"2 m over the spot", 35.00498, 139.01997, 2, ground, 45, -20},
    {"20 cm over the spot", 35.00502, 139.02003, 0.2, ground, 190, -35},
    {"100 m oblique", -33, 151, 100, ground, 200, -30},
    {"3 m above the ground", 41, 2, 3, ground, 10, -5},
};

constexpr SmoothWorld mars{"Mars", {3396190.0, 3396190.0, 3376200.0}, 12000.0, 14.0, false};
constexpr ViewCase marsViews[] = {
    {"whole disc", -10, 250, 9e6, ellipsoid, 0, -90},
    {"limb from 600 km", 25, 40, 6e5, ellipsoid, 30, -25},
    {"horizon from 30 km", -45, -65, 3e4, ellipsoid, 250, -6},
    {"2 km over the relief", 18, 226, 2e3, ground, 45, -8},
    {"100 m over the relief", 4, 137, 100, ground, 160, -4},
    {"north pole", 90, 0, 1e5, ellipsoid, 0, -70},
    {"south pole", -89.8, 30, 3e4, ellipsoid, 180, -20},
    {"antimeridian", 5, 180, 2e4, ellipsoid, 90, -14},
    {"limb through a telescope", 0, 0, 4e6, ellipsoid, 40, -62.6, 0.04},
};

constexpr SmoothWorld triaxial{"Triaxial", {3.0e6, 2.5e6, 2.0e6}, 15000.0, 10.0, true};
constexpr ViewCase triaxialViews[] = {
    {"whole body along x", 0, 0, 7e6, ellipsoid, 0, -90},
    {"whole body along y", 0, 90, 7e6, ellipsoid, 0, -90},
    {"whole body along z", 90, 0, 7e6, ellipsoid, 0, -90},
    {"whole body oblique", 30, 50, 6e6, ellipsoid, 20, -90},
    {"limb", -25, 140, 4e5, ellipsoid, 80, -30},
    {"horizon", 40, -30, 5e4, ellipsoid, 200, -8},
    {"2 km over the relief", 12, 75, 2e3, ground, 15, -10},
    {"100 m over the relief", -55, 115, 100, ground, 330, -5},
    {"north pole down", 90, 0, 1e5, ellipsoid, 0, -90},
    {"north pole beside", 89, 45, 4e4, ellipsoid, 0, -25},
    {"south pole", -89.5, 200, 5e4, ellipsoid, 180, -30},
    {"antimeridian", 3, 180, 5e4, ellipsoid, 90, -20},
    {"equator", 0, -45, 3e4, ellipsoid, 0, -90},
};

constexpr SmoothWorld tiny{"Tiny", {13000.0, 11400.0, 9100.0}, 450.0, 8.0, false};
constexpr ViewCase tinyViews[] = {
    {"whole body", 15, 60, 4e4, ellipsoid, 0, -90},
    {"whole body from the pole", 90, 0, 3e4, ellipsoid, 0, -90},
    {"3 km limb", -30, -100, 3e3, ellipsoid, 10, -35},
    {"2 km horizon", 5, 179, 2e3, ellipsoid, 95, -20},
    {"2 km down", 45, -45, 2e3, ground, 0, -90},
    {"100 m horizon", 20, 110, 100, ground, 60, 0},
    {"100 m down", -60, 20, 100, ground, 0, -90},
    {"100 m oblique over the equator", 0, 33, 100, ground, 0, -25},
    {"valley looking up", -15, 20, 25, ground, 320, 8},
    {"valley looking along", -15, 20, 25, ground, 200, 0},
    {"north pole from 100 m", 90, 0, 100, ground, 0, -30},
    {"south pole from 300 m", -89, 77, 300, ground, 180, -20},
    {"antimeridian from 60 m", -14, -180, 60, ground, 270, -8},
};

/// Its relief is a twelfth of its radius, so that what lies below the ellipsoid shows and hides much.
constexpr SmoothWorld hollow{"Hollow", {260000.0, 260000.0, 230000.0}, 20000.0, 7.0, false};
constexpr ViewCase hollowViews[] = {
    {"whole body", -20, 10, 9e5, ellipsoid, 0, -90},
    {"limb", 35, 100, 6e4, ellipsoid, 150, -30},
    {"below the ellipsoid", -25, -105, 500, ground, 30, 0},
    {"below the ellipsoid looking up", -25, -105, 500, ground, 210, 8},
    {"just above the ellipsoid, deep hollow", -25, -105, 300, ellipsoid, 120, -35},
    {"above the ellipsoid, deep hollow", -25, -105, 3e3, ellipsoid, 300, -30},
    {"deep hollow through a long lens", -25, -105, 300, ellipsoid, 120, -25, 0.06},
    {"hollow to its far side through a long lens", -25, -105, 1e3, ellipsoid, 200, -15, 0.06},
    {"low over a ridge", 60, 20, 300, ground, 100, -6},
    {"antimeridian", -20, 180, 5e3, ground, 80, -15},
};

/// Flatter than any body that is known: its face bends twenty-five times less than a sphere, its rim that much more.
constexpr SmoothWorld disc{"Disc", {2.5e6, 2.5e6, 5.0e5}, 3000.0, 6.0, true};
constexpr ViewCase discViews[] = {
    {"whole body on its edge", 0, 20, 7e6, ellipsoid, 0, -90},
    {"whole body on its face", 90, 0, 7e6, ellipsoid, 0, -90},
    {"whole body oblique", 30, 50, 6e6, ellipsoid, 20, -90},
    {"limb", -65, 140, 4e5, ellipsoid, 80, -30},
    {"2 km over the face", 85, 75, 2e3, ground, 15, -10},
    {"along the rim", 0, 180, 5e4, ellipsoid, 90, -20},
    {"north pole beside", 89, 45, 4e4, ellipsoid, 0, -25},
};

Eye eyeOf(const SmoothWorld& world, const ViewCase& view) {
  const double longitude = view.longitude * degree;
  const double heading = view.heading * degree;
  const double pitch = view.pitch * degree;
  const glm::dvec3 up = normalAt(view.latitude, view.longitude);
  const glm::dvec3 east(-std::sin(longitude), std::cos(longitude), 0.0);
  const glm::dvec3 level = std::cos(heading) * glm::cross(up, east) + std::sin(heading) * east;
  const double height = view.altitude + (view.aboveRelief ? world.height(up) : 0.0);
  return {positionOf(up, height, world.radii), std::cos(pitch) * level + std::sin(pitch) * up,
          std::cos(pitch) * up - std::sin(pitch) * level, std::max(0.05, 1e-3 * view.altitude), view.fieldOfView};
}

std::string fileName(const SmoothWorld& world, const std::string& view) {
  std::string name = fmt::format("{} {}.png", world.name, view);
  std::replace(name.begin(), name.end(), ' ', '_');
  return name;
}

/// Within anything that may be drawn, however coarse: a root's 32 segments over half the globe lie at most
/// 2 (1 - cos(pi / 64)) of the radius below the ellipsoid.
Relief innermost(const SmoothWorld& world) {
  const double least = std::min({world.radii.x, world.radii.y, world.radii.z});
  const double inner = 1.0 - world.relief / least - 2.0 * (1.0 - std::cos(std::numbers::pi / 64.0));
  return {inner * world.radii, 0.0, 0.0, [](const glm::dvec3&) { return 0.0; }};
}

class GlobeViews : public ::testing::Test {
 protected:
  static void SetUpTestSuite() { ASSERT_TRUE(graphics::useShaderCacheFolder(MERIDIAN_TEST_FOLDER).has_value()); }

  void SetUp() override {
    auto made = graphics::OffscreenContext::create();
    if (!made) {
      // Where EGL is there, a failure to make a context on it is a failure of ours.
      if (made.error().what.starts_with("no EGL display")) {
        std::cerr << "NO OPENGL HERE, NOTHING IS TESTED: " << made.error().message() << "\n";
        GTEST_SKIP() << made.error().message();
      }
      FAIL() << made.error().message();
    }
    context_ = std::move(*made);
    ASSERT_TRUE(context_->makeCurrent().has_value());
    std::string path = (std::filesystem::temp_directory_path() / "meridian-image-XXXXXX").string();
    ASSERT_NE(mkdtemp(path.data()), nullptr);
    folder_ = path;
  }

  void TearDown() override {
    stage_.reset();
    if (!folder_.empty()) {
      std::filesystem::remove_all(folder_);
    }
  }

  void open(const SmoothWorld& world) {
    ASSERT_NO_THROW(stage_ = std::make_unique<GlobeStage>(*context_, world, folder_));
  }

  static std::filesystem::path pictures() { return std::filesystem::path(MERIDIAN_TEST_FOLDER) / "pictures"; }

  void checkSettled(const SmoothWorld& world, const ViewCase& view) {
    const Eye eye = eyeOf(world, view);
    EXPECT_EQ(stage_->settle(eye, settleSeconds), "") << world.name << ", " << view.name;
    const Expected expected = expectedPicture(world, eye);
    const Pixels drawn = stage_->pixels();
    const Verdict verdict = compare(drawn, expected);
    const bool keep = std::getenv("MERIDIAN_KEEP_PICTURES") != nullptr;
    const std::string picture = verdict.isGood() && !keep
                                    ? std::string()
                                    : writeEvidence(pictures() / fileName(world, view.name), drawn, expected, verdict);
    EXPECT_TRUE(verdict.isGood()) << world.name << ", " << view.name << ": " << verdict.text() << "; see " << picture;
  }

  void checkAll(const SmoothWorld& world, std::span<const ViewCase> views) {
    open(world);
    ASSERT_NE(stage_, nullptr);
    for (const ViewCase& view : views) {
      checkSettled(world, view);
    }
  }

  std::unique_ptr<graphics::OffscreenContext> context_;
  std::unique_ptr<GlobeStage> stage_;
  std::filesystem::path folder_;
};

constexpr std::size_t viewCount = std::size(earthViews) + std::size(marsViews) + std::size(triaxialViews) +
                                  std::size(tinyViews) + std::size(hollowViews) + std::size(discViews);
static_assert(viewCount >= 60);

TEST_F(GlobeViews, EarthIsWhatRaysMeet) {
  checkAll(earth, earthViews);
}
TEST_F(GlobeViews, MarsIsWhatRaysMeet) {
  checkAll(mars, marsViews);
}
TEST_F(GlobeViews, ATriaxialBodyIsWhatRaysMeet) {
  checkAll(triaxial, triaxialViews);
}
TEST_F(GlobeViews, ATinyBodyIsWhatRaysMeet) {
  checkAll(tiny, tinyViews);
}
TEST_F(GlobeViews, ABodyOfHollowsIsWhatRaysMeet) {
  checkAll(hollow, hollowViews);
}
TEST_F(GlobeViews, AFlatBodyIsWhatRaysMeet) {
  checkAll(disc, discViews);
}

/// Frames right after a jump, when only coarser tiles are there.
class GlobeJumps : public GlobeViews {
 protected:
  /// Only eyes above all relief: a coarser surface may lie above the finer one, and the eye within it.
  void jump(const SmoothWorld& world, const ViewCase& from, const ViewCase& to, int frames) {
    ASSERT_EQ(stage_->settle(eyeOf(world, from), settleSeconds), "") << world.name << ", " << from.name;
    const Eye eye = eyeOf(world, to);
    ASSERT_GT(footOf(eye.position, world.radii).height, world.relief) << to.name;
    for (int frame = 0; frame < frames; ++frame) {
      checkUnsettled(world, eye, fmt::format("{} after {}, frame {}", to.name, from.name, frame));
    }
  }

  /// From each view to the next that a jump can lead to.
  void jumpAll(const SmoothWorld& world, std::span<const ViewCase> views, int frames) {
    open(world);
    ASSERT_NE(stage_, nullptr);
    const ViewCase* from = nullptr;
    int jumps = 0;
    for (const ViewCase& view : views) {
      if (footOf(eyeOf(world, view).position, world.radii).height <= world.relief ||
          view.altitude > 10.0 * world.radii.x) {
        continue;
      }
      if (from != nullptr) {
        jump(world, *from, view, frames);
        ++jumps;
      }
      from = &view;
    }
    EXPECT_GE(jumps, 3);
    EXPECT_GE(unsettled_, jumps) << "the jumps showed nothing that was still loading";
  }

  void checkUnsettled(const SmoothWorld& world, const Eye& eye, const std::string& name) {
    const Expected outline = expectedOutline(innermost(world), eye);
    stage_->draw(eye);
    unsettled_ += int{!stage_->globe().settled(0).complete};
    const Pixels drawn = stage_->pixels();
    const Verdict verdict = checkCoverage(drawn, outline);
    EXPECT_TRUE(verdict.isGood()) << world.name << ", " << name << ": " << verdict.text() << "; see "
                                  << writeEvidence(pictures() / fileName(world, name), drawn, outline, verdict);
  }

  int unsettled_ = 0;
};

TEST_F(GlobeJumps, EarthHasNoHoleWhileItLoads) {
  jumpAll(earth, earthViews, 4);
}
TEST_F(GlobeJumps, ATriaxialBodyHasNoHoleWhileItLoads) {
  jumpAll(triaxial, triaxialViews, 4);
}
TEST_F(GlobeJumps, ATinyBodyHasNoHoleWhileItLoads) {
  jumpAll(tiny, tinyViews, 4);
}

TEST_F(GlobeJumps, ADescentHasNoHoleWhileItLoads) {
  open(earth);
  ASSERT_NE(stage_, nullptr);
  constexpr int frames = 80;
  ViewCase view{"descent", 40, 170, 2e7, ellipsoid, 0, -90};
  ASSERT_EQ(stage_->settle(eyeOf(earth, view), settleSeconds), "");
  for (int frame = 0; frame < frames; ++frame) {
    // Down to a kilometre above the highest relief, over the antimeridian, and round by half a turn from frame to frame
    // near the end.
    const double share = frame / (frames - 1.0);
    view.altitude = 6000.0 * std::pow(2e7 / 6000.0, 1.0 - share);
    view.longitude = 170.0 + 12.0 * share;
    view.latitude = 40.0 - 10.0 * share;
    view.pitch = -90.0 + 75.0 * share;
    view.heading = share < 0.8 ? 200.0 * share : 170.0 * frame;
    checkUnsettled(earth, eyeOf(earth, view), fmt::format("descent, frame {}", frame));
  }
  EXPECT_GT(unsettled_, 0) << "nothing was still loading";
}

/// The rays stand on this, so it is held against a library.
TEST(SmoothWorldFoot, AgreesWithGeographicLib) {
  const GeographicLib::Geocentric oracle(6378137.0, 1.0 / 298.257223563);
  const glm::dvec3 radii(6378137.0, 6378137.0, 6378137.0 * (1.0 - 1.0 / 298.257223563));
  for (const double latitude : {-90.0, -60.0, -1e-3, 0.0, 12.3, 45.0, 89.999, 90.0}) {
    for (const double height : {-9000.0, 0.0, 3.0, 8000.0, 4e7}) {
      glm::dvec3 position;
      oracle.Forward(latitude, 137.0, height, position.x, position.y, position.z);
      EXPECT_LT(glm::length(positionOf(normalAt(latitude, 137.0), height, radii) - position), 1e-7);
      const Foot foot = footOf(position, radii);
      EXPECT_NEAR(foot.height, height, 2e-8 * std::max(1.0, std::abs(height) * 1e-6)) << latitude << ", " << height;
      EXPECT_LT(glm::length(foot.normal - normalAt(latitude, 137.0)), 1e-14) << latitude << ", " << height;
    }
  }
}

}  // namespace

}  // namespace meridian::globebrowsing::test

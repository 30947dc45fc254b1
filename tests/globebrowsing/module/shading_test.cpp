#include <algorithm>

#include "globe_fixture.h"

namespace meridian::globebrowsing {
namespace {

/// Globes in the light of a Sun that goes round, compared with formulas of docs/layers.md (Light), evaluated here in
/// double for the very place that each pixel shows.
class ShadingTest : public GlobeTest {
 protected:
  /// One for the rounding of composites to bytes and one for that of the picture. Between the pixels' middles and the
  /// drawn surface (within half a pixel), light changes by less.
  static constexpr double tolerance = 2.0;
  static constexpr double altitude = 3.0e6;
  static constexpr double equatorHere = 0.2;  ///< longitude that is looked at, radians
  static constexpr std::array<double, 7> sunAngles{0.0, 30.0, 60.0, 85.0, 95.0, 120.0, 180.0};

  void SetUp() override {
    GlobeTest::SetUp();
    look(0.0, equatorHere, radius + altitude);
  }
  [[nodiscard]] static glm::dvec3 up() { return {std::cos(equatorHere), std::sin(equatorHere), 0.0}; }
  [[nodiscard]] static glm::dvec3 east() { return {-std::sin(equatorHere), std::cos(equatorHere), 0.0}; }
  /// Degrees from the vertical of the middle of the picture, towards the east or the north of it.
  void lightFrom(double degrees, const glm::dvec3& towards) {
    const double angle = glm::radians(degrees);
    view_.lightDirection = std::cos(angle) * up() + std::sin(angle) * towards;
  }
  static double lambert(double ambient, double sun) { return std::min(ambient + std::max(sun, 0.0), 1.0); }

  /// The place of the ellipsoid, a sphere, that this pixel's middle shows, over its radius; nothing beside the globe
  /// and near its edge, where a pixel spans many degrees.
  [[nodiscard]] std::optional<glm::dvec3> normalAt(int x, int y) const {
    const glm::dvec2 across((2.0 * x + 1.0) / width - 1.0, (2.0 * y + 1.0) / height - 1.0);
    const glm::dvec3 fromCamera(across.x / view_.clipFromCamera[0][0], across.y / view_.clipFromCamera[1][1], -1.0);
    const glm::dvec3 ray = glm::normalize(glm::transpose(glm::dmat3(view_.cameraFromModel)) * fromCamera);
    const double along = -glm::dot(view_.cameraPosition, ray);
    const double past = radius * radius - glm::dot(view_.cameraPosition, view_.cameraPosition) + along * along;
    if (past < 0.0) {
      return std::nullopt;
    }
    const glm::dvec3 normal = (view_.cameraPosition + (along - std::sqrt(past)) * ray) / radius;
    return -glm::dot(normal, ray) > 0.5 ? std::optional(normal) : std::nullopt;
  }
  /// Compares pixels all over the globe with what that says of their normals, 0 to 1; how many.
  int compare(const std::function<glm::dvec3(const glm::dvec3&)>& expected) const {
    std::vector<std::uint8_t> picture(std::size_t{4} * width * height);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, target_->framebuffer());
    glReadPixels(0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, picture.data());
    int compared = 0;
    double most = 0.0;
    for (int y = 2; y < height; y += 5) {
      for (int x = 2; x < width; x += 5) {
        if (const std::optional<glm::dvec3> normal = normalAt(x, y)) {
          const glm::dvec3 colour = 255.0 * expected(*normal);
          for (int channel = 0; channel < 3; ++channel) {
            const double drawn = picture[4 * (static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x)) +
                                         static_cast<std::size_t>(channel)];
            most = std::max(most, std::abs(drawn - colour[channel]));
          }
          ++compared;
        }
      }
    }
    EXPECT_LE(most, tolerance);
    return compared;
  }
};

TEST_F(ShadingTest, LambertsLawOnTheEllipsoid) {
  const glm::dvec3 albedo(1.0, 0.6, 0.2);
  RenderableGlobe& globe =
      addGlobe({{"ColorLayers", listOf({solidLayer("Ground", albedo)})}}, {{"PerformShading", true}});
  for (const double ambient : {0.05, 0.0, 0.4}) {
    globe.ambientIntensity.put(ambient);
    for (const double degrees : sunAngles) {
      for (const glm::dvec3& towards : {east(), glm::dvec3(0, 0, 1)}) {
        SCOPED_TRACE(::testing::Message() << "ambient " << ambient << ", the Sun " << degrees << " degrees away");
        lightFrom(degrees, towards);
        ASSERT_TRUE(settle());
        EXPECT_GT(compare([&](const glm::dvec3& normal) {
                    return albedo * lambert(ambient, glm::dot(normal, view_.lightDirection));
                  }),
                  1000);
      }
    }
  }
}

TEST_F(ShadingTest, AccurateNormalsAreThoseOfTheSlope) {
  // Ground that rises eastward by as much of the radius per radian: by that over 1 on the equator. Beyond 10 degrees it
  // is level.
  constexpr double gradient = 0.3;
  const std::string slope = raster(
      "slope.tif",
      [](int, double longitude, double) {
        return gradient * radius * std::clamp(glm::radians(longitude) - equatorHere, -0.17, 0.17);
      },
      1, GDT_Float32, 2048);
  RenderableGlobe& globe =
      addGlobe({{"ColorLayers", listOf({solidLayer("Ground", glm::dvec3(1.0))})},
                {"HeightLayers", listOf({fileLayer("Slope", slope)})}},
               {{"PerformShading", true}, {"AmbientIntensity", 0.05}, {"UseAccurateNormals", true}});
  // So near that the middle pixel is 0.0002 radians from the place that is looked at, where the height is 0.
  look(0.0, equatorHere, radius + 3.0e5);
  const glm::dvec3 normal = glm::normalize(up() - gradient * east());
  for (const bool accurate : {true, false}) {
    globe.useAccurateNormals.put(accurate);
    for (const glm::dvec3& towards : {east(), -east(), glm::dvec3(0, 0, 1)}) {
      for (const double degrees : sunAngles) {
        lightFrom(degrees, towards);
        ASSERT_TRUE(settle());
        const double expected = 255.0 * lambert(0.05, glm::dot(accurate ? normal : up(), view_.lightDirection));
        EXPECT_NEAR(centre()[0], expected, tolerance)
            << (accurate ? "accurate" : "the ellipsoid's") << ", the Sun " << degrees << " degrees away towards "
            << glm::dot(towards, east());
      }
    }
  }
}

TEST_F(ShadingTest, NightLayersShowWhereTheSunIsLow) {
  const glm::dvec3 ground(0.4, 0.8, 0.2);
  const glm::dvec3 lights(0.8, 0.6, 0.0);
  constexpr double ambient = 0.2;
  RenderableGlobe& globe = addGlobe({{"ColorLayers", listOf({solidLayer("Ground", ground)})},
                                     {"NightLayers", listOf({solidLayer("Lights", lights)})}},
                                    {{"PerformShading", true}, {"AmbientIntensity", ambient}});
  Layer* layer = globe.layers().group(LayerGroupId::NightLayers).find("Lights");
  for (const double opacity : {1.0, 0.5}) {
    layer->opacity.put(opacity);
    for (const double degrees : {0.0, 60.0, 75.0, 85.0, 90.0, 95.0, 105.0, 130.0, 180.0}) {
      SCOPED_TRACE(::testing::Message() << "opacity " << opacity << ", the Sun " << degrees << " degrees away");
      lightFrom(degrees, east());
      ASSERT_TRUE(settle());
      double brightest = 0.0;
      double darkest = 1.0;
      EXPECT_GT(compare([&](const glm::dvec3& normal) {
                  const double sun = glm::dot(normal, view_.lightDirection);
                  // As in docs/layers.md, by the angle instead of by vectors: |normal - sunward / 5| is this.
                  const double length = std::sqrt(1.0 - 0.4 * sun + 0.04);
                  const double night = std::clamp(3.0 * (0.2 - sun) / length, 0.0, 1.0);
                  brightest = std::max(brightest, night);
                  darkest = std::min(darkest, night);
                  const double share = opacity * night * 0.8;
                  return (1.0 - share) * ground * lambert(ambient, sun) + share * lights;
                }),
                1000);
      // Within the picture the Sun is up to 17 degrees higher and lower.
      EXPECT_EQ(brightest > 0.0, degrees > 70.0);
      EXPECT_EQ(darkest > 0.0, degrees > 100.0);
    }
  }
  globe.performShading.put(false);
  ASSERT_TRUE(settle());
  compare([&](const glm::dvec3&) { return ground; });
}

}  // namespace
}  // namespace meridian::globebrowsing

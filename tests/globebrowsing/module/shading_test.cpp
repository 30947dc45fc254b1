// Light on the ground against its formulas: ambient light and Lambert's cosine, on the ellipsoid and on slopes, and
// where night layers show.
#include <algorithm>
#include <optional>

#include "globe_fixture.h"

namespace meridian::globebrowsing {
namespace {

constexpr double degree = std::numbers::pi / 180.0;

class ShadingTest : public GlobeTest {
 protected:
  /// The Sun at that angle from the zenith of the middle of the picture, towards a direction of its horizon.
  void shineFrom(double zenithAngle, const glm::dvec3& towards) {
    view_.lightDirection =
        std::cos(zenithAngle) * glm::normalize(view_.cameraPosition) + std::sin(zenithAngle) * towards;
  }
  [[nodiscard]] Pixel pixel(int x, int y) const {
    std::array<std::uint8_t, 4> rgba{};
    glBindFramebuffer(GL_READ_FRAMEBUFFER, target_->framebuffer());
    glReadPixels(x, y, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
    return {rgba[0], rgba[1], rgba[2]};
  }
  /// The vertical where the middle of the pixel meets the sphere; nothing beside it and close to its outline.
  [[nodiscard]] std::optional<glm::dvec3> vertical(int x, int y) const {
    const glm::dvec2 clip(2.0 * (x + 0.5) / width - 1.0, 2.0 * (y + 0.5) / height - 1.0);
    const glm::dvec3 inCamera(clip.x / view_.clipFromCamera[0][0], clip.y / view_.clipFromCamera[1][1], -1.0);
    const glm::dvec3 along = glm::normalize(glm::transpose(glm::dmat3(view_.cameraFromModel)) * inCamera);
    const double nearest = -glm::dot(view_.cameraPosition, along);
    const double below = radius * radius - glm::dot(view_.cameraPosition, view_.cameraPosition) + nearest * nearest;
    if (below <= 0.0) {
      return std::nullopt;
    }
    const glm::dvec3 up = (view_.cameraPosition + (nearest - std::sqrt(below)) * along) / radius;
    return glm::dot(up, -along) > 0.2 ? std::optional(up) : std::nullopt;
  }

  static constexpr int albedo = 200;
};

TEST_F(ShadingTest, IsAmbientLightAndLambertsCosine) {
  for (const double ambient : {0.05, 0.4}) {
    addGlobe({{"ColorLayers", listOf({fileLayer("Grey", uniformRaster("g.tif", {albedo, albedo, albedo}))})}},
             {{"PerformShading", true}, {"AmbientIntensity", ambient}});
    ASSERT_TRUE(settle());
    for (const double angle : {0.0, 35.0, 80.0, 120.0, 180.0}) {
      shineFrom(angle * degree, glm::normalize(glm::cross(view_.cameraPosition, glm::dvec3(0.3, 0.4, -0.5))));
      ASSERT_TRUE(settle());
      int seen = 0;
      for (int y = 0; y < height; y += 7) {
        for (int x = 0; x < width; x += 7) {
          if (const std::optional<glm::dvec3> up = vertical(x, y)) {
            const double light = std::min(ambient + std::max(glm::dot(*up, view_.lightDirection), 0.0), 1.0);
            // Half a grey level is rounding; the rest is that light is interpolated within cells of five degrees.
            ASSERT_NEAR(pixel(x, y)[0], albedo * light, 1.5)
                << ambient << ", " << angle << " degrees, " << x << ' ' << y;
            ++seen;
          }
        }
      }
      EXPECT_GT(seen, 200);
    }
    removeGlobes();
  }
}

TEST_F(ShadingTest, FollowsSlopesWithAccurateNormals) {
  constexpr double slope = 0.3;
  constexpr double sunAngle = 50.0 * degree;
  constexpr double ambient = 0.05;
  // Ridges and valleys eight degrees apart, straight slopes between them; the middle of the picture is on one.
  const auto zigzag = [](double degrees) {
    return slope * radius * degree * (2.0 - std::abs(std::remainder(degrees - 2.0, 8.0)));
  };
  for (const bool isNorthward : {false, true}) {
    const std::string heights = raster(
        "h.tif", [&](int, double longitude, double latitude) { return zigzag(isNorthward ? latitude : longitude); }, 1,
        GDT_Float32, 2048);
    RenderableGlobe& globe =
        addGlobe({{"ColorLayers", listOf({fileLayer("Grey", uniformRaster("g.tif", {albedo, albedo, albedo}))})},
                  {"HeightLayers", listOf({fileLayer("Zigzag", heights)})}},
                 {{"PerformShading", true}, {"AmbientIntensity", ambient}});
    look(0.0, 0.0, radius + 4e5);
    const glm::dvec3 east(0.0, 1.0, 0.0);
    const glm::dvec3 north(0.0, 0.0, 1.0);
    const glm::dvec3 normal = glm::normalize(glm::dvec3(1.0, 0.0, 0.0) - slope * (isNorthward ? north : east));
    for (const bool areAccurate : {true, false}) {
      globe.useAccurateNormals.put(areAccurate);
      for (const glm::dvec3& towards : {east, -east, north, -north}) {
        shineFrom(sunAngle, towards);
        ASSERT_TRUE(settle());
        const double cosine = areAccurate ? glm::dot(normal, view_.lightDirection) : std::cos(sunAngle);
        // Normals are stored in steps of 1/127 of the steepest.
        EXPECT_NEAR(centre()[0], albedo * (ambient + cosine), 2.5)
            << (isNorthward ? "northward, " : "eastward, ") << areAccurate << " towards " << towards.y << ' '
            << towards.z;
      }
    }
    removeGlobes();
  }
}

TEST_F(ShadingTest, NightLayersShowWhereTheSunHasSet) {
  constexpr double ambient = 0.05;
  constexpr std::array<int, 3> lights{180, 120, 60};
  addGlobe({{"ColorLayers", listOf({fileLayer("Grey", uniformRaster("g.tif", {albedo, albedo, albedo}))})},
            {"NightLayers", listOf({fileLayer("Lights", uniformRaster("n.tif", lights))})}},
           {{"PerformShading", true}, {"AmbientIntensity", ambient}});
  const glm::dvec3 up = glm::normalize(view_.cameraPosition);
  const glm::dvec3 side = glm::normalize(glm::cross(up, glm::dvec3(0.0, 0.0, 1.0)));
  for (const double angle : {0.0, 60.0, 89.0, 94.0, 100.0, 110.0, 125.0, 150.0, 180.0}) {
    shineFrom(angle * degree, side);
    ASSERT_TRUE(settle());
    // From where the Sun is 11 degrees above the horizon to where it is 9 below.
    const glm::dvec3 leaning = glm::normalize(up - 0.2 * view_.lightDirection);
    const double darkness = std::clamp(-3.0 * glm::dot(leaning, view_.lightDirection), 0.0, 1.0);
    const double share = darkness * lights[0] / 255.0;  // dim lights hide less of the ground
    const double ground = albedo * std::min(ambient + std::max(std::cos(angle * degree), 0.0), 1.0);
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_NEAR(centre()[i], ground + share * (lights[i] - ground), 2.0) << angle << " degrees, component " << i;
    }
    if (angle <= 60.0) {
      EXPECT_EQ(darkness, 0.0) << "by day";
    }
    if (angle >= 150.0) {
      EXPECT_EQ(darkness, 1.0) << "at night";
    }
  }
}

}  // namespace
}  // namespace meridian::globebrowsing

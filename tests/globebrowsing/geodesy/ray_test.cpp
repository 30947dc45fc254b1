#include "globebrowsing/geodesy/ray.h"

#include <cmath>
#include <limits>
#include <random>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace meridian::globebrowsing {
namespace {

const glm::dvec3 haumea(1161e3, 852e3, 513e3);

struct Case {
  const char* what;
  glm::dvec3 origin;
  glm::dvec3 direction;
  std::optional<double> expected;
};

TEST(RayTest, TableOfHits) {
  const glm::dvec3 radii(2.0, 3.0, 4.0);
  const Case cases[] = {
      {"head on", {10.0, 0.0, 0.0}, {-1.0, 0.0, 0.0}, 8.0},
      {"in lengths of the direction", {10.0, 0.0, 0.0}, {-2.0, 0.0, 0.0}, 4.0},
      {"looking away", {10.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, std::nullopt},
      {"passing by", {10.0, 3.1, 0.0}, {-1.0, 0.0, 0.0}, std::nullopt},
      {"from the centre", {0.0, 0.0, 0.0}, {0.0, 0.0, 1.0}, 4.0},
      {"from inside, the way out", {0.0, 0.0, 3.0}, {0.0, 0.0, -1.0}, 7.0},
      {"from the surface, inward", {0.0, 3.0, 0.0}, {0.0, -1.0, 0.0}, 0.0},
      {"no direction", {10.0, 0.0, 0.0}, {0.0, 0.0, 0.0}, std::nullopt},
      {"not a number", {std::nan(""), 0.0, 0.0}, {1.0, 0.0, 0.0}, std::nullopt},
      {"infinite", {10.0, 0.0, 0.0}, {-std::numeric_limits<double>::infinity(), 0.0, 0.0}, std::nullopt},
  };
  for (const Case& item : cases) {
    const std::optional<double> hit = nearestHit(item.origin, item.direction, radii);
    ASSERT_EQ(hit.has_value(), item.expected.has_value()) << item.what;
    if (hit) {
      EXPECT_NEAR(*hit, *item.expected, 1e-12) << item.what;
    }
  }
  EXPECT_FALSE(nearestHit({10.0, 0.0, 0.0}, {-1.0, 0.0, 0.0}, {1.0, 0.0, 1.0}).has_value());
}

TEST(RayTest, HitsAreOnTheSurfaceAndTheFirstInFront) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  int hits = 0;
  for (int i = 0; i < 20000; ++i) {
    const glm::dvec3 origin = 3e6 * glm::dvec3(unit(random), unit(random), unit(random));
    const glm::dvec3 target = 1e6 * glm::dvec3(unit(random), unit(random), unit(random));
    const glm::dvec3 direction = glm::normalize(target - origin);
    const std::optional<double> hit = nearestHit(origin, direction, haumea);
    if (!hit) {
      continue;
    }
    ++hits;
    const glm::dvec3 scaled = (origin + *hit * direction) / haumea;
    ASSERT_NEAR(glm::length(scaled), 1.0, 1e-13);
    // Nothing of the ray before the hit crosses the surface.
    const bool inside = glm::length(origin / haumea) < 1.0;
    for (const double part : {0.1, 0.5, 0.9, 0.999}) {
      const double radius = glm::length((origin + part * *hit * direction) / haumea);
      ASSERT_EQ(radius < 1.0, inside);
    }
  }
  EXPECT_GT(hits, 1000);
}

TEST(RayTest, KeepsMetresFromAThousandAstronomicalUnits) {
  constexpr double far = 1.5e14;
  const std::optional<double> hit = nearestHit({far, 0.0, 0.0}, {-1.0, 0.0, 0.0}, {6378137.0, 6378137.0, 6356752.0});
  ASSERT_TRUE(hit.has_value());
  EXPECT_NEAR(far - *hit, 6378137.0, 0.1);
}

}  // namespace
}  // namespace meridian::globebrowsing

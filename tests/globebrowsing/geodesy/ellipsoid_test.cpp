#include "globebrowsing/geodesy/ellipsoid.h"

#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <string>

#include <GeographicLib/Geocentric.hpp>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace meridian::globebrowsing {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double degrees = pi / 180.0;

struct Body {
  std::string name;
  glm::dvec3 radii;
};

void PrintTo(const Body& body, std::ostream* out) {
  *out << body.name;
}

std::string nameOf(const testing::TestParamInfo<Body>& info) {
  return info.param.name;
}

const auto spheroids =
    testing::Values(Body{"Earth", {6378137.0, 6378137.0, 6356752.314245}},
                    Body{"Moon", {1737400.0, 1737400.0, 1737400.0}}, Body{"Mars", {3396190.0, 3396190.0, 3376200.0}},
                    Body{"Saturn", {60268e3, 60268e3, 54364e3}}, Body{"Prolate", {900e3, 900e3, 1100e3}});
const auto triaxial =
    testing::Values(Body{"Phobos", {13000.0, 11400.0, 9100.0}}, Body{"Vesta", {286300.0, 278600.0, 223200.0}},
                    Body{"Haumea", {1161e3, 852e3, 513e3}}, Body{"LongAlongY", {500e3, 700e3, 500e3}},
                    Body{"ShortAlongX", {400e3, 700e3, 600e3}});

Ellipsoid ellipsoidOf(const Body& body) {
  return *Ellipsoid::fromRadii(body.radii);
}

class SpheroidTest : public testing::TestWithParam<Body> {};
class TriaxialTest : public testing::TestWithParam<Body> {};
class AnyEllipsoidTest : public testing::TestWithParam<Body> {};

TEST_P(SpheroidTest, AgreesWithGeographicLibOutwards) {
  const Ellipsoid ellipsoid = ellipsoidOf(GetParam());
  const glm::dvec3& radii = ellipsoid.radii();
  const GeographicLib::Geocentric oracle(radii.x, (radii.x - radii.z) / radii.x);
  // A double in the millions of metres is good to a nanometre; bodies the size of Saturn to ten, and both of us round
  // several times.
  const double tolerance = radii.x < 1e7 ? 1e-8 : 1.6e-15 * radii.x;
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> latitudes(-90.0, 90.0);
  std::uniform_real_distribution<double> longitudes(-180.0, 180.0);
  std::uniform_real_distribution<double> heights(-0.3 * radii.z, 5e6);
  for (int i = 0; i < 20000; ++i) {
    const double latitude = latitudes(random);
    const double longitude = longitudes(random);
    const double height = heights(random);
    glm::dvec3 expected;
    oracle.Forward(latitude, longitude, height, expected.x, expected.y, expected.z);
    const glm::dvec3 ours = ellipsoid.cartesian({latitude * degrees, longitude * degrees, height});
    ASSERT_LT(glm::length(ours - expected), tolerance) << latitude << ' ' << longitude << ' ' << height;
  }
}

TEST_P(SpheroidTest, AgreesWithGeographicLibInwards) {
  const Ellipsoid ellipsoid = ellipsoidOf(GetParam());
  const glm::dvec3& radii = ellipsoid.radii();
  const GeographicLib::Geocentric oracle(radii.x, (radii.x - radii.z) / radii.x);
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> places(-radii.x - 5e6, radii.x + 5e6);
  for (int i = 0; i < 20000; ++i) {
    const glm::dvec3 position(places(random), places(random), places(random));
    GeodeticPosition expected;
    oracle.Reverse(position.x, position.y, position.z, expected.latitude, expected.longitude, expected.height);
    const GeodeticPosition ours = ellipsoid.geodetic(position);
    ASSERT_NEAR(ours.latitude, expected.latitude * degrees, 1e-12);
    ASSERT_NEAR(ours.longitude, expected.longitude * degrees, 1e-12);
    ASSERT_NEAR(ours.height, expected.height, 1e-8);
  }
}

TEST_P(TriaxialTest, NormalIsThatOfTheSurface) {
  const Ellipsoid ellipsoid = ellipsoidOf(GetParam());
  const glm::dvec3& radii = ellipsoid.radii();
  for (int latitude = -90; latitude <= 90; latitude += 6) {
    for (int longitude = -180; longitude <= 180; longitude += 6) {
      const glm::dvec3 point = ellipsoid.cartesian({latitude * degrees, longitude * degrees, 0.0});
      const glm::dvec3 onUnit = point / radii;
      EXPECT_NEAR(glm::dot(onUnit, onUnit), 1.0, 1e-14);
      const glm::dvec3 gradient = glm::normalize(point / (radii * radii));
      const glm::dvec3 normal = ellipsoid.normal(latitude * degrees, longitude * degrees);
      EXPECT_LT(glm::length(gradient - normal), 1e-14) << latitude << ' ' << longitude;
    }
  }
}

TEST_P(TriaxialTest, FootOfAnyPositionIsAtRightAngles) {
  const Ellipsoid ellipsoid = ellipsoidOf(GetParam());
  const double least = ellipsoid.minimumRadius();
  const double most = ellipsoid.maximumRadius();
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  for (int i = 0; i < 20000; ++i) {
    // From deep inside to 5000 km out.
    const double reach = i % 2 == 0 ? most : most + 5e6;
    const glm::dvec3 position = reach * glm::dvec3(unit(random), unit(random), unit(random));
    const GeodeticPosition place = ellipsoid.geodetic(position);
    // Residual of the foot point along and across the normal.
    const glm::dvec3 back = ellipsoid.cartesian(place);
    ASSERT_LT(glm::length(back - position), 1e-8) << position.x << ' ' << position.y << ' ' << position.z;
    ASSERT_GE(place.height, -most - 1e-6);
    // The nearest point: no other foot is, so the height is at most that of the ball that touches from inside.
    ASSERT_LE(std::abs(place.height), glm::length(position) + most);
    if (place.height < 0.0) {
      ASSERT_LE(-place.height, least + 1e-6);
    }
  }
}

TEST_P(TriaxialTest, FootIsTheNearestPoint) {
  const Ellipsoid ellipsoid = ellipsoidOf(GetParam());
  std::mt19937_64 random(4);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  for (int i = 0; i < 200; ++i) {
    const glm::dvec3 position = 1.5 * ellipsoid.maximumRadius() * glm::dvec3(unit(random), unit(random), unit(random));
    const double height = std::abs(ellipsoid.geodetic(position).height);
    for (int j = 0; j < 400; ++j) {
      const glm::dvec3 other = ellipsoid.cartesian({std::asin(unit(random)), pi * unit(random), 0.0});
      ASSERT_GE(glm::length(position - other), height * (1.0 - 1e-12));
    }
  }
}

TEST_P(TriaxialTest, RoundTripsNearTheSurface) {
  const Ellipsoid ellipsoid = ellipsoidOf(GetParam());
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  for (int i = 0; i < 20000; ++i) {
    const double height = i % 2 == 0 ? 5e6 * std::abs(unit(random)) : 0.05 * ellipsoid.minimumRadius() * unit(random);
    const GeodeticPosition place{std::asin(unit(random)), pi * unit(random), height};
    const GeodeticPosition back = ellipsoid.geodetic(ellipsoid.cartesian(place));
    ASSERT_NEAR(back.height, place.height, 1e-8);
    // 5000 km above a body of 10 km a double's last digit is 1e-12 rad of longitude near the pole only.
    ASSERT_NEAR(back.latitude, place.latitude, 1e-12);
    ASSERT_LT(std::abs(std::remainder(back.longitude - place.longitude, 2.0 * pi)) * std::cos(place.latitude), 1e-12);
  }
}

TEST_P(AnyEllipsoidTest, PolesAreExactAndAntimeridiansMeet) {
  const Ellipsoid ellipsoid = ellipsoidOf(GetParam());
  const glm::dvec3 pole(0.0, 0.0, ellipsoid.radii().z);
  for (int longitude = -180; longitude <= 180; longitude += 15) {
    EXPECT_EQ(ellipsoid.cartesian({pi / 2.0, longitude * degrees, 0.0}), pole);
    EXPECT_EQ(ellipsoid.cartesian({-pi / 2.0, longitude * degrees, 0.0}), -pole);
  }
  for (int latitude = -90; latitude <= 90; latitude += 5) {
    for (const double height : {-1000.0, 0.0, 5e5}) {
      EXPECT_EQ(ellipsoid.cartesian({latitude * degrees, pi, height}),
                ellipsoid.cartesian({latitude * degrees, -pi, height}));
    }
  }
  const GeodeticPosition above = ellipsoid.geodetic(1.5 * pole);
  EXPECT_EQ(above.latitude, pi / 2.0);
  EXPECT_EQ(above.longitude, 0.0);
  EXPECT_NEAR(above.height, 0.5 * pole.z, 1e-8);
  EXPECT_EQ(ellipsoid.geodetic(-1.5 * pole).latitude, -pi / 2.0);
}

TEST_P(AnyEllipsoidTest, FiniteInputGivesFiniteOutput) {
  const Ellipsoid ellipsoid = ellipsoidOf(GetParam());
  const double values[] = {0.0,
                           -0.0,
                           1e-320,
                           -1e-200,
                           1e-30,
                           1.0,
                           -1e3,
                           ellipsoid.minimumRadius(),
                           -ellipsoid.maximumRadius(),
                           1e12,
                           -1e30,
                           1e150,
                           std::numeric_limits<double>::max()};
  for (const double x : values) {
    for (const double y : values) {
      for (const double z : values) {
        const GeodeticPosition place = ellipsoid.geodetic({x, y, z});
        ASSERT_TRUE(std::abs(place.latitude) <= pi / 2.0) << x << ' ' << y << ' ' << z;
        ASSERT_TRUE(std::abs(place.longitude) <= pi) << x << ' ' << y << ' ' << z;
        ASSERT_FALSE(std::isnan(place.height)) << x << ' ' << y << ' ' << z;
      }
    }
  }
}

TEST_P(AnyEllipsoidTest, CentreIsBelowTheEndOfTheShortestAxis) {
  const Ellipsoid ellipsoid = ellipsoidOf(GetParam());
  const GeodeticPosition place = ellipsoid.geodetic(glm::dvec3(0.0));
  EXPECT_NEAR(place.height, -ellipsoid.minimumRadius(), 1e-8);
  EXPECT_LT(glm::length(ellipsoid.cartesian(place)), 1e-8);
}

INSTANTIATE_TEST_SUITE_P(Bodies, SpheroidTest, spheroids, nameOf);
INSTANTIATE_TEST_SUITE_P(Bodies, TriaxialTest, triaxial, nameOf);
INSTANTIATE_TEST_SUITE_P(Spheroids, AnyEllipsoidTest, spheroids, nameOf);
INSTANTIATE_TEST_SUITE_P(Triaxial, AnyEllipsoidTest, triaxial, nameOf);

TEST(EllipsoidTest, RefusesRadiiThatAreNoLengths) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  for (const double bad : {0.0, -1.0, nan, infinity, -infinity, 1e-300, 1e300}) {
    for (int axis = 0; axis < 3; ++axis) {
      glm::dvec3 radii(1000.0);
      radii[axis] = bad;
      const Result<Ellipsoid> result = Ellipsoid::fromRadii(radii);
      ASSERT_FALSE(result.has_value());
      EXPECT_FALSE(result.error().remedy.empty());
    }
  }
}

TEST(EllipsoidTest, KnowsItsShape) {
  EXPECT_TRUE(ellipsoidOf({"", {1.0, 1.0, 1.0}}).isSphere());
  EXPECT_TRUE(ellipsoidOf({"", {1.0, 1.0, 2.0}}).isSpheroid());
  EXPECT_FALSE(ellipsoidOf({"", {1.0, 1.0, 2.0}}).isSphere());
  EXPECT_FALSE(ellipsoidOf({"", {1.0, 2.0, 2.0}}).isSpheroid());
  EXPECT_EQ(ellipsoidOf({"", {3.0, 2.0, 1.0}}).minimumRadius(), 1.0);
  EXPECT_EQ(ellipsoidOf({"", {2.0, 3.0, 1.0}}).maximumRadius(), 3.0);
}

TEST(HeightLimitsTest, HoldRealReliefAndNoFillValues) {
  struct Case {
    glm::dvec3 radii;
    std::vector<double> real;
    std::vector<double> wild;
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const Case& body : {Case{{6378137, 6378137, 6356752}, {-11000, 8849}, {-9.9999998e33, -7e6, 1e8, 1e9, nan}},
                           Case{{3396190, 3396190, 3376200}, {-8200, 21900}, {-1e7, 1e7}},
                           Case{{286300, 278600, 223200}, {-22000, 42000}, {-3.4e38, 3.4e38}},
                           Case{{60000, 60000, 60000}, {-40000, 80000}, {-1e5, 2e5}}}) {
    const HeightLimits limits = Ellipsoid::fromRadii(body.radii)->heightLimits();
    for (const double height : body.real) {
      EXPECT_TRUE(limits.hold(height)) << height;
    }
    for (const double height : body.wild) {
      EXPECT_FALSE(limits.hold(height)) << height;
    }
  }
  EXPECT_TRUE(HeightLimits().hold(1e300));
}

}  // namespace
}  // namespace meridian::globebrowsing

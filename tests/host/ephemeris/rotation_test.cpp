#include <cmath>
#include <map>
#include <numbers>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <gtest/gtest.h>

#include "golden.h"
#include "host/ephemeris/frames.h"
#include "host/ephemeris/rotation_model.h"

namespace meridian::ephemeris {

namespace {

constexpr double degree = std::numbers::pi / 180.0;

/// The angle by which the two rotations differ, radians.
double angleBetween(const glm::dmat3& a, const glm::dmat3& b) {
  const glm::dmat3 difference = a - b;
  double square = 0.0;
  for (int i = 0; i < 3; ++i) {
    square += glm::dot(difference[i], difference[i]);
  }
  return std::sqrt(square / 2.0);
}

glm::dmat3 goldenMatrix(const std::string& line) {
  const std::vector<double> m = test::goldenNumbers(line, "matrix_rowmajor");
  return {{m.at(0), m.at(3), m.at(6)}, {m.at(1), m.at(4), m.at(7)}, {m.at(2), m.at(5), m.at(8)}};
}

struct Compared {
  int count = 0;
  double worst = 0.0;
};

/// Every rotation of the file between frames we know, by its frame other than J2000.
std::map<std::string, Compared> compare(const std::string& file) {
  std::map<std::string, Compared> result;
  for (const std::string& line : test::goldenLines(file)) {
    if (test::goldenField(line, "cmd") != "PXFORM") {
      continue;
    }
    const std::string from = test::goldenField(line, "from");
    const std::string to = test::goldenField(line, "to");
    const auto source = Frame::fromName(from);
    const auto destination = Frame::fromName(to);
    if (!source || !destination) {
      continue;
    }
    const Time time(std::stod(test::goldenField(line, "et")));
    Compared& compared = result[from == "J2000" ? to : from];
    ++compared.count;
    compared.worst =
        std::max(compared.worst, angleBetween(rotationBetween(*source, *destination, time), goldenMatrix(line)));
  }
  return result;
}

}  // namespace

TEST(Frames, FixedFramesAgreeWithSpice) {
  if (test::goldenLines("cassini_lesson.jsonl").empty()) {
    GTEST_SKIP() << "NOT CHECKED: no golden files in " << test::goldenFolder();
  }
  auto compared = compare("cassini_lesson.jsonl");
  for (const char* frame : {"GALACTIC", "B1950", "ECLIPJ2000"}) {
    EXPECT_GE(compared[frame].count, 1) << frame;
    EXPECT_LT(compared[frame].worst, 1e-15) << frame;
  }
}

TEST(RotationModels, TheReportOf2009AgreesWithSpiceUnderItsConstants) {
  if (test::goldenLines("cassini_iss_N1702360370.jsonl").empty()) {
    GTEST_SKIP() << "NOT CHECKED: no golden files in " << test::goldenFolder();
  }
  auto compared = compare("cassini_iss_N1702360370.jsonl");
  EXPECT_GE(compared["IAU_ENCELADUS"].count, 3);
  EXPECT_LT(compared["IAU_ENCELADUS"].worst, 1e-11);
}

TEST(RotationModels, AgreeWithOlderReportsWithinWhatTheReportsChanged) {
  if (test::goldenLines("de430_2015.jsonl").empty()) {
    GTEST_SKIP() << "NOT CHECKED: no golden files in " << test::goldenFolder();
  }
  auto compared = compare("de430_2015.jsonl");  // under the constants of 2000
  const std::map<std::string, double> toleranceDegrees = {
      {"IAU_EARTH", 1e-8}, {"IAU_MOON", 1e-8}, {"IAU_VENUS", 1e-8},   {"IAU_URANUS", 1e-8}, {"IAU_MARS", 0.01},
      {"IAU_IO", 1e-8},    {"IAU_TITAN", 0.5}, {"IAU_MERCURY", 0.05}, {"IAU_PHOBOS", 1e-7}, {"IAU_DEIMOS", 1e-7}};
  for (const auto& [frame, tolerance] : toleranceDegrees) {
    EXPECT_GE(compared[frame].count, 4) << frame;
    EXPECT_LT(compared[frame].worst / degree, tolerance) << frame;
  }
}

TEST(RotationModels, TheIauEarthIsNearTheEarthOfPrecessionAndNutation) {
  const auto iau = Frame::fromName("IAU_EARTH");
  const auto terrestrial = Frame::fromName("ITRF93");
  ASSERT_TRUE(iau && terrestrial);
  for (const double years : {-40.0, -1.0, 0.0, 15.5, 26.5, 50.0}) {
    const Time time(years * 365.25 * 86400.0);
    // The model of the report has no nutation, and neither UT1 nor leap seconds: it drifts with TDB - UTC.
    EXPECT_LT(angleBetween(iau->icrfFromFrame(time), terrestrial->icrfFromFrame(time)), 0.35 * degree) << years;
    EXPECT_LT(glm::length(iau->icrfFromFrame(time)[2] - terrestrial->icrfFromFrame(time)[2]), 0.01 * degree) << years;
  }
}

TEST(RotationModels, AreRotationsAtAnyTime) {
  for (const RotationModel& model : rotationModels()) {
    EXPECT_EQ(rotationModel(model.body), &model);
    for (const double seconds : {-2e11, -1.0, 0.0, 8.4e8, 2.5e11}) {
      const glm::dmat3 matrix = icrfFromBody(model, Time(seconds));
      EXPECT_NEAR(glm::determinant(matrix), 1.0, 1e-13) << model.body;
      EXPECT_LT(angleBetween(glm::transpose(matrix) * matrix, glm::dmat3(1.0)), 1e-13) << model.body;
    }
  }
  EXPECT_EQ(rotationModel("NIBIRU"), nullptr);
  EXPECT_NE(rotationModel("earth"), nullptr);
}

TEST(RotationModels, MarsTurnsAsTheReportOf2015Says) {
  // Archinal et al. 2018: the new prime meridian passes where that of 2000 did, 176.630 degrees, at J2000.
  const Orientation mars = orientation(*rotationModel("MARS"), Time(0.0));
  EXPECT_NEAR(mars.primeMeridian / degree, 176.630, 0.01);
  EXPECT_NEAR(mars.poleRightAscension / degree, 317.68143, 0.001);
  EXPECT_NEAR(mars.poleDeclination / degree, 52.88650, 0.001);
}

TEST(Frames, RefuseUnknownNames) {
  for (const char* name : {"", "IAU_", "IAU_NIBIRU", "GALACTICA"}) {
    EXPECT_FALSE(Frame::fromName(name)) << name;
  }
}

}  // namespace meridian::ephemeris

#include "host/ephemeris/frames.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <numbers>

#include <glm/matrix.hpp>

#include "host/ephemeris/rotation_model.h"

namespace meridian::ephemeris {

namespace {

constexpr double radiansPerDegree = std::numbers::pi / 180.0;
constexpr double radiansPerArcsecond = radiansPerDegree / 3600.0;

/// The new axes are the old ones turned about x, or z, by `angle`; the matrix takes old coordinates to new ones.
glm::dmat3 turnX(double angle) {
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  return {{1.0, 0.0, 0.0}, {0.0, c, -s}, {0.0, s, c}};
}
glm::dmat3 turnY(double angle) {
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  return {{c, 0.0, s}, {0.0, 1.0, 0.0}, {-s, 0.0, c}};
}
glm::dmat3 turnZ(double angle) {
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  return {{c, -s, 0.0}, {s, c, 0.0}, {0.0, 0.0, 1.0}};
}

/// NAIF's Frames Required Reading, appendix on inertial frames; angles of Lieske 1979 for the precession.
glm::dmat3 b1950FromIcrf() {
  return turnZ(1152.84248596724 * radiansPerArcsecond) * turnY(-1002.26108439117 * radiansPerArcsecond) *
         turnZ(1153.04066200330 * radiansPerArcsecond);
}

/// Fricke's correction of the FK4's equinox at 1950; the galactic system stands on the FK4.
glm::dmat3 fk4FromB1950() {
  return turnZ(0.525 * radiansPerArcsecond);
}

/// The same appendix; Blaauw et al. 1960 for the galactic pole.
glm::dmat3 galacticFromFk4() {
  return turnZ(327.0 * radiansPerDegree) * turnX(62.6 * radiansPerDegree) * turnZ(282.25 * radiansPerDegree);
}

/// Obliquity of the IAU 1976 system, as SPICE has it.
glm::dmat3 eclipticFromIcrf() {
  return turnX(84381.448 * radiansPerArcsecond);
}

}  // namespace

Result<Frame> Frame::fromName(std::string_view name) {
  std::string key(name);
  std::transform(key.begin(), key.end(), key.begin(), [](unsigned char c) { return std::toupper(c); });
  if (key == "GALACTIC") {
    return galactic();
  }
  if (key == "J2000" || key == "ICRF") {
    return Frame(key, Kind::Fixed);
  }
  if (key == "B1950" || key == "ECLIPJ2000") {
    Frame frame(key, Kind::Fixed);
    frame.icrfFromFixed_ = glm::transpose(key == "B1950" ? b1950FromIcrf() : eclipticFromIcrf());
    return frame;
  }
  if (key == "ITRF93") {
    return Frame(key, Kind::Terrestrial);
  }
  if (key.starts_with("IAU_")) {
    if (const RotationModel* model = rotationModel(std::string_view(key).substr(4))) {
      Frame frame(key, Kind::Body);
      frame.model_ = model;
      return frame;
    }
  }
  return failure("the reference frame '" + std::string(name) + "' is not known", {},
                 "use J2000, B1950, GALACTIC, ECLIPJ2000, ITRF93 or IAU_ and the name of a body with a rotation model");
}

Frame Frame::galactic() {
  static const glm::dmat3 icrfFromGalactic = glm::transpose(galacticFromFk4() * fk4FromB1950() * b1950FromIcrf());
  Frame frame("GALACTIC", Kind::Fixed);
  frame.icrfFromFixed_ = icrfFromGalactic;
  return frame;
}

Frame Frame::icrf() {
  return {"ICRF", Kind::Fixed};
}

glm::dmat3 Frame::icrfFromFrame(const Time& time) const {
  switch (kind_) {
    case Kind::Body:
      return icrfFromBody(*model_, time);
    case Kind::Terrestrial:
      return icrfFromTerrestrial(time);
    case Kind::Fixed:
      break;
  }
  return icrfFromFixed_;
}

glm::dmat3 rotationBetween(const Frame& source, const Frame& destination, const Time& time) {
  return glm::transpose(destination.icrfFromFrame(time)) * source.icrfFromFrame(time);
}

}  // namespace meridian::ephemeris

#include "host/ephemeris/rotation_model.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <numbers>
#include <string>

#include <erfa.h>
#include <glm/geometric.hpp>

namespace meridian::ephemeris {

namespace {

constexpr double secondsPerDay = 86400.0;
constexpr double daysPerCentury = 36525.0;
constexpr double radiansPerDegree = std::numbers::pi / 180.0;

double polynomial(const double (&coefficients)[3], double x) {
  return coefficients[0] + x * (coefficients[1] + x * coefficients[2]);
}

}  // namespace

const RotationModel* rotationModel(std::string_view body) {
  std::string name(body);
  std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return std::toupper(c); });
  const auto models = rotationModels();
  const auto found =
      std::lower_bound(models.begin(), models.end(), name,
                       [](const RotationModel& model, const std::string& key) { return model.body < key; });
  return found != models.end() && found->body == name ? &*found : nullptr;
}

Orientation orientation(const RotationModel& model, const Time& time) {
  const double days = time.tdbSeconds() / secondsPerDay;
  const double centuries = days / daysPerCentury;
  double rightAscension = polynomial(model.rightAscensionDegrees, centuries);
  double declination = polynomial(model.declinationDegrees, centuries);
  // The linear term is reduced to one turn first: far from J2000 it is millions of degrees.
  double meridian = model.meridianDegrees[0] + std::fmod(model.meridianDegrees[1] * days, 360.0) +
                    model.meridianDegrees[2] * days * days;
  for (const PeriodicTerm& term : model.terms) {
    const double angle =
        radiansPerDegree * (term.phaseDegrees + std::fmod(term.rateDegreesPerCentury * centuries, 360.0));
    rightAscension += term.rightAscensionDegrees * std::sin(angle);
    declination += term.declinationDegrees * std::cos(angle);
    meridian += term.meridianDegrees * std::sin(angle);
  }
  return {radiansPerDegree * rightAscension, radiansPerDegree * declination,
          radiansPerDegree * std::fmod(meridian, 360.0)};
}

glm::dmat3 icrfFromBody(const RotationModel& model, const Time& time) {
  const Orientation angles = orientation(model, time);
  const double sinRa = std::sin(angles.poleRightAscension);
  const double cosRa = std::cos(angles.poleRightAscension);
  const double sinDec = std::sin(angles.poleDeclination);
  const double cosDec = std::cos(angles.poleDeclination);
  const glm::dvec3 pole(cosDec * cosRa, cosDec * sinRa, sinDec);
  // W counts from where the body's equator rises through the ICRF's.
  const glm::dvec3 node(-sinRa, cosRa, 0.0);
  const glm::dvec3 ahead = glm::cross(pole, node);
  const double sinW = std::sin(angles.primeMeridian);
  const double cosW = std::cos(angles.primeMeridian);
  return {cosW * node + sinW * ahead, -sinW * node + cosW * ahead, pole};
}

glm::dmat3 icrfFromTerrestrial(const Time& time) {
  const Time::JulianDate tt = time.julianDateTdb();  // TDB for TT: 2 ms, nothing in precession
  const Time::JulianDate utc = time.julianDateUtc();
  double terrestrialFromIcrf[3][3];
  eraC2t06a(tt.day, tt.fraction, utc.day, utc.fraction, 0.0, 0.0, terrestrialFromIcrf);
  glm::dmat3 icrf(1.0);
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      icrf[row][column] = terrestrialFromIcrf[row][column];  // glm has columns: this transposes, that is inverts
    }
  }
  return icrf;
}

}  // namespace meridian::ephemeris

#include "host/ephemeris/kepler.h"

#include <cassert>
#include <cmath>
#include <numbers>

namespace meridian::ephemeris {

Result<void> KeplerElements::validate() const {
  for (const double value : {semiMajorAxis, eccentricity, inclination, ascendingNode, argumentOfPeriapsis,
                             meanAnomalyAtEpoch, epoch.tdbSeconds(), period}) {
    if (!std::isfinite(value)) {
      return failure("an element of the Kepler orbit is not a finite number", {}, "give finite numbers");
    }
  }
  if (semiMajorAxis <= 0.0 || period <= 0.0) {
    return failure("the semi-major axis and the period of a Kepler orbit must be positive", {},
                   "give positive numbers");
  }
  if (eccentricity < 0.0 || eccentricity >= 1.0) {
    return failure("the eccentricity of a Kepler orbit must be at least 0 and below 1", {},
                   "give an ellipse's elements");
  }
  return {};
}

double eccentricAnomaly(double meanAnomaly, double eccentricity) {
  assert(eccentricity >= 0.0 && eccentricity < 1.0 && std::isfinite(meanAnomaly));
  const double turns = 2.0 * std::numbers::pi * std::round(meanAnomaly / (2.0 * std::numbers::pi));
  const double m = meanAnomaly - turns;
  // The left side grows with E, and |e sin E| <= e: the root is in this bracket.
  double low = m - eccentricity;
  double high = m + eccentricity;
  double e = m + std::copysign(0.85 * eccentricity, m);
  for (int i = 0; i < 100 && low < high; ++i) {
    const double residual = e - eccentricity * std::sin(e) - m;
    if (residual == 0.0) {
      break;
    }
    (residual > 0.0 ? high : low) = e;
    double next = e - residual / (1.0 - eccentricity * std::cos(e));
    if (!(next > low && next < high)) {
      next = 0.5 * (low + high);
    }
    if (next == e || next == low || next == high) {
      break;
    }
    e = next;
  }
  return e + turns;
}

glm::dvec3 position(const KeplerElements& elements, const Time& time) {
  // Whole periods go first, so that the angle stays exact for times far from the epoch.
  const double part = std::remainder(time - elements.epoch, elements.period) / elements.period;
  const double anomaly =
      eccentricAnomaly(elements.meanAnomalyAtEpoch + 2.0 * std::numbers::pi * part, elements.eccentricity);
  const double e = elements.eccentricity;
  const double x = elements.semiMajorAxis * (std::cos(anomaly) - e);
  const double y = elements.semiMajorAxis * std::sqrt((1.0 - e) * (1.0 + e)) * std::sin(anomaly);
  const double cosW = std::cos(elements.argumentOfPeriapsis);
  const double sinW = std::sin(elements.argumentOfPeriapsis);
  const double cosN = std::cos(elements.ascendingNode);
  const double sinN = std::sin(elements.ascendingNode);
  const double cosI = std::cos(elements.inclination);
  const double sinI = std::sin(elements.inclination);
  const double alongNode = x * cosW - y * sinW;
  const double acrossNode = x * sinW + y * cosW;
  return {alongNode * cosN - acrossNode * cosI * sinN, alongNode * sinN + acrossNode * cosI * cosN, acrossNode * sinI};
}

}  // namespace meridian::ephemeris

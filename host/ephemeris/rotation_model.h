#pragma once

#include <span>
#include <string_view>

#include <glm/mat3x3.hpp>

#include "host/api/time.h"

namespace meridian::ephemeris {

/// One periodic term of a rotation model: `amplitude` times the sine (right ascension, prime meridian) or the cosine
/// (declination) of the angle `phase + rate * centuries`.
struct PeriodicTerm {
  double phaseDegrees;
  double rateDegreesPerCentury;
  double rightAscensionDegrees;
  double declinationDegrees;
  double meridianDegrees;
};

/// A body's pole and prime meridian as the IAU Working Group on Cartographic Coordinates and Rotational Elements gives
/// them: Archinal et al. 2011 (report of 2009), and for Mars Archinal et al. 2018 (report of 2015). Polynomials in TDB
/// centuries (pole) and TDB days (meridian) past J2000.
struct RotationModel {
  std::string_view body;  ///< as in SPICE's frame IAU_body: "EARTH", "MOON", "ENCELADUS"
  double rightAscensionDegrees[3];
  double declinationDegrees[3];
  double meridianDegrees[3];
  std::span<const PeriodicTerm> terms;
};

/// Every model there is, by name in alphabetical order.
[[nodiscard]] std::span<const RotationModel> rotationModels();

/// The model of that body (any case), or null.
[[nodiscard]] const RotationModel* rotationModel(std::string_view body);

/// Radians; the angles that the reports call alpha0, delta0 and W.
struct Orientation {
  double poleRightAscension;
  double poleDeclination;
  double primeMeridian;
};
[[nodiscard]] Orientation orientation(const RotationModel& model, const Time& time);

/// Turns body-fixed directions (+z the IAU north pole, +x the prime meridian) into ICRF ones.
[[nodiscard]] glm::dmat3 icrfFromBody(const RotationModel& model, const Time& time);

/// The same for the Earth by the IAU 2006/2000A precession-nutation and the Earth rotation angle (ERFA's eraC2t06a),
/// with UT1 = UTC and no polar motion: within 15 arcseconds of the International Terrestrial Reference System.
[[nodiscard]] glm::dmat3 icrfFromTerrestrial(const Time& time);

}  // namespace meridian::ephemeris

#pragma once

#include <string>
#include <string_view>

#include <glm/mat3x3.hpp>

#include "host/api/error.h"
#include "host/api/time.h"

namespace meridian::ephemeris {

struct RotationModel;

/// A named set of axes. Known names, in any case: J2000 and ICRF (one and the same, as in SPICE), B1950, GALACTIC,
/// ECLIPJ2000, IAU_body for every body of rotationModels(), and ITRF93 (the Earth by ERFA; see icrfFromTerrestrial).
///
/// GALACTIC is SPICE's: the galactic system of 1958 applied to SPICE's own FK4 axes. eraIcrs2g differs from it by a
/// fraction of an arcsecond.
class Frame {
 public:
  /// Errors: a name that is not known.
  [[nodiscard]] static Result<Frame> fromName(std::string_view name);
  [[nodiscard]] static Frame galactic();
  [[nodiscard]] static Frame icrf();

  [[nodiscard]] const std::string& name() const { return name_; }
  /// Whether the axes turn with time.
  [[nodiscard]] bool rotates() const { return kind_ == Kind::Body || kind_ == Kind::Terrestrial; }
  [[nodiscard]] glm::dmat3 icrfFromFrame(const Time& time) const;

 private:
  enum class Kind { Fixed, Body, Terrestrial };
  Frame(std::string name, Kind kind) : name_(std::move(name)), kind_(kind) {}
  std::string name_;
  Kind kind_;
  glm::dmat3 icrfFromFixed_{1.0};
  const RotationModel* model_ = nullptr;
};

/// Turns directions given in `source` into `destination`.
[[nodiscard]] glm::dmat3 rotationBetween(const Frame& source, const Frame& destination, const Time& time);

}  // namespace meridian::ephemeris

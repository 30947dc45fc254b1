#pragma once

#include <optional>
#include <string_view>

#include <glm/vec3.hpp>

#include "host/api/time.h"

namespace meridian::ephemeris {

/// A body or barycentre by its NAIF number: 0 is the solar-system barycentre, 3 the Earth-Moon barycentre, 10 the Sun,
/// 301 the Moon, 399 the Earth.
using BodyId = int;

/// By name ("EARTH", "Earth Barycenter", "SSB", "SOLAR_SYSTEM_BARYCENTER", any case, blanks and underscores alike) or
/// by number as text ("399"). Nothing for a name that is not in our list; a number is taken as it is.
[[nodiscard]] std::optional<BodyId> bodyId(std::string_view nameOrNumber);

/// Whether relativePosition knows that body: the solar-system barycentre, the Sun, Mercury to Neptune with their
/// barycentres, and the Moon.
[[nodiscard]] bool hasPosition(BodyId body);

/// Where `target` is as seen from `observer`: metres along the ICRF axes, geometric (no light time, no aberration).
/// Both must be known; asserts otherwise. Zero when they are the same.
///
/// Series: Earth and Sun eraEpv00 (barycentric to 5 km rms over 1900-2100), planets eraPlan94 (1000-3000;
/// at most 6 arcseconds for Mercury to 87 for Saturn as seen from the Sun within 1800-2050), Moon eraMoon98 (3
/// arcseconds and 6 km rms over 1950-2100, 32 km at worst). Beyond those years the answers grow worse slowly but stay
/// finite. The outer planets' centres are taken to be at their barycentres (Jupiter 200 km, Neptune 75 km off at most).
/// Relations go through the nearest common centre, so that Moon and Earth are exact to each other.
[[nodiscard]] glm::dvec3 relativePosition(BodyId target, BodyId observer, const Time& time);

}  // namespace meridian::ephemeris

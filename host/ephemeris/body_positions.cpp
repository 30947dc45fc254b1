#include "host/ephemeris/body_positions.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cctype>
#include <charconv>
#include <string>

#include <erfa.h>
#include <erfam.h>

namespace meridian::ephemeris {

namespace {

constexpr BodyId solarSystemBarycenter = 0;
constexpr BodyId earthMoonBarycenter = 3;
constexpr BodyId sun = 10;
constexpr BodyId moon = 301;
constexpr BodyId earth = 399;
/// IAU 2009 system of astronomical constants.
constexpr double earthToMoonMass = 81.30056907419062;

struct NamedBody {
  std::string_view name;
  BodyId id;
};

constexpr std::array namedBodies = {
    NamedBody{"SSB", 0},
    NamedBody{"SOLAR SYSTEM BARYCENTER", 0},
    NamedBody{"MERCURY BARYCENTER", 1},
    NamedBody{"VENUS BARYCENTER", 2},
    NamedBody{"EARTH BARYCENTER", 3},
    NamedBody{"EARTH MOON BARYCENTER", 3},
    NamedBody{"EARTH-MOON BARYCENTER", 3},
    NamedBody{"EMB", 3},
    NamedBody{"MARS BARYCENTER", 4},
    NamedBody{"JUPITER BARYCENTER", 5},
    NamedBody{"SATURN BARYCENTER", 6},
    NamedBody{"URANUS BARYCENTER", 7},
    NamedBody{"NEPTUNE BARYCENTER", 8},
    NamedBody{"PLUTO BARYCENTER", 9},
    NamedBody{"SUN", 10},
    NamedBody{"MERCURY", 199},
    NamedBody{"VENUS", 299},
    NamedBody{"MOON", 301},
    NamedBody{"EARTH", 399},
    NamedBody{"PHOBOS", 401},
    NamedBody{"DEIMOS", 402},
    NamedBody{"MARS", 499},
    NamedBody{"IO", 501},
    NamedBody{"EUROPA", 502},
    NamedBody{"GANYMEDE", 503},
    NamedBody{"CALLISTO", 504},
    NamedBody{"JUPITER", 599},
    NamedBody{"MIMAS", 601},
    NamedBody{"ENCELADUS", 602},
    NamedBody{"TETHYS", 603},
    NamedBody{"DIONE", 604},
    NamedBody{"RHEA", 605},
    NamedBody{"TITAN", 606},
    NamedBody{"HYPERION", 607},
    NamedBody{"IAPETUS", 608},
    NamedBody{"PHOEBE", 609},
    NamedBody{"SATURN", 699},
    NamedBody{"ARIEL", 701},
    NamedBody{"UMBRIEL", 702},
    NamedBody{"TITANIA", 703},
    NamedBody{"OBERON", 704},
    NamedBody{"MIRANDA", 705},
    NamedBody{"URANUS", 799},
    NamedBody{"TRITON", 801},
    NamedBody{"NEREID", 802},
    NamedBody{"PROTEUS", 808},
    NamedBody{"NEPTUNE", 899},
    NamedBody{"CHARON", 901},
    NamedBody{"PLUTO", 999},
};

/// From astronomical units. The series' axes are taken to be the ICRF's: they differ by 0.02 arcseconds.
glm::dvec3 metres(const double (&position)[3]) {
  return glm::dvec3(position[0], position[1], position[2]) * ERFA_DAU;
}

struct Bodies {
  glm::dvec3 earthFromBarycenter;
  glm::dvec3 earthFromSun;
};

Bodies earthAndSun(const Time& time) {
  const Time::JulianDate tdb = time.julianDateTdb();
  double heliocentric[2][3];
  double barycentric[2][3];
  // Its status only warns of years outside 1900 to 2100, which the header speaks of.
  static_cast<void>(eraEpv00(tdb.day, tdb.fraction, heliocentric, barycentric));
  return {metres(barycentric[0]), metres(heliocentric[0])};
}

glm::dvec3 moonFromEarth(const Time& time) {
  const Time::JulianDate tdb = time.julianDateTdb();
  double state[2][3];
  eraMoon98(tdb.day, tdb.fraction, state);
  return metres(state[0]);
}

glm::dvec3 planetFromSun(int planet, const Time& time) {
  const Time::JulianDate tdb = time.julianDateTdb();
  double state[2][3];
  static_cast<void>(eraPlan94(tdb.day, tdb.fraction, planet, state));
  return metres(state[0]);
}

/// What a body's position is given from.
BodyId centre(BodyId body) {
  if (body == moon || body == earth) {
    return earthMoonBarycenter;
  }
  if (body > 100) {
    return body / 100;  // a planet stands at its barycentre
  }
  return body == sun || body == earthMoonBarycenter ? solarSystemBarycenter : sun;
}

glm::dvec3 fromCentre(BodyId body, const Time& time) {
  switch (body) {
    case sun: {
      const Bodies bodies = earthAndSun(time);
      return bodies.earthFromBarycenter - bodies.earthFromSun;
    }
    case earthMoonBarycenter:
      return earthAndSun(time).earthFromBarycenter + moonFromEarth(time) / (1.0 + earthToMoonMass);
    case earth:
      return -moonFromEarth(time) / (1.0 + earthToMoonMass);
    case moon:
      return moonFromEarth(time) * (earthToMoonMass / (1.0 + earthToMoonMass));
    default:
      return body > 100 ? glm::dvec3(0.0) : planetFromSun(body, time);
  }
}

/// The body itself first, the solar-system barycentre last; returns how many.
std::size_t chain(BodyId body, std::array<BodyId, 5>& centres) {
  std::size_t count = 0;
  centres[count++] = body;
  while (body != solarSystemBarycenter) {
    body = centre(body);
    centres[count++] = body;
  }
  return count;
}

}  // namespace

std::optional<BodyId> bodyId(std::string_view nameOrNumber) {
  std::string name(nameOrNumber);
  std::transform(name.begin(), name.end(), name.begin(),
                 [](unsigned char c) { return static_cast<char>(c == '_' ? ' ' : std::toupper(c)); });
  int number = 0;
  const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), number);
  if (error == std::errc() && end == name.data() + name.size()) {
    return number;
  }
  const auto found =
      std::find_if(namedBodies.begin(), namedBodies.end(), [&](const NamedBody& body) { return body.name == name; });
  return found != namedBodies.end() ? std::optional(found->id) : std::nullopt;
}

bool hasPosition(BodyId body) {
  const bool planet = body > 100 && body < 900 && body % 100 == 99;
  return (body >= 0 && body <= 8) || body == sun || body == moon || planet;
}

glm::dvec3 relativePosition(BodyId target, BodyId observer, const Time& time) {
  assert(hasPosition(target) && hasPosition(observer));
  std::array<BodyId, 5> ofTarget{};
  std::array<BodyId, 5> ofObserver{};
  std::size_t targetCount = chain(target, ofTarget);
  std::size_t observerCount = chain(observer, ofObserver);
  if ((target == earth && observer == moon) || (target == moon && observer == earth)) {
    return target == moon ? moonFromEarth(time) : -moonFromEarth(time);
  }
  // Both chains end at the barycentre: drop what they share, but for the nearest common centre.
  while (targetCount > 1 && observerCount > 1 && ofTarget[targetCount - 2] == ofObserver[observerCount - 2]) {
    --targetCount;
    --observerCount;
  }
  glm::dvec3 sum(0.0);
  for (std::size_t i = 0; i + 1 < targetCount; ++i) {
    sum += fromCentre(ofTarget[i], time);
  }
  for (std::size_t i = 0; i + 1 < observerCount; ++i) {
    sum -= fromCentre(ofObserver[i], time);
  }
  return sum;
}

}  // namespace meridian::ephemeris

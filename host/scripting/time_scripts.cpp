#include "host/scripting/time_scripts.h"

#include <array>
#include <charconv>
#include <chrono>
#include <cmath>

#include <fmt/format.h>

namespace meridian::scripting {

namespace {

constexpr double secondsPerDay = 86400.0;
constexpr double secondsPerJulianYear = 365.25 * secondsPerDay;

// How long OpenSpace's clock takes where a script does not say.
constexpr double timeSeconds = 2.0;
constexpr double deltaSeconds = 1.0;
constexpr double pauseSeconds = 0.5;
constexpr double unpauseSeconds = 1.0;

using Arguments = std::span<const Value>;

Result<Time> timeAt(Arguments arguments, std::size_t i) {
  const Value& value = arguments[i];
  if (const auto seconds = value.number(); seconds && std::isfinite(*seconds)) {
    return Time(*seconds);
  }
  if (const std::string* text = value.string()) {
    return Time::fromUtc(*text);
  }
  return failure(fmt::format("argument {} must be a time: TDB seconds past J2000 or a UTC date", i + 1));
}

Result<double> numberAt(Arguments arguments, std::size_t i, std::optional<double> otherwise = {}) {
  if (otherwise && (i >= arguments.size() || arguments[i].isNil())) {
    return *otherwise;
  }
  const auto number = i < arguments.size() ? arguments[i].number() : std::nullopt;
  if (!number || !std::isfinite(*number)) {
    return failure(fmt::format("argument {} must be a finite number", i + 1));
  }
  return *number;
}

Result<Time> movedOnCalendar(Time base, double months) {
  using namespace std::chrono;
  const std::string text = base.utc();
  const std::size_t day = text.find('T');
  if (day == std::string::npos || day < 8 || months != std::floor(months) || std::abs(months) > 1e6) {
    return failure("the calendar cannot be moved by that", {}, "give a whole number of months or years");
  }
  const int yearNow = std::stoi(text.substr(0, day - 6));
  const int total = yearNow * 12 + std::stoi(text.substr(day - 5, 2)) - 1 + static_cast<int>(months);
  const int newYear = total >= 0 ? total / 12 : -((-total + 11) / 12);
  const auto newMonth = static_cast<unsigned>(total - newYear * 12 + 1);
  const unsigned last =
      static_cast<unsigned>(year_month_day_last(year(newYear), month_day_last(month(newMonth))).day());
  const unsigned newDay = std::min(static_cast<unsigned>(std::stoi(text.substr(day - 2, 2))), last);
  return Time::fromUtc(fmt::format("{:04}-{:02}-{:02}{}", newYear, newMonth, newDay, text.substr(day)));
}

/// "2026 NOV 22 21:17:05.250".
std::string asSpiceWritesIt(Time time) {
  static constexpr std::array<std::string_view, 12> months{"JAN", "FEB", "MAR", "APR", "MAY", "JUN",
                                                           "JUL", "AUG", "SEP", "OCT", "NOV", "DEC"};
  std::string utc = time.utc();
  const std::size_t day = utc.find('T');
  if (day == std::string::npos || day < 8) {
    return utc;
  }
  const int month = std::stoi(utc.substr(day - 5, 2));
  return fmt::format("{} {} {} {}", utc.substr(0, day - 6), months.at(static_cast<std::size_t>(month - 1)),
                     utc.substr(day - 2, 2), utc.substr(day + 1));
}

ScriptFunction action(std::string name, std::string description, std::function<void()> act) {
  return {std::move(name), "", std::move(description), 0, 0, [act = std::move(act)](Arguments) -> ScriptResult {
            act();
            return {};
          }};
}

ScriptFunction reading(std::string name, std::string description, std::function<Value()> read) {
  return {std::move(name), "", std::move(description), 0, 0, [read = std::move(read)](Arguments) -> ScriptResult {
            return std::vector<Value>{read()};
          }};
}

void addSpeedFunctions(ScriptLibrary& library, Clock& clock) {
  auto& functions = library.functions;
  functions.push_back({"setDeltaTime", "seconds", "Simulation seconds per second, at once.", 1, 1,
                       [&clock](Arguments a) -> ScriptResult {
                         return numberAt(a, 0).map([&](double speed) {
                           clock.setDeltaTime(speed);
                           return std::vector<Value>();
                         });
                       }});
  functions.push_back({"interpolateDeltaTime", "seconds, duration?", "The same, over a time.", 1, 2,
                       [&clock](Arguments a) -> ScriptResult {
                         const Result<double> speed = numberAt(a, 0);
                         const Result<double> seconds = numberAt(a, 1, deltaSeconds);
                         if (!speed || !seconds) {
                           return tl::make_unexpected(!speed ? speed.error() : seconds.error());
                         }
                         clock.interpolateDeltaTime(*speed, *seconds);
                         return {};
                       }});
  functions.push_back({"setDeltaTimeSteps", "list", "The speeds that next and previous go through.", 1, 1,
                       [&clock](Arguments a) -> ScriptResult {
                         const auto steps = a[0].numbers();
                         if (!steps || steps->empty()) {
                           return failure("argument 1 must be a list of numbers");
                         }
                         clock.setDeltaTimeSteps(*steps);
                         return {};
                       }});
  functions.push_back(action("setNextDeltaTimeStep", "The next faster speed, at once.",
                             [&clock] { clock.setDeltaTime(clock.nextDeltaTimeStep()); }));
  functions.push_back(action("setPreviousDeltaTimeStep", "The next slower speed, at once.",
                             [&clock] { clock.setDeltaTime(clock.previousDeltaTimeStep()); }));
  functions.push_back(action("interpolateNextDeltaTimeStep", "The next faster speed, over a second.",
                             [&clock] { clock.interpolateDeltaTime(clock.nextDeltaTimeStep(), deltaSeconds); }));
  functions.push_back(action("interpolatePreviousDeltaTimeStep", "The next slower speed, over a second.",
                             [&clock] { clock.interpolateDeltaTime(clock.previousDeltaTimeStep(), deltaSeconds); }));
  functions.push_back(
      reading("deltaTime", "Simulation seconds per second when not paused.", [&clock] { return clock.deltaTime(); }));
}

void addPauseFunctions(ScriptLibrary& library, Clock& clock) {
  const auto setter = [&clock](std::string name, bool atOnce) {
    return ScriptFunction{std::move(name),
                          "paused",
                          "Pauses the simulation or lets it go on.",
                          1,
                          1,
                          [&clock, atOnce](Arguments a) -> ScriptResult {
                            const auto paused = a[0].boolean();
                            if (!paused) {
                              return failure("argument 1 must be a boolean");
                            }
                            clock.interpolatePause(*paused, atOnce ? 0.0 : (*paused ? pauseSeconds : unpauseSeconds));
                            return {};
                          }};
  };
  const auto toggle = [&clock] {
    clock.interpolatePause(!clock.isPaused(), clock.isPaused() ? unpauseSeconds : pauseSeconds);
  };
  auto& functions = library.functions;
  functions.push_back(setter("setPause", true));
  functions.push_back(setter("interpolatePause", false));
  functions.push_back(
      action("togglePause", "Pauses or goes on, at once.", [&clock] { clock.setPause(!clock.isPaused()); }));
  functions.push_back(action("interpolateTogglePause", "Pauses or goes on, gently.", toggle));
  functions.push_back(action("pauseToggleViaKeyboard", "Pauses or goes on, gently.", toggle));
  functions.push_back(reading("isPaused", "Whether the simulation is paused.", [&clock] { return clock.isPaused(); }));
}

void addTimeFunctions(ScriptLibrary& library, Clock& clock) {
  auto& functions = library.functions;
  functions.push_back(
      {"setTime", "time", "At once; seconds past J2000 or a UTC date.", 1, 1, [&clock](Arguments a) -> ScriptResult {
         return timeAt(a, 0).map([&](Time time) {
           clock.setTime(time);
           return std::vector<Value>();
         });
       }});
  functions.push_back(
      {"interpolateTime", "time, duration?", "The same, over a time.", 1, 2, [&clock](Arguments a) -> ScriptResult {
         const Result<Time> time = timeAt(a, 0);
         const Result<double> seconds = numberAt(a, 1, timeSeconds);
         if (!time || !seconds) {
           return tl::make_unexpected(!time ? time.error() : seconds.error());
         }
         clock.interpolateTime(*time, *seconds);
         return {};
       }});
  functions.push_back({"interpolateTimeRelative", "seconds, duration?", "By so many simulation seconds.", 1, 2,
                       [&clock](Arguments a) -> ScriptResult {
                         const Result<double> change = numberAt(a, 0);
                         const Result<double> seconds = numberAt(a, 1, timeSeconds);
                         if (!change || !seconds) {
                           return tl::make_unexpected(!change ? change.error() : seconds.error());
                         }
                         clock.interpolateTime(clock.time() + *change, *seconds);
                         return {};
                       }});
  functions.push_back(
      reading("currentTime", "TDB seconds past J2000.", [&clock] { return clock.time().tdbSeconds(); }));
  functions.push_back(reading("UTC", "The simulation's time as a UTC date.", [&clock] { return clock.time().utc(); }));
  functions.push_back(
      {"SPICE", "format?", "The same as SPICE writes it by default; formats are not heeded.", 0, 1,
       [&clock](Arguments) -> ScriptResult { return std::vector<Value>{asSpiceWritesIt(clock.time())}; }});
}

void addConversions(ScriptLibrary& library) {
  auto& functions = library.functions;
  functions.push_back({"advancedTime", "base, change", "A time moved by seconds or by \"[-]N\" and s, m, h, d, M or y.",
                       2, 2, [](Arguments a) -> ScriptResult {
                         Result<Time> time = timeAt(a, 0);
                         if (time && a[1].number()) {
                           time = numberAt(a, 1).map([&](double seconds) { return *time + seconds; });
                         } else if (time && a[1].string() != nullptr) {
                           time = advanced(*time, *a[1].string());
                         } else if (time) {
                           return failure("argument 2 must be a number of seconds or a text like \"-3d\"");
                         }
                         return time.map([&](Time moved) {
                           return std::vector<Value>{a[0].number() ? Value(moved.tdbSeconds()) : Value(moved.utc())};
                         });
                       }});
  functions.push_back({"convertTime", "time", "A UTC date for seconds past J2000, and the reverse.", 1, 1,
                       [](Arguments a) -> ScriptResult {
                         return timeAt(a, 0).map([&](Time time) {
                           return std::vector<Value>{a[0].number() ? Value(time.utc()) : Value(time.tdbSeconds())};
                         });
                       }});
  functions.push_back(
      {"duration", "start, end", "Seconds from one time to another.", 2, 2, [](Arguments a) -> ScriptResult {
         const Result<Time> start = timeAt(a, 0);
         const Result<Time> end = timeAt(a, 1);
         if (!start || !end) {
           return tl::make_unexpected(!start ? start.error() : end.error());
         }
         return std::vector<Value>{*end - *start};
       }});
  functions.push_back(reading("secondsPerDay", "86400.", [] { return secondsPerDay; }));
  functions.push_back(reading("secondsPerYear", "Of a Julian year.", [] { return secondsPerJulianYear; }));
}

}  // namespace

Result<Time> advanced(Time base, std::string_view change) {
  double number = 0.0;
  const char* end = change.data() + change.size();
  const auto [unit, status] = std::from_chars(change.data(), end, number);
  if (status != std::errc() || end - unit != 1 || !std::isfinite(number)) {
    return failure(fmt::format("\"{}\" is no change of time", change), {},
                   "write a number and one of s, m, h, d, M (months), y");
  }
  switch (*unit) {
    case 's':
      return base + number;
    case 'm':
      return base + number * 60.0;
    case 'h':
      return base + number * 3600.0;
    case 'd':
      return base + number * secondsPerDay;
    case 'M':
      return movedOnCalendar(base, number);
    case 'y':
      return movedOnCalendar(base, number * 12.0);
    default:
      return failure(fmt::format("\"{}\" has an unknown unit", change), {}, "use s, m, h, d, M (months) or y");
  }
}

ScriptLibrary timeLibrary(Clock& clock, std::function<double()> applicationSeconds) {
  ScriptLibrary library{"time", {}};
  addSpeedFunctions(library, clock);
  addPauseFunctions(library, clock);
  addTimeFunctions(library, clock);
  addConversions(library);
  library.functions.push_back(
      reading("currentWallTime", "The machine's clock as a UTC date.", [] { return Time::now().utc(); }));
  library.functions.push_back(reading("currentApplicationTime", "Seconds since the program began.",
                                      [seconds = std::move(applicationSeconds)] { return seconds(); }));
  return library;
}

}  // namespace meridian::scripting

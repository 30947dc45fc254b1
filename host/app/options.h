#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include <glm/vec2.hpp>

#include "host/api/log.h"
#include "host/api/time.h"
#include "host/navigation/geodetic_pose.h"

namespace meridian::app {

/// What the process returns (docs/command-line.md, Exit codes).
enum class ExitCode : int { Done = 0, Failed = 1, WrongUsage = 2, AssetErrors = 3 };

/// One `--set URI=VALUE`. The value is still text: the script engine reads it as a Lua literal.
struct PropertySetting {
  std::string uri;
  std::string value;
};

/// The whole command line, checked: whatever is here is in range and does not contradict the rest.
struct Options {
  std::vector<std::string> assets;  ///< empty: the default scene
  bool headless = false;
  glm::ivec2 size{1280, 720};  ///< pixels, each side 1..16384, together at most 8192 * 8192
  std::optional<Time> time;
  std::optional<navigation::GeodeticPose> camera;
  std::string anchor;  ///< identifier; empty: the host chooses
  std::vector<PropertySetting> settings;
  std::optional<std::filesystem::path> script;
  std::optional<std::filesystem::path> play;
  std::optional<std::filesystem::path> record;
  std::optional<std::uint64_t> frames;  ///< at least 1
  std::optional<double> fps;            ///< above 0
  std::optional<double> settleSeconds;  ///< at least 0; 0: never
  std::optional<std::filesystem::path> output;
  std::optional<std::filesystem::path> stats;
  bool validate = false;
  log::Level logLevel = log::Level::Info;

  static constexpr double defaultFps = 60.0;
  static constexpr double defaultSettleSeconds = 10.0;  ///< of pictures that are written off screen

  /// Whether time runs by the frame (1 / fps each) instead of by the clock on the wall.
  [[nodiscard]] bool hasFixedStep() const { return headless || frames || fps || output; }
};

/// The program has nothing more to do: help, the version, or wrong usage. Text goes to standard output when the code
/// is Done, else to standard error; it ends with a line break.
struct EarlyExit {
  ExitCode code = ExitCode::Done;
  std::string text;
};

/// Reads the arguments after the program's name. Looks at no file. Wrong usage gives one line that names the option,
/// what was found and what is expected.
[[nodiscard]] std::variant<Options, EarlyExit> parseOptions(std::span<const char* const> arguments);

}  // namespace meridian::app

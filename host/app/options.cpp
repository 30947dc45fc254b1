#include "host/app/options.h"

#include <charconv>
#include <cmath>
#include <string_view>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "host/app/version.h"

namespace meridian::app {
namespace {

constexpr int maximumSide = 16384;
constexpr std::int64_t maximumPixels = std::int64_t{8192} * 8192;  // more take minutes a frame without a graphics card
constexpr std::uint64_t maximumFrames = 1'000'000'000;
constexpr double minimumAltitude = -20'000.0;  // deeper than any trench or crater of a mapped body
constexpr double maximumAltitude = 1e15;       // well outside the solar system

/// As text, before any of it is checked.
struct Words {
  std::vector<std::string> assets;
  std::vector<std::string> settings;
  std::string size, time, camera, anchor, script, play, record, frames, fps, settle, output, stats, log;
  bool headless = false;
  bool validate = false;
  bool version = false;
};

constexpr std::string_view footer =
    "Without ASSET the default scene is shown. With --headless one frame is drawn unless --frames or --play says\n"
    "otherwise, and likewise where no window can be opened and one of these, --output or --stats is given.\n"
    "\n"
    "Keys: F1 panels, Space pause, Esc quit. Mouse: left orbit, right or wheel zoom, middle tilt.\n"
    "Exit codes: 0 done, 1 failed at run time, 2 wrong usage, 3 assets had errors (with --validate).\n"
    "\n"
    "Examples:\n"
    "  meridian --camera 46.5,8.0,20000,180,-30 --anchor Earth\n"
    "  meridian --headless --size 1920x1080 --settle 10 --output earth.png\n"
    "  meridian --headless --play flight.osrectxt --fps 30 --settle 10 --output flight.mp4\n"
    "  meridian --set \"Scene.Earth.Renderable.Layers.ColorLayers.*.Enabled=false\"\n"
    "  meridian my.profile\n"
    "  meridian --validate my-assets";

void declare(CLI::App& app, Words& words) {
  app.set_help_flag("-h,--help", "Print this and end");
  app.footer(std::string(footer));
  app.add_option("ASSET", words.assets, "Asset files and profiles to load; with --validate also folders")
      ->option_text(" ");
  app.add_flag("--headless", words.headless, "No window: off screen, works without a display");
  app.add_option("--size", words.size, "Size of the picture in pixels (default 1280x720)")->option_text("WxH");
  app.add_option("--time", words.time, "Scene time at start, UTC")->option_text("ISO8601");
  app.add_option("--camera", words.camera, "Where the camera starts: degrees, metres above the ellipsoid of the anchor")
      ->option_text("LAT,LON,ALT[,HEADING,PITCH]");
  app.add_option("--anchor", words.anchor, "Scene-graph node that the camera starts at")->option_text("IDENTIFIER");
  app.add_option("--set", words.settings, "Set a property after loading, wildcards as in Lua; may be repeated")
      ->option_text("URI=VALUE")
      ->allow_extra_args(false);
  app.add_option("--script", words.script, "Run this script after loading")->option_text("FILE.lua");
  app.add_option("--play", words.play, "Play a session recording")->option_text("FILE");
  app.add_option("--record", words.record, "Record the session")->option_text("FILE");
  app.add_option("--frames", words.frames, "Fixed time step; stop after so many frames")->option_text("N");
  app.add_option("--fps", words.fps, "Fixed time step of 1/F seconds (default 60)")->option_text("F");
  app.add_option("--settle", words.settle,
                 "Before each frame wait until the view is complete, at most so long\n"
                 "(default 10 for pictures that are written off screen, else 0)")
      ->option_text("SECONDS");
  app.add_option("--output", words.output, "Write a .png, a folder of them, or a video (.mp4 .mkv .mov .webm)")
      ->option_text("PATH");
  app.add_option("--stats", words.stats, "Write the figures of the run")->option_text("FILE.json");
  app.add_flag("--validate", words.validate, "Load the assets, report every error, draw nothing");
  app.add_option("--log", words.log, "trace, debug, info, warning, error or off (default info)")->option_text("LEVEL");
  app.add_flag("--version", words.version, "Print the version and end");
}

/// What is wrong with one option's text: ends up behind "meridian: --NAME: ".
tl::unexpected<Error> wrong(std::string_view option, std::string_view found, std::string_view expected) {
  return failure(fmt::format("{}: '{}' is not {}", option, found, expected));
}

/// The whole text as a finite number.
std::optional<double> finiteNumber(std::string_view text) {
  double number = 0.0;
  const char* const end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, number);
  if (error != std::errc{} || rest != end || !std::isfinite(number)) {
    return std::nullopt;
  }
  return number;
}

std::optional<std::uint64_t> wholeNumber(std::string_view text, std::uint64_t maximum) {
  std::uint64_t number = 0;
  const char* const end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, number);
  if (error != std::errc{} || rest != end || number == 0 || number > maximum) {
    return std::nullopt;
  }
  return number;
}

std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(separator, begin), text.size());
    parts.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return parts;
}

Result<glm::ivec2> parseSize(std::string_view text) {
  const auto parts = split(text, 'x');
  if (parts.size() == 2) {
    const auto width = wholeNumber(parts[0], maximumSide);
    const auto height = wholeNumber(parts[1], maximumSide);
    if (width && height && static_cast<std::int64_t>(*width * *height) > maximumPixels) {
      return failure(fmt::format("--size: '{}' has {} million pixels, and a frame {} million at most", text,
                                 *width * *height / 1'000'000, maximumPixels / 1'000'000));
    }
    if (width && height) {
      return glm::ivec2(static_cast<int>(*width), static_cast<int>(*height));
    }
  }
  return wrong("--size", text, fmt::format("WIDTHxHEIGHT in pixels, each 1 to {}, as in 1280x720", maximumSide));
}

Result<navigation::GeodeticPose> parseCamera(std::string_view text) {
  auto pose = navigation::geodeticPoseFromText(text);
  if (!pose) {
    return failure(fmt::format("--camera: {}", pose.error().message()));
  }
  if (pose->position.height < minimumAltitude || pose->position.height > maximumAltitude) {
    return wrong("--camera", text, fmt::format("at an altitude from {} to {} m", minimumAltitude, maximumAltitude));
  }
  return pose;
}

Result<PropertySetting> parseSetting(std::string_view text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string_view::npos || equals == 0 || equals + 1 == text.size()) {
    return wrong("--set", text, "URI=VALUE, as in Scene.Earth.Renderable.Enabled=false");
  }
  return PropertySetting{std::string(text.substr(0, equals)), std::string(text.substr(equals + 1))};
}

Result<void> parseNumbers(const Words& words, Options& options) {
  if (!words.frames.empty()) {
    options.frames = wholeNumber(words.frames, maximumFrames);
    if (!options.frames) {
      return wrong("--frames", words.frames, fmt::format("a whole number from 1 to {}", maximumFrames));
    }
  }
  if (!words.fps.empty()) {
    options.fps = finiteNumber(words.fps);
    if (!options.fps || *options.fps < 0.01 || *options.fps > 10'000.0) {
      return wrong("--fps", words.fps, "a number of frames a second between 0.01 and 10000");
    }
  }
  if (!words.settle.empty()) {
    options.settleSeconds = finiteNumber(words.settle);
    if (!options.settleSeconds || *options.settleSeconds < 0.0 || *options.settleSeconds > 86'400.0) {
      return wrong("--settle", words.settle, "a number of seconds from 0 to 86400");
    }
  }
  return {};
}

Result<void> parseScene(const Words& words, Options& options) {
  if (!words.size.empty()) {
    const auto size = parseSize(words.size);
    if (!size) {
      return tl::make_unexpected(size.error());
    }
    options.size = *size;
  }
  if (!words.time.empty()) {
    const auto time = Time::fromUtc(words.time);
    if (!time) {
      return failure(fmt::format("--time: {}", time.error().message()));
    }
    options.time = *time;
  }
  if (!words.camera.empty()) {
    const auto camera = parseCamera(words.camera);
    if (!camera) {
      return tl::make_unexpected(camera.error());
    }
    options.camera = *camera;
  }
  for (const std::string& text : words.settings) {
    auto setting = parseSetting(text);
    if (!setting) {
      return tl::make_unexpected(setting.error());
    }
    options.settings.push_back(std::move(*setting));
  }
  if (!words.log.empty()) {
    const auto level = log::levelFromName(words.log);
    if (!level) {
      return wrong("--log", words.log, "trace, debug, info, warning, error or off");
    }
    options.logLevel = *level;
  }
  return {};
}

Result<void> rejectConflicts(const Options& options) {
  const auto conflict = [](std::string_view a, std::string_view b, std::string_view why) {
    return failure(fmt::format("{} and {} exclude each other: {}", a, b, why));
  };
  if (options.play && options.record) {
    return conflict("--play", "--record", "the session would record what it plays");
  }
  if (options.play && options.camera) {
    return conflict("--play", "--camera", "the recording moves the camera");
  }
  if (options.validate) {
    const std::pair<std::string_view, bool> drawing[] = {
        {"--output", options.output.has_value()}, {"--play", options.play.has_value()},
        {"--record", options.record.has_value()}, {"--frames", options.frames.has_value()},
        {"--fps", options.fps.has_value()},       {"--settle", options.settleSeconds.has_value()},
        {"--stats", options.stats.has_value()},   {"--script", options.script.has_value()}};
    for (const auto& [name, given] : drawing) {
      if (given) {
        return conflict("--validate", name, "validating draws nothing");
      }
    }
  }
  return {};
}

Result<Options> check(Words words) {
  Options options;
  if (auto numbers = parseNumbers(words, options); !numbers) {
    return tl::make_unexpected(numbers.error());
  }
  if (auto scene = parseScene(words, options); !scene) {
    return tl::make_unexpected(scene.error());
  }
  const auto file = [](const std::string& text) {
    return text.empty() ? std::nullopt : std::optional<std::filesystem::path>(text);
  };
  options.assets = std::move(words.assets);
  options.headless = words.headless;
  options.validate = words.validate;
  options.anchor = std::move(words.anchor);
  options.script = file(words.script);
  options.play = file(words.play);
  options.record = file(words.record);
  options.output = file(words.output);
  options.stats = file(words.stats);
  if (auto conflicts = rejectConflicts(options); !conflicts) {
    return tl::make_unexpected(conflicts.error());
  }
  return options;
}

/// An option given as "" would look as if it had not been given.
std::optional<std::string> emptyOption(const CLI::App& app) {
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& text : option->results()) {
      if (text.empty()) {
        return fmt::format("{}: the value is empty", option->get_name());
      }
    }
  }
  return std::nullopt;
}

/// The library's own words for these name its types, not what is expected.
std::string mismatchOf(const CLI::App& app, const std::string& message, std::span<const char* const> arguments) {
  const std::string name = message.substr(0, message.find(':'));
  const CLI::Option* option = app.get_option_no_throw(name);
  if (option == nullptr) {
    return message;
  }
  if (message.ends_with(" missing")) {
    return fmt::format("{}: expected {} after it, found nothing", name, option->get_option_text());
  }
  const auto given = std::count_if(arguments.begin(), arguments.end(), [&](const char* argument) {
    return argument == name || std::string_view(argument).starts_with(name + "=");
  });
  return fmt::format("{}: given {} times, expected once", name, given);
}

/// Only options that take no value are converted by the library, and that names none of theirs.
std::string valueOfFlag(const CLI::App& app, std::span<const char* const> arguments) {
  for (const std::string_view argument : arguments) {
    const std::size_t end = std::min(argument.find('='), argument.size());
    const std::string name(argument.substr(0, end));
    const CLI::Option* option = app.get_option_no_throw(name);
    if (end < argument.size() && option != nullptr && option->get_items_expected_max() == 0) {
      return fmt::format("{}: it takes no value, found '{}'; write it without '='", name, argument.substr(end + 1));
    }
  }
  return "an option that takes no value has one: write it without '='";
}

EarlyExit wrongUsage(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  return {ExitCode::WrongUsage, fmt::format("meridian: {}; see meridian --help\n", text)};
}

}  // namespace

std::variant<Options, EarlyExit> parseOptions(std::span<const char* const> arguments) {
  Words words;
  CLI::App app("Meridian shows the bodies of the solar system from scene assets.", "meridian");
  declare(app, words);
  try {
    // CLI11 takes the arguments from the back.
    std::vector<std::string> reversed(arguments.rbegin(), arguments.rend());
    app.parse(std::move(reversed));
  } catch (const CLI::CallForHelp&) {
    return EarlyExit{ExitCode::Done, app.help()};
  } catch (const CLI::ArgumentMismatch& error) {
    return wrongUsage(mismatchOf(app, error.what(), arguments));
  } catch (const CLI::ConversionError&) {
    return wrongUsage(valueOfFlag(app, arguments));
  } catch (const CLI::ParseError& error) {
    return wrongUsage(error.what());
  }
  if (words.version) {
    return EarlyExit{ExitCode::Done, fmt::format("meridian {}\n", version)};
  }
  if (auto empty = emptyOption(app)) {
    return wrongUsage(std::move(*empty));
  }
  auto options = check(std::move(words));
  if (!options) {
    return wrongUsage(options.error().message());
  }
  return std::move(*options);
}

}  // namespace meridian::app

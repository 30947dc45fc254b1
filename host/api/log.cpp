#include "host/api/log.h"

#include <array>

#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

namespace meridian::log {

namespace {

spdlog::level::level_enum native(Level level) {
  switch (level) {
    case Level::Trace:
      return spdlog::level::trace;
    case Level::Debug:
      return spdlog::level::debug;
    case Level::Info:
      return spdlog::level::info;
    case Level::Warning:
      return spdlog::level::warn;
    case Level::Error:
      return spdlog::level::err;
    case Level::Off:
      return spdlog::level::off;
  }
  return spdlog::level::off;
}

spdlog::logger& logger() {
  static const std::shared_ptr<spdlog::logger> instance = [] {
    auto made = spdlog::stderr_color_mt("meridian");
    made->set_pattern("%H:%M:%S.%e %^%l%$ %v");
    return made;
  }();
  return *instance;
}

}  // namespace

std::optional<Level> levelFromName(std::string_view name) {
  using Entry = std::pair<std::string_view, Level>;
  static constexpr std::array<Entry, 6> names{{{"trace", Level::Trace},
                                               {"debug", Level::Debug},
                                               {"info", Level::Info},
                                               {"warning", Level::Warning},
                                               {"error", Level::Error},
                                               {"off", Level::Off}}};
  for (const auto& [word, level] : names) {
    if (word == name) {
      return level;
    }
  }
  return std::nullopt;
}

void setLevel(Level level) {
  logger().set_level(native(level));
}

void write(Level level, std::string_view text) {
  logger().log(native(level), "{}", text);
}

}  // namespace meridian::log

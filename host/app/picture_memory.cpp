#include "host/app/picture_memory.h"

#include <cmath>
#include <fstream>
#include <string>

#include <fmt/format.h>

namespace meridian::app {
namespace {

/// Of each pixel: colour and depth with four samples, colour with one, and the copy that is written.
constexpr std::uint64_t bytesPerPixel = 4 * (4 + 4) + 4 + 4;
/// For what is drawn: tiles, textures, shaders.
constexpr std::uint64_t bytesOfTheRest = std::uint64_t{1} << 29;
constexpr double mebi = 1024.0 * 1024.0;

}  // namespace

std::optional<std::uint64_t> availableMemory() {
  std::ifstream file("/proc/meminfo");
  std::string word;
  while (file >> word) {
    std::uint64_t kibibytes = 0;
    if (word == "MemAvailable:" && file >> kibibytes) {
      return kibibytes << 10;
    }
  }
  return std::nullopt;
}

Result<void> checkPictureFits(glm::ivec2 size, std::optional<std::uint64_t> availableBytes) {
  const std::uint64_t pixels = static_cast<std::uint64_t>(size.x) * static_cast<std::uint64_t>(size.y);
  const std::uint64_t needed = pixels * bytesPerPixel + bytesOfTheRest;
  // A small picture is drawn even where memory is short: the system may find some.
  if (!availableBytes || needed <= *availableBytes || pixels <= std::uint64_t{1920} * 1080) {
    return {};
  }
  const double forPictures = static_cast<double>(*availableBytes) - static_cast<double>(bytesOfTheRest);
  const double shrink = std::sqrt(std::max(forPictures, 0.0) / static_cast<double>(pixels * bytesPerPixel));
  return failure(fmt::format("--size: frames of {}x{} need {:.0f} MiB of memory, and {:.0f} MiB are free", size.x,
                             size.y, static_cast<double>(needed) / mebi, static_cast<double>(*availableBytes) / mebi),
                 {},
                 fmt::format("use at most {}x{}", std::max(1, static_cast<int>(size.x * shrink)),
                             std::max(1, static_cast<int>(size.y * shrink))));
}

}  // namespace meridian::app

#include "picture_check.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <thread>

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "host/graphics/image.h"

namespace meridian::globebrowsing::test {

namespace {

/// Below the darkest channel of SmoothWorld::colour, far enough for rounding.
constexpr int darkest = 30;
/// Of a pixel: what a ray's end may be off by.
constexpr double precisionPixels = 0.02;

/// Of the range of colours around a pixel: that much filtering may take off their peaks.
constexpr float filtered = 0.1F;

std::size_t at(int column, int row) {
  return static_cast<std::size_t>(row) * pictureSize.x + static_cast<std::size_t>(column);
}

/// Calls `pixel(column, row)` for all, on all cores.
void forAllPixels(const std::function<void(int, int)>& pixel) {
  const int count = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  std::vector<std::thread> threads;
  for (int first = 0; first < count; ++first) {
    threads.emplace_back([&pixel, first, count] {
      for (int row = first; row < pictureSize.y; row += count) {
        for (int column = 0; column < pictureSize.x; ++column) {
          pixel(column, row);
        }
      }
    });
  }
  for (std::thread& thread : threads) {
    thread.join();
  }
}

/// Calls `pixel(index)` for every pixel of the picture within `margin` of that one.
void around(int column, int row, int margin, const std::function<void(std::size_t)>& pixel) {
  for (int y = std::max(0, row - margin); y <= std::min(pictureSize.y - 1, row + margin); ++y) {
    for (int x = std::max(0, column - margin); x <= std::min(pictureSize.x - 1, column + margin); ++x) {
      pixel(at(x, y));
    }
  }
}

Expected cast(const Relief& relief, const Eye& eye, const std::function<glm::dvec3(const glm::dvec3&)>& colour) {
  Expected expected;
  expected.covered.resize(at(0, pictureSize.y));
  expected.colours.resize(expected.covered.size());
  const double precision = precisionPixels * eye.verticalFieldOfView / pictureSize.y;
  expected.colourAt = [relief, eye, colour, precision](double column, double row) -> std::optional<glm::vec3> {
    const auto normal = firstHit(relief, eye.position, eye.through(column, row), precision);
    return normal ? std::optional(glm::vec3(colour(*normal))) : std::nullopt;
  };
  forAllPixels([&](int column, int row) {
    if (const auto met = expected.colourAt(column, row)) {
      expected.covered[at(column, row)] = 1;
      expected.colours[at(column, row)] = *met;
    }
  });
  return expected;
}

/// The colours that a pixel may have: those that are met no farther than a pixel from it.
struct Range {
  glm::vec3 least{255.0F};
  glm::vec3 most{0.0F};

  void include(const glm::vec3& colour) {
    least = glm::min(least, colour);
    most = glm::max(most, colour);
  }
  /// By how much a colour is outside; filtering flattens what varies from pixel to pixel.
  [[nodiscard]] double misses(const glm::vec3& colour) const {
    const glm::vec3 off = glm::max(least - colour, colour - most) - filtered * (most - least);
    return std::max({off.x, off.y, off.z});
  }
};

Range rangeAround(const Expected& expected, int column, int row) {
  Range range;
  around(column, row, 1, [&](std::size_t neighbour) { range.include(expected.colours[neighbour]); });
  return range;
}

/// The same square, looked at four times as closely.
Range closeRangeAround(const Expected& expected, int column, int row) {
  constexpr int parts = 4;
  Range range;
  for (int y = -parts; y <= parts; ++y) {
    for (int x = -parts; x <= parts; ++x) {
      if (const auto met = expected.colourAt(column + x / double{parts}, row + y / double{parts})) {
        range.include(*met);
      }
    }
  }
  return range;
}

glm::ivec3 drawnAt(const Pixels& drawn, std::size_t i) {
  return {drawn[4 * i], drawn[4 * i + 1], drawn[4 * i + 2]};
}

void mark(Verdict& verdict, std::size_t i, const glm::ivec3& colour) {
  for (int channel = 0; channel < 3; ++channel) {
    verdict.difference[4 * i + static_cast<std::size_t>(channel)] = static_cast<std::uint8_t>(colour[channel]);
  }
}

Verdict checkCoverage(const Pixels& drawn, const std::vector<Region>& regions) {
  Verdict verdict;
  verdict.difference.resize(drawn.size(), 0);
  for (std::size_t i = 0; i < regions.size(); ++i) {
    verdict.difference[4 * i + 3] = 255;
    const glm::ivec3 colour = drawnAt(drawn, i);
    verdict.inside += int{regions[i] == Region::Inside};
    if (colour == background) {
      if (regions[i] == Region::Inside) {
        ++verdict.holes;
        mark(verdict, i, {255, 0, 0});
      }
    } else if (std::max({colour.x, colour.y, colour.z}) < darkest) {
      ++verdict.black;
      mark(verdict, i, {255, 255, 255});
    }
  }
  return verdict;
}

}  // namespace

Expected expectedPicture(const SmoothWorld& world, const Eye& eye) {
  return cast(world.surface(), eye, [&](const glm::dvec3& normal) { return world.colour(normal); });
}

Expected expectedOutline(const Relief& relief, const Eye& eye) {
  return cast(relief, eye, [](const glm::dvec3&) { return glm::dvec3(128.0); });
}

std::vector<Region> regionsOf(const Expected& expected, int margin) {
  std::vector<Region> regions(expected.covered.size());
  forAllPixels([&](int column, int row) {
    bool all = true;
    bool none = true;
    around(column, row, margin, [&](std::size_t i) { (expected.covered[i] != 0 ? none : all) = false; });
    regions[at(column, row)] = all ? Region::Inside : none ? Region::Outside : Region::Edge;
  });
  return regions;
}

Verdict checkCoverage(const Pixels& drawn, const Expected& outline) {
  return checkCoverage(drawn, regionsOf(outline, outlineMargin));
}

Verdict compare(const Pixels& drawn, const Expected& expected) {
  const std::vector<Region> regions = regionsOf(expected, outlineMargin);
  Verdict verdict = checkCoverage(drawn, regions);
  for (int row = 0; row < pictureSize.y; ++row) {
    for (int column = 0; column < pictureSize.x; ++column) {
      const std::size_t i = at(column, row);
      const glm::ivec3 colour = drawnAt(drawn, i);
      if (regions[i] == Region::Outside && colour != background) {
        ++verdict.spilled;
        mark(verdict, i, {255, 255, 0});
      }
      if (regions[i] != Region::Inside || colour == background) {
        continue;
      }
      double worst = rangeAround(expected, column, row).misses(glm::vec3(colour));
      if (worst > colourTolerance) {
        worst = closeRangeAround(expected, column, row).misses(glm::vec3(colour));
      }
      verdict.worst = std::max(verdict.worst, worst);
      if (worst > colourTolerance) {
        ++verdict.wrong;
        mark(verdict, i, {0, std::min(255, 60 + static_cast<int>(2.0 * worst)), 0});
      }
    }
  }
  return verdict;
}

std::string Verdict::text() const {
  return fmt::format(
      "of {} pixels inside the outline {} are not drawn and {} have a wrong colour (by up to {:.1f}); {} "
      "are black, {} are drawn outside",
      inside, holes, wrong, worst, black, spilled);
}

std::string writeEvidence(const std::filesystem::path& file, const Pixels& drawn, const Expected& expected,
                          const Verdict& verdict) {
  std::vector<std::uint8_t> sheet(3 * drawn.size(), 255);
  for (int row = 0; row < pictureSize.y; ++row) {
    for (int column = 0; column < pictureSize.x; ++column) {
      const std::size_t i = at(column, row);
      const std::size_t to = 4 * (static_cast<std::size_t>(row) * 3 * pictureSize.x + static_cast<std::size_t>(column));
      const glm::vec3 colour = expected.covered[i] != 0 ? expected.colours[i] : glm::vec3(background);
      for (std::size_t channel = 0; channel < 3; ++channel) {
        sheet[to + channel] = drawn[4 * i + channel];
        sheet[to + 4 * pictureSize.x + channel] =
            static_cast<std::uint8_t>(std::clamp(colour[static_cast<int>(channel)] + 0.5F, 0.0F, 255.0F));
        sheet[to + 8 * pictureSize.x + channel] = verdict.difference[4 * i + channel];
      }
    }
  }
  std::filesystem::create_directories(file.parent_path());
  const auto written = graphics::writePng(file, sheet, {3 * pictureSize.x, pictureSize.y});
  return written ? file.string() : written.error().message();
}

}  // namespace meridian::globebrowsing::test

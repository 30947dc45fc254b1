#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "eye.h"
#include "smooth_world.h"

namespace meridian::globebrowsing::test {

/// Pixels of a picture, RGBA, 8 bits each, rows from top to bottom.
using Pixels = std::vector<std::uint8_t>;

/// What no world shows: pixels of this colour were not drawn.
inline constexpr glm::ivec3 background{255, 0, 255};

/// What an eye must see: found by casting a ray through every pixel in double.
struct Expected {
  std::vector<std::uint8_t> covered;  ///< per pixel: 1 where the ray meets the world
  std::vector<glm::vec3> colours;     ///< of what it meets
  /// Of what a ray between the middles of pixels meets: colours may peak there.
  std::function<std::optional<glm::vec3>(double column, double row)> colourAt;
};
[[nodiscard]] Expected expectedPicture(const SmoothWorld& world, const Eye& eye);

/// Grey where the ray meets that relief.
[[nodiscard]] Expected expectedOutline(const Relief& relief, const Eye& eye);

/// Pixels whose neighbourhood of that many pixels around is covered altogether, or not at all.
enum class Region : std::uint8_t { Edge, Inside, Outside };
[[nodiscard]] std::vector<Region> regionsOf(const Expected& expected, int margin);

/// What is wrong with a picture.
struct Verdict {
  int inside = 0;                        ///< pixels well within the outline
  int holes = 0;                         ///< of these, pixels that were not drawn
  int spilled = 0;                       ///< pixels drawn well outside the outline
  int black = 0;                         ///< drawn pixels darker than any colour of a world
  int wrong = 0;                         ///< pixels of another colour than anything around them ought to have
  double worst = 0.0;                    ///< levels by which the worst of them is off
  std::vector<std::uint8_t> difference;  ///< RGBA: red holes, yellow spills, white black ones, green wrong ones

  [[nodiscard]] bool isGood() const { return holes == 0 && spilled == 0 && black == 0 && wrong == 0; }
  [[nodiscard]] std::string text() const;
};

/// How far a drawn colour may leave the range of the expected colours of its pixel and those around, in levels of 255,
/// beside a tenth of that range. The range allows for the half pixel by which geometry may be off, and is looked at
/// four times as closely where the pixels' middles alone do not explain a colour; the rest is for 8-bit rasters and
/// composites and for texture filtering, which near the poles of a geodetic tiling, where texels are narrow, smooths
/// along meridians as far as it must along parallels.
inline constexpr double colourTolerance = 6.0;
/// Pixels from the outline where both are right.
inline constexpr int outlineMargin = 2;

/// Of a settled picture.
[[nodiscard]] Verdict compare(const Pixels& drawn, const Expected& expected);
/// Of a picture that is still being loaded: holes and black pixels only, against an outline that lies within the true.
[[nodiscard]] Verdict checkCoverage(const Pixels& drawn, const Expected& outline);

/// Writes drawn, expected and difference side by side; the file's name for the message.
std::string writeEvidence(const std::filesystem::path& file, const Pixels& drawn, const Expected& expected,
                          const Verdict& verdict);

}  // namespace meridian::globebrowsing::test

#include "globebrowsing/surface/chunk_sampling.h"

#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "globebrowsing/source/tile_layout.h"
#include "globebrowsing/tiling/geodetic_tiling.h"

namespace meridian::globebrowsing {
namespace {

using Kind = Composer::Sampling::Kind;

constexpr double radius = 6.4e6;
constexpr double pixelsPerRadian = 1000.0;

class ChunkSamplingTest : public testing::Test {
 protected:
  /// Of a tile at the equator whose western edge is at longitude 0, seen from above 0, 0.
  [[nodiscard]] Composer::Sampling seenFrom(double altitude, const TileIndex& index, int colourLevel,
                                            float height = 0.0F) const {
    const double texels = std::ldexp(double{colourLayout.interior}, colourLevel - index.level);
    return seenFrom(altitude, index, TexelsAcross{texels, texels}, height);
  }
  [[nodiscard]] Composer::Sampling seenFrom(double altitude, const TileIndex& index, const TexelsAcross& texels,
                                            float height = 0.0F) const {
    const std::size_t nodes = static_cast<std::size_t>(ChunkSurface::heightSide) * ChunkSurface::heightSide;
    const ChunkSurface surface(tiling_, index, std::vector<float>(nodes, height));
    View view;
    view.cameraPosition = {radius + altitude, 0.0, 0.0};
    view.pixelsPerRadian = pixelsPerRadian;
    SelectedChunk chunk;
    chunk.index = index;
    chunk.distance = glm::distance(view.cameraPosition, nearest(surface) * (1.0 + double{height} / radius));
    return samplingOf(surface, chunk, texels, view);
  }
  /// How high to be for so many texels a pixel straight below.
  [[nodiscard]] static double altitudeFor(double texelsPerPixel, int colourLevel) {
    const double texel = std::numbers::pi * radius / std::ldexp(double{colourLayout.interior}, colourLevel);
    return texelsPerPixel * texel * pixelsPerRadian;
  }

  GeodeticTiling tiling_{*Ellipsoid::fromRadii({radius, radius, radius})};

 private:
  static glm::dvec3 nearest(const ChunkSurface& surface) {
    glm::dvec3 best = surface.corners()[0];
    for (const glm::dvec3& corner : surface.corners()) {
      best = corner.x > best.x ? corner : best;
    }
    return best;
  }
};

/// Of level 7, 1.4 degrees wide, as many degrees east of the meridian as `column` says times that, south of the
/// equator.
TileIndex besideTheMeridian(std::uint32_t column) {
  return {1, 7, column, 64};
}

TEST_F(ChunkSamplingTest, TheLevelIsTheNearestToATexelAPixel) {
  constexpr int level = 7;
  const std::pair<double, int> cases[] = {{0.4, 0}, {1.0, 0}, {1.3, 0}, {1.5, 1},
                                          {2.7, 1}, {3.0, 2}, {5.0, 2}, {8.0, 3}};
  for (const auto& [texels, expected] : cases) {
    const Composer::Sampling sampling = seenFrom(altitudeFor(texels, level), besideTheMeridian(0), level);
    EXPECT_EQ(sampling.kind, Kind::OneLevel) << texels;
    EXPECT_EQ(int{sampling.level}, expected) << texels;
  }
}

TEST_F(ChunkSamplingTest, APartOfAnAncestorsCompositeIsSampledLikeIt) {
  const double altitude = altitudeFor(2.0, 5);
  EXPECT_EQ(seenFrom(altitude, besideTheMeridian(0), 5), (Composer::Sampling{Kind::OneLevel, 1}));
  EXPECT_EQ(seenFrom(altitude, besideTheMeridian(0), 7), (Composer::Sampling{Kind::OneLevel, 3}));
}

TEST_F(ChunkSamplingTest, TheCoarsestOfSeveralCompositesIsNotBlurred) {
  const double altitude = altitudeFor(2.0, 7);
  const double full = colourLayout.interior;
  EXPECT_EQ(seenFrom(altitude, besideTheMeridian(0), {full, full}), (Composer::Sampling{Kind::OneLevel, 1}));
  EXPECT_EQ(seenFrom(altitude, besideTheMeridian(0), {full / 2.0, full}), (Composer::Sampling{Kind::OneLevel, 0}));
  EXPECT_EQ(seenFrom(altitude, besideTheMeridian(0), {full / 8.0, 8.0 * full}).kind, Kind::Plain);
}

TEST_F(ChunkSamplingTest, GroundIsSeenFromItsOwnHeight) {
  // 150 m wide, and from 1 km above it three texels a pixel; from as high over the ellipsoid that would be another.
  const TileIndex tile{1, 17, 0, 1 << 16};
  for (const float height : {-7000.0F, 0.0F, 5000.0F}) {
    const double texels = 3.0 * pixelsPerRadian * std::numbers::pi * radius / (1 << 17) / 1000.0;
    EXPECT_EQ(seenFrom(double{height} + 1000.0, tile, {texels, texels}, height),
              (Composer::Sampling{Kind::OneLevel, 2}))
        << height;
  }
  // A plateau that fills the view to its horizon.
  EXPECT_EQ(seenFrom(6000.0, besideTheMeridian(0), 7, 5000.0F).kind, Kind::Plain);
}

TEST_F(ChunkSamplingTest, NothingIsBlurredByMoreThanTheSlantItself) {
  // Nearer to the limb a pixel spans more texels; where they differ too much in one tile, each pixel has its own level.
  const double altitude = altitudeFor(1.0, 7);
  int last = 0;
  bool isPlain = false;
  for (std::uint32_t column = 0; column < 64; ++column) {
    const Composer::Sampling sampling = seenFrom(altitude, besideTheMeridian(column), 7);
    if (sampling.kind == Kind::OneLevel) {
      EXPECT_FALSE(isPlain) << column;
      EXPECT_GE(int{sampling.level}, last) << column;
      last = sampling.level;
    } else {
      EXPECT_EQ(sampling.kind, Kind::Plain);
      isPlain = true;
    }
  }
  EXPECT_EQ(last, Composer::levelCount - 1);
  EXPECT_TRUE(isPlain);
}

TEST_F(ChunkSamplingTest, ATileThatReachesFromBelowTheEyeToTheHorizonHasNoOneLevel) {
  EXPECT_EQ(seenFrom(1000.0, besideTheMeridian(0), 7).kind, Kind::Plain);
  EXPECT_EQ(seenFrom(-1000.0, besideTheMeridian(0), 7).kind, Kind::Plain);  // below the ellipsoid
}

TEST_F(ChunkSamplingTest, TilesThatTaperToAPoleAreBlurredAlongTheParallelsAlone) {
  const TileIndex polar{1, 3, 0, 0};
  EXPECT_EQ(seenFrom(1e6, polar, 3).kind, Kind::Polar);
  EXPECT_EQ(seenFrom(1e9, polar, 3).kind, Kind::Plain);
}

}  // namespace
}  // namespace meridian::globebrowsing

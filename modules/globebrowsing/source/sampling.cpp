#include <algorithm>
#include <cmath>
#include <numbers>

#include "globebrowsing/source/resample_parts.h"

namespace meridian::globebrowsing {

namespace {

/// Angles on the sphere of a pixel of full resolution, and of a step between samples.
struct Sides {
  double width = 0.0;
  double height = 0.0;
};

/// Up to the next quarter of an octave: by steps, so that neighbouring samples mostly have the same.
double roundedUp(double ratio) {
  return std::exp2(std::ceil(4.0 * std::log2(ratio) - 1e-9) / 4.0);
}

void stretch(Sampling& sampling, const PyramidLevel& level, const Sides& pixel, const Sides& step) {
  sampling.stretchX = std::clamp(step.width / (pixel.width * level.scaleX), 1.0, widestTriangle);
  sampling.stretchY = std::clamp(step.height / (pixel.height * level.scaleY), 1.0, widestTriangle);
}

/// The coarsest level whose pixels cover no more than a sample does. In degrees, pixels towards a pole become ever
/// narrower than high; they are let be narrower by a factor of at most `narrowest`, or a tile at a pole would need
/// more of them the deeper it is.
Sampling chooseByArea(const Pyramid& pyramid, const Sides& pixel, double spacing, double columnSpacing) {
  constexpr double narrowest = 8.0;
  constexpr double rounding = 1.0 + 1e-3;  // services round the scales of their levels
  Sampling sampling;
  for (std::size_t i = 0; i < pyramid.levels.size(); ++i) {
    const double width = pixel.width * pyramid.levels[i].scaleX;
    const double height = pixel.height * pyramid.levels[i].scaleY;
    if (std::sqrt(width * height) <= spacing * rounding || width * narrowest <= spacing) {
      sampling.level = i;
    }
  }
  stretch(sampling, pyramid.levels[sampling.level], pixel, {columnSpacing, spacing});
  return sampling;
}

}  // namespace

Sampling chooseSampling(const Pyramid& pyramid, const SampleSpacing& spacing) {
  const RasterGeoreference& georeference = pyramid.georeference;
  const std::vector<PyramidLevel>& levels = pyramid.levels;
  const double ratioX = spacing.nominal / georeference.pixelWidthAngle();
  const double ratioY = spacing.nominal / georeference.pixelHeightAngle();
  Sampling sampling;
  for (std::size_t i = 0; i < levels.size(); ++i) {
    constexpr double rounding = 1.0 + 1e-9;
    if (levels[i].scaleY <= ratioY * rounding && levels[i].scaleX <= ratioX * rounding) {
      sampling.level = i;
    }
  }
  const PyramidLevel& level = levels[sampling.level];
  const double wider = std::max(spacing.nominal, spacing.columns) / spacing.nominal;
  sampling.stretchX = std::max(1.0, ratioX * wider / level.scaleX);
  sampling.stretchY = std::max(1.0, ratioY / level.scaleY);
  return sampling;
}

Sampling chooseSampling(const Pyramid& pyramid, const SampleSpacing& spacing, double latitude) {
  if (!pyramid.isChosenByPlace) {
    return chooseSampling(pyramid, spacing);
  }
  // At a pole itself a pixel would be of no width; as wide as this many samples away from it.
  constexpr double polarSamples = 32.0;
  const RasterGeoreference& georeference = pyramid.georeference;
  const double narrowest = std::sin(std::min(polarSamples * spacing.nominal, std::numbers::pi / 2));
  const double narrowing = std::min(1.0, roundedUp(std::max(std::cos(latitude), narrowest)));
  const Sides pixel{georeference.pixelWidthAngle() * narrowing,
                    georeference.pixelHeightAngle() * (georeference.isMercator() ? narrowing : 1.0)};
  return chooseByArea(pyramid, pixel, spacing.nominal,
                      spacing.columns > 0.0 ? spacing.columns * narrowing : spacing.nominal);
}

Sampling chooseSampling(const Pyramid& pyramid, const SampleSpacing& spacing, double column, double row) {
  if (!pyramid.isChosenByPlace) {
    return chooseSampling(pyramid, spacing);
  }
  const RasterGeoreference& georeference = pyramid.georeference;
  const double middle = std::sqrt(georeference.pixelWidthAngle() * georeference.pixelHeightAngle());
  const double angle = middle * roundedUp(georeference.pixelAngleAt(column, row) / middle);
  return chooseByArea(pyramid, {angle, angle}, spacing.nominal, spacing.nominal);
}

bool isFinerAt(const Pyramid& pyramid, const SampleSpacing& spacing, const GeodeticPosition& place) {
  const RasterGeoreference& georeference = pyramid.georeference;
  if (!georeference.isGeographic()) {
    return georeference.finestPixelAngle() < 0.99 * spacing.nominal;
  }
  const double latitude = std::clamp(place.latitude, georeference.south(), georeference.north());
  const double height = georeference.pixelHeightAngle() * (georeference.isMercator() ? std::cos(latitude) : 1.0);
  // Near a pole, degrees are sampled from coarser levels; some levels further, finer ones come into their own.
  constexpr double enough = 8.0;
  return chooseSampling(pyramid, spacing, latitude).level > 0 ? height < enough * spacing.nominal
                                                              : height < 0.99 * spacing.nominal;
}

}  // namespace meridian::globebrowsing

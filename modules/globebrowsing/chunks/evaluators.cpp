#include "globebrowsing/chunks/evaluators.h"

#include <cmath>

namespace meridian::globebrowsing {

double ScreenSpaceErrorEvaluator::urgency(const TileMeasure& tile, const SelectionSettings& settings) const {
  const double texel = tile.edgeLength / settings.compositeTexels;
  return settings.scale * texel * tile.pixelsPerRadian / tile.distance;
}

double DistanceEvaluator::urgency(const TileMeasure& tile, const SelectionSettings& settings) const {
  return settings.scale * 2.0 * tile.edgeLength / tile.distance;
}

double ProjectedAreaEvaluator::urgency(const TileMeasure& tile, const SelectionSettings& settings) const {
  const double pixelsPerMetre = tile.pixelsPerRadian / tile.distance;
  const double side = std::sqrt(tile.area * tile.facing) * pixelsPerMetre;
  return settings.scale * side / settings.compositeTexels;
}

double AvailableDataEvaluator::urgency(const TileMeasure& tile, const SelectionSettings& settings) const {
  return DistanceEvaluator().urgency(tile, settings);
}

const EvaluatorStrategy& evaluatorOf(Evaluator evaluator) {
  static const ScreenSpaceErrorEvaluator screenSpaceError;
  static const DistanceEvaluator distance;
  static const ProjectedAreaEvaluator projectedArea;
  static const AvailableDataEvaluator availableData;
  switch (evaluator) {
    case Evaluator::Distance:
      return distance;
    case Evaluator::ProjectedArea:
      return projectedArea;
    case Evaluator::AvailableData:
      return availableData;
    case Evaluator::ScreenSpaceError:
      break;
  }
  return screenSpaceError;
}

}  // namespace meridian::globebrowsing

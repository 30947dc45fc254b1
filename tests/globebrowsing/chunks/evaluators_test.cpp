#include "globebrowsing/chunks/evaluators.h"

#include <gtest/gtest.h>

namespace meridian::globebrowsing {
namespace {

TEST(EvaluatorsTest, TableOfUrgencies) {
  struct Case {
    const char* what;
    Evaluator evaluator;
    double edge;
    double facing;
    double distance;
    double scale;
    double expected;
  };
  // 1000 pixels a radian and 500 texels a side: a tile's edge of 500 m has texels of a metre.
  const Case cases[] = {
      {"a texel of a metre at 1 km is a pixel", Evaluator::ScreenSpaceError, 500.0, 1.0, 1000.0, 1.0, 1.0},
      {"half as far, two pixels", Evaluator::ScreenSpaceError, 500.0, 1.0, 500.0, 1.0, 2.0},
      {"twice the texels asked for", Evaluator::ScreenSpaceError, 500.0, 1.0, 1000.0, 2.0, 2.0},
      {"seen at a slant it stays", Evaluator::ScreenSpaceError, 500.0, 0.01, 1000.0, 1.0, 1.0},
      {"twice the edge away", Evaluator::Distance, 500.0, 1.0, 1000.0, 1.0, 1.0},
      {"four times the edge away", Evaluator::Distance, 500.0, 1.0, 2000.0, 1.0, 0.5},
      {"a finer scale", Evaluator::Distance, 500.0, 1.0, 2000.0, 4.0, 2.0},
      {"500 x 500 pixels for 500 x 500 texels", Evaluator::ProjectedArea, 500.0, 1.0, 1000.0, 1.0, 1.0},
      {"a quarter of the area at a slant", Evaluator::ProjectedArea, 500.0, 0.25, 1000.0, 1.0, 0.5},
      {"as by distance", Evaluator::AvailableData, 500.0, 1.0, 1000.0, 1.0, 1.0},
  };
  for (const Case& item : cases) {
    SelectionSettings settings;
    settings.compositeTexels = 500.0;
    settings.scale = item.scale;
    const TileMeasure tile{item.edge, item.edge * item.edge, item.facing, item.distance, 1000.0};
    EXPECT_DOUBLE_EQ(evaluatorOf(item.evaluator).urgency(tile, settings), item.expected) << item.what;
  }
}

TEST(EvaluatorsTest, SomeStopWhereTheDataStop) {
  EXPECT_TRUE(evaluatorOf(Evaluator::ScreenSpaceError).limitedByData());
  EXPECT_TRUE(evaluatorOf(Evaluator::AvailableData).limitedByData());
  EXPECT_FALSE(evaluatorOf(Evaluator::Distance).limitedByData());
  EXPECT_FALSE(evaluatorOf(Evaluator::ProjectedArea).limitedByData());
}

}  // namespace
}  // namespace meridian::globebrowsing

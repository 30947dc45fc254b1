#include "host/ui/statistics_panel.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "recording_builder.h"

namespace meridian::ui {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

TEST(StatisticsPanel, HasSomethingToSayBeforeTheFirstFrame) {
  const Statistics statistics;
  RecordingBuilder builder;
  StatisticsPanel(statistics).build(builder);
  EXPECT_THAT(builder.texts, Contains(HasSubstr("chunks")));
}

TEST(StatisticsPanel, ShowsOnlyTheLastFrames) {
  Statistics statistics;
  statistics.frame.frame = 500.0;
  statistics.endFrame();
  for (std::size_t i = 0; i < StatisticsPanel::window; ++i) {
    statistics.frame.frame = 8.0;
    statistics.endFrame();
  }
  RecordingBuilder builder;
  StatisticsPanel(statistics).build(builder);
  EXPECT_THAT(builder.texts.front(), AllOf(HasSubstr("8.00"), Not(HasSubstr("500"))));
}

TEST(StatisticsPanel, WarnsOfFailedTilesOnly) {
  Statistics statistics;
  statistics.tiles.requested = 12;
  statistics.tiles.loaded = 9;
  RecordingBuilder builder;
  StatisticsPanel(statistics).build(builder);
  EXPECT_THAT(builder.warnings, IsEmpty());
  EXPECT_THAT(builder.texts, Contains(HasSubstr("9 loaded of 12")));

  statistics.tiles.failed = 3;
  StatisticsPanel(statistics).build(builder);
  EXPECT_THAT(builder.warnings, ElementsAre(HasSubstr("3 tiles failed")));
}

}  // namespace
}  // namespace meridian::ui

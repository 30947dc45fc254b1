#include "globebrowsing/gpu/composite_gathering.h"

#include "composites_fixture.h"

namespace meridian::globebrowsing {
namespace {

class CompositeGatheringTest : public CompositesTest {
 protected:
  /// A frame in which these are asked for. What it asks of workers is there in the next.
  void gather(const std::vector<CompositeGathering::Request>& requests) {
    frame();
    streamer_.beginFrame();
    gathering_.beginFrame();
    opacities_.clear();
    for (const Layer* layer : base().layers()) {
      opacities_.push_back({layer->version(), static_cast<float>(layer->effectiveOpacity())});
    }
    for (CompositeGathering::Request request : requests) {
      request.generations = &base();
      request.opacities = &opacities_;
      gathering_.request(request);
    }
    workers_.drain();
    streamer_.endFrame();
  }
  static CompositeKey keyOf(int level) { return {CompositeKind::Base, {0, static_cast<std::uint8_t>(level), 0, 0}}; }

  CompositeGathering gathering_{tiling_, layers_, streamer_};
  LayerOpacities opacities_;
};

TEST_F(CompositeGatheringTest, QueuesWhatHasAllItsTiles) {
  add({{"Identifier", "F"}, {"FilePath", picture("f.pgm", 32)}, {"Opacity", 0.5}});
  Layer& solid = add({{"Identifier", "S"}, {"Type", "SolidColor"}});
  gather({{keyOf(1), 1.5}});
  EXPECT_FALSE(gathering_.isQueued(keyOf(1)));
  EXPECT_TRUE(gathering_.sorted().empty());
  gather({{.key = keyOf(1), .priority = 1.5, .isMissing = false, .other = {solid.version(), 0.25F}}});
  ASSERT_TRUE(gathering_.isQueued(keyOf(1)));
  ASSERT_EQ(gathering_.sorted().size(), 1U);
  const CompositeGathering::Queued& queued = gathering_.sorted().front();
  EXPECT_EQ(queued.lack, 0U);
  EXPECT_EQ(queued.priority, 1.5);
  EXPECT_FALSE(queued.isMissing);
  const std::span<const CompositionPart> parts = gathering_.parts(queued);
  ASSERT_EQ(parts.size(), 2U);
  ASSERT_NE(parts[0].tile, nullptr);
  EXPECT_EQ(parts[0].key.index, (TileIndex{0, 0, 0, 0})) << "its data are no finer";
  EXPECT_EQ(parts[0].transform, tiling_->inParent(keyOf(1).index));
  EXPECT_EQ(parts[0].opacity, 0.5F);
  EXPECT_EQ(parts[1].tile, nullptr);
  EXPECT_EQ(parts[1].opacity, 0.25F) << "as the other end of a fade";
  gather({});
  EXPECT_FALSE(gathering_.isQueued(keyOf(1)));
}

TEST_F(CompositeGatheringTest, QueuesByPriorityAndKeepsEachItsParts) {
  add({{"Identifier", "S"}, {"Type", "SolidColor"}});
  add({{"Identifier", "F"}, {"FilePath", picture("f.pgm", 2048)}});
  const std::vector<CompositeGathering::Request> requests{{keyOf(1), 1.0}, {keyOf(2), 3.0}, {keyOf(0), 2.0}};
  gather(requests);
  gather(requests);
  const std::span<const CompositeGathering::Queued> queue = gathering_.sorted();
  ASSERT_EQ(queue.size(), 3U);
  const std::array<int, 3> levels{2, 0, 1};
  for (std::size_t i = 0; i < queue.size(); ++i) {
    EXPECT_EQ(queue[i].key, keyOf(levels[i]));
    ASSERT_EQ(gathering_.parts(queue[i]).size(), 2U);
    EXPECT_EQ(gathering_.parts(queue[i])[1].key.index, queue[i].key.index);
  }
}

TEST_F(CompositeGatheringTest, WhatWaitsLeavesTheOthersTheirParts) {
  add({{"Identifier", "F"}, {"FilePath", picture("f.pgm", 2048)}});
  gather({{keyOf(0), 1.0}});
  gather({{keyOf(1), 1.0}, {keyOf(0), 1.0}});
  ASSERT_EQ(gathering_.sorted().size(), 1U);
  const std::span<const CompositionPart> parts = gathering_.parts(gathering_.sorted().front());
  ASSERT_EQ(parts.size(), 1U);
  EXPECT_EQ(parts[0].key.index, keyOf(0).index);
  EXPECT_NE(parts[0].tile, nullptr);
}

}  // namespace
}  // namespace meridian::globebrowsing

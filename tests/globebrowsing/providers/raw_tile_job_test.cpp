#include "globebrowsing/providers/raw_tile_job.h"

#include <atomic>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "../source/fake_fetcher.h"
#include "../streaming/streamer_fixture.h"
#include "globebrowsing/source/tiled_service_source.h"
#include "provider_fixture.h"

namespace meridian::globebrowsing {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using State = TileAnswer::State;

/// The whole world in two tiles of 512 pixels, each of one colour.
TileService worldService() {
  TileService service;
  service.where = "world";
  service.matrices.push_back({"0", 512, 512, -180, 90, 180.0 / 512, 180.0 / 512, 0, 1, 0, 0});
  service.west = -180;
  service.south = -90;
  service.east = 180;
  service.north = 90;
  service.url = [](const TileAddress& tile) { return std::to_string(tile.column); };
  return service;
}

Result<SourceTilePointer> decode(const TileService& /*service*/, std::size_t /*matrix*/, PixelKind kind,
                                 const Fetched& fetched) {
  auto tile = std::make_shared<SourceTile>();
  tile->width = tile->height = 512;
  const std::uint8_t value = fetched.body->front();
  if (kind == PixelKind::Colours) {
    for (int i = 0; i < 512 * 512; ++i) {
      tile->rgba.insert(tile->rgba.end(), {value, 0, 0, 255});
    }
  } else {
    tile->heights.assign(512 * 512, float{1.0F} * value);
  }
  return SourceTilePointer(tile);
}

/// A provider whose data are a map service's.
class ServiceProvider final : public TileProvider {
 public:
  explicit ServiceProvider(std::shared_ptr<SourceTileStore> store) : store_(std::move(store)) {}

 private:
  Result<void> openData() override {
    return TiledServiceSource::make(worldService(), store_).map([this](auto source) { source_ = std::move(source); });
  }
  Result<ColourPixels> makeColours(const Tiling& tiling, const TileIndex& index, std::stop_token stop) const override {
    return source_->colours(tiling, index, colourLayout, std::move(stop));
  }
  Result<HeightPixels> makeHeights(const Tiling& tiling, const TileIndex& index, const TileLayout& layout,
                                   std::stop_token stop) const override {
    return source_->heights(tiling, index, layout, std::move(stop));
  }
  std::unique_ptr<ColourTask> makeColourTask(const Tiling& tiling, const TileIndex& index) const override {
    return source_->colourTask(tiling, index, colourLayout);
  }
  std::unique_ptr<HeightTask> makeHeightTask(const Tiling& tiling, const TileIndex& index,
                                             const TileLayout& layout) const override {
    return source_->heightTask(tiling, index, layout);
  }
  bool dataOverlap(const Tiling& tiling, const TileIndex& index) const override {
    return source_->overlaps(tiling, index);
  }
  bool dataFiner(const Tiling& tiling, const TileIndex& index, const TileLayout& layout) const override {
    return source_->hasDataFiner(tiling, index, layout);
  }

  std::shared_ptr<SourceTileStore> store_;
  std::shared_ptr<TiledServiceSource> source_;
};

/// Streamer, store and a single worker, as a globe has them.
class ServiceJobs : public testing::Test {
 protected:
  TileAnswer ask(const TileIndex& index, double priority = 1.0) {
    return streamer_.request({stream_, index}, priority,
                             [&] { return std::make_unique<ColourJob>(provider_, tiling_, index); });
  }
  TileAnswer::State frame(const TileIndex& index) {
    streamer_.beginFrame();
    const TileAnswer::State state = ask(index).state;
    streamer_.endFrame();
    pool_.drain();
    return state;
  }
  TileAnswer wait(const TileIndex& index) {
    while (frame(index) == State::Pending) {
      std::this_thread::yield();
    }
    return streamer_.peek({stream_, index});
  }

  std::atomic<bool> isBroken_{false};
  std::shared_ptr<test::FakeFetcher> fetcher_ =
      std::make_shared<test::FakeFetcher>([this](const std::string& url) -> Result<Fetched> {
        if (isBroken_) {
          return failure("the server is gone", url);
        }
        Fetched fetched;
        fetched.body = std::make_shared<const std::vector<std::uint8_t>>(1, url == "0" ? 100 : 200);
        return fetched;
      });
  WorkerPool pool_{1};
  std::shared_ptr<SourceTileStore> store_ = std::make_shared<SourceTileStore>(SourceTileStore::Parts{
      fetcher_,
      [this](std::function<void()> task) { pool_.post([task = std::move(task)](const std::stop_token&) { task(); }); },
      decode});
  std::shared_ptr<const Tiling> tiling_ = std::make_shared<GeodeticTiling>(earthTiling());
  std::shared_ptr<TileProvider> provider_ = std::make_shared<ServiceProvider>(store_);
  Statistics statistics_;
  TileStreamer streamer_{pool_, statistics_, takingAll};
  std::uint32_t stream_ = streamer_.newStream();
};

TEST_F(ServiceJobs, BringAServicesTilesOntoTheGlobe) {
  ASSERT_TRUE(provider_->open());
  EXPECT_FALSE(provider_->colours(*tiling_, {}, {})) << "not at once";
  const TileAnswer answer = wait({1, 0, 0, 0});
  ASSERT_EQ(answer.state, State::Ready);
  const ColourPixels& pixels = static_cast<const ColourTile&>(**answer.data).pixels();
  EXPECT_TRUE(pixels.allOpaque);
  EXPECT_EQ(pixels.rgba[4 * (264 * 528 + 264)], 200);
  EXPECT_EQ(pixels.rgba[4 * (264 * 528)], 100) << "the border is its neighbour's";
  EXPECT_FALSE(provider_->hasFinerColours(*tiling_, {1, 0, 0, 0}));
}

TEST_F(ServiceJobs, ArePendingWhileTheServerIsSilentAndDropTheirRequests) {
  ASSERT_TRUE(provider_->open());
  fetcher_->stall(true);
  EXPECT_EQ(frame({0, 0, 0, 0}), State::Pending);
  EXPECT_EQ(frame({0, 0, 0, 0}), State::Pending);
  EXPECT_EQ(fetcher_->waiting().size(), 2U);
  streamer_.beginFrame();
  ask({0, 0, 0, 0}, 7.0);
  streamer_.endFrame();
  EXPECT_EQ(fetcher_->waiting().at("0"), 7.0);
  streamer_.beginFrame();
  streamer_.endFrame();
  EXPECT_THAT(fetcher_->waiting(), IsEmpty());
  fetcher_->stall(false);
  EXPECT_EQ(wait({0, 0, 0, 0}).state, State::Ready);
}

TEST_F(ServiceJobs, FailForGoodWhenAllTheirTilesDo) {
  ASSERT_TRUE(provider_->open());
  isBroken_ = true;
  const TileAnswer answer = wait({0, 1, 0, 0});
  ASSERT_EQ(answer.state, State::Failed);
  EXPECT_THAT(answer.error->message(), HasSubstr("the server is gone"));
  EXPECT_EQ(streamer_.lastError(stream_)->what, "the server is gone");
}

TEST_F(ServiceJobs, FailWhenTheProviderIsNotOpen) {
  EXPECT_EQ(wait({0, 0, 0, 0}).state, State::Failed);
}

}  // namespace
}  // namespace meridian::globebrowsing

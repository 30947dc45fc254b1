#include "globebrowsing/source/source_tile_store.h"

#include <latch>

#include <gmock/gmock.h>

#include "tile_service_fixture.h"

namespace meridian::globebrowsing {
namespace {

using namespace test;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::Pair;

class SourceTileStoreTest : public testing::Test {
 protected:
  static constexpr int side = 8;
  static constexpr std::size_t tileBytes = sizeof(SourceTile) + side * side * sizeof(Rgba);

  std::unique_ptr<SourceTileStore::Want> want(std::vector<TileAddress> tiles, double priority = 1.0,
                                              std::function<void()> settled = {}, PixelKind kind = PixelKind::Colours) {
    return store_->want({service_, kind, std::move(tiles), priority, std::move(settled)});
  }
  /// Wants and waits.
  std::unique_ptr<SourceTileStore::Want> get(std::vector<TileAddress> tiles, PixelKind kind = PixelKind::Colours) {
    auto settled = std::make_shared<std::latch>(1);
    auto made = want(
        std::move(tiles), 1.0, [settled] { settled->count_down(); }, kind);
    if (!made->isSettled()) {
      settled->wait();
    }
    EXPECT_TRUE(made->isSettled());
    return made;
  }
  /// Until all that has been posted is done.
  void drain() {
    std::latch done(1);
    worker_.post([&] { done.count_down(); });
    done.wait();
  }

  static Result<Fetched> serve(const std::string& url) {
    if (url.ends_with("/404")) {
      return Fetched{404};
    }
    if (url.ends_with("/500")) {
      return failure("the server failed", url);
    }
    Fetched fetched;
    fetched.body = std::make_shared<const std::vector<std::uint8_t>>(
        url.ends_with("/13") ? 13 : side * side * sizeof(Texel), std::uint8_t{7});
    return fetched;
  }

  std::shared_ptr<TileService> makeService() {
    auto service = std::make_shared<TileService>(serviceOf(geographic));
    for (TileMatrix& matrix : service->matrices) {
      matrix.tileWidth = matrix.tileHeight = side;
    }
    return service;
  }

  std::shared_ptr<const TileService> service_ = makeService();
  Worker worker_;
  std::shared_ptr<FakeFetcher> fetcher_ = std::make_shared<FakeFetcher>(serve);
  std::unique_ptr<SourceTileStore> store_ = std::make_unique<SourceTileStore>(SourceTileStore::Parts{
      fetcher_, [this](std::function<void()> task) { worker_.post(std::move(task)); }, decodeTexels});
};

TEST_F(SourceTileStoreTest, SaysWhyItWaitsToEachServiceThatWantsTheTile) {
  fetcher_->stall(true);
  const auto other = makeService();
  const auto first = want({{0, 1, 1}});
  auto second = store_->want({other, PixelKind::Colours, {{0, 1, 1}}, 1.0, {}});
  EXPECT_EQ(fetcher_->asked().size(), 1U) << "they share it";
  EXPECT_TRUE(store_->lastFailure(*service_));
  EXPECT_TRUE(store_->lastFailure(*other));
  second.reset();
  EXPECT_FALSE(store_->lastFailure(*other)) << "it waits for nothing";
  EXPECT_TRUE(store_->lastFailure(*service_));
}

TEST_F(SourceTileStoreTest, FetchesAndDecodesOnceForAllAndAcceptsThen) {
  fetcher_->stall(true);
  std::latch both(2);
  const auto first = want({{0, 1, 1}, {0, 2, 1}}, 1.0, [&] { both.count_down(); });
  const auto second = want({{0, 2, 1}, {0, 1, 1}}, 2.0, [&] { both.count_down(); });
  EXPECT_FALSE(first->isSettled());
  EXPECT_EQ(store_->pending(), 2U);
  EXPECT_THAT(fetcher_->accepted(), IsEmpty());
  fetcher_->stall(false);
  both.wait();
  ASSERT_TRUE(first->isSettled() && second->isSettled());
  EXPECT_EQ(first->answer(0).tile, second->answer(1).tile);
  EXPECT_EQ(first->answer(0).tile->width, side);
  EXPECT_EQ(first->answer(0).tile->pixels(static_cast<const Rgba*>(nullptr)).front(), (Rgba{7, 7, 7, 7}));
  EXPECT_THAT(fetcher_->asked(), ElementsAre(Pair("0/1/1", 1), Pair("0/2/1", 1)));
  EXPECT_THAT(fetcher_->accepted(), ElementsAre(Pair("0/1/1", 1), Pair("0/2/1", 1)));
  EXPECT_THAT(fetcher_->rejected(), IsEmpty());
  EXPECT_EQ(store_->bytes(), 2 * tileBytes);
  const auto third = want({{0, 1, 1}}, 1.0, [] { FAIL() << "it is there at once"; });
  EXPECT_TRUE(third->isSettled());
}

TEST_F(SourceTileStoreTest, AsksAtTheGreatestPriorityOfThoseThatWant) {
  fetcher_->stall(true);
  const auto first = want({{0, 1, 1}, {0, 2, 1}}, 1.0);
  auto second = want({{0, 2, 1}}, 5.0);
  EXPECT_THAT(fetcher_->waiting(), ElementsAre(Pair("0/1/1", 1.0), Pair("0/2/1", 5.0)));
  first->setPriority(7.0);
  EXPECT_THAT(fetcher_->waiting(), ElementsAre(Pair("0/1/1", 7.0), Pair("0/2/1", 7.0)));
  first->setPriority(2.0);
  EXPECT_THAT(fetcher_->waiting(), ElementsAre(Pair("0/1/1", 2.0), Pair("0/2/1", 5.0)));
  second.reset();
  EXPECT_THAT(fetcher_->waiting(), ElementsAre(Pair("0/1/1", 2.0), Pair("0/2/1", 2.0)));
}

TEST_F(SourceTileStoreTest, CancelsWhatNobodyWantsAnyMore) {
  fetcher_->stall(true);
  auto first = want({{0, 1, 1}, {0, 2, 1}}, 1.0, [] { FAIL() << "it is not wanted"; });
  const auto second = want({{0, 2, 1}}, 1.0);
  first.reset();
  EXPECT_THAT(fetcher_->waiting(), ElementsAre(Pair("0/2/1", 1.0)));
  EXPECT_EQ(store_->pending(), 1U);
}

TEST_F(SourceTileStoreTest, TellsNothingFromErrors) {
  const auto all = get({{0, 0, 404}, {0, 0, 500}, {0, 0, 13}, {0, 0, 1}});
  EXPECT_TRUE(all->answer(0).tile == nullptr && !all->answer(0).error);
  ASSERT_TRUE(all->answer(1).error);
  EXPECT_EQ(all->answer(1).error->what, "the server failed");
  ASSERT_TRUE(all->answer(2).error);
  EXPECT_EQ(all->answer(2).error->where, "0/0/13") << "of the address that cannot be decoded";
  EXPECT_NE(all->answer(3).tile, nullptr);
  EXPECT_THAT(fetcher_->rejected(), ElementsAre(Pair("0/0/13", 1)));
  EXPECT_THAT(fetcher_->accepted(), ElementsAre(Pair("0/0/1", 1)));
}

TEST_F(SourceTileStoreTest, RemembersNeitherErrorsNorAbsenceOnceNobodyWantsThem) {
  get({{0, 0, 404}, {0, 0, 500}}).reset();
  const auto again = get({{0, 0, 404}, {0, 0, 500}});
  EXPECT_THAT(fetcher_->asked(), ElementsAre(Pair("0/0/404", 2), Pair("0/0/500", 2)));
}

TEST_F(SourceTileStoreTest, RefusesTilesOfAnotherSize) {
  auto other = makeService();
  other->matrices[0].tileWidth = 16;
  service_ = other;
  const auto tile = get({{0, 1, 1}});
  ASSERT_TRUE(tile->answer(0).error);
  EXPECT_THAT(tile->answer(0).error->message(), testing::HasSubstr("8 x 8 pixels instead of 16 x 8"));
  EXPECT_THAT(fetcher_->rejected(), IsEmpty()) << "with the size corrected it is a tile";
  EXPECT_THAT(fetcher_->accepted(), IsEmpty());
  service_ = makeService();
  EXPECT_NE(get({{0, 1, 1}})->answer(0).tile, nullptr);
}

TEST_F(SourceTileStoreTest, KeepsKindsAndRulesApart) {
  const auto colours = get({{0, 1, 1}});
  const auto heights = get({{0, 1, 1}}, PixelKind::Heights);
  EXPECT_TRUE(heights->answer(0).tile->rgba.empty());
  EXPECT_EQ(heights->answer(0).tile->heights.size(), std::size_t{side * side});
  auto other = makeService();
  other->heightScale = 2.0;
  service_ = other;
  const auto scaled = get({{0, 1, 1}}, PixelKind::Heights);
  EXPECT_NE(scaled->answer(0).tile, heights->answer(0).tile);
  service_ = makeService();
  EXPECT_EQ(get({{0, 1, 1}}, PixelKind::Heights)->answer(0).tile, heights->answer(0).tile)
      << "another layer of the same service";
}

TEST_F(SourceTileStoreTest, DropsTheLeastRecentlyWantedAndNeverWhatIsInUse) {
  store_->setBudget(3 * tileBytes);
  const auto wanted = get({{0, 0, 1}});
  SourceTilePointer held = get({{0, 0, 2}})->answer(0).tile;
  get({{0, 0, 3}}).reset();
  get({{0, 0, 4}}).reset();
  EXPECT_EQ(store_->bytes(), 3 * tileBytes);
  fetcher_->forget();
  get({{0, 0, 1}, {0, 0, 2}, {0, 0, 4}}).reset();
  EXPECT_THAT(fetcher_->asked(), IsEmpty()) << "3 was dropped";
  store_->setBudget(0);
  EXPECT_EQ(store_->bytes(), 2 * tileBytes) << "wanted or held";
  held.reset();
  store_->setBudget(0);
  EXPECT_EQ(store_->bytes(), tileBytes);
}

TEST_F(SourceTileStoreTest, EndsWithWantsAlive) {
  fetcher_->stall(true);
  const auto waiting = want({{0, 1, 1}}, 1.0, [] { FAIL() << "the store is gone"; });
  store_.reset();
  EXPECT_THAT(fetcher_->waiting(), IsEmpty());
  fetcher_->stall(false);
  waiting->setPriority(3.0);
  drain();
  EXPECT_FALSE(waiting->isSettled());
}

TEST_F(SourceTileStoreTest, BearsManyThreads) {
  store_->setBudget(10 * tileBytes);
  std::vector<std::thread> threads;
  for (std::uint32_t seed = 1; seed <= 3; ++seed) {
    threads.emplace_back([&, seed] {
      std::uint32_t random = seed * 2654435761U;
      const auto upTo = [&random](std::uint32_t n) {
        random = random * 1664525U + 1013904223U;
        return (random >> 8U) % n;
      };
      std::vector<std::unique_ptr<SourceTileStore::Want>> wants;
      for (int i = 0; i < 400; ++i) {
        std::vector<TileAddress> tiles;
        for (std::uint32_t t = 0; t < 1 + upTo(4); ++t) {
          tiles.push_back({0, 0, upTo(30)});
        }
        wants.push_back(want(tiles, upTo(9)));
        wants[upTo(static_cast<std::uint32_t>(wants.size()))]->setPriority(upTo(9));
        if (upTo(3) == 0) {
          wants.erase(wants.begin() + upTo(static_cast<std::uint32_t>(wants.size())));
        }
      }
      EXPECT_NE(get({{0, 0, upTo(30)}})->answer(0).tile, nullptr);
      for (const auto& one : wants) {
        while (!one->isSettled()) {
          std::this_thread::yield();
        }
      }
    });
  }
  for (std::thread& thread : threads) {
    thread.join();
  }
  drain();
  store_->setBudget(0);
  EXPECT_EQ(store_->bytes(), 0U);
  EXPECT_EQ(store_->pending(), 0U);
}

}  // namespace
}  // namespace meridian::globebrowsing

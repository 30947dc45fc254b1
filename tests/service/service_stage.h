#pragma once

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <set>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "globebrowsing/network/on_demand_fetcher.h"
#include "globebrowsing/providers/provider_registry.h"
#include "globebrowsing/providers/raw_tile_job.h"
#include "globebrowsing/providers/tile_steps.h"
#include "globebrowsing/source/source_tile_store.h"
#include "globebrowsing/source/tile_decoder.h"
#include "globebrowsing/streaming/tile_streamer.h"
#include "globebrowsing/tiling/geodetic_tiling.h"
#include "support/server_process.h"
#include "support/world_raster.h"

namespace meridian::globebrowsing {

using Fields = std::map<std::string, Value, std::less<>>;

inline Value tableOf(Fields fields) {
  return Table{{}, std::move(fields)};
}

/// Network, workers, store and streamer, as GlobeServices has them.
struct ServiceStage {
  explicit ServiceStage(const std::filesystem::path& cacheFolder = {}) {
    NetworkOptions options;
    options.cache.folder = cacheFolder;
    fetcher = std::make_shared<OnDemandFetcher>(std::move(options));
    store = std::make_shared<SourceTileStore>(
        SourceTileStore::Parts{fetcher,
                               [this](std::function<void()> work) {
                                 workers.post([work = std::move(work)](const std::stop_token&) { work(); });
                               },
                               decodeTile});
    streamer = std::make_unique<TileStreamer>(workers, statistics);
  }
  ServiceStage(const ServiceStage&) = delete;
  ServiceStage& operator=(const ServiceStage&) = delete;
  ~ServiceStage() { fetcher->close(); }

  [[nodiscard]] std::shared_ptr<TileProvider> make(Fields fields, const std::string& folder = "/") const {
    ProviderRequest request{tableOf(std::move(fields)), "world.asset:4", "Layers.ColorLayers[1]", folder, store};
    auto provider = makeProvider(request);
    EXPECT_TRUE(provider) << provider.error().message();
    return provider ? *provider : nullptr;
  }
  /// Opened as a layer does it; of a layer with steps that of the year 2000.
  [[nodiscard]] std::shared_ptr<TileProvider> open(Fields fields, const std::string& folder = "/") {
    const auto provider = opened(make(std::move(fields), folder));
    return provider->steps() == nullptr ? provider : open(*provider, Time());
  }
  [[nodiscard]] std::shared_ptr<TileProvider> opened(const std::shared_ptr<TileProvider>& provider) {
    TileProvider::openOn(workers, provider);
    while (provider->state() == TileProvider::State::Opening) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    EXPECT_EQ(provider->state(), TileProvider::State::Ready) << (provider->error() ? provider->error()->message() : "");
    return provider;
  }
  /// What a layer with steps shows then.
  [[nodiscard]] std::shared_ptr<TileProvider> open(const TileProvider& layer, const Time& time) {
    const auto step = layer.steps()->make(time);
    EXPECT_TRUE(step) << step.error().message();
    return step ? opened(*step) : nullptr;
  }
  [[nodiscard]] std::shared_ptr<TileProvider> open(const std::string& filePath) {
    return open(Fields{{"FilePath", filePath}});
  }

  /// One frame that wants that tile.
  TileAnswer frame(const std::shared_ptr<TileProvider>& provider, std::uint32_t stream, const TileIndex& index) {
    streamer->beginFrame();
    const TileAnswer answer =
        streamer->request({stream, index}, 1.0, [&] { return std::make_unique<ColourJob>(provider, tiling, index); });
    streamer->endFrame();
    return answer;
  }
  /// Frames until it is there, or has failed.
  Result<ColourPixels> tile(const std::shared_ptr<TileProvider>& provider, const TileIndex& index) {
    const std::uint32_t stream = streamer->newStream();
    TileAnswer answer = frame(provider, stream, index);
    while (answer.state == TileAnswer::State::Pending) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      answer = frame(provider, stream, index);
    }
    if (answer.state == TileAnswer::State::Failed) {
      return tl::make_unexpected(*answer.error);
    }
    ColourPixels pixels = static_cast<const ColourTile&>(**answer.data).pixels();
    streamer->forget(stream);
    return pixels;
  }

  std::shared_ptr<const Tiling> tiling =
      std::make_shared<GeodeticTiling>(*Ellipsoid::fromRadii({6378137.0, 6378137.0, 6356752.314245}));
  Statistics statistics;
  WorkerPool workers{2};
  std::shared_ptr<OnDemandFetcher> fetcher;
  std::shared_ptr<SourceTileStore> store;
  std::unique_ptr<TileStreamer> streamer;
};

/// Tiles at several places and levels; some are finer than the raster.
inline const std::vector<TileIndex> someTiles{{0, 0, 0, 0}, {1, 0, 0, 0}, {0, 1, 0, 1}, {1, 1, 1, 0},
                                              {0, 2, 1, 2}, {1, 2, 0, 1}, {1, 3, 2, 3}};

/// The greatest difference of a channel, or 256 when one has something where the other has not.
inline int difference(const ColourPixels& a, const ColourPixels& b) {
  if (a.rgba.size() != b.rgba.size() || a.rgba.empty()) {
    return 256;
  }
  int greatest = 0;
  for (std::size_t i = 0; i < a.rgba.size(); ++i) {
    const int here = std::abs(int{a.rgba[i]} - int{b.rgba[i]});
    greatest = std::max(greatest, i % 4 == 3 && here > 0 ? 256 : here);
  }
  return greatest;
}

/// A folder with the raster world.tif, gone with the test.
class ServiceTest : public testing::Test {
 protected:
  ServiceTest() {
    std::string name = (std::filesystem::temp_directory_path() / "meridian-service-XXXXXX").string();
    folder = ::mkdtemp(name.data());
    WorldRaster::write(folder / "world.tif");
  }
  ~ServiceTest() override {
    std::error_code ignored;
    std::filesystem::remove_all(folder, ignored);
  }
  [[nodiscard]] std::string raster() const { return (folder / "world.tif").string(); }

  /// Every tile of that layer is that of the file.
  void expectRaster(ServiceStage& stage, const std::shared_ptr<TileProvider>& layer, int tolerance,
                    const std::vector<TileIndex>& tiles = someTiles) {
    const auto file = stage.open(raster());
    for (const TileIndex& index : tiles) {
      const auto expected = stage.tile(file, index);
      const auto found = stage.tile(layer, index);
      ASSERT_TRUE(expected && found) << (found ? "" : found.error().message());
      EXPECT_LE(difference(*expected, *found), tolerance)
          << "level " << int{index.level} << ", x " << index.x << ", y " << index.y;
    }
  }

  std::filesystem::path folder;
};

}  // namespace meridian::globebrowsing

#pragma once

#include <condition_variable>
#include <cstring>
#include <deque>
#include <mutex>
#include <set>
#include <thread>

#include <ogr_spatialref.h>

#include "fake_fetcher.h"
#include "globebrowsing/source/tiled_service_source.h"
#include "raster_fixture.h"

namespace meridian::globebrowsing::test {

/// A thread that does what is posted.
class Worker {
 public:
  Worker() : thread_([this] { work(); }) {}
  ~Worker() {
    post(nullptr);
    thread_.join();
  }
  void post(std::function<void()> task) {
    const std::lock_guard lock(mutex_);
    tasks_.push_back(std::move(task));
    changed_.notify_all();
  }

 private:
  void work() {
    while (true) {
      std::function<void()> task;
      {
        std::unique_lock lock(mutex_);
        changed_.wait(lock, [this] { return !tasks_.empty(); });
        task = std::move(tasks_.front());
        tasks_.pop_front();
      }
      if (!task) {
        return;
      }
      task();
    }
  }

  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::function<void()>> tasks_;
  std::thread thread_;
};

/// Bodies are tiles' pixels, eight bytes each: height (a float), red, green, blue, alpha.
struct Texel {
  float metres;
  Rgba colour;
};

inline Result<SourceTilePointer> decodeTexels(const TileService& /*service*/, std::size_t /*matrix*/, PixelKind kind,
                                              const Fetched& fetched) {
  const auto count = fetched.body->size() / sizeof(Texel);
  const int side = static_cast<int>(std::lround(std::sqrt(count)));
  if (static_cast<std::size_t>(side) * static_cast<std::size_t>(side) * sizeof(Texel) != fetched.body->size()) {
    return failure("this is no tile");
  }
  std::vector<Texel> texels(count);
  std::memcpy(texels.data(), fetched.body->data(), fetched.body->size());
  auto tile = std::make_shared<SourceTile>();
  tile->width = tile->height = side;
  for (const Texel& texel : texels) {
    if (kind == PixelKind::Colours) {
      tile->rgba.insert(tile->rgba.end(), texel.colour.begin(), texel.colour.end());
    } else {
      tile->heights.push_back(texel.metres);
    }
  }
  return SourceTilePointer(tile);
}

/// One kind of service, with `levels` matrices, each of half the resolution of the one before.
struct Layout {
  std::string name;
  std::string crs;
  double left = 0.0;  ///< of all matrices
  double top = 0.0;
  double pixel = 0.0;  ///< of the finest
  int tileSize = 256;
  int levels = 1;
  std::array<double, 4> extent{};  ///< west, south, east, north
};

inline TileService serviceOf(const Layout& layout) {
  TileService service;
  service.where = layout.name;
  service.crs = layout.crs;
  std::tie(service.west, service.south, service.east, service.north) =
      std::tuple(layout.extent[0], layout.extent[1], layout.extent[2], layout.extent[3]);
  for (int level = 0; level < layout.levels; ++level) {
    TileMatrix matrix;
    matrix.identifier = std::to_string(level);
    matrix.tileWidth = matrix.tileHeight = layout.tileSize;
    matrix.left = layout.left;
    matrix.top = layout.top;
    matrix.pixelWidth = matrix.pixelHeight = std::ldexp(layout.pixel, level);
    const double tile = matrix.pixelWidth * layout.tileSize;
    matrix.firstColumn = std::lround(std::floor((service.west - layout.left) / tile + 1e-9));
    matrix.lastColumn = std::lround(std::ceil((service.east - layout.left) / tile - 1e-9)) - 1;
    matrix.firstRow = std::lround(std::floor((layout.top - service.north) / tile + 1e-9));
    matrix.lastRow = std::lround(std::ceil((layout.top - service.south) / tile - 1e-9)) - 1;
    service.matrices.push_back(matrix);
  }
  service.url = [](const TileAddress& tile) {
    return std::to_string(tile.matrix) + '/' + std::to_string(tile.column) + '/' + std::to_string(tile.row);
  };
  return service;
}

inline TileAddress addressOf(const std::string& url) {
  TileAddress address;
  long long column = 0;
  long long row = 0;
  EXPECT_EQ(std::sscanf(url.c_str(), "%zu/%lld/%lld", &address.matrix, &column, &row), 3) << url;
  address.column = column;
  address.row = row;
  return address;
}

/// Calls `prepare(wake)` until it says that nothing is missing, on this thread, which waits meanwhile.
template <class Prepare>
void prepareFully(Prepare&& prepare) {
  // Kept alive by whoever wakes late.
  struct Signal {
    std::mutex mutex;
    std::condition_variable changed;
    bool isWoken = false;
  };
  const auto signal = std::make_shared<Signal>();
  while (!prepare([signal] {
    const std::lock_guard lock(signal->mutex);
    signal->isWoken = true;
    signal->changed.notify_all();
  })) {
    std::unique_lock lock(signal->mutex);
    signal->changed.wait(lock, [&] { return signal->isWoken; });
    signal->isWoken = false;
  }
}

/// What a task makes once it has what it needs.
template <class Pixels>
Result<Pixels> waitFor(const std::unique_ptr<PixelTask<Pixels>>& task) {
  prepareFully([&](const std::function<void()>& wake) { return task->prepare(1.0, wake); });
  return task->make({});
}

/// Serves what `texel(level, column, row)` says of pixels counted from the matrices' corner. Any request beyond the
/// matrices' limits or the extent fails the test.
class Served {
 public:
  using TexelAt = std::function<Texel(std::size_t level, std::int64_t column, std::int64_t row)>;
  /// What happens to a request instead of an answer.
  enum class Fate { Answered, Missing, Failed };

  Served(TileService service, TexelAt texel) : service_(std::move(service)), texel_(std::move(texel)) { start(); }
  Served(const Layout& layout, TexelAt texel) : Served(serviceOf(layout), std::move(texel)) {}

  std::function<Fate(const TileAddress&)> fate = [](const TileAddress&) { return Fate::Answered; };
  [[nodiscard]] FakeFetcher& fetcher() { return *fetcher_; }
  [[nodiscard]] SourceTileStore& store() { return *store_; }
  [[nodiscard]] const TileService& service() const { return service_; }
  [[nodiscard]] const TiledServiceSource& source() const { return *source_; }

  /// Of this test's thread, which waits.
  template <class Pixels>
  Result<Pixels> wait(std::unique_ptr<PixelTask<Pixels>> task) {
    Result<Pixels> made = waitFor(task);
    flaw = task->flaw();
    return made;
  }
  Result<ColourPixels> colours(const Tiling& tiling, const TileIndex& index, const TileLayout& layout = colourLayout) {
    return wait(source_->colourTask(tiling, index, layout));
  }
  Result<HeightPixels> heights(const Tiling& tiling, const TileIndex& index, const TileLayout& layout = heightLayout) {
    return wait(source_->heightTask(tiling, index, layout));
  }
  std::optional<Error> flaw;

 private:
  void start() {
    fetcher_ = std::make_shared<FakeFetcher>([this](const std::string& url) { return answer(url); });
    store_ = std::make_shared<SourceTileStore>(SourceTileStore::Parts{
        fetcher_, [this](std::function<void()> task) { worker_.post(std::move(task)); }, decodeTexels});
    auto made = TiledServiceSource::make(service_, store_, earth().ellipsoid().heightLimits());
    EXPECT_TRUE(made) << (made ? "" : made.error().message());
    source_ = *made;
  }

  Result<Fetched> answer(const std::string& url) {
    const TileAddress address = addressOf(url);
    const TileMatrix& matrix = service_.matrices.at(address.matrix);
    EXPECT_TRUE(address.column >= matrix.firstColumn && address.column <= matrix.lastColumn &&
                address.row >= matrix.firstRow && address.row <= matrix.lastRow)
        << service_.where << ": beyond the limits: " << url;
    const double west = matrix.left + static_cast<double>(address.column) * matrix.tileWidth * matrix.pixelWidth;
    const double north = matrix.top - static_cast<double>(address.row) * matrix.tileHeight * matrix.pixelHeight;
    EXPECT_TRUE(west < service_.east && west + matrix.tileWidth * matrix.pixelWidth > service_.west &&
                north > service_.south && north - matrix.tileHeight * matrix.pixelHeight < service_.north)
        << service_.where << ": beyond the extent: " << url;
    switch (fate(address)) {
      case Fate::Missing:
        return Fetched{404};
      case Fate::Failed:
        return failure("the server is on fire", url);
      case Fate::Answered:
        break;
    }
    std::vector<Texel> texels;
    for (int y = 0; y < matrix.tileHeight; ++y) {
      for (int x = 0; x < matrix.tileWidth; ++x) {
        texels.push_back(
            texel_(address.matrix, address.column * matrix.tileWidth + x, address.row * matrix.tileHeight + y));
      }
    }
    std::vector<std::uint8_t> bytes(texels.size() * sizeof(Texel));
    std::memcpy(bytes.data(), texels.data(), bytes.size());
    Fetched fetched;
    fetched.body = std::make_shared<const std::vector<std::uint8_t>>(std::move(bytes));
    return fetched;
  }

  TileService service_;
  TexelAt texel_;
  Worker worker_;
  std::shared_ptr<FakeFetcher> fetcher_;
  std::shared_ptr<SourceTileStore> store_;
  std::shared_ptr<TiledServiceSource> source_;
};

constexpr double mercatorSide = 20037508.342789244;

inline const Layout geographic{"EPSG:4326", "", -180, 90, 180.0 / 1024, 256, 4, {-180, -90, 180, 90}};
/// GIBS: tiles of 288 degrees on the coarsest matrix, larger than the globe.
inline const Layout gibs{"GIBS", "EPSG:4326", -180, 90, 0.5625 / 4, 512, 3, {-180, -90, 180, 90}};
inline const Layout mercator{"EPSG:3857",
                             "EPSG:3857",
                             -mercatorSide,
                             mercatorSide,
                             2 * mercatorSide / 2048,
                             256,
                             4,
                             {-mercatorSide, -mercatorSide, mercatorSide, mercatorSide}};
inline const Layout north{"EPSG:3413", "EPSG:3413", -4194304, 4194304,
                          8192,        256,         3,        {-4194304, -4194304, 4194304, 4194304}};
inline const Layout south{"EPSG:3031", "EPSG:3031", -4194304, 4194304,
                          8192,        256,         3,        {-4194304, -4194304, 4194304, 4194304}};
/// A country's extent that no tile ends at.
inline const Layout country{"Country", "EPSG:4326", -180, 90, 180.0 / 4096, 256, 6, {5.87, 45.81, 10.53, 47.83}};

inline void PrintTo(const Layout& layout, std::ostream* out) {
  *out << layout.name;
}

}  // namespace meridian::globebrowsing::test

#pragma once

#include <atomic>
#include <functional>
#include <latch>
#include <memory>
#include <utility>

#include "globebrowsing/streaming/tile_streamer.h"

namespace meridian::globebrowsing {

/// With these a frame takes all that is finished, however busy the machine is.
inline constexpr TileStreamerOptions takingAll{.takeMilliseconds = 1e9};

/// A tile of a given size that knows which it is.
class CountedTile final : public TileData {
 public:
  CountedTile(const TileKey& key, std::size_t bytes) : key_(key), bytes_(bytes) {}
  [[nodiscard]] std::size_t bytes() const override { return bytes_; }
  [[nodiscard]] const TileKey& key() const { return key_; }

 private:
  TileKey key_;
  std::size_t bytes_;
};

/// A job that does what the test says.
class FunctionJob final : public TileJob {
 public:
  using Function = std::function<Result<TileDataPointer>(const std::stop_token&)>;
  explicit FunctionJob(Function function) : function_(std::move(function)) {}
  Result<TileDataPointer> run(const std::stop_token& stop) override { return function_(stop); }

 private:
  Function function_;
};

inline TileKey keyOf(std::uint32_t stream, std::uint32_t x) {
  return {stream, {0, 5, x, 0}};
}

inline std::unique_ptr<TileJob> tileJob(const TileKey& key, std::size_t bytes) {
  return std::make_unique<FunctionJob>(
      [=](const std::stop_token&) { return TileDataPointer(std::make_shared<CountedTile>(key, bytes)); });
}

/// Keeps a worker busy until it is opened; may be gone before the worker has noticed.
class Gate {
 public:
  explicit Gate(WorkerPool& pool) {
    pool.post([latches = latches_](const std::stop_token&) {
      latches->entered.count_down();
      latches->opened.wait();
    });
    latches_->entered.wait();
  }
  void open() { latches_->opened.count_down(); }

 private:
  struct Latches {
    std::latch entered{1};
    std::latch opened{1};
  };
  std::shared_ptr<Latches> latches_ = std::make_shared<Latches>();
};

}  // namespace meridian::globebrowsing

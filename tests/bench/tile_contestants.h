#pragma once

#include <atomic>
#include <condition_variable>
#include <deque>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace meridian::bench {

/// Threads that decode, of usual priority: at the product's idle priority others' programs would decide the contest.
class Decoders {
 public:
  explicit Decoders(int threads);
  Decoders(const Decoders&) = delete;
  Decoders& operator=(const Decoders&) = delete;
  ~Decoders();
  void post(std::function<void()> task);

 private:
  void work();

  std::mutex mutex_;
  std::condition_variable posted_;
  std::deque<std::function<void()>> tasks_;
  bool isStopping_ = false;
  std::vector<std::thread> threads_;
};

/// Somebody who fetches and decodes tiles. Keeps connections from one run to the next, if it can.
class TileContestant {
 public:
  virtual ~TileContestant() = default;
  /// Tiles a second of so many, until the last is decoded. Throws std::runtime_error when
  /// one does not come.
  virtual double run(int tiles) = 0;
};

struct Contest {
  std::string address;
  int atOnce = 8;                      ///< connections; over HTTP/2 requests
  std::filesystem::path certificates;  ///< to trust; may be empty without TLS
};

/// HttpFetcher, SourceTileStore and decodeTile, without the cache on disk.
std::unique_ptr<TileContestant> meridianTiles(const Contest& contest, Decoders& decoders);
/// curl_multi and libjpeg-turbo, and nothing that is not needed: buffers are used again, the oldest pixels are
/// overwritten.
std::unique_ptr<TileContestant> curlTiles(const Contest& contest, Decoders& decoders);

struct GdalSettings {
  int threads = 1;
  /// Rows of the pyramid at once, with the contest's connections; else tile by tile, with GDAL's own settings.
  bool isBatched = false;
};
/// GDAL's TMS driver.
std::unique_ptr<TileContestant> gdalTiles(const Contest& contest, const GdalSettings& settings);

}  // namespace meridian::bench

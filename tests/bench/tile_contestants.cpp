#include "tile_contestants.h"

#include <chrono>
#include <cstdint>
#include <cstdio>
#include <stdexcept>
#include <utility>

#include <curl/curl.h>
#include <gdal_priv.h>
#include <jpeglib.h>  // needs cstdio before it

#include "globebrowsing/network/on_demand_fetcher.h"
#include "globebrowsing/source/gdal_wms.h"
#include "globebrowsing/source/source_tile_store.h"
#include "globebrowsing/source/tile_decoder.h"
#include "support/jpeg_pyramid.h"

namespace meridian::bench {

namespace {

namespace gb = globebrowsing;
using Clock = std::chrono::steady_clock;

constexpr std::size_t tileBytes = std::size_t{4} * JpegPyramid::tileSize * JpegPyramid::tileSize;

double perSecond(int tiles, Clock::time_point start) {
  return tiles / std::chrono::duration<double>(Clock::now() - start).count();
}

void requireAll(int failures, const char* who) {
  if (failures > 0) {
    throw std::runtime_error(std::string(who) + ": " + std::to_string(failures) + " tiles did not come");
  }
}

/// Counts down from any thread; one waits.
class Countdown {
 public:
  void begin(int count) { left_ = count; }
  void step() {
    if (--left_ == 0) {
      left_.notify_all();
    }
  }
  void wait() const {
    for (int now = left_; now != 0; now = left_) {
      left_.wait(now);
    }
  }

 private:
  std::atomic<int> left_{0};
};

class MeridianTiles final : public TileContestant {
 public:
  MeridianTiles(const Contest& contest, Decoders& decoders) {
    auto described = gb::readGdalWms(JpegPyramid::document(contest.address), contest.address);
    if (!described || !described->service) {
      throw std::runtime_error("the service is not understood");
    }
    service_ = std::make_shared<const gb::TileService>(*std::move(described->service));
    gb::NetworkOptions options;
    options.concurrency.perHost = contest.atOnce;
    options.cache.mode = gb::CacheMode::Off;
    options.certificateFile = contest.certificates;
    fetcher_ = std::make_shared<gb::OnDemandFetcher>(std::move(options));
    store_ = std::make_unique<gb::SourceTileStore>(gb::SourceTileStore::Parts{
        fetcher_, [&decoders](std::function<void()> work) { decoders.post(std::move(work)); }, gb::decodeTile});
  }
  ~MeridianTiles() override { fetcher_->close(); }
  MeridianTiles(const MeridianTiles&) = delete;
  MeridianTiles& operator=(const MeridianTiles&) = delete;

  double run(int tiles) override {
    end_ = next_ + tiles;
    countdown_.begin(tiles);
    const auto start = Clock::now();
    for (Slot& slot : slots_) {
      begin(slot);
    }
    countdown_.wait();
    const double speed = perSecond(tiles, start);
    next_ = end_;
    requireAll(failures_, "Meridian");
    return speed;
  }

 private:
  /// All of a round, as the raw one sends all it has to.
  static constexpr std::size_t wantedAtOnce = 2048;
  struct Slot {
    std::mutex mutex;
    std::unique_ptr<gb::SourceTileStore::Want> want;
  };

  void begin(Slot& slot) {
    const int number = next_++;
    if (number >= end_) {
      return;
    }
    // Through the whole pyramid, round by round: the store's memory holds a sixteenth of it, so none is there when its
    // turn comes again, and each is fetched.
    const gb::TileAddress tile{0, number % JpegPyramid::columns, number / JpegPyramid::columns % JpegPyramid::rows};
    const std::lock_guard lock(slot.mutex);  // its answer may come before it is in its place
    slot.want =
        store_->want({service_, gb::PixelKind::Colours, {tile}, -double{1} * number, [this, &slot] { end(slot); }});
  }

  void end(Slot& slot) {
    {
      const std::lock_guard lock(slot.mutex);
      failures_ += slot.want->answer(0).tile == nullptr ? 1 : 0;
      slot.want.reset();
    }
    begin(slot);
    countdown_.step();
  }

  std::shared_ptr<const gb::TileService> service_;
  std::shared_ptr<gb::OnDemandFetcher> fetcher_;
  std::unique_ptr<gb::SourceTileStore> store_;
  std::vector<Slot> slots_{wantedAtOnce};
  std::atomic<int> next_{0};
  int end_ = 0;
  std::atomic<int> failures_{0};
  Countdown countdown_;
};

/// libjpeg's state and the pixels of one thread: the decoders together keep as many tiles as SourceTileStore does by
/// default, for writing where the last tile was is faster than memory is.
class PlainJpeg {
 public:
  PlainJpeg() {
    info_.err = jpeg_std_error(&errors_);
    jpeg_create_decompress(&info_);
  }
  PlainJpeg(const PlainJpeg&) = delete;
  PlainJpeg& operator=(const PlainJpeg&) = delete;
  ~PlainJpeg() { jpeg_destroy_decompress(&info_); }

  bool decode(const std::vector<std::uint8_t>& body) {
    jpeg_mem_src(&info_, body.data(), static_cast<unsigned long>(body.size()));
    jpeg_read_header(&info_, TRUE);
    info_.out_color_space = JCS_EXT_RGBA;
    jpeg_start_decompress(&info_);
    const bool isTile = info_.output_width == JpegPyramid::tileSize && info_.output_height == JpegPyramid::tileSize;
    while (isTile && info_.output_scanline < info_.output_height) {
      JSAMPROW row = kept_[next_].data() + std::size_t{4} * info_.output_width * info_.output_scanline;
      jpeg_read_scanlines(&info_, &row, 1);
    }
    jpeg_abort_decompress(&info_);
    next_ = (next_ + 1) % kept_.size();
    return isTile;
  }

 private:
  static constexpr std::size_t tilesKept = (std::size_t{128} << 20) / tileBytes / 2;
  jpeg_decompress_struct info_{};
  jpeg_error_mgr errors_{};
  std::vector<std::vector<std::uint8_t>> kept_{tilesKept, std::vector<std::uint8_t>(tileBytes)};
  std::size_t next_ = 0;
};

std::size_t append(char* data, std::size_t, std::size_t size, void* body) {
  auto& bytes = *static_cast<std::vector<std::uint8_t>*>(body);
  bytes.insert(bytes.end(), data, data + size);
  return size;
}

class CurlTiles final : public TileContestant {
 public:
  CurlTiles(Contest contest, Decoders& decoders)
      : contest_(std::move(contest)), decoders_(&decoders), slots_(static_cast<std::size_t>(contest_.atOnce)) {
    const bool isEncrypted = contest_.address.starts_with("https");
    const std::string certificates = contest_.certificates.string();
    for (Slot& slot : slots_) {
      slot.easy = curl_easy_init();
      curl_easy_setopt(slot.easy, CURLOPT_NOSIGNAL, 1L);
      if (isEncrypted) {
        curl_easy_setopt(slot.easy, CURLOPT_CAINFO, certificates.c_str());
        curl_easy_setopt(slot.easy, CURLOPT_CAPATH, nullptr);
        curl_easy_setopt(slot.easy, CURLOPT_PIPEWAIT, 1L);
      }
      curl_easy_setopt(slot.easy, CURLOPT_WRITEFUNCTION, &append);
      curl_easy_setopt(slot.easy, CURLOPT_PRIVATE, &slot);
    }
    curl_multi_setopt(multi_, CURLMOPT_MAX_HOST_CONNECTIONS, static_cast<long>(contest_.atOnce));
  }
  CurlTiles(const CurlTiles&) = delete;
  CurlTiles& operator=(const CurlTiles&) = delete;
  ~CurlTiles() override {
    for (Slot& slot : slots_) {
      curl_easy_cleanup(slot.easy);
    }
    curl_multi_cleanup(multi_);
  }

  double run(int tiles) override {
    countdown_.begin(tiles);
    next_ = 0;
    const auto start = Clock::now();
    for (Slot& slot : slots_) {
      begin(slot, tiles);
    }
    for (int done = 0; done < tiles;) {
      int running = 0;
      curl_multi_perform(multi_, &running);
      int left = 0;
      const int before = done;
      while (const CURLMsg* message = curl_multi_info_read(multi_, &left)) {
        char* user = nullptr;
        curl_easy_getinfo(message->easy_handle, CURLINFO_PRIVATE, &user);
        auto& slot = *reinterpret_cast<Slot*>(user);
        failures_ += message->data.result == CURLE_OK ? 0 : 1;
        decode(std::move(slot.body));
        curl_multi_remove_handle(multi_, slot.easy);
        ++done;
        begin(slot, tiles);
      }
      if (done == before) {
        curl_multi_poll(multi_, nullptr, 0, 100, nullptr);
      }
    }
    countdown_.wait();
    const double speed = perSecond(tiles, start);
    requireAll(failures_, "curl");
    return speed;
  }

 private:
  struct Slot {
    CURL* easy = nullptr;
    std::shared_ptr<std::vector<std::uint8_t>> body;
  };

  void begin(Slot& slot, int tiles) {
    if (next_ >= tiles) {
      return;
    }
    slot.body = spare();
    curl_easy_setopt(slot.easy, CURLOPT_URL, JpegPyramid::url(contest_.address, next_++).c_str());
    curl_easy_setopt(slot.easy, CURLOPT_WRITEDATA, slot.body.get());
    curl_multi_add_handle(multi_, slot.easy);
  }

  void decode(std::shared_ptr<std::vector<std::uint8_t>> body) {
    decoders_->post([this, body = std::move(body)]() mutable {
      thread_local PlainJpeg jpeg;
      failures_ += jpeg.decode(*body) ? 0 : 1;
      body->clear();
      {
        const std::lock_guard lock(mutex_);
        spares_.push_back(std::move(body));
      }
      countdown_.step();
    });
  }

  std::shared_ptr<std::vector<std::uint8_t>> spare() {
    const std::lock_guard lock(mutex_);
    if (spares_.empty()) {
      return std::make_shared<std::vector<std::uint8_t>>();
    }
    auto body = std::move(spares_.back());
    spares_.pop_back();
    return body;
  }

  Contest contest_;
  Decoders* decoders_;
  CURLM* multi_ = curl_multi_init();
  std::vector<Slot> slots_;
  int next_ = 0;
  std::mutex mutex_;
  std::vector<std::shared_ptr<std::vector<std::uint8_t>>> spares_;
  std::atomic<int> failures_{0};
  Countdown countdown_;
};

class GdalTiles final : public TileContestant {
 public:
  GdalTiles(const Contest& contest, const GdalSettings& settings)
      : settings_(settings),
        document_(JpegPyramid::document(
            contest.address,
            settings.isBatched ? "<MaxConnections>" + std::to_string(contest.atOnce) + "</MaxConnections>" : "")),
        certificates_(contest.certificates.string()) {
    GDALAllRegister();
  }

  double run(int tiles) override {
    CPLSetConfigOption("CURL_CA_BUNDLE", certificates_.empty() ? nullptr : certificates_.c_str());
    next_ = 0;
    std::atomic<int> failures{0};
    const auto start = Clock::now();
    std::vector<std::thread> threads;
    for (int i = 0; i < settings_.threads; ++i) {
      threads.emplace_back([&] { failures += read(tiles); });
    }
    for (std::thread& thread : threads) {
      thread.join();
    }
    const double speed = perSecond(tiles, start);
    requireAll(failures, "GDAL");
    return speed;
  }

 private:
  /// A thread's share, with a dataset of its own, whose blocks go with it.
  int read(int tiles) {
    const GDALDatasetUniquePtr dataset(GDALDataset::Open(document_.c_str(), GDAL_OF_RASTER));
    if (dataset == nullptr) {
      return tiles;
    }
    const int atOnce = settings_.isBatched ? batch : 1;
    std::vector<std::uint8_t> rgba(tileBytes * static_cast<std::size_t>(atOnce));
    int failures = 0;
    for (int first = next_.fetch_add(atOnce); first < tiles; first = next_.fetch_add(atOnce)) {
      const int width = std::min(atOnce, tiles - first) * JpegPyramid::tileSize;
      const CPLErr code = dataset->RasterIO(GF_Read, first % JpegPyramid::columns * JpegPyramid::tileSize,
                                            first / JpegPyramid::columns * JpegPyramid::tileSize, width,
                                            JpegPyramid::tileSize, rgba.data(), width, JpegPyramid::tileSize, GDT_Byte,
                                            3, nullptr, 4, GSpacing{4} * width, 1, nullptr);
      failures += code == CE_None ? 0 : 1;
    }
    return failures;
  }

  /// GDAL asks for at most 30 tiles in a row at once.
  static constexpr int batch = 16;
  GdalSettings settings_;
  std::string document_;
  std::string certificates_;
  std::atomic<int> next_{0};
};

}  // namespace

Decoders::Decoders(int threads) {
  for (int i = 0; i < threads; ++i) {
    threads_.emplace_back([this] { work(); });
  }
}

Decoders::~Decoders() {
  {
    const std::lock_guard lock(mutex_);
    isStopping_ = true;
  }
  posted_.notify_all();
  for (std::thread& thread : threads_) {
    thread.join();
  }
}

void Decoders::post(std::function<void()> task) {
  {
    const std::lock_guard lock(mutex_);
    tasks_.push_back(std::move(task));
  }
  posted_.notify_one();
}

void Decoders::work() {
  std::unique_lock lock(mutex_);
  while (true) {
    posted_.wait(lock, [this] { return isStopping_ || !tasks_.empty(); });
    if (tasks_.empty()) {
      return;
    }
    std::function<void()> task = std::move(tasks_.front());
    tasks_.pop_front();
    lock.unlock();
    task();
    task = nullptr;
    lock.lock();
  }
}

std::unique_ptr<TileContestant> meridianTiles(const Contest& contest, Decoders& decoders) {
  return std::make_unique<MeridianTiles>(contest, decoders);
}

std::unique_ptr<TileContestant> curlTiles(const Contest& contest, Decoders& decoders) {
  return std::make_unique<CurlTiles>(contest, decoders);
}

std::unique_ptr<TileContestant> gdalTiles(const Contest& contest, const GdalSettings& settings) {
  return std::make_unique<GdalTiles>(contest, settings);
}

}  // namespace meridian::bench

#include "globebrowsing/source/raster_access.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <optional>
#include <system_error>

#include <fmt/format.h>
#include <gdal_priv.h>

#include "globebrowsing/source/gdal_runtime.h"
#include "globebrowsing/source/netcdf_length.h"
#include "globebrowsing/source/service_text.h"

namespace meridian::globebrowsing {

namespace {

constexpr std::size_t keptBytes = std::size_t{64} << 20U;  // of a level
constexpr std::size_t stripBytes = std::size_t{4} << 20U;  // read between two looks at the stop token
constexpr std::size_t pooledDatasets = 8;

tl::unexpected<Error> cancelled(const std::string& where) {
  return failure("cancelled", where);
}

/// Rasters beyond 2^32 pixels without overviews cannot be averaged in a tolerable time: coarse levels take every
/// step-th pixel, so that a level costs at most a few million.
int stepFor(const RasterLevel& level, GDALRasterBand& native) {
  constexpr double tolerable = 4294967296.0;
  constexpr double affordable = 4194304.0;
  const double pixels = double{1.0} * native.GetXSize() * native.GetYSize();
  int step = 1;
  while (pixels > tolerable && step < level.factor && pixels / step / step > affordable) {
    step *= 2;
  }
  return step;
}

/// What GeoTIFF, photographs and PNG call it.
std::string attributionOf(GDALDataset& dataset) {
  for (const char* key : {"TIFFTAG_COPYRIGHT", "EXIF_Copyright", "Copyright"}) {
    if (const char* text = dataset.GetMetadataItem(key)) {
      return creditText(text);
    }
  }
  return {};
}

SampleType sampleType(GDALRasterBand& band) {
  switch (band.GetRasterDataType()) {
    case GDT_UInt16:
      return SampleType::UInt16;
    case GDT_Int16:
      return SampleType::Int16;
    case GDT_UInt32:
      return SampleType::UInt32;
    case GDT_Int32:
      return SampleType::Int32;
    case GDT_UInt64:
      return SampleType::UInt64;
    case GDT_Int64:
      return SampleType::Int64;
    case GDT_Float32:
      return SampleType::Float32;
    case GDT_Float64:
      return SampleType::Float64;
    default:
      break;
  }
  const char* sign = band.GetMetadataItem("PIXELTYPE", "IMAGE_STRUCTURE");
  return sign != nullptr && EQUAL(sign, "SIGNEDBYTE") ? SampleType::Int8 : SampleType::UInt8;
}

}  // namespace

RasterHandle::RasterHandle(GDALDataset* dataset, const Projection* projection)
    : dataset_(dataset),
      projection_(projection != nullptr ? std::make_unique<Projection>(projection->clone()) : nullptr) {}

RasterHandle::~RasterHandle() {
  const GdalMessages messages;
  GDALClose(dataset_);
}

/// Outlives the access while a handle is out.
struct RasterAccess::Pool {
  std::mutex mutex;
  std::vector<std::unique_ptr<RasterHandle>> idle;
};

/// A level in memory, or the part of it that has been read: a cancelled read goes on where it stopped.
template <class Pixel>
struct RasterAccess::Resident {
  std::mutex mutex;
  std::vector<Pixel> pixels;
  int rows = 0;
  std::optional<Error> error;
};

template <class Pixel>
struct RasterAccess::Store {
  explicit Store(std::size_t count) : levels(count) {}
  std::vector<Resident<Pixel>> levels;
  std::atomic<std::size_t> bytes{0};
};

RasterAccess::RasterAccess(RasterDescription description, GdalReach reach, GDALDataset* dataset,
                           RasterGeoreference georeference)
    : description_(std::move(description)),
      reach_(std::move(reach)),
      pyramid_{description_.where.empty() ? description_.path : description_.where, std::move(georeference)},
      pool_(std::make_shared<Pool>()) {
  pool_->idle.push_back(std::make_unique<RasterHandle>(dataset, pyramid_.georeference.projection()));
}

RasterAccess::~RasterAccess() = default;

Result<void> RasterAccess::examine() {
  const GdalMessages messages;
  checkLength();
  GDALDataset& dataset = pool_->idle.front()->dataset();
  levels_ = rasterLevels(dataset);
  for (const RasterLevel& level : levels_) {
    pyramid_.levels.push_back({level.width, level.height, level.scaleX, level.scaleY});
  }
  colours_ = std::make_unique<Store<Rgba>>(levels_.size());
  heights_ = std::make_unique<Store<float>>(levels_.size());
  heightRule_ = heightRule(dataset, description_);
  GDALRasterBand& band = *dataset.GetRasterBand(1);
  info_.width = dataset.GetRasterXSize();
  info_.height = dataset.GetRasterYSize();
  info_.bands = dataset.GetRasterCount();
  info_.type = sampleType(band);
  for (int b = 1; b <= info_.bands; ++b) {
    info_.hasAlpha = info_.hasAlpha || dataset.GetRasterBand(b)->GetColorInterpretation() == GCI_AlphaBand;
  }
  info_.hasColourTable = band.GetColorTable() != nullptr;
  info_.noData = heightRule_.noData;
  info_.west = pyramid_.georeference.west();
  info_.south = pyramid_.georeference.south();
  info_.east = pyramid_.georeference.east();
  info_.north = pyramid_.georeference.north();
  info_.coversAllLongitudes = pyramid_.georeference.coversAllLongitudes();
  info_.isGeographic = pyramid_.georeference.isGeographic();
  info_.finestPixelAngle = pyramid_.georeference.finestPixelAngle();
  info_.attribution = attributionOf(dataset);
  info_.heightScale = heightRule_.scale;
  info_.heightOffset = heightRule_.offset;
  return {};
}

Result<void> RasterAccess::prepareColours(GDALDataset& dataset) const {
  const std::lock_guard lock(colourRuleMutex_);
  if (hasColourRule_) {
    return {};
  }
  if (auto allowed = checkReach(reach_, pyramid_.where); !allowed) {
    return allowed;
  }
  auto rule = colourRule(dataset, pyramid_.where);
  if (!rule) {
    return tl::make_unexpected(rule.error());
  }
  colourRule_ = std::move(*rule);
  hasColourRule_ = true;
  return {};
}

Result<std::shared_ptr<RasterHandle>> RasterAccess::borrow() const {
  std::unique_ptr<RasterHandle> handle;
  {
    const std::lock_guard lock(pool_->mutex);
    if (!pool_->idle.empty()) {
      handle = std::move(pool_->idle.back());
      pool_->idle.pop_back();
    }
  }
  if (!handle) {
    if (auto allowed = checkReach(reach_, pyramid_.where); !allowed) {
      return tl::make_unexpected(allowed.error());
    }
    const GdalMessages messages;
    GDALDataset* dataset = GDALDataset::Open(description_.path.c_str(), GDAL_OF_RASTER | GDAL_OF_VERBOSE_ERROR);
    if (dataset == nullptr) {
      return messages.failure("the raster cannot be opened again", pyramid_.where,
                              "check that the file is still there");
    }
    handle = std::make_unique<RasterHandle>(dataset, pyramid_.georeference.projection());
    if (dataset->GetRasterXSize() != info_.width || dataset->GetRasterYSize() != info_.height ||
        dataset->GetRasterCount() != info_.bands) {
      return failure("the raster has changed since it was opened", pyramid_.where, "load the layer again");
    }
  }
  return std::shared_ptr<RasterHandle>(handle.release(), [pool = pool_](RasterHandle* returned) {
    std::unique_ptr<RasterHandle> owner(returned);
    const std::lock_guard lock(pool->mutex);
    if (!owner->isSpoiled() && pool->idle.size() < pooledDatasets) {
      pool->idle.push_back(std::move(owner));
    }
  });
}

std::optional<Error> RasterAccess::flaw() const {
  const std::lock_guard lock(flawMutex_);
  return flaw_;
}

void RasterAccess::keepFlaw(const ReadNotes& notes) const {
  const std::lock_guard lock(flawMutex_);
  if (!flaw_ && notes.implausible) {
    flaw_ = implausibleHeight(*notes.implausible, heightRule_.limits, pyramid_.where);
  }
  if (!flaw_ && !notes.warning.empty()) {
    flaw_ = Error{"GDAL warned of the raster while it was read: " + notes.warning, pyramid_.where,
                  "check that the file is complete"};
  }
}

void RasterAccess::checkLength() const {
  std::error_code code;
  const std::uintmax_t length = std::filesystem::is_regular_file(description_.path, code)
                                    ? std::filesystem::file_size(description_.path, code)
                                    : 0;
  const std::optional<std::uint64_t> needed = length > 0 ? classicNetcdfLength(description_.path) : std::nullopt;
  if (needed && !code && length < *needed) {
    const std::lock_guard lock(flawMutex_);
    flaw_ = Error{fmt::format("the file ends after {} of {} bytes; what is missing reads as zeros", length, *needed),
                  pyramid_.where, "get the whole file"};
  }
}

bool RasterAccess::isKept(std::size_t level, std::size_t pixelBytes) const {
  const RasterLevel& l = levels_[level];
  // Datasets with overviews are laid out for reading windows; nothing is gained by keeping their own levels.
  const bool isNative = l.factor == 1;
  const bool hasOverviews = std::any_of(levels_.begin(), levels_.end(), [](const auto& o) { return o.overview >= 0; });
  return !(isNative && hasOverviews) &&
         static_cast<std::size_t>(l.width) * static_cast<std::size_t>(l.height) * pixelBytes <= keptBytes;
}

template <class Pixel>
Result<void> RasterAccess::readStrips(RasterHandle& handle, const RasterLevel& level, const PixelWindow& window,
                                      Pixel* out, std::ptrdiff_t stride, const std::stop_token& stop) const {
  if (auto allowed = checkReach(reach_, pyramid_.where); !allowed) {
    return allowed;
  }
  GDALRasterBand* band = handle.dataset().GetRasterBand(1);
  GDALRasterBand* native = level.overview < 0 ? band : band->GetOverview(level.overview);
  if (native == nullptr) {
    return failure("the raster has lost an overview", pyramid_.where, "load the layer again");
  }
  const auto nativeSize = [&level](int first, int count, int size) {
    return static_cast<int>(std::min(std::int64_t{count} * level.factor, std::int64_t{size} - first));
  };
  ReadRequest request{level.overview, {}, stepFor(level, *native)};
  const int factor = level.factor / request.step;
  request.window.x = window.x * level.factor;
  request.window.width = nativeSize(request.window.x, window.width, native->GetXSize());
  const int columns = request.columns();
  const auto rowBytes = static_cast<std::size_t>(columns) * static_cast<std::size_t>(factor) * sizeof(Pixel);
  const int rowsAtOnce =
      static_cast<int>(std::clamp<std::size_t>(stripBytes / rowBytes, 1, static_cast<std::size_t>(window.height)));
  const bool isDirect = factor == 1 && stride == columns;
  std::vector<Pixel> strip;
  for (int row = 0; row < window.height; row += rowsAtOnce) {
    if (stop.stop_requested()) {
      return cancelled(pyramid_.where);
    }
    const int rows = std::min(rowsAtOnce, window.height - row);
    request.window.y = (window.y + row) * level.factor;
    request.window.height = nativeSize(request.window.y, rows, native->GetYSize());
    Pixel* target = out + row * stride;
    strip.resize(isDirect ? 0 : static_cast<std::size_t>(columns) * static_cast<std::size_t>(request.rows()));
    Pixel* into = isDirect ? target : strip.data();
    ReadNotes notes;
    if (auto done = readPixels(handle.dataset(), rule(target), request, into, pyramid_.where, notes); !done) {
      handle.spoil();
      return done;
    }
    keepFlaw(notes);
    for (int r = 0; r < rows && !isDirect; ++r) {
      const Pixel* from = strip.data() + static_cast<std::ptrdiff_t>(r) * factor * columns;
      reduce(from, columns, std::min(factor, request.rows() - r * factor), factor, target + r * stride);
    }
  }
  return {};
}

template <class Pixel>
Result<const Pixel*> RasterAccess::resident(RasterHandle& handle, std::size_t level,
                                            const std::stop_token& stop) const {
  Store<Pixel>& all = store(static_cast<const Pixel*>(nullptr));
  Resident<Pixel>& kept = all.levels[level];
  const RasterLevel& l = levels_[level];
  const std::lock_guard lock(kept.mutex);
  if (kept.error) {
    return tl::make_unexpected(*kept.error);
  }
  if (kept.pixels.empty()) {
    const std::size_t count = static_cast<std::size_t>(l.width) * static_cast<std::size_t>(l.height);
    kept.pixels.resize(count);
    all.bytes += count * sizeof(Pixel);
  }
  const bool fromFiner =
      l.factor > 1 && level > 0 && isKept(level - 1, sizeof(Pixel)) && levels_[level - 1].overview == l.overview;
  const Pixel* finer = nullptr;
  if (fromFiner && kept.rows < l.height) {
    auto found = resident<Pixel>(handle, level - 1, stop);
    if (!found) {
      return found;
    }
    finer = *found;
  }
  constexpr int rowsAtOnce = 64;
  while (kept.rows < l.height) {
    if (stop.stop_requested()) {
      return cancelled(pyramid_.where);
    }
    const int rows = std::min(rowsAtOnce, l.height - kept.rows);
    Pixel* target = kept.pixels.data() + static_cast<std::ptrdiff_t>(kept.rows) * l.width;
    if (finer != nullptr) {
      const RasterLevel& f = levels_[level - 1];
      const int from = kept.rows * 2;
      reduce(finer + static_cast<std::ptrdiff_t>(from) * f.width, f.width, std::min(rows * 2, f.height - from), 2,
             target);
    } else if (auto done = readStrips(handle, l, {0, kept.rows, l.width, rows}, target, l.width, stop); !done) {
      if (!stop.stop_requested() && checkReach(reach_, pyramid_.where)) {  // being offline may end
        kept.error = done.error();
      }
      return tl::make_unexpected(done.error());
    }
    kept.rows += rows;
  }
  return kept.pixels.data();
}

template <class Pixel>
Result<void> RasterAccess::read(RasterHandle& handle, std::size_t level, const PixelWindow& window, Pixel* out,
                                std::ptrdiff_t stride, const std::stop_token& stop) const {
  if (!isKept(level, sizeof(Pixel))) {
    return readStrips(handle, levels_[level], window, out, stride, stop);
  }
  auto pixels = resident<Pixel>(handle, level, stop);
  if (!pixels) {
    return tl::make_unexpected(pixels.error());
  }
  for (int row = 0; row < window.height; ++row) {
    const Pixel* from = *pixels + static_cast<std::ptrdiff_t>(window.y + row) * levels_[level].width + window.x;
    std::copy(from, from + window.width, out + row * stride);
  }
  return {};
}

template <class Pixel>
Result<void> RasterAccess::fetchUnbounded(RasterHandle& handle, std::size_t level, const UnboundedWindow& window,
                                          Pixel* out, const std::stop_token& stop) const {
  for (const WindowPiece& piece : piecesOf(pyramid_, level, window)) {
    Pixel* target = out + static_cast<std::ptrdiff_t>(piece.row) * window.width + piece.column;
    if (auto done = read(handle, level, piece.from, target, window.width, stop); !done) {
      return done;
    }
  }
  return {};
}

class RasterAccess::Reader final : public PixelReader {
 public:
  Reader(const RasterAccess& access, std::shared_ptr<RasterHandle> handle)
      : access_(access), handle_(std::move(handle)) {}

  const Pyramid& pyramid() const override { return access_.pyramid_; }
  const Projection* projection() const override { return handle_->projection(); }
  Result<void> fetch(std::size_t level, const UnboundedWindow& window, Rgba* out,
                     const std::stop_token& stop) override {
    if (auto ready = access_.prepareColours(handle_->dataset()); !ready) {
      return ready;
    }
    return access_.fetchUnbounded(*handle_, level, window, out, stop);
  }
  Result<void> fetch(std::size_t level, const UnboundedWindow& window, float* out,
                     const std::stop_token& stop) override {
    return access_.fetchUnbounded(*handle_, level, window, out, stop);
  }

 private:
  const RasterAccess& access_;
  std::shared_ptr<RasterHandle> handle_;
};

Result<std::unique_ptr<PixelReader>> RasterAccess::reader() const {
  return borrow().map([this](std::shared_ptr<RasterHandle> handle) -> std::unique_ptr<PixelReader> {
    return std::make_unique<Reader>(*this, std::move(handle));
  });
}

std::size_t RasterAccess::residentBytes() const {
  return colours_->bytes + heights_->bytes;
}

}  // namespace meridian::globebrowsing

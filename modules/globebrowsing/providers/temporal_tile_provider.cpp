#include "globebrowsing/providers/temporal_tile_provider.h"

#include <filesystem>
#include <system_error>
#include <utility>

#include "globebrowsing/providers/colormapped_tile_provider.h"
#include "globebrowsing/providers/date_text.h"
#include "globebrowsing/providers/default_tile_provider.h"
#include "globebrowsing/providers/inner_providers.h"
#include "globebrowsing/providers/path_tokens.h"
#include "globebrowsing/providers/service_series.h"
#include "globebrowsing/providers/temporal_document.h"
#include "globebrowsing/source/document_file.h"
#include "globebrowsing/source/source_tile_store.h"
#include "host/api/log.h"

namespace meridian::globebrowsing {

namespace {

/// Of an XML file; there is no longer one.
constexpr std::size_t mostDocumentBytes = std::size_t{1} << 20;

Result<std::unique_ptr<TimeSeries>> seriesOf(std::string_view document, const ProviderRequest& request) {
  return readTemporalDocument(document, placeOf(request, "FilePath"))
      .and_then([&](const PrototypedSeries::Description& description) {
        return PrototypedSeries::make(description,
                                      innerRequest(request, "FilePath", valueAt(request.table, "FilePath")));
      });
}

/// Null for what is to be read first: a file, or capabilities.
Result<std::unique_ptr<TimeSeries>> seriesOf(const ProviderRequest& request) {
  if (!valueAt(request.table, "Folder").isNil()) {
    return FolderSeries::make(request);
  }
  if (!valueAt(request.table, "Prototyped").isNil()) {
    return PrototypedSeries::make(request);
  }
  const std::string* filePath = valueAt(request.table, "FilePath").string();
  if (filePath == nullptr || filePath->empty()) {
    return failure("a temporal layer needs a table Prototyped or Folder", placeOf(request, "Mode"),
                   "give one of them, and Mode with its name");
  }
  if (dataPath(*filePath, request.folder).kind != DataPath::Kind::Document || mayHaveTimes(*filePath)) {
    return nullptr;
  }
  return seriesOf(*filePath, request);
}

}  // namespace

const Schema& TemporalTileProvider::schema() {
  using Type = Schema::Type;
  static const Schema fields(
      {{"Mode",
        Type::String,
        "which of the two tables says where the data are",
        false,
        {},
        {},
        {"Prototyped", "Folder"}},
       {"Prototyped", Type::Table, "Time, TemporalResolution, TimeFormat and Prototype"},
       {"Folder", Type::Table, "Folder and Format: a file for each step"},
       {"FilePath", Type::String,
        "a layer of a WMS or WMTS with times, as docs/services.md tells; or, of older assets, an "
        "<OpenSpaceTemporalGDALDataset>, or a file that holds one"},
       {"UseFixedTime", Type::Boolean, "whether FixedTime is shown whatever the time"},
       {"FixedTime", Type::String, "the date to show then"},
       {"Interpolation", Type::Boolean, "whether the picture between two steps is a mixture of both, by the time"},
       {"Colormap", Type::String,
        "an image whose first row says the colours of the first band, from its least value to its greatest"}});
  return fields;
}

Result<std::shared_ptr<TileProvider>> TemporalTileProvider::make(const ProviderRequest& request) {
  Result<std::unique_ptr<TimeSeries>> series = seriesOf(request);
  if (!series) {
    return tl::make_unexpected(std::move(series.error()));
  }
  // What its rasters will be made from must be right now, not when time comes to them.
  if (Result<ProviderPointer> raster = makeInner(rasterRequest(request, "step.tif")); !raster) {
    return raster;
  }
  auto provider = std::make_shared<TemporalTileProvider>(request, std::move(*series));
  if (const std::string* text = valueAt(request.table, "FixedTime").string()) {
    provider->fixedTime.put(*text);
  }
  provider->useFixedTime.put(valueAt(request.table, "UseFixedTime").boolean().value_or(false));
  provider->interpolation.put(valueAt(request.table, "Interpolation").boolean().value_or(false));
  if (Result<void> read = provider->readFixedTime(); !read) {
    read.error().where = placeOf(request, "FixedTime");
    return tl::make_unexpected(std::move(read.error()));
  }
  provider->fixedTime.onChange([self = provider.get()] {
    if (const Result<void> read = self->readFixedTime(); !read) {
      log::warning("{}: {}; the scene's time is shown", self->fixedTime.uri(), read.error().message());
    }
  });
  return provider;
}

TemporalTileProvider::TemporalTileProvider(ProviderRequest request, std::unique_ptr<TimeSeries> series)
    : request_(std::move(request)), isNamed_(series == nullptr), rasters_(request_), series_(std::move(series)) {
  rasters_.share = std::make_shared<SeriesShare>();
  if (isNamed_ && request_.sourceTiles != nullptr) {
    opening_ = std::make_unique<ServiceOpening>(
        dataPath(*valueAt(request_.table, "FilePath").string(), request_.folder).text, placeOf(request_, "FilePath"),
        request_.sourceTiles->fetcher(), rasters_.share);
  }
  owner_.addProperty(useFixedTime);
  owner_.addProperty(fixedTime);
  owner_.addProperty(interpolation);
}

Result<void> TemporalTileProvider::readFixedTime() {
  fixed_.reset();
  if (fixedTime.get().empty()) {
    return {};
  }
  return readDate(fixedTime.get()).map([this](Time::UtcInstant instant) { fixed_ = instant; });
}

std::string TemporalTileProvider::colormapPath() const {
  const std::string* path = valueAt(request_.table, "Colormap").string();
  return path == nullptr || path->empty() ? std::string() : dataPath(*path, request_.folder).text;
}

Result<void> TemporalTileProvider::check() const {
  std::error_code code;
  if (const std::string path = colormapPath(); !path.empty() && !std::filesystem::is_regular_file(path, code)) {
    return tl::make_unexpected(missing("the colormap", path, placeOf(request_, "Colormap"),
                                       "check Colormap; a relative path starts at the asset's folder"));
  }
  return checkSeries();
}

Result<void> TemporalTileProvider::checkSeries() const {
  return isNamed_ ? checkData(dataPath(*valueAt(request_.table, "FilePath").string(), request_.folder),
                              placeOf(request_, "FilePath"))
                  : series_->check();
}

bool TemporalTileProvider::prepareData(const std::function<void()>& wake) {
  return opening_ == nullptr || !check() || opening_->prepare(wake);
}

Result<void> TemporalTileProvider::openData() {
  if (Result<void> checked = check(); !checked) {
    return checked;
  }
  if (isNamed_) {
    Result<std::unique_ptr<TimeSeries>> series = openSeries();
    if (opening_ != nullptr) {
      opening_->end();
    }
    if (!series) {
      return tl::make_unexpected(std::move(series.error()));
    }
    series_ = std::move(*series);
  }
  if (const std::string path = colormapPath(); !path.empty()) {
    Result<std::shared_ptr<const Colormap>> colormap = Colormap::read(path, placeOf(request_, "Colormap"));
    if (!colormap) {
      return tl::make_unexpected(std::move(colormap.error()));
    }
    colormap_ = std::move(*colormap);
  }
  return series_->open();
}

Result<std::unique_ptr<TimeSeries>> TemporalTileProvider::openSeries() {
  if (opening_ != nullptr) {
    Result<std::optional<CapabilitiesReference>> reference = opening_->reference();
    if (!reference) {
      return tl::make_unexpected(std::move(reference.error()));
    }
    if (*reference) {
      return ServiceSeries::make(std::move(**reference), opening_->document());
    }
  }
  const DataPath path = dataPath(*valueAt(request_.table, "FilePath").string(), request_.folder);
  if (path.kind != DataPath::Kind::File) {
    return failure("FilePath names no series in time", placeOf(request_, "FilePath"),
                   "name a layer of a WMS or WMTS by its capabilities, or use Mode, Prototyped and Folder");
  }
  // Relative paths in the file start at the file.
  rasters_.folder = std::filesystem::path(path.text).parent_path().string();
  return readTextFile(path.text, mostDocumentBytes, placeOf(request_, "FilePath"),
                      "name an <OpenSpaceTemporalGDALDataset>, or use Mode, Prototyped and Folder")
      .and_then([&](const std::string& text) { return seriesOf(text, rasters_); });
}

TimeSeries::Entry TemporalTileProvider::entryAt(const Time& now) const {
  return isFixed() ? series_->atFixed(*fixed_) : series_->at(now.utcInstant());
}

TileStep TemporalTileProvider::at(const Time& now) const {
  const TimeSeries::Entry entry = entryAt(now);
  TileStep step;
  step.id = static_cast<std::uint64_t>(entry.instant.time_since_epoch().count());
  step.begin = entry.begin ? Time::fromUtcInstant(*entry.begin) : step.begin;
  step.end = entry.end ? Time::fromUtcInstant(*entry.end) : step.end;
  step.instant = Time::fromUtcInstant(entry.instant);
  return step;
}

Result<std::shared_ptr<TileProvider>> TemporalTileProvider::make(const Time& now) const {
  return series_->tiles(entryAt(now).instant, rasters_).map([this](std::shared_ptr<TileProvider> values) {
    return colormap_ == nullptr ? values : std::make_shared<ColormappedTileProvider>(std::move(values), colormap_);
  });
}

Result<std::shared_ptr<TileProvider>> RasterSeries::tiles(Instant entry, const ProviderRequest& rasters) const {
  return filePath(entry).and_then([&](std::string path) { return makeInner(rasterRequest(rasters, std::move(path))); });
}

}  // namespace meridian::globebrowsing

#include "globebrowsing/providers/default_tile_provider.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <system_error>

#include "globebrowsing/providers/path_tokens.h"
#include "globebrowsing/providers/tiles_table.h"
#include "globebrowsing/source/tiled_service_source.h"
#include "host/api/log.h"

namespace meridian::globebrowsing {

namespace {

bool isDocument(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  return first != std::string_view::npos && text[first] == '<';
}

/// "WMS:...", "NETCDF:...", "https://...", "/vsizip/...": a driver's or a virtual file system's prefix.
bool isConnection(std::string_view text) {
  if (text.substr(0, 4) == "/vsi") {
    return true;
  }
  const std::size_t colon = text.find(':');
  return colon != std::string_view::npos && colon >= 2 &&
         std::all_of(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(colon),
                     [](unsigned char c) { return std::isalnum(c) != 0 || c == '_' || c == '+' || c == '-'; });
}

std::optional<double> numberAt(const Value& table, std::string_view key) {
  const Value* value = table.find(key);
  return value == nullptr ? std::nullopt : value->number();
}

Result<std::optional<std::array<double, 4>>> extentOf(const ProviderRequest& request) {
  const Value* value = request.table.find("ExtentDegrees");
  if (value == nullptr || value->isNil()) {
    return std::nullopt;
  }
  const std::vector<double> sides = value->numbers(4).value_or(std::vector<double>(4, 0.0));
  if (!(sides[2] > sides[0]) || !(sides[3] > sides[1])) {
    return failure("ExtentDegrees is empty or turned around", placeOf(request, "ExtentDegrees"),
                   "give west, south, east, north in degrees, east greater than west and north greater than south");
  }
  return std::array<double, 4>{sides[0], sides[1], sides[2], sides[3]};
}

/// The asset's word on heights, in place of the service's own.
TileService withHeights(TileService service, const RasterDescription& description, const TileSettings& tiles) {
  service.encoding = tiles.encoding.value_or(service.encoding);
  if (service.encoding != TileEncoding::Image) {
    service.heightUrl = nullptr;  // values instead of colours
    service.noData.reset();
  }
  if (description.heightScale) {
    service.heightScale = description.heightScale;
  }
  if (description.heightOffset) {
    service.heightOffset = description.heightOffset;
  }
  if (description.heightDatum) {
    service.heightOffset = service.heightOffset.value_or(0.0) - *description.heightDatum;
  }
  return service;
}

}  // namespace

DataPath dataPath(const std::string& filePath, const std::string& folder) {
  if (isDocument(filePath)) {
    return {DataPath::Kind::Document, filePath};
  }
  if (isConnection(filePath)) {
    return {DataPath::Kind::Connection, filePath};
  }
  const std::filesystem::path path(filePath);
  return {DataPath::Kind::File,
          (path.is_absolute() ? path : std::filesystem::path(folder) / path).lexically_normal().string()};
}

Result<void> checkData(const DataPath& path, const std::string& where) {
  if (path.kind != DataPath::Kind::File) {
    return checkTokens(path.text, where);
  }
  std::error_code code;
  const std::filesystem::file_status status = std::filesystem::status(path.text, code);
  if (!std::filesystem::exists(status)) {
    return tl::make_unexpected(
        missing("the data file", path.text, where, "check the path; a relative one starts at the asset's folder"));
  }
  if (std::filesystem::is_directory(status)) {
    return failure("the data file " + path.text + " is a directory", where, "name a file in it");
  }
  return {};
}

const Schema& DefaultTileProvider::schema() {
  using Type = Schema::Type;
  static const Schema fields(
      {{"FilePath", Type::String,
        "a raster file, relative to the asset's folder or absolute; or a map service, as docs/services.md tells; or a "
        "GDAL "
        "connection string such as /vsicurl/...",
        true},
       {"TilePixelSize", Type::Integer, "pixels along a tile; tiles here are always 512 wide", false, 32.0, 2048.0},
       {"ExtentDegrees", Type::Vector4,
        "west, south, east and north edge in degrees, in place of the raster's own georeference", false, -360.0, 720.0},
       {"HeightScale", Type::Number, "metres for one unit of a stored height, in place of the raster's own scale"},
       {"HeightOffset", Type::Number, "metres added to stored heights, in place of the raster's own offset"},
       {"HeightDatum", Type::Number,
        "metres taken off the heights: the radius, where the raster stores heights as radii"},
       {"Tiles", Type::Table, "what a map service does not say of its tiles: Encoding, PixelSize and more"}});
  return fields;
}

Result<std::shared_ptr<TileProvider>> DefaultTileProvider::make(const ProviderRequest& request) {
  return makeUnopened(request);
}

Result<std::shared_ptr<TileProvider>> DefaultTileProvider::make(const ProviderRequest& request,
                                                                std::unique_ptr<ServiceOpening> opening) {
  return makeUnopened(request).map([&](std::shared_ptr<DefaultTileProvider> provider) {
    provider->opening_ = std::move(opening);
    return std::shared_ptr<TileProvider>(std::move(provider));
  });
}

Result<std::shared_ptr<DefaultTileProvider>> DefaultTileProvider::makeUnopened(const ProviderRequest& request) {
  const std::string& filePath = *request.table.find("FilePath")->string();
  if (filePath.empty()) {
    return failure("FilePath is empty", placeOf(request, "FilePath"), "name a raster");
  }
  auto extent = extentOf(request);
  if (!extent) {
    return tl::make_unexpected(std::move(extent.error()));
  }
  auto tiles = readTiles(request);
  if (!tiles) {
    return tl::make_unexpected(std::move(tiles.error()));
  }
  DataPath path = dataPath(filePath, request.folder);
  RasterDescription description;
  description.path = path.text;
  description.where = placeOf(request, "FilePath");
  description.extentDegrees = *extent;
  description.heightScale = numberAt(request.table, "HeightScale");
  description.heightOffset = numberAt(request.table, "HeightOffset");
  description.heightDatum = numberAt(request.table, "HeightDatum");
  description.heightLimits = request.heightLimits;
  return std::make_shared<DefaultTileProvider>(std::move(path), std::move(description), *tiles, request);
}

DefaultTileProvider::DefaultTileProvider(DataPath path, RasterDescription description, TileSettings tiles,
                                         const ProviderRequest& request)
    : path_(std::move(path)),
      description_(std::move(description)),
      tiles_(tiles),
      whereTiles_(placeOf(request, "Tiles")),
      sourceTiles_(request.sourceTiles),
      share_(request.share) {
  // A service has its own georeference; one that the asset replaces is a raster's.
  if (sourceTiles_ != nullptr && !description_.extentDegrees) {
    opening_ =
        std::make_unique<ServiceOpening>(path_.text, description_.where, sourceTiles_->fetcher(), share_, tiles_);
  }
}

Result<void> DefaultTileProvider::check() const {
  return checkTiles(tiles_, path_.text, whereTiles_).and_then([this] { return checkData(path_, description_.where); });
}

bool DefaultTileProvider::prepareData(const std::function<void()>& wake) {
  return opening_ == nullptr || !check() || opening_->prepare(wake);
}

Result<void> DefaultTileProvider::openData() {
  Result<void> opened =
      check().and_then([this] { return openSource(); }).map([this](std::shared_ptr<PixelSource> source) {
        source_ = std::move(source);
      });
  if (opening_ != nullptr) {
    opening_->end();
  }
  return opened;
}

std::optional<Error> DefaultTileProvider::lastFailure() const {
  switch (state()) {
    case State::Opening:
      return opening_ != nullptr ? opening_->lastFailure() : std::nullopt;
    case State::Ready:
      return source_->lastFailure();
    case State::NotOpened:
    case State::Failed:
      break;
  }
  return std::nullopt;
}

Result<std::shared_ptr<PixelSource>> DefaultTileProvider::openSource() {
  if (opening_ != nullptr) {
    Result<std::optional<TileService>> service = opening_->service();
    if (!service) {
      return tl::make_unexpected(std::move(service.error()));
    }
    if (*service) {
      tellNotes();
      return TiledServiceSource::make(withHeights(std::move(**service), description_, tiles_), sourceTiles_,
                                      description_.heightLimits);
    }
  }
  if (!tiles_.isEmpty()) {
    const std::string reason = opening_ != nullptr ? opening_->reason() : std::string("services are not asked here");
    return failure("Tiles is of map services, and FilePath is opened as a raster: " + reason, whereTiles_,
                   "leave Tiles out, or name a map service");
  }
  return RasterSource::open(description_);
}

void DefaultTileProvider::tellNotes() const {
  const std::vector<std::string> notes = opening_->notes();
  if (notes.empty() || (share_ != nullptr && !share_->isFirstToTell())) {
    return;
  }
  for (const std::string& note : notes) {
    log::info("{}: {}", description_.where, note);
  }
}

Result<ColourPixels> DefaultTileProvider::makeColours(const Tiling& tiling, const TileIndex& index,
                                                      std::stop_token stop) const {
  return source_->colours(tiling, index, colourLayout, std::move(stop));
}

Result<HeightPixels> DefaultTileProvider::makeHeights(const Tiling& tiling, const TileIndex& index,
                                                      const TileLayout& layout, std::stop_token stop) const {
  return source_->heights(tiling, index, layout, std::move(stop));
}

std::unique_ptr<ColourTask> DefaultTileProvider::makeColourTask(const Tiling& tiling, const TileIndex& index) const {
  return source_->colourTask(tiling, index, colourLayout);
}

std::unique_ptr<HeightTask> DefaultTileProvider::makeHeightTask(const Tiling& tiling, const TileIndex& index,
                                                                const TileLayout& layout) const {
  return source_->heightTask(tiling, index, layout);
}

bool DefaultTileProvider::dataOverlap(const Tiling& tiling, const TileIndex& index) const {
  return source_->overlaps(tiling, index);
}

bool DefaultTileProvider::dataFiner(const Tiling& tiling, const TileIndex& index, const TileLayout& layout) const {
  return source_->hasDataFiner(tiling, index, layout);
}

}  // namespace meridian::globebrowsing

#include "globebrowsing/source/raster_source.h"

#include <filesystem>

#include <gdal_priv.h>

#include "globebrowsing/source/gdal_network.h"
#include "globebrowsing/source/gdal_runtime.h"
#include "globebrowsing/source/raster_access.h"
#include "globebrowsing/source/resample_parts.h"

namespace meridian::globebrowsing {

namespace {

Result<void> checkPath(const RasterDescription& description, const std::string& where) {
  if (description.path.empty()) {
    return failure("no raster is named", where, "give a file, a GDAL connection string or a VRT document");
  }
  return {};
}

tl::unexpected<Error> cannotOpen(const GdalMessages& messages, const std::string& path, const std::string& where) {
  std::error_code ignored;
  const std::filesystem::path file(path.size() < 4096 ? path : std::string{});
  if (std::filesystem::is_directory(file, ignored)) {
    return failure("'" + path + "' is a folder, not a raster", where, "name a file in it");
  }
  if (path.front() == '/' && !path.starts_with("/vsi") && !std::filesystem::exists(file, ignored)) {
    return failure("there is no file '" + path + "'", where, "check the path");
  }
  return messages.failure("this is no raster that GDAL can read", where,
                          "check the path and the file; gdalinfo says more");
}

Result<void> checkBands(GDALDataset& dataset, const std::string& where) {
  if (dataset.GetRasterCount() == 0) {
    return failure("the raster has no bands", where, "name one of its subdatasets, which gdalinfo lists");
  }
  for (int band = 1; band <= dataset.GetRasterCount(); ++band) {
    if (GDALDataTypeIsComplex(dataset.GetRasterBand(band)->GetRasterDataType()) != 0) {
      return failure("the raster has complex samples", where, "convert it to real ones with gdal_translate");
    }
  }
  if (dataset.GetRasterXSize() < 1 || dataset.GetRasterYSize() < 1) {
    return failure("the raster has no pixels", where);
  }
  // Absurd headers announce more than is there; a block is what GDAL allocates at once.
  int blockWidth = 0;
  int blockHeight = 0;
  GDALRasterBand& band = *dataset.GetRasterBand(1);
  band.GetBlockSize(&blockWidth, &blockHeight);
  const double blockBytes = double{1.0} * blockWidth * blockHeight * GDALGetDataTypeSizeBytes(band.GetRasterDataType());
  if (blockBytes > 1e9) {
    return failure("the raster's blocks are larger than a gigabyte", where,
                   "tile it with gdal_translate -co TILED=YES");
  }
  return {};
}

}  // namespace

RasterSource::RasterSource(std::unique_ptr<RasterAccess> access) : access_(std::move(access)) {}
RasterSource::~RasterSource() = default;

Result<std::shared_ptr<RasterSource>> RasterSource::open(const RasterDescription& asked) {
  initializeGdal();
  RasterDescription description = asked;
  const std::string& where = asked.where.empty() ? asked.path : asked.where;
  if (auto named = checkPath(description, where); !named) {
    return tl::make_unexpected(named.error());
  }
  const GdalMessages messages;
  description.path = withVerifiedCertificates(asked.path);
  const GdalReach reach = gdalReach(description.path);
  if (auto allowed = checkReach(reach, where); !allowed) {
    return tl::make_unexpected(allowed.error());
  }
  GDALDatasetUniquePtr dataset(GDALDataset::Open(description.path.c_str(), GDAL_OF_RASTER | GDAL_OF_VERBOSE_ERROR));
  if (!dataset) {
    return cannotOpen(messages, description.path, where);
  }
  if (auto good = checkBands(*dataset, where); !good) {
    return tl::make_unexpected(good.error());
  }
  auto georeference = RasterGeoreference::of(*dataset, description);
  if (!georeference) {
    return tl::make_unexpected(georeference.error());
  }
  auto access = std::make_unique<RasterAccess>(description, reach, dataset.release(), std::move(*georeference));
  if (auto examined = access->examine(); !examined) {
    return tl::make_unexpected(examined.error());
  }
  return std::shared_ptr<RasterSource>(new RasterSource(std::move(access)));
}

const RasterInfo& RasterSource::info() const {
  return access_->info();
}

const RasterDescription& RasterSource::description() const {
  return access_->description();
}

std::optional<Error> RasterSource::flaw() const {
  return access_->flaw();
}

std::size_t RasterSource::residentBytes() const {
  return access_->residentBytes();
}

bool RasterSource::overlaps(const Tiling& tiling, const TileIndex& index) const {
  return reaches(access_->pyramid().georeference, tiling, index);
}

bool RasterSource::hasDataFiner(const Tiling& tiling, const TileIndex& index, const TileLayout& layout) const {
  // A raster on the very grid of the tiles differs by rounding only.
  return info().finestPixelAngle < 0.99 * nominalSpacing(tiling, index, layout) && overlaps(tiling, index);
}

Result<ColourPixels> RasterSource::colours(const Tiling& tiling, const TileIndex& index, const TileLayout& layout,
                                           std::stop_token stop) const {
  return resampleColours(*this, tiling, index, layout, stop);
}

Result<HeightPixels> RasterSource::heights(const Tiling& tiling, const TileIndex& index, const TileLayout& layout,
                                           std::stop_token stop) const {
  return resampleHeights(*this, tiling, index, layout, stop);
}

}  // namespace meridian::globebrowsing

#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>

#include "globebrowsing/source/pixel_source.h"

namespace meridian::globebrowsing {

class RasterAccess;

/// What is opened, and what the user knows better than the file.
struct RasterDescription {
  std::string path;     ///< a file, any GDAL connection string, or the text of a VRT or GDAL_WMS document
  std::string where{};  ///< place in the asset, for errors; empty: the path

  /// Takes the raster for the whole globe, -180..180 by 90..-90 degrees, whatever it says itself.
  bool assumeGlobal = false;
  /// West, south, east, north of the outer pixels' outer edges, instead of the raster's own georeference: for labels
  /// that GDAL misplaces (MOLA MEGDR: {0, -90, 360, 90}). East is greater than west.
  std::optional<std::array<double, 4>> extentDegrees{};

  /// metres = stored value * heightScale + heightOffset - heightDatum. Default: the raster's own scale and offset, its
  /// unit (km and feet are known), and as datum the semi-major axis of its CRS where the offset is within 1 % of it
  /// (heights stored as radii, as in ISIS cubes of LOLA), else 0.
  std::optional<double> heightScale{};
  std::optional<double> heightOffset{};
  std::optional<double> heightDatum{};
  /// Heights beyond are no data, and a flaw().
  HeightLimits heightLimits{};
};

enum class SampleType { UInt8, Int8, UInt16, Int16, UInt32, Int32, UInt64, Int64, Float32, Float64 };

/// What is known of an open raster. Angles in radians.
struct RasterInfo {
  int width = 0;
  int height = 0;
  int bands = 0;
  SampleType type = SampleType::UInt8;
  bool hasAlpha = false;
  bool hasColourTable = false;
  std::optional<double> noData{};

  /// Outer edges; west is in -pi..pi, east in west..west + 2 pi (over pi where the raster crosses the antimeridian).
  double west = 0.0;
  double south = 0.0;
  double east = 0.0;
  double north = 0.0;
  bool coversAllLongitudes = false;
  /// Rows are parallels and columns meridians: resampling goes by rows and columns, and needs no PROJ.
  bool isGeographic = false;
  double finestPixelAngle = 0.0;  ///< the smallest side of a pixel, on the unit sphere

  /// metres = stored value * heightScale + heightOffset, all of RasterDescription's rules applied.
  double heightScale = 1.0;
  double heightOffset = 0.0;

  std::string attribution{};  ///< by its metadata, such as TIFFTAG_COPYRIGHT; on one line
};

/// A georeferenced raster in any format, CRS and data type that GDAL and PROJ read.
///
/// Georeference: geographic and projected CRSs, rotated geotransforms, positive-west and 0..360 longitudes. Latitude
/// and longitude on the raster's own body are taken for those of the globe: no datum shifts. A raster without CRS but
/// with a geotransform is geographic; one without any georeference covers the whole globe. A whole turn of columns
/// within half a pixel is taken as exact (etopo5.cdf is 0.04 pixel off).
///
/// Colours: grey, grey + alpha, RGB, RGBA or paletted. 8-bit values are taken as they are; values of n bits by
/// metadata NBITS over 2^n - 1; UInt16 over 65535 unless its band has statistics in its metadata; every other type from
/// its band's (approximate) minimum..maximum to 0..255. Heights: band 1.
/// No data is what the nodata value, the mask, alpha 0 or not-a-number say; a colour is absent where all bands are.
///
/// Safe from any thread: each call borrows a GDAL dataset of its own from a pool. Rasters up to 64 MiB decoded are kept
/// in memory once they are sampled; coarser levels of rasters without overviews are averaged once and kept (beyond 2^32
/// pixels, thinned: such a raster wants overviews).
class RasterSource final : public PixelSource {
 public:
  /// Opens and examines; may read from disk or network, so call it on a worker. Errors: no such file, a directory, not
  /// a raster, a server that is not to be asked (gdal_network.h), no bands, complex samples, a size beyond 2^31 - 1
  /// pixels of memory, a CRS that PROJ rejects, an invertible geotransform missing, an extent outside the globe.
  [[nodiscard]] static Result<std::shared_ptr<RasterSource>> open(const RasterDescription& asked);
  ~RasterSource() override;
  RasterSource(const RasterSource&) = delete;
  RasterSource& operator=(const RasterSource&) = delete;

  [[nodiscard]] const RasterInfo& info() const;
  [[nodiscard]] const RasterDescription& description() const;

  [[nodiscard]] bool overlaps(const Tiling& tiling, const TileIndex& index) const override;
  [[nodiscard]] bool hasDataFiner(const Tiling& tiling, const TileIndex& index,
                                  const TileLayout& layout) const override;
  [[nodiscard]] Result<ColourPixels> colours(const Tiling& tiling, const TileIndex& index, const TileLayout& layout,
                                             std::stop_token stop) const override;
  [[nodiscard]] Result<HeightPixels> heights(const Tiling& tiling, const TileIndex& index, const TileLayout& layout,
                                             std::stop_token stop) const override;

  [[nodiscard]] std::optional<Error> flaw() const override;
  [[nodiscard]] std::string_view attribution() const override { return info().attribution; }

  /// Pixels kept in memory. Safe from any thread; grows as the raster is sampled, freed with the source.
  [[nodiscard]] std::size_t residentBytes() const;

  /// For resampling; of no use outside this room.
  [[nodiscard]] RasterAccess& access() const { return *access_; }

 private:
  explicit RasterSource(std::unique_ptr<RasterAccess> access);
  std::unique_ptr<RasterAccess> access_;
};

}  // namespace meridian::globebrowsing

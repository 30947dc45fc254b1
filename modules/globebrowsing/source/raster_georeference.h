#pragma once

#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "globebrowsing/source/raster_source.h"

class GDALDataset;
class OGRCoordinateTransformation;

namespace meridian::globebrowsing {

/// Geographic coordinates of the raster's own body to its projected ones. Belongs to one thread at a time.
class Projection {
 public:
  explicit Projection(std::unique_ptr<OGRCoordinateTransformation> transformation);
  Projection(Projection&&) noexcept;
  ~Projection();
  [[nodiscard]] OGRCoordinateTransformation& transformation() const { return *transformation_; }
  [[nodiscard]] Projection clone() const;

 private:
  std::unique_ptr<OGRCoordinateTransformation> transformation_;
};

/// Pixels on a map: the outer corner of the first, their size, and how many. Units of the CRS, easting or longitude
/// first.
struct PixelGrid {
  double left = 0.0;
  double top = 0.0;
  double pixelWidth = 0.0;
  double pixelHeight = 0.0;
  int width = 0;
  int height = 0;
};

/// How far a CRS reaches, in its units.
struct CrsReach {
  double turn = 0.0;    ///< a whole turn of longitude; 0 where columns are no meridians
  double middle = 0.0;  ///< easting of longitude 0
  double south = -std::numeric_limits<double>::infinity();  ///< of the poles
  double north = std::numeric_limits<double>::infinity();
};
/// `crs`: what PROJ understands; empty: degrees. Errors: it does not.
[[nodiscard]] Result<CrsReach> reachOf(const std::string& crs, const std::string& where);

/// Where a raster lies on its globe: longitude and latitude in radians to pixel coordinates (columns from the left
/// edge, rows from the top edge, of full resolution; a pixel's centre is at its number + 0.5).
class RasterGeoreference {
 public:
  [[nodiscard]] static Result<RasterGeoreference> of(GDALDataset& dataset, const RasterDescription& description);

  /// The same for a grid that is no dataset. Spherical Mercator (EPSG:3857) is known by its formula, so that its rows
  /// are parallels and its columns meridians. Errors: as of(dataset).
  [[nodiscard]] static Result<RasterGeoreference> of(const std::string& crs, const PixelGrid& grid,
                                                     const std::string& where);

  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }
  /// Rows are parallels and columns meridians.
  [[nodiscard]] bool isGeographic() const { return isGeographic_; }
  /// Columns of one turn of longitude where the raster holds one, else 0.
  [[nodiscard]] int columnsOfTurn() const { return columnsOfTurn_; }
  /// The first of them: rasters may hold more than one turn.
  [[nodiscard]] int firstColumn() const { return firstColumn_; }

  /// Geographic rasters only. Outside the raster the answer is outside 0..width, 0..height.
  [[nodiscard]] double column(double longitude) const;
  [[nodiscard]] double row(double latitude) const {
    return ((isMercator_ ? std::asinh(std::tan(latitude)) : latitude) - topLatitude_) / rowStep_;
  }
  /// Of a row coordinate; not for Mercator. Beyond a pole it goes on growing.
  [[nodiscard]] double latitude(double row) const { return topLatitude_ + row * rowStep_; }
  /// Rows grow towards the poles with 1 / cos(latitude), so that pixels are square everywhere.
  [[nodiscard]] bool isMercator() const { return isMercator_; }

  /// Turns longitudes into columns and latitudes into rows, in place; not-a-number where there is no such place.
  /// `projection` is a clone of this one's, or null when there is none.
  void toPixels(const Projection* projection, std::span<double> longitudes, std::span<double> latitudes) const;
  [[nodiscard]] const Projection* projection() const { return projection_.get(); }

  /// Extent and pixel sizes, as in RasterInfo.
  [[nodiscard]] double west() const { return west_; }
  [[nodiscard]] double south() const { return south_; }
  [[nodiscard]] double east() const { return east_; }
  [[nodiscard]] double north() const { return north_; }
  [[nodiscard]] bool coversAllLongitudes() const { return coversAllLongitudes_; }
  [[nodiscard]] double finestPixelAngle() const { return finestPixelAngle_; }
  /// Of a pixel's width and height at the raster's middle (geographic: along the equator and a meridian).
  [[nodiscard]] double pixelWidthAngle() const { return pixelWidthAngle_; }
  [[nodiscard]] double pixelHeightAngle() const { return pixelHeightAngle_; }
  /// The geometric mean of a pixel's sides at that place of a raster that is not geographic; smooth, within some
  /// percent.
  [[nodiscard]] double pixelAngleAt(double column, double row) const;

 private:
  RasterGeoreference() = default;
  void setGeographic(const std::array<double, 6>& degreesFromPixel);
  [[nodiscard]] Result<void> setProjected(const std::array<double, 6>& crsFromPixel, const std::string& where);
  [[nodiscard]] Result<void> measure(const std::string& where);

  int width_ = 0;
  int height_ = 0;
  bool isGeographic_ = false;
  int columnsOfTurn_ = 0;
  int firstColumn_ = 0;
  double leftLongitude_ = 0.0;  ///< of column coordinate 0
  double columnStep_ = 0.0;     ///< radians a column; negative where longitude runs westward
  bool isMercator_ = false;     ///< then "latitudes" of rows are isometric ones
  double topLatitude_ = 0.0;    ///< of row coordinate 0
  double rowStep_ = 0.0;        ///< radians a row; negative where the first row is in the north

  std::shared_ptr<const Projection> projection_;
  std::array<double, 6> crsFromPixel_{};
  std::array<double, 6> pixelFromCrs_{};
  double crsUnit_ = 1.0;        ///< radians in a unit of the geographic coordinates
  double primeMeridian_ = 0.0;  ///< radians
  double eastward_ = 1.0;       ///< -1 where the CRS counts longitude westward

  double west_ = 0.0;
  double south_ = 0.0;
  double east_ = 0.0;
  double north_ = 0.0;
  bool coversAllLongitudes_ = false;
  double finestPixelAngle_ = 0.0;
  double pixelWidthAngle_ = 0.0;
  double pixelHeightAngle_ = 0.0;
  std::vector<double> pixelAngles_;  ///< of measure()'s cells
};

}  // namespace meridian::globebrowsing

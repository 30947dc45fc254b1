#include "globebrowsing/source/raster_georeference.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include <gdal_priv.h>
#include <ogr_spatialref.h>

#include "globebrowsing/source/gdal_runtime.h"
#include "globebrowsing/source/raster_crs.h"

namespace meridian::globebrowsing {

namespace {

constexpr double pi = std::numbers::pi;
constexpr double turn = 2.0 * pi;
constexpr double degree = pi / 180.0;
constexpr int cells = 32;  // a side, of the grid that measures a projected raster; bounds the error of curved edges

/// In -pi..pi, pi excluded, so that both names of the antimeridian are one.
double canonical(double longitude) {
  const double turned = longitude - turn * std::floor((longitude + pi) / turn);
  return turned >= pi ? turned - turn : turned;
}

double greatCircle(double longitudeA, double latitudeA, double longitudeB, double latitudeB) {
  const double dLatitude = std::sin((latitudeB - latitudeA) / 2);
  const double dLongitude = std::sin((longitudeB - longitudeA) / 2);
  const double h = dLatitude * dLatitude + std::cos(latitudeA) * std::cos(latitudeB) * dLongitude * dLongitude;
  return 2 * std::asin(std::sqrt(std::min(1.0, h)));
}

struct Georeference {
  Affine affine{};
  bool isGlobal = false;  ///< no georeference at all
  const OGRSpatialReference* crs = nullptr;
};

Result<Georeference> readGeoreference(GDALDataset& dataset, const std::string& where) {
  Georeference found;
  found.crs = dataset.GetSpatialRef();
  if (dataset.GetGeoTransform(found.affine.data()) == CE_None) {
    return found;
  }
  if (dataset.GetGCPCount() > 0) {
    found.crs = dataset.GetGCPSpatialRef();
    if (GDALGCPsToGeoTransform(dataset.GetGCPCount(), dataset.GetGCPs(), found.affine.data(), FALSE) == FALSE) {
      return failure("the raster is placed by control points that no affine transform fits", where,
                     "bring it onto a map projection with gdalwarp");
    }
    return found;
  }
  found.isGlobal = true;
  return found;
}

}  // namespace

Result<CrsReach> reachOf(const std::string& text, const std::string& where) {
  Affine degrees{0, 1, 0, 0, 0, 1};
  const auto crs =
      parseCrs(text, where).and_then([&](const OGRSpatialReference& found) { return readCrs(&found, degrees, where); });
  if (!crs) {
    return tl::make_unexpected(crs.error());
  }
  if (crs->mercatorRadius > 0.0) {
    return CrsReach{turn * crs->mercatorRadius};
  }
  if (!crs->isGeographic || degrees[2] != 0.0 || degrees[4] != 0.0) {
    return CrsReach{};
  }
  return CrsReach{360.0 / std::abs(degrees[1]), -degrees[0] / degrees[1], (-90.0 - degrees[3]) / degrees[5],
                  (90.0 - degrees[3]) / degrees[5]};
}

Projection::Projection(std::unique_ptr<OGRCoordinateTransformation> transformation)
    : transformation_(std::move(transformation)) {}
Projection::Projection(Projection&&) noexcept = default;
Projection::~Projection() = default;

Projection Projection::clone() const {
  return Projection(std::unique_ptr<OGRCoordinateTransformation>(transformation_->Clone()));
}

Result<RasterGeoreference> RasterGeoreference::of(GDALDataset& dataset, const RasterDescription& description) {
  const std::string& where = description.where.empty() ? description.path : description.where;
  RasterGeoreference result;
  result.width_ = dataset.GetRasterXSize();
  result.height_ = dataset.GetRasterYSize();
  GdalMessages messages;
  auto found = readGeoreference(dataset, where);
  if (!found) {
    return tl::make_unexpected(found.error());
  }
  std::array<double, 4> extent{-180.0, -90.0, 180.0, 90.0};
  if (description.extentDegrees) {
    extent = *description.extentDegrees;
  }
  if (description.extentDegrees || description.assumeGlobal || found->isGlobal) {
    const auto& [west, south, east, north] = extent;
    if (!(east > west) || !(north > south) || !std::isfinite(east - west) || !std::isfinite(north - south)) {
      return failure("the extent is empty", where, "give west, south, east, north in degrees, east greater than west");
    }
    result.setGeographic({west, (east - west) / result.width_, 0, north, 0, (south - north) / result.height_});
    if (auto measured = result.measure(where); !measured) {
      return tl::make_unexpected(measured.error());
    }
    return result;
  }
  auto crs = readCrs(found->crs, found->affine, where);
  if (!crs) {
    return tl::make_unexpected(crs.error());
  }
  result.projection_ = crs->projection;
  result.crsUnit_ = crs->unit;
  result.primeMeridian_ = crs->primeMeridian;
  result.eastward_ = crs->eastward;
  const Affine& affine = found->affine;
  if (crs->isGeographic && affine[2] == 0.0 && affine[4] == 0.0 && affine[1] != 0.0 && affine[5] != 0.0) {
    result.setGeographic(affine);
  } else if (auto set = result.setProjected(affine, where); !set) {
    return tl::make_unexpected(set.error());
  }
  if (auto measured = result.measure(where); !measured) {
    return tl::make_unexpected(measured.error());
  }
  return result;
}

Result<RasterGeoreference> RasterGeoreference::of(const std::string& text, const PixelGrid& grid,
                                                  const std::string& where) {
  RasterGeoreference result;
  result.width_ = grid.width;
  result.height_ = grid.height;
  Affine affine{grid.left, grid.pixelWidth, 0, grid.top, 0, -grid.pixelHeight};
  const auto crs =
      parseCrs(text, where).and_then([&](const OGRSpatialReference& found) { return readCrs(&found, affine, where); });
  if (!crs) {
    return tl::make_unexpected(crs.error());
  }
  if (crs->mercatorRadius > 0.0) {
    result.isMercator_ = true;
    for (double& value : affine) {
      value /= crs->mercatorRadius * degree;
    }
  } else if (!crs->isGeographic) {
    result.projection_ = crs->projection;
    result.crsUnit_ = crs->unit;
    result.primeMeridian_ = crs->primeMeridian;
    result.eastward_ = crs->eastward;
    if (auto set = result.setProjected(affine, where); !set) {
      return tl::make_unexpected(set.error());
    }
  }
  if (!result.projection_) {
    result.setGeographic(affine);
  }
  return result.measure(where).map([&result] { return std::move(result); });
}

void RasterGeoreference::setGeographic(const std::array<double, 6>& degreesFromPixel) {
  isGeographic_ = true;
  double stepDegrees = degreesFromPixel[1];
  double leftDegrees = degreesFromPixel[0];
  const double columns = 360.0 / std::abs(stepDegrees);
  const double whole = std::round(columns);
  // One column's drift over the whole turn is rounding in the file, not its meaning (etopo5.cdf: 0.04).
  if (width_ >= columns - 0.5 && std::abs(columns - whole) < 0.5 && whole >= 1.0) {
    const double snapped = std::copysign(360.0 / whole, stepDegrees);
    leftDegrees += (stepDegrees - snapped) / 2;  // the first column's centre stays
    stepDegrees = snapped;
    columnsOfTurn_ = std::min(static_cast<int>(whole), width_);
    if (width_ > columnsOfTurn_) {
      const double toAntimeridian = std::round((std::copysign(180.0, -stepDegrees) - leftDegrees) / stepDegrees);
      if (toAntimeridian > 0 && toAntimeridian + columnsOfTurn_ <= width_) {
        firstColumn_ = static_cast<int>(toAntimeridian);
      }
    }
  }
  leftLongitude_ = leftDegrees * degree;
  columnStep_ = stepDegrees * degree;
  topLatitude_ = degreesFromPixel[3] * degree;
  rowStep_ = degreesFromPixel[5] * degree;
}

double RasterGeoreference::column(double longitude) const {
  double east = canonical(longitude) - leftLongitude_ - firstColumn_ * columnStep_;
  if (columnStep_ < 0) {
    east = -east;
  }
  east -= turn * std::floor(east / turn);
  const double step = std::abs(columnStep_);
  if (columnsOfTurn_ == 0 && east > (width_ * step + turn) / 2) {
    east -= turn;  // nearer to the left edge than to the right one
  }
  return firstColumn_ + east / step;
}

Result<void> RasterGeoreference::setProjected(const std::array<double, 6>& crsFromPixel, const std::string& where) {
  crsFromPixel_ = crsFromPixel;
  if (!std::all_of(crsFromPixel.begin(), crsFromPixel.end(), [](double v) { return std::isfinite(v); }) ||
      GDALInvGeoTransform(crsFromPixel_.data(), pixelFromCrs_.data()) == 0) {
    return failure("the raster's geotransform cannot be inverted", where, "correct it, for example with gdal_edit.py");
  }
  return {};
}

void RasterGeoreference::toPixels(const Projection* projection, std::span<double> longitudes,
                                  std::span<double> latitudes) const {
  if (isGeographic_) {
    for (std::size_t i = 0; i < longitudes.size(); ++i) {
      longitudes[i] = column(longitudes[i]);
      latitudes[i] = row(latitudes[i]);
    }
    return;
  }
  if (projection != nullptr) {
    for (std::size_t i = 0; i < longitudes.size(); ++i) {
      longitudes[i] = canonical(eastward_ * (longitudes[i] - primeMeridian_)) / crsUnit_;
      latitudes[i] /= crsUnit_;
    }
    GdalMessages messages;
    std::vector<int> good(longitudes.size(), 0);
    projection->transformation().Transform(static_cast<int>(longitudes.size()), longitudes.data(), latitudes.data(),
                                           nullptr, good.data());
    for (std::size_t i = 0; i < longitudes.size(); ++i) {
      if (good[i] == 0) {
        longitudes[i] = latitudes[i] = std::numeric_limits<double>::quiet_NaN();
      }
    }
  } else {
    // A rotated raster in degrees: the name of a longitude nearest the raster's middle.
    const double middle = (crsFromPixel_[0] + crsFromPixel_[1] * width_ / 2 + crsFromPixel_[2] * height_ / 2) * degree;
    for (std::size_t i = 0; i < longitudes.size(); ++i) {
      longitudes[i] = (middle + canonical(longitudes[i] - middle)) / degree;
      latitudes[i] /= degree;
    }
  }
  for (std::size_t i = 0; i < longitudes.size(); ++i) {
    const double x = longitudes[i];
    const double y = latitudes[i];
    longitudes[i] = pixelFromCrs_[0] + pixelFromCrs_[1] * x + pixelFromCrs_[2] * y;
    latitudes[i] = pixelFromCrs_[3] + pixelFromCrs_[4] * x + pixelFromCrs_[5] * y;
  }
}

double RasterGeoreference::pixelAngleAt(double column, double row) const {
  const auto cell = [](double place, int size) { return std::clamp(place / size * cells - 0.5, 0.0, cells - 1.0); };
  const double x = cell(column, width_);
  const double y = cell(row, height_);
  const int left = std::min(static_cast<int>(x), cells - 2);
  const int top = std::min(static_cast<int>(y), cells - 2);
  const auto at = [this](int c, int r) {
    return pixelAngles_[static_cast<std::size_t>(r) * cells + static_cast<std::size_t>(c)];
  };
  return std::lerp(std::lerp(at(left, top), at(left + 1, top), x - left),
                   std::lerp(at(left, top + 1), at(left + 1, top + 1), x - left), y - top);
}

Result<void> RasterGeoreference::measure(const std::string& where) {
  const auto outside = [&where] {
    return failure("the raster lies outside the globe", where,
                   "give it a CRS, or its extent in degrees, or say that it is global");
  };
  if (isGeographic_) {
    const double right = leftLongitude_ + columnStep_ * width_;
    const double bottom = topLatitude_ + rowStep_ * height_;
    const auto latitude = [this](double row) { return isMercator_ ? std::atan(std::sinh(row)) : row; };
    south_ = std::max(latitude(std::min(topLatitude_, bottom)), -pi / 2);
    north_ = std::min(latitude(std::max(topLatitude_, bottom)), pi / 2);
    coversAllLongitudes_ = columnsOfTurn_ > 0;
    west_ = coversAllLongitudes_ ? -pi : canonical(std::min(leftLongitude_, right));
    east_ = coversAllLongitudes_ ? pi : west_ + std::min(std::abs(right - leftLongitude_), turn);
    pixelWidthAngle_ = std::abs(columnStep_);
    pixelHeightAngle_ = std::abs(rowStep_);
    finestPixelAngle_ = std::min(pixelWidthAngle_, pixelHeightAngle_);
    if (isMercator_) {
      finestPixelAngle_ *= std::min(std::cos(south_), std::cos(north_));
    }
    if (!std::isfinite(leftLongitude_ + right + topLatitude_ + bottom) || !(north_ > south_) ||
        !(finestPixelAngle_ > 0.0) || std::abs(leftLongitude_) > 10 * turn) {
      return outside();
    }
    return {};
  }
  // A grid over the raster, brought to longitude and latitude.
  constexpr int points = cells + 1;
  std::vector<double> x(std::size_t{points} * points);
  std::vector<double> y(std::size_t{points} * points);
  for (int r = 0; r < points; ++r) {
    for (int c = 0; c < points; ++c) {
      const double column = static_cast<double>(width_) * c / cells;
      const double row = static_cast<double>(height_) * r / cells;
      const auto i = static_cast<std::size_t>(r) * points + static_cast<std::size_t>(c);
      x[i] = crsFromPixel_[0] + crsFromPixel_[1] * column + crsFromPixel_[2] * row;
      y[i] = crsFromPixel_[3] + crsFromPixel_[4] * column + crsFromPixel_[5] * row;
    }
  }
  std::vector<int> good(x.size(), 1);
  if (projection_) {
    GdalMessages messages;
    const std::unique_ptr<OGRCoordinateTransformation> inverse(projection_->transformation().GetInverse());
    if (!inverse) {
      return messages.failure("PROJ rejects the raster's CRS", where, "correct the CRS, for example with gdal_edit.py");
    }
    inverse->Transform(static_cast<int>(x.size()), x.data(), y.data(), nullptr, good.data());
    for (std::size_t i = 0; i < x.size(); ++i) {
      x[i] = eastward_ * x[i] * crsUnit_ + primeMeridian_;
      y[i] *= crsUnit_;
      good[i] = good[i] != 0 && std::isfinite(x[i]) && std::isfinite(y[i]) ? 1 : 0;
    }
    if (std::none_of(good.begin(), good.end(), [](int g) { return g != 0; })) {
      return messages.failure("PROJ cannot bring any of the raster's pixels to latitude and longitude", where,
                              "correct the CRS, for example with gdal_edit.py");
    }
  } else {
    for (std::size_t i = 0; i < x.size(); ++i) {
      x[i] *= degree;
      y[i] *= degree;
      good[i] = std::abs(y[i]) <= pi / 2 && std::abs(x[i]) <= 10 * turn ? 1 : 0;
    }
    if (std::none_of(good.begin(), good.end(), [](int g) { return g != 0; })) {
      return outside();
    }
  }
  // Longitudes are made continuous along the walk, so that an extent may cross the antimeridian.
  south_ = pi / 2;
  north_ = -pi / 2;
  double westmost = std::numeric_limits<double>::max();
  double eastmost = std::numeric_limits<double>::lowest();
  double previous = std::numeric_limits<double>::quiet_NaN();
  finestPixelAngle_ = std::numeric_limits<double>::max();
  pixelAngles_.assign(std::size_t{cells} * cells, 0.0);
  const auto at = [](int r, int c) { return static_cast<std::size_t>(r) * points + static_cast<std::size_t>(c); };
  const auto side = [&](std::size_t a, std::size_t b, double pixels) {
    return good[a] != 0 && good[b] != 0 ? greatCircle(x[a], y[a], x[b], y[b]) / pixels : 0.0;
  };
  for (int r = 0; r < points; ++r) {
    for (int step = 0; step < points; ++step) {
      const int c = r % 2 == 0 ? step : cells - step;
      const std::size_t i = at(r, c);
      if (good[i] == 0) {
        continue;
      }
      const double unwrapped = std::isnan(previous) ? canonical(x[i]) : previous + canonical(x[i] - previous);
      previous = unwrapped;
      westmost = std::min(westmost, unwrapped);
      eastmost = std::max(eastmost, unwrapped);
      south_ = std::min(south_, y[i]);
      north_ = std::max(north_, y[i]);
      const double wide = c < cells ? side(i, at(r, c + 1), width_ / double{cells}) : 0.0;
      const double high = r < cells ? side(i, at(r + 1, c), height_ / double{cells}) : 0.0;
      if (c < cells && r < cells) {
        pixelAngles_[static_cast<std::size_t>(r) * cells + static_cast<std::size_t>(c)] = std::sqrt(wide * high);
      }
      for (const double angle : {wide, high}) {
        if (angle > 0.0) {
          finestPixelAngle_ = std::min(finestPixelAngle_, angle);
        }
      }
      if (wide > 0.0 && (pixelWidthAngle_ == 0.0 || (r == cells / 2 && c == cells / 2))) {
        pixelWidthAngle_ = wide;
      }
      if (high > 0.0 && (pixelHeightAngle_ == 0.0 || (r == cells / 2 && c == cells / 2))) {
        pixelHeightAngle_ = high;
      }
    }
  }
  if (pixelWidthAngle_ == 0.0 || pixelHeightAngle_ == 0.0) {
    return outside();
  }
  for (double& angle : pixelAngles_) {
    angle = angle > 0.0 ? angle : std::sqrt(pixelWidthAngle_ * pixelHeightAngle_);
  }
  const double margin = std::max(eastmost - westmost, north_ - south_) / (cells * cells);
  south_ = std::max(south_ - margin, -pi / 2);
  north_ = std::min(north_ + margin, pi / 2);
  coversAllLongitudes_ = eastmost - westmost + 2 * margin >= turn;
  for (const double pole : {-pi / 2, pi / 2}) {
    double column = 0.0;
    double row = pole;
    toPixels(projection_.get(), {&column, 1}, {&row, 1});
    if (projection_ && column >= -0.5 && column <= width_ + 0.5 && row >= -0.5 && row <= height_ + 0.5) {
      coversAllLongitudes_ = true;
      (pole < 0 ? south_ : north_) = pole;
    }
  }
  west_ = coversAllLongitudes_ ? -pi : canonical(westmost - margin);
  east_ = coversAllLongitudes_ ? pi : west_ + std::min(eastmost - westmost + 2 * margin, turn);
  return {};
}

}  // namespace meridian::globebrowsing

#pragma once

#include <cstddef>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "globebrowsing/source/gdal_network.h"
#include "globebrowsing/source/pyramid.h"
#include "globebrowsing/source/raster_levels.h"

namespace meridian::globebrowsing {

/// A dataset and a projection that belong to one thread at a time.
class RasterHandle {
 public:
  RasterHandle(GDALDataset* dataset, const Projection* projection);
  ~RasterHandle();
  RasterHandle(const RasterHandle&) = delete;
  RasterHandle& operator=(const RasterHandle&) = delete;
  [[nodiscard]] GDALDataset& dataset() const { return *dataset_; }
  /// Null when the raster is in geographic coordinates.
  [[nodiscard]] const Projection* projection() const { return projection_.get(); }
  /// After a failure: a decoder that has said once that its data end gives anything for the rest. It is not used again.
  void spoil() { isSpoiled_ = true; }
  [[nodiscard]] bool isSpoiled() const { return isSpoiled_; }

 private:
  bool isSpoiled_ = false;
  GDALDataset* dataset_;
  std::unique_ptr<Projection> projection_;
};

/// What resampling needs of a raster: its pixels at any level, from memory where they are kept. Safe from any thread.
class RasterAccess {
 public:
  /// `dataset` is open and becomes the first of the pool.
  RasterAccess(RasterDescription description, GdalReach reach, GDALDataset* dataset, RasterGeoreference georeference);
  [[nodiscard]] Result<void> examine();  ///< fills info; call once, before anything else
  ~RasterAccess();

  [[nodiscard]] const RasterDescription& description() const { return description_; }
  [[nodiscard]] const RasterInfo& info() const { return info_; }
  [[nodiscard]] const Pyramid& pyramid() const { return pyramid_; }

  /// With a dataset that goes back to the pool when the reader is destroyed, which must be before the access is.
  [[nodiscard]] Result<std::unique_ptr<PixelReader>> reader() const;

  [[nodiscard]] std::optional<Error> flaw() const;

  /// Bytes of pixels kept in memory.
  [[nodiscard]] std::size_t residentBytes() const;

 private:
  template <class Pixel>
  struct Resident;
  template <class Pixel>
  struct Store;
  class Reader;

  [[nodiscard]] const ColourRule& rule(const Rgba*) const { return colourRule_; }
  [[nodiscard]] const HeightRule& rule(const float*) const { return heightRule_; }
  [[nodiscard]] Store<Rgba>& store(const Rgba*) const { return *colours_; }
  [[nodiscard]] Store<float>& store(const float*) const { return *heights_; }
  /// The borrowed handle goes back to the pool when the pointer is destroyed.
  [[nodiscard]] Result<std::shared_ptr<RasterHandle>> borrow() const;
  [[nodiscard]] Result<void> prepareColours(GDALDataset& dataset) const;
  void keepFlaw(const ReadNotes& notes) const;
  /// Whether the file is there to its end, where its header tells.
  void checkLength() const;
  [[nodiscard]] bool isKept(std::size_t level, std::size_t pixelBytes) const;

  template <class Pixel>
  Result<void> fetchUnbounded(RasterHandle& handle, std::size_t level, const UnboundedWindow& window, Pixel* out,
                              const std::stop_token& stop) const;
  /// Within the level; rows of `stride` pixels.
  template <class Pixel>
  Result<void> read(RasterHandle& handle, std::size_t level, const PixelWindow& window, Pixel* out,
                    std::ptrdiff_t stride, const std::stop_token& stop) const;
  template <class Pixel>
  Result<void> readStrips(RasterHandle& handle, const RasterLevel& level, const PixelWindow& window, Pixel* out,
                          std::ptrdiff_t stride, const std::stop_token& stop) const;
  template <class Pixel>
  Result<const Pixel*> resident(RasterHandle& handle, std::size_t level, const std::stop_token& stop) const;

  RasterDescription description_;
  GdalReach reach_;
  Pyramid pyramid_;
  RasterInfo info_;
  std::vector<RasterLevel> levels_;  ///< of the pyramid's, where they come from
  HeightRule heightRule_;
  mutable std::mutex flawMutex_;
  mutable std::optional<Error> flaw_;
  mutable std::mutex colourRuleMutex_;
  mutable bool hasColourRule_ = false;
  mutable ColourRule colourRule_;

  struct Pool;
  std::shared_ptr<Pool> pool_;
  mutable std::unique_ptr<Store<Rgba>> colours_;
  mutable std::unique_ptr<Store<float>> heights_;
};

}  // namespace meridian::globebrowsing

#pragma once

#include <memory>
#include <string>

#include "globebrowsing/providers/provider_registry.h"
#include "globebrowsing/providers/service_opening.h"
#include "globebrowsing/source/raster_source.h"
#include "globebrowsing/source/source_tile_store.h"

namespace meridian::globebrowsing {

/// What the `FilePath` of an asset means.
struct DataPath {
  enum class Kind {
    File,       ///< of the file system; `text` is absolute when the folder is
    Document,   ///< the text of a VRT or GDAL_WMS document
    Connection  ///< any other name that GDAL knows: WMS:..., NETCDF:"...":v, /vsicurl/...
  };
  Kind kind = Kind::File;
  std::string text;
};
[[nodiscard]] DataPath dataPath(const std::string& filePath, const std::string& folder);
/// Of a File: that it is there and no directory. Nothing can be said of the others.
[[nodiscard]] Result<void> checkData(const DataPath& path, const std::string& where);

/// Any georeferenced raster, cut into tiles, or the tiles of a map service: DefaultTileProvider.
class DefaultTileProvider final : public TileProvider {
 public:
  /// FilePath, and ours: ExtentDegrees, HeightScale, HeightOffset, HeightDatum, Tiles.
  [[nodiscard]] static const Schema& schema();
  [[nodiscard]] static Result<std::shared_ptr<TileProvider>> make(const ProviderRequest& request);
  /// Of a map service, whatever FilePath says; the request has source tiles.
  [[nodiscard]] static Result<std::shared_ptr<TileProvider>> make(const ProviderRequest& request,
                                                                  std::unique_ptr<ServiceOpening> opening);

  /// Without source tiles, map services are left to GDAL.
  DefaultTileProvider(DataPath path, RasterDescription description, TileSettings tiles, const ProviderRequest& request);

  [[nodiscard]] Result<void> check() const override;
  [[nodiscard]] std::optional<Error> lastFailure() const override;
  [[nodiscard]] std::optional<Error> flaw() const override {
    return state() == State::Ready ? source_->flaw() : std::nullopt;
  }
  [[nodiscard]] std::string_view attribution() const override {
    return state() == State::Ready ? source_->attribution() : std::string_view();
  }
  [[nodiscard]] const RasterDescription& description() const { return description_; }

 private:
  [[nodiscard]] bool prepareData(const std::function<void()>& wake) override;
  [[nodiscard]] Result<void> openData() override;
  /// A map service's source where the data are one, else a raster's.
  [[nodiscard]] Result<std::shared_ptr<PixelSource>> openSource();
  void tellNotes() const;
  [[nodiscard]] static Result<std::shared_ptr<DefaultTileProvider>> makeUnopened(const ProviderRequest& request);
  [[nodiscard]] Result<ColourPixels> makeColours(const Tiling& tiling, const TileIndex& index,
                                                 std::stop_token stop) const override;
  [[nodiscard]] Result<HeightPixels> makeHeights(const Tiling& tiling, const TileIndex& index, const TileLayout& layout,
                                                 std::stop_token stop) const override;
  [[nodiscard]] std::unique_ptr<ColourTask> makeColourTask(const Tiling& tiling, const TileIndex& index) const override;
  [[nodiscard]] std::unique_ptr<HeightTask> makeHeightTask(const Tiling& tiling, const TileIndex& index,
                                                           const TileLayout& layout) const override;
  [[nodiscard]] bool dataOverlap(const Tiling& tiling, const TileIndex& index) const override;
  [[nodiscard]] bool dataFiner(const Tiling& tiling, const TileIndex& index, const TileLayout& layout) const override;

  DataPath path_;
  RasterDescription description_;
  TileSettings tiles_;
  std::string whereTiles_;  ///< of the key, for errors
  std::shared_ptr<SourceTileStore> sourceTiles_;
  std::shared_ptr<SeriesShare> share_;
  std::unique_ptr<ServiceOpening> opening_;  ///< null where the data are no map service's
  std::shared_ptr<PixelSource> source_;
};

}  // namespace meridian::globebrowsing

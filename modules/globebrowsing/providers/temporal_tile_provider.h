#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "globebrowsing/providers/colormap.h"
#include "globebrowsing/providers/provider_registry.h"
#include "globebrowsing/providers/service_opening.h"
#include "globebrowsing/providers/tile_steps.h"
#include "globebrowsing/providers/time_series.h"
#include "host/api/property.h"
#include "host/api/property_owner.h"

namespace meridian::globebrowsing {

/// Another raster for each time: TemporalTileProvider. Its rasters are named by a prototype, by the files of a folder,
/// by the XML of older assets, or by the times of a map service's layer; all have the keys of the layer's table.
class TemporalTileProvider final : public SteppedTileProvider {
 public:
  [[nodiscard]] static const Schema& schema();
  [[nodiscard]] static Result<std::shared_ptr<TileProvider>> make(const ProviderRequest& request);

  /// Without a series it is what the table's FilePath names, an XML file or capabilities, and read when opened.
  TemporalTileProvider(ProviderRequest request, std::unique_ptr<TimeSeries> series);

  [[nodiscard]] Result<void> check() const override;
  [[nodiscard]] std::optional<Error> lastFailure() const override {
    return state() == State::Opening && opening_ != nullptr ? opening_->lastFailure() : std::nullopt;
  }
  [[nodiscard]] PropertyOwner* properties() override { return &owner_; }
  [[nodiscard]] TileStep at(const Time& now) const override;
  [[nodiscard]] Result<std::shared_ptr<TileProvider>> make(const Time& now) const override;
  [[nodiscard]] bool interpolates() const override { return interpolation.get() && !isFixed(); }

  BoolProperty useFixedTime{{"UseFixedTime", "Use fixed time", "Whether FixedTime is shown whatever the time"}, false};
  StringProperty fixedTime{{"FixedTime", "Fixed time", "The date to show; empty: the scene's time"}};
  BoolProperty interpolation{
      {"Interpolation", "Interpolation", "Whether the picture between two steps is a mixture of both, by the time"},
      false};

 private:
  [[nodiscard]] bool prepareData(const std::function<void()>& wake) override;
  [[nodiscard]] Result<void> openData() override;
  [[nodiscard]] Result<std::unique_ptr<TimeSeries>> openSeries();
  [[nodiscard]] Result<void> checkSeries() const;
  /// Empty where there is none.
  [[nodiscard]] std::string colormapPath() const;
  [[nodiscard]] bool isFixed() const { return useFixedTime.get() && fixed_; }
  [[nodiscard]] TimeSeries::Entry entryAt(const Time& now) const;
  Result<void> readFixedTime();

  const ProviderRequest request_;
  const bool isNamed_;                        ///< the series is in what FilePath names
  std::unique_ptr<ServiceOpening> opening_;   ///< null where there is no network
  ProviderRequest rasters_;                   ///< what each of them is made from; final once open
  std::unique_ptr<TimeSeries> series_;        ///< likewise
  std::shared_ptr<const Colormap> colormap_;  ///< likewise; null without the key
  std::optional<Time::UtcInstant> fixed_;     ///< FixedTime, where it is a date
  PropertyOwner owner_{"TileProvider", "Tile provider", "Which time is shown"};
};

}  // namespace meridian::globebrowsing

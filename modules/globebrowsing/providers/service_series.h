#pragma once

#include <memory>
#include <optional>

#include "globebrowsing/providers/capabilities_document.h"
#include "globebrowsing/providers/time_series.h"
#include "globebrowsing/source/service_description.h"
#include "globebrowsing/source/time_dimension.h"

namespace meridian::globebrowsing {

/// The times of a layer of a map service, as its capabilities list them. Shown is what the service itself would take
/// for the scene's time:
/// - where it takes the nearest value (nearestValue = 1), that;
/// - else the latest that is not later. Before the first value, and after the last for longer than that differs from
///   the one before it, the service's default where it names one, and else the first or last.
/// A layer without times is one step.
class ServiceSeries final : public TimeSeries {
 public:
  /// Errors: no such layer, or one that cannot be shown; the document's own. "present" and "current" are now.
  [[nodiscard]] static Result<std::unique_ptr<TimeSeries>> make(CapabilitiesReference reference,
                                                                std::shared_ptr<CapabilitiesDocument> document);

  [[nodiscard]] Result<void> check() const override { return {}; }
  [[nodiscard]] Entry at(Instant now) const override;
  [[nodiscard]] Entry atFixed(Instant fixed) const override { return at(fixed); }
  [[nodiscard]] Result<std::shared_ptr<TileProvider>> tiles(Instant entry,
                                                            const ProviderRequest& rasters) const override;
  [[nodiscard]] const TimeDimension& times() const { return times_; }
  /// What is asked for at an entry; empty: the service's default.
  [[nodiscard]] std::string valueOf(Instant entry) const;

 private:
  ServiceSeries(CapabilitiesReference reference, std::shared_ptr<CapabilitiesDocument> document)
      : reference_(std::move(reference)), document_(std::move(document)) {}
  void setTimes(const LayerDimension& dimension);
  [[nodiscard]] Entry nearestAt(CalendarMilliseconds at) const;

  CapabilitiesReference reference_;
  std::shared_ptr<CapabilitiesDocument> document_;
  TimeDimension times_;
  bool isNearest_ = false;
  CalendarMilliseconds first_ = 0;
  CalendarMilliseconds end_ = 0;  ///< of the last value
};

}  // namespace meridian::globebrowsing

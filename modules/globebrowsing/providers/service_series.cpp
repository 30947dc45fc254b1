#include "globebrowsing/providers/service_series.h"

#include <algorithm>
#include <utility>

#include "globebrowsing/providers/default_tile_provider.h"
#include "globebrowsing/providers/inner_providers.h"
#include "globebrowsing/providers/service_opening.h"
#include "host/api/log.h"

namespace meridian::globebrowsing {

namespace {

TimeSeries::Instant instantOf(CalendarMilliseconds at) {
  return TimeSeries::Instant(std::chrono::milliseconds(at));
}

/// The first that is nearer to `b` than to `a`.
CalendarMilliseconds beyondMiddle(CalendarMilliseconds a, CalendarMilliseconds b) {
  return a + (b - a) / 2 + 1;
}

}  // namespace

Result<std::unique_ptr<TimeSeries>> ServiceSeries::make(CapabilitiesReference reference,
                                                        std::shared_ptr<CapabilitiesDocument> document) {
  const Result<std::shared_ptr<const Capabilities>> capabilities = document->capabilities();
  if (!capabilities) {
    return tl::make_unexpected(capabilities.error());
  }
  const Result<const CapabilitiesLayer*> layer = layerOf(reference, **capabilities);
  if (!layer) {
    return tl::make_unexpected(layer.error());
  }
  // What no step can have is told now, not by each.
  if (Result<TileService> service = serviceOf(reference, **capabilities); !service) {
    return tl::make_unexpected(std::move(service.error()));
  }
  std::unique_ptr<ServiceSeries> series(new ServiceSeries(std::move(reference), std::move(document)));
  const LayerDimension* dimension = (*layer)->timeDimension();
  if (dimension != nullptr && series->reference_.choices.time.empty()) {
    series->setTimes(*dimension);
    for (const std::string& problem : series->times_.problems()) {
      log::warning("{}: the times of '{}': {}", (*capabilities)->url, (*layer)->title, problem);
    }
  }
  return series;
}

void ServiceSeries::setTimes(const LayerDimension& dimension) {
  times_ = TimeDimension::parse(dimension.values, dimension.defaultValue, Time::now());
  isNearest_ = dimension.isNearestValue;
  if (times_.isEmpty()) {
    return;
  }
  first_ = times_.first()->at;
  const CalendarMilliseconds last = times_.last()->at;
  const TimeDimension::Found before = times_.previous(last);
  end_ = last + (before ? last - before->at : 1);
}

TimeSeries::Entry ServiceSeries::at(Instant now) const {
  const CalendarMilliseconds at = now.time_since_epoch().count();
  if (times_.isEmpty()) {
    return {};
  }
  if (isNearest_) {
    return nearestAt(at);
  }
  const TimeDimension::Found otherwise = times_.defaultValue();
  if (otherwise && at < first_) {
    return {instantOf(otherwise->at), {}, instantOf(first_)};
  }
  if (otherwise && at >= end_) {
    return {instantOf(otherwise->at), instantOf(end_), {}};
  }
  const CalendarMilliseconds shown = at < first_ ? first_ : times_.atOrBefore(at)->at;
  Entry entry{instantOf(shown), {}, {}};
  if (otherwise || shown != first_) {
    entry.begin = instantOf(shown);
  }
  if (const TimeDimension::Found next = times_.next(shown); next || otherwise) {
    entry.end = instantOf(next ? next->at : end_);
  }
  return entry;
}

TimeSeries::Entry ServiceSeries::nearestAt(CalendarMilliseconds at) const {
  const CalendarMilliseconds shown = times_.nearest(at)->at;
  Entry entry{instantOf(shown), {}, {}};
  if (const TimeDimension::Found before = times_.previous(shown)) {
    entry.begin = instantOf(beyondMiddle(before->at, shown));
  }
  if (const TimeDimension::Found after = times_.next(shown)) {
    entry.end = instantOf(beyondMiddle(shown, after->at));
  }
  return entry;
}

std::string ServiceSeries::valueOf(Instant entry) const {
  const CalendarMilliseconds at = entry.time_since_epoch().count();
  const TimeDimension::Found value = times_.atOrBefore(at);
  return value && value->at == at ? times_.text(*value) : std::string();
}

Result<std::shared_ptr<TileProvider>> ServiceSeries::tiles(Instant entry, const ProviderRequest& rasters) const {
  CapabilitiesReference reference = reference_;
  if (reference.choices.time.empty()) {
    reference.choices.time = valueOf(entry);
  }
  return DefaultTileProvider::make(rasterRequest(rasters, reference_.url),
                                   std::make_unique<ServiceOpening>(std::move(reference), document_));
}

}  // namespace meridian::globebrowsing

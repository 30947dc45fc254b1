#include <chrono>
#include <filesystem>

#include <fmt/format.h>

#include "globebrowsing/providers/date_text.h"
#include "globebrowsing/providers/default_tile_provider.h"
#include "globebrowsing/providers/inner_providers.h"
#include "globebrowsing/providers/path_tokens.h"
#include "globebrowsing/providers/time_picture.h"
#include "globebrowsing/providers/time_series.h"
#include "host/api/schema.h"

namespace meridian::globebrowsing {

namespace {

constexpr std::string_view placeholder = "${OpenSpaceTimeId}";

const Schema& prototypedSchema() {
  using Type = Schema::Type;
  static const Schema fields(
      {{"Time", Type::Table, "Start and End", true},
       {"TemporalResolution", Type::String, "the distance between two steps: a number and y, M, d, h or m", true},
       {"TimeFormat", Type::String, "how the time is written: YYYY, MM, DD, DOY, HR, MN, SC and other text", true},
       {"Prototype", Type::String, "a FilePath with ${OpenSpaceTimeId} where the time stands", true}});
  return fields;
}

const Schema& timeSchema() {
  static const Schema fields({{"Start", Schema::Type::String, "a date", true},
                              {"End", Schema::Type::String, "a date, Today or Yesterday", true}});
  return fields;
}

std::string replaced(std::string text, std::string_view time) {
  for (std::size_t at = text.find(placeholder); at != std::string::npos;
       at = text.find(placeholder, at + time.size())) {
    text.replace(at, placeholder.size(), time);
  }
  return text;
}

/// An error with its key's place.
template <class T>
Result<T> placed(Result<T> result, const ProviderRequest& request, std::string_view key) {
  return std::move(result).map_error([&](Error error) {
    error.where = placeOf(request, key);
    return error;
  });
}

/// "Today" and "Yesterday" are no dates of data: the last step before them is the end.
Result<TimeQuantizer> quantizerOf(const PrototypedSeries::Description& description, const ProviderRequest& request) {
  const Result<Time::UtcInstant> start = placed(readDate(description.start), request, "Time.Start");
  const Result<TimeResolution> resolution =
      placed(TimeResolution::read(description.resolution), request, "TemporalResolution");
  if (!start || !resolution) {
    return tl::make_unexpected(start ? resolution.error() : start.error());
  }
  const bool isYesterday = description.end == "Yesterday";
  if (description.end != "Today" && !isYesterday) {
    const Result<Time::UtcInstant> end = placed(readDate(description.end), request, "Time.End");
    return end ? placed(TimeQuantizer::create(*start, *end, *resolution), request, "Time")
               : tl::make_unexpected(end.error());
  }
  const Time::UtcInstant end = Time::now().utcInstant() - std::chrono::days(isYesterday ? 1 : 0);
  return placed(TimeQuantizer::create(*start, end, *resolution), request, "Time")
      .and_then(
          [&](const TimeQuantizer& all) { return TimeQuantizer::create(*start, all.quantize(end), *resolution); });
}

}  // namespace

Result<std::unique_ptr<RasterSeries>> PrototypedSeries::make(const ProviderRequest& request) {
  const ProviderRequest own = innerRequest(request, "Prototyped", valueAt(request.table, "Prototyped"));
  if (Result<void> valid = prototypedSchema().validate(own.table, own.where, own.path); !valid) {
    return tl::make_unexpected(std::move(valid.error()));
  }
  const Value& time = valueAt(own.table, "Time");
  if (Result<void> valid = timeSchema().validate(time, own.where, own.path + ".Time"); !valid) {
    return tl::make_unexpected(std::move(valid.error()));
  }
  return make({*valueAt(time, "Start").string(), *valueAt(time, "End").string(),
               *valueAt(own.table, "TemporalResolution").string(), *valueAt(own.table, "TimeFormat").string(),
               *valueAt(own.table, "Prototype").string()},
              own);
}

Result<std::unique_ptr<RasterSeries>> PrototypedSeries::make(const Description& description,
                                                             const ProviderRequest& request) {
  const Result<TimeQuantizer> quantizer = quantizerOf(description, request);
  if (!quantizer) {
    return tl::make_unexpected(quantizer.error());
  }
  if (Result<std::string> text = placed(writeTime(description.picture, quantizer->start()), request, "TimeFormat");
      !text) {
    return tl::make_unexpected(std::move(text.error()));
  }
  if (description.prototype.find(placeholder) == std::string::npos) {
    return failure(fmt::format("the prototype has no {}", placeholder), placeOf(request, "Prototype"),
                   "put it where the time stands");
  }
  return std::unique_ptr<RasterSeries>(
      new PrototypedSeries(*quantizer, description, request.folder, placeOf(request, "Prototype")));
}

Result<void> PrototypedSeries::check() const {
  const DataPath path = dataPath(description_.prototype, folder_);
  if (path.kind != DataPath::Kind::File) {
    return checkTokens(path.text, where_);
  }
  // Not every step need exist; the folder of all of them must.
  const std::string fixed = path.text.substr(0, path.text.find(placeholder));
  const std::filesystem::path folder = std::filesystem::path(fixed).parent_path();
  std::error_code code;
  if (!std::filesystem::is_directory(folder, code)) {
    if (Result<void> checked = checkTokens(path.text, where_); !checked) {
      return checked;
    }
    return failure("the folder " + folder.string() + " does not exist", where_,
                   "check Prototype; a relative path starts at the asset's folder");
  }
  return {};
}

TimeSeries::Entry PrototypedSeries::at(Instant now) const {
  const Instant shown = quantizer_.quantize(now);
  Entry entry{shown, shown, quantizer_.following(shown)};
  if (shown == quantizer_.start()) {
    entry.begin.reset();
  } else if (!entry.end) {
    // An end that is no step of its own begins after the last step's time: just after itself.
    const Instant before = quantizer_.quantize(shown);
    entry.begin = before == shown ? shown : shown + std::chrono::milliseconds(1);
  }
  return entry;
}

Result<std::string> PrototypedSeries::filePath(Instant entry) const {
  return writeTime(description_.picture, entry).map([&](const std::string& time) {
    return replaced(description_.prototype, time);
  });
}

}  // namespace meridian::globebrowsing

#pragma once

#include <algorithm>
#include <charconv>
#include <cmath>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "host/api/error.h"
#include "host/api/time.h"
#include "host/scene/node_transforms.h"

namespace meridian::scene {

template <class Kind>
using TransformMaker = Result<std::unique_ptr<Kind>> (*)(const TransformRequest& request);

/// Deeper than any asset goes, and not so deep that the stack ends.
inline constexpr std::size_t longestTransformPath = 512;

/// The transform of a table inside the request's, at that key.
template <class Kind>
Result<std::unique_ptr<Kind>> makeInner(const TransformRequest& request, const Value& table, const std::string& key,
                                        TransformMaker<Kind> make) {
  TransformRequest inner = request;
  inner.table = table;
  inner.path += key;
  if (!table.isTable()) {
    return failure("expected the table of a transform, found " + std::string(kindName(table.kind())), inner.place({}));
  }
  if (inner.path.size() > longestTransformPath) {
    return failure("the transforms are nested too deeply", request.place({}));
  }
  return make(inner);
}

/// Those of a Multi* transform: the list at `key`, or the request's table itself if that is a list.
template <class Kind>
Result<std::vector<std::unique_ptr<Kind>>> makeParts(const TransformRequest& request, std::string_view key,
                                                     TransformMaker<Kind> make) {
  const bool isList = !request.table.table()->list.empty();
  const Value* list = isList ? &request.table : request.table.find(key);
  if (list == nullptr || !list->isTable()) {
    return failure("the required list " + std::string(key) + " is missing", request.place(key),
                   "give the tables of the transforms to be combined");
  }
  std::vector<std::unique_ptr<Kind>> parts;
  for (const Value& each : list->table()->list) {
    const std::string index = '[' + std::to_string(parts.size() + 1) + ']';
    auto part = makeInner<Kind>(request, each, isList ? index : '.' + std::string(key) + index, make);
    if (!part) {
      return tl::make_unexpected(part.error());
    }
    parts.push_back(std::move(*part));
  }
  return parts;
}

/// Transforms by the dates from which they hold: `Keyframes = { ["2000 JAN 01"] = { ... } }`, where keys are UTC dates
/// or TDB seconds past J2000. Between two of them they are mixed unless `ShouldInterpolate` is false; before the first
/// and after the last these hold.
template <class Kind>
class Timeline {
 public:
  [[nodiscard]] static Result<Timeline> make(const TransformRequest& request, TransformMaker<Kind> makeFrame) {
    const Value* frames = request.table.find("Keyframes");
    if (frames == nullptr || !frames->isTable() || (frames->table()->fields.empty() && frames->table()->list.empty())) {
      return failure("the timeline has no keyframes", request.place("Keyframes"), "give a table of transforms by date");
    }
    Timeline timeline;
    if (const Value* mixed = request.table.find("ShouldInterpolate")) {
      timeline.interpolates_ = mixed->boolean().value_or(true);
    }
    const auto add = [&](Time time, const Value& table, const std::string& key) -> Result<void> {
      return makeInner<Kind>(request, table, ".Keyframes[" + key + ']', makeFrame).map([&](auto made) {
        timeline.frames_.push_back({time, std::move(made)});
      });
    };
    double second = 0.0;
    for (const Value& table : frames->table()->list) {
      second += 1.0;
      if (auto added = add(Time(second), table, std::to_string(static_cast<int>(second))); !added) {
        return tl::make_unexpected(added.error());
      }
    }
    for (const auto& [key, table] : frames->table()->fields) {
      const auto time = keyframeTime(key);
      if (!time) {
        return failure(time.error().what, request.place("Keyframes[" + key + ']'), time.error().remedy);
      }
      if (auto added = add(*time, table, key); !added) {
        return tl::make_unexpected(added.error());
      }
    }
    std::stable_sort(timeline.frames_.begin(), timeline.frames_.end(),
                     [](const Frame& a, const Frame& b) { return a.time - b.time < 0.0; });
    return timeline;
  }

  struct Moment {
    const Kind& before;
    const Kind& after;
    double share = 0.0;  ///< of `after`: 0 to 1
  };
  [[nodiscard]] Moment at(const Time& time) const {
    const auto after =
        std::find_if(frames_.begin(), frames_.end(), [&](const Frame& frame) { return frame.time - time > 0.0; });
    if (after == frames_.begin() || after == frames_.end()) {
      const Kind& only = *(after == frames_.begin() ? frames_.front() : frames_.back()).transform;
      return {only, only, 0.0};
    }
    const auto before = std::prev(after);
    const double share = interpolates_ ? (time - before->time) / (after->time - before->time) : 0.0;
    return {*before->transform, *after->transform, share};
  }

 private:
  struct Frame {
    Time time;
    std::unique_ptr<Kind> transform;
  };

  static Result<Time> keyframeTime(const std::string& key) {
    double seconds = 0.0;
    const char* end = key.data() + key.size();
    const auto [rest, status] = std::from_chars(key.data(), end, seconds);
    return status == std::errc() && rest == end && std::isfinite(seconds) && key.find_first_of("-:", 1) == key.npos
               ? Result<Time>(Time(seconds))
               : Time::fromUtc(key);
  }

  std::vector<Frame> frames_;
  bool interpolates_ = true;
};

}  // namespace meridian::scene

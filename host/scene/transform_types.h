#pragma once

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "host/api/error.h"
#include "host/api/time.h"
#include "host/api/value.h"
#include "host/scene/node_transforms.h"

namespace meridian::scene {

/// A type of transform: its name in assets, and what makes it from its table (whose `Type` has been read).
template <class Kind>
struct TransformType {
  std::string_view name;
  Result<std::unique_ptr<Kind>> (*make)(const TransformRequest& request);
};

/// Makes the transform that the table's `Type` names.
template <class Kind>
Result<std::unique_ptr<Kind>> makeByType(const TransformRequest& request, std::span<const TransformType<Kind>> types) {
  const Value* type = request.table.find("Type");
  const std::string* name = type != nullptr ? type->string() : nullptr;
  if (name == nullptr) {
    return failure("the transform has no Type", request.place("Type"), "give its Type as a string");
  }
  std::string known;
  for (const TransformType<Kind>& each : types) {
    if (each.name == *name) {
      return each.make(request);
    }
    known += (known.empty() ? "" : ", ") + std::string(each.name);
  }
  return failure("'" + *name + "' is not a transform type", request.place("Type"), "use one of: " + known);
}

/// Where a scale must lie so that neither it nor its inverse leaves the range of a double's useful numbers.
inline constexpr double smallestScale = 1e-30;
inline constexpr double largestScale = 1e30;
/// The factor within that range; assets also hide things by a scale of 0.
[[nodiscard]] double usableScale(double factor);

/// Warns of what a transform cannot do: once in a scene for each `subject`.
void warnOnce(const TransformRequest& request, const std::string& subject, const std::string& message);

/// The clock of SPICE transforms: a fixed date, or the scene's time plus an offset in seconds.
class TransformClock {
 public:
  /// Reads FixedDate and TimeOffset. Errors: a date that cannot be read.
  [[nodiscard]] static Result<TransformClock> fromTable(const TransformRequest& request);
  [[nodiscard]] Time at(const Time& time) const { return fixed_ ? *fixed_ : time + offset_; }

 private:
  std::optional<Time> fixed_;
  double offset_ = 0.0;
};

}  // namespace meridian::scene

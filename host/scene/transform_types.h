#pragma once

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "host/api/error.h"
#include "host/api/time.h"
#include "host/api/value.h"

namespace meridian::scene {

/// A type of transform: its name in assets, and what makes it from its table (whose `Type` has been read).
template <class Kind>
struct TransformType {
  std::string_view name;
  Result<std::unique_ptr<Kind>> (*make)(const Value& table, std::string_view where);
};

/// Makes the transform that `table.Type` names. `later` holds the types of OpenSpace that we do not have yet.
template <class Kind>
Result<std::unique_ptr<Kind>> makeByType(const Value& table, std::string_view where,
                                         std::span<const TransformType<Kind>> types,
                                         std::span<const std::string_view> later) {
  const Value* type = table.find("Type");
  const std::string* name = type != nullptr ? type->string() : nullptr;
  if (name == nullptr) {
    return failure("the transform has no Type", std::string(where), "give its Type as a string");
  }
  std::string known;
  for (const TransformType<Kind>& each : types) {
    if (each.name == *name) {
      return each.make(table, where);
    }
    known += (known.empty() ? "" : ", ") + std::string(each.name);
  }
  for (const std::string_view each : later) {
    if (each == *name) {
      return failure("the transform type " + *name + " comes with a later version", std::string(where),
                     "use one of: " + known);
    }
  }
  return failure("'" + *name + "' is not a transform type", std::string(where), "use one of: " + known);
}

/// The clock of SPICE transforms: a fixed date, or the scene's time plus an offset in seconds.
class TransformClock {
 public:
  /// Reads FixedDate and TimeOffset. Errors: a date that cannot be read.
  [[nodiscard]] static Result<TransformClock> fromTable(const Value& table, std::string_view where);
  [[nodiscard]] Time at(const Time& time) const { return fixed_ ? *fixed_ : time + offset_; }

 private:
  std::optional<Time> fixed_;
  double offset_ = 0.0;
};

}  // namespace meridian::scene

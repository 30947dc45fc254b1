#pragma once

#include <string>
#include <string_view>

#include "host/api/error.h"

namespace meridian {
class PropertyOwner;
}

namespace meridian::scripting {

/// Which properties, or owners of some, a script means.
///
///     URI                    that one
///     pre*post               pre occurs in the URI, and post ends it after that; an empty post: the URI begins with
///     pre {tag}.rest             some owner above (or of) the property has the tag, and the URI ends with ".rest"
///     {tag}.pre*post         as above, ".pre" may be anywhere
///     {a&b} {a|b} {a~b}      both, either, a without b; both tags are looked for on one and the same owner
class PropertyPattern {
 public:
  /// Errors: more than one `*`; `*` alone; an empty pattern; a tag group that is not closed, is empty, holds more than
  /// two tags or stands alone.
  [[nodiscard]] static Result<PropertyPattern> parse(std::string_view text);

  /// Without tag and wildcard: names one property at most.
  [[nodiscard]] bool isExact() const { return operator_ == Operator::None && !hasWildcard_; }
  /// `innermost`: the first owner whose tags count, a property's own or the owner itself that the URI names.
  [[nodiscard]] bool matches(std::string_view uri, const PropertyOwner* innermost) const;

 private:
  enum class Operator { None, One, And, Or, Without };

  [[nodiscard]] bool matchesText(std::string_view uri) const;
  [[nodiscard]] bool matchesTags(const PropertyOwner* innermost) const;

  Operator operator_ = Operator::None;
  std::string firstTag_;
  std::string secondTag_;
  bool hasWildcard_ = false;
  std::string before_;  ///< the whole text when there is no wildcard
  std::string after_;
};

}  // namespace meridian::scripting

#pragma once

#include <string>

#include <tl/expected.hpp>

namespace meridian {

/// Why something could not be done: what happened, where, and what the user can do about it.
///
/// Bad data and bad input give an Error; misuse of an interface by our own code asserts.
struct Error {
  std::string what;      ///< one sentence without a full stop: "the raster has no georeference"
  std::string where;     ///< file with line, key path or URL; empty when there is no such place
  std::string remedy{};  ///< what to do, as an imperative; empty when nothing sensible can be said

  /// "WHERE: WHAT; REMEDY", without the parts that are empty.
  [[nodiscard]] std::string message() const;
};

template <class T>
using Result = tl::expected<T, Error>;

/// The unexpected value of any Result: `return failure("no such file", path, "check the path")`.
[[nodiscard]] inline tl::unexpected<Error> failure(std::string what, std::string where = {}, std::string remedy = {}) {
  return tl::make_unexpected(Error{std::move(what), std::move(where), std::move(remedy)});
}

}  // namespace meridian

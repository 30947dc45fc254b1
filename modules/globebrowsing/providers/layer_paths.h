#pragma once

#include <functional>
#include <string>

#include "host/api/value.h"

namespace meridian::globebrowsing {

/// A layer's table with every path in it replaced by what `change` makes of it, also in tables within it: of providers
/// by level, by index, by date, and of series. A path is what stands at one of the keys that layer_paths.cpp lists; it
/// may be a map service or the text of a document as well, as dataPath tells. Those that are empty stay so.
[[nodiscard]] Value withPaths(const Value& table, const std::function<std::string(const std::string&)>& change);

/// Its relative paths started at that folder, so that they hold anywhere.
[[nodiscard]] Value withWholePaths(const Value& table, const std::string& folder);

}  // namespace meridian::globebrowsing

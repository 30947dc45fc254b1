#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "globebrowsing/layers/layer_manager.h"

namespace meridian::globebrowsing {

using Fields = std::map<std::string, Value, std::less<>>;

inline Value tableOf(Fields fields) {
  return Table{{}, std::move(fields)};
}
inline Value listOf(std::vector<Value> items) {
  return Table{std::move(items), {}};
}

/// A layer table that needs no data.
inline Value solidLayer(const std::string& identifier, Fields more = {}) {
  more.insert({{"Identifier", identifier}, {"Type", "SolidColor"}});
  return tableOf(std::move(more));
}

inline ProviderRequest requestFor(Value table) {
  return {std::move(table), "earth.asset:12", "Layer", "/data"};
}

}  // namespace meridian::globebrowsing

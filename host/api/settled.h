#pragma once

#include <string>

namespace meridian {

/// Whether what a view shows is what it will show when nothing more arrives; if not, why not, in words for a person
/// ("3 tiles of ColorLayers.BlueMarble are loading").
struct Settled {
  bool complete = true;
  std::string reason{};
};

}  // namespace meridian

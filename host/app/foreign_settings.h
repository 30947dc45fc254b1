#pragma once

#include <memory>
#include <vector>

#include "host/api/property.h"
#include "host/api/property_owner.h"

namespace meridian::app {

/// Properties of parts of OpenSpace that are not here, so that assets which read or set them load. Without effect.
struct ForeignSettings {
  ForeignSettings();

  PropertyOwner dashboard{"Dashboard"};
  Vec2Property startPosition{{"StartPositionOffset", "Start position", "Without effect"}, {10.0, -25.0}};

  PropertyOwner webGui{"WebGui"};
  BoolProperty serverEnabled{{"ServerProcessEnabled", "Server", "Without effect"}, false};
  StringProperty serverEntryPoint{{"ServerProcessEntryPoint", "Entry point", "Without effect"}, ""};

  PropertyOwner exoplanets{"Exoplanets"};
  std::vector<std::unique_ptr<StringProperty>> files;  ///< of exoplanets: paths
};

}  // namespace meridian::app

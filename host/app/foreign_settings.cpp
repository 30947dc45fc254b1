#include "host/app/foreign_settings.h"

namespace meridian::app {

ForeignSettings::ForeignSettings() {
  dashboard.addProperty(startPosition);
  webGui.addProperty(serverEnabled);
  webGui.addProperty(serverEntryPoint);
  for (const char* name : {"DataFolder", "BvColormap", "StarTexture", "StarGlareTexture", "NoDataTexture",
                           "OrbitDiscTexture", "HabitableZoneTexture"}) {
    files.push_back(std::make_unique<StringProperty>(Property::Description{name, name, "Without effect"}));
    exoplanets.addProperty(*files.back());
  }
}

}  // namespace meridian::app

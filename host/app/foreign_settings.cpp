#include "host/app/foreign_settings.h"

namespace meridian::app {

ForeignSettings::ForeignSettings() {
  dashboard.addProperty(startPosition);
  webGui.addProperty(serverEnabled);
  webGui.addProperty(serverEntryPoint);
  exoplanets.addProperty(exoplanetsFolder);
  exoplanets.addProperty(starTexture);
}

}  // namespace meridian::app

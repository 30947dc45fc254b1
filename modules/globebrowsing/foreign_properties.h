#pragma once

#include <initializer_list>

#include "host/api/property.h"
#include "host/api/property_owner.h"

namespace meridian::globebrowsing {

/// Properties of OpenSpace's globes for what there is none of here: scripts, recordings and the command line set them
/// without an error and without effect.
struct ForeignProperties {
  /// Of a globe and of its `Debug`.
  void addTo(PropertyOwner& globe, PropertyOwner& debug) {
    for (Property* property :
         std::initializer_list<Property*>{&orenNayarRoughness, &dimInAtmosphere, &eclipse, &eclipseHardShadows}) {
      globe.addProperty(*property);
    }
    for (Property* property : std::initializer_list<Property*>{&shadows, &zFightingPercentage, &numberShadowSamples}) {
      shadowMapping.addProperty(*property);
    }
    globe.addChild(shadowMapping);
    debug.addProperty(modelSpaceCutoffLevel);
    debug.addProperty(dynamicLodIterationCount);
  }

  static constexpr const char* none = "Without effect";
  FloatProperty orenNayarRoughness{{"OrenNayarRoughness", "Oren-Nayar roughness", none}, 0.0, {0.0, 1.0}};
  BoolProperty dimInAtmosphere{{"DimInAtmosphere", "Dim in atmosphere", none}, false};
  BoolProperty eclipse{{"Eclipse", "Eclipse", none}, false};
  BoolProperty eclipseHardShadows{{"EclipseHardShadows", "Eclipse hard shadows", none}, false};
  PropertyOwner shadowMapping{"ShadowMapping", "Shadow mapping", none};
  BoolProperty shadows{{"ShadowMapping", "Shadow mapping", none}, false};
  FloatProperty zFightingPercentage{{"ZFightingPercentage", "Z-fighting percentage", none}, 0.995, {1e-6, 1.0}};
  IntProperty numberShadowSamples{{"NumberShadowSamples", "Shadow samples", none}, 5, 1, 7};
  IntProperty modelSpaceCutoffLevel{{"ModelSpaceRenderingCutoffLevel", "Cut-off level", none}, 14, 1, 22};
  IntProperty dynamicLodIterationCount{{"DynamicLodIterationCount", "Level-of-detail iterations", none}, 16, 4, 128};
};

}  // namespace meridian::globebrowsing

#pragma once

#include "host/api/property_owner.h"
#include "host/api/script_library.h"
#include "host/scripting/property_animation.h"
#include "host/scripting/property_index.h"

namespace meridian::scripting {

/// `openspace.*`: setPropertyValue, setPropertyValueSingle, propertyValue (and getPropertyValue),
/// invertBooleanProperty, hasProperty, property, propertyOwner, stopPropertyBouncing, fadeIn, fadeOut, toggleFade,
/// addTag, removeTag. The arguments must outlive the library.
///
/// setPropertyValue sets those of the matching properties that take the value's type. When none is left, or one refuses
/// the value (range, choices, read only), that is logged and the script goes on, as OpenSpace's do; a bad pattern or an
/// unknown easing is a Lua error.
[[nodiscard]] ScriptLibrary propertyLibrary(PropertyOwner& root, PropertyIndex& index, PropertyAnimation& animation);

/// What the command line's `--set URI=VALUE` does: as setPropertyValue, but an Error when nothing could be set.
Result<void> setProperties(PropertyIndex& index, PropertyAnimation& animation, std::string_view pattern,
                           const Value& value);

/// `openspace.*`: printDebug, printInfo, printWarning, printError, printFatal.
[[nodiscard]] ScriptLibrary logLibrary();

}  // namespace meridian::scripting

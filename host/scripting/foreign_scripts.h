#pragma once

#include <vector>

#include "host/api/script_library.h"

namespace meridian::scripting {

/// Functions that OpenSpace has for parts which this program has not (dashboards, sound, web pages, joysticks, ...), so
/// that assets which also use those load. Called, they do nothing, say so once each, and give back what "nothing there"
/// looks like: no value, an empty list or false. docs/openspace.md lists them.
[[nodiscard]] std::vector<ScriptLibrary> foreignLibraries();

}  // namespace meridian::scripting

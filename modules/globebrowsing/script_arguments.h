#pragma once

#include <span>
#include <string>
#include <string_view>

#include "globebrowsing/renderable_globe.h"
#include "host/api/module.h"
#include "host/api/script_library.h"

namespace meridian::globebrowsing {

// What script functions make of their arguments; the errors are what a script gets.

[[nodiscard]] Result<std::string> text(const Value& value, std::string_view argument);
/// A name, or the table that has it at `Identifier`.
[[nodiscard]] Result<std::string> identifierOf(const Value& value, std::string_view argument);
/// A finite number.
[[nodiscard]] Result<double> number(const Value& value, std::string_view argument);
/// The globe of that node.
[[nodiscard]] Result<RenderableGlobe*> globe(Host& host, const Value& node);
/// Of a function that gives back nothing.
[[nodiscard]] ScriptResult none(const Result<void>& done);

/// Adds a layer's table to a globe: RenderableGlobe::addLayer, at the place of the script that runs.
Result<void> addLayerFromScript(Host& host, const Value& node, const std::string& group, const Value& table);

}  // namespace meridian::globebrowsing

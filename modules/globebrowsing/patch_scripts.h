#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <glm/vec2.hpp>

#include "host/api/error.h"
#include "host/api/module.h"
#include "host/api/script_library.h"

namespace meridian::globebrowsing {

/// What an `.info` file says of a patch of a globe: a Lua file that sets Name, Identifier, Description, ColorFile,
/// HeightFile, Location = { Center = { longitude, latitude } }, ZIndex and BlendMode.
struct PatchInfo {
  std::string identifier;
  std::string name;
  Value location{};                           ///< as it is, or nil
  std::optional<glm::dvec2> centreDegrees{};  ///< longitude, latitude
  Value colour{};                             ///< a layer's table, or nil; likewise the next
  Value height{};
};

/// Errors: what cannot be read; no Identifier and no Name.
[[nodiscard]] Result<PatchInfo> readPatchInfo(const Host& host, const std::filesystem::path& file);

/// parseInfoFile(file) -> { Color, Height, Name, Location, Identifier }, addBlendingLayersFromDirectory(folder, globe),
/// addFocusNodesFromDirectory(folder, globe), both of them for every `.info` file below the folder, those that are
/// wrong left out with a message; addFocusNodeFromLatLong(name, globe, latitude, longitude, altitude?).
[[nodiscard]] std::vector<ScriptFunction> patchFunctions(Host& host);

}  // namespace meridian::globebrowsing

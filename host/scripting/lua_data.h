#pragma once

#include <filesystem>

#include "host/api/error.h"
#include "host/api/value.h"

namespace meridian::scripting {

/// What a Lua file that holds data returns, or else the globals that it sets, as a table. It runs in a sandbox of its
/// own, without `openspace`. Errors: what cannot be read, what the script says, functions among the values.
[[nodiscard]] Result<Value> readLuaData(const std::filesystem::path& file);

}  // namespace meridian::scripting

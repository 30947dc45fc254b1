#pragma once

#include <string>
#include <string_view>

#include "host/api/error.h"

namespace meridian::assets {

/// An asset in JSON as the Lua that means the same: `{ "version", "metadata": { "name", "asset_version",
/// "description", "author", "license" }, "dependencies": [paths, relative to the file], "scenegraphnodes": [node
/// tables, in the order of adding] }`, all optional. Nodes are exported by their identifiers. Errors: what is no JSON,
/// keys of another type, nodes without Identifier.
[[nodiscard]] Result<std::string> luaFromJsonAsset(std::string_view text, const std::string& where);

}  // namespace meridian::assets

#pragma once

#include <filesystem>

#include "host/api/error.h"

namespace meridian::graphics {

/// Points the driver's cache of machine code (Mesa's MESA_SHADER_CACHE_DIR) to CACHE/shaders, which it creates. To be
/// called before the first context is made and before other threads start: it sets the environment. A folder that the
/// user's environment names already wins. Warns when the environment turns that cache off, since every program then
/// costs its compile time again in the first frame that draws with it.
///
/// Gives the folder in force. Errors: it cannot be created; drawing works without it.
[[nodiscard]] Result<std::filesystem::path> useShaderCacheFolder(const std::filesystem::path& cache);

}  // namespace meridian::graphics

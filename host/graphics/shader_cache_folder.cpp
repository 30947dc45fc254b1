#include "host/graphics/shader_cache_folder.h"

#include <cstdlib>
#include <string>
#include <system_error>

#include <fmt/format.h>

#include "host/api/log.h"

namespace meridian::graphics {

namespace {

bool isTrue(const char* value) {
  const std::string word = value != nullptr ? value : "";
  return word == "1" || word == "true" || word == "yes" || word == "y" || word == "t";
}

}  // namespace

Result<std::filesystem::path> useShaderCacheFolder(const std::filesystem::path& cache) {
  for (const char* name : {"MESA_SHADER_CACHE_DISABLE", "MESA_GLSL_CACHE_DISABLE"}) {
    if (isTrue(std::getenv(name))) {
      log::warning("{} is set: every new program stops a frame for its compile time; unset it", name);
    }
  }
  if (const char* chosen = std::getenv("MESA_SHADER_CACHE_DIR"); chosen != nullptr && *chosen != '\0') {
    return std::filesystem::path(chosen);
  }
  const std::filesystem::path folder = cache / "shaders";
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) {
    return failure(fmt::format("the folder for compiled shaders cannot be made ({})", error.message()), folder.string(),
                   "choose a cache folder that can be written");
  }
  if (setenv("MESA_SHADER_CACHE_DIR", folder.c_str(), 0) != 0) {
    return failure("the environment cannot be set", "MESA_SHADER_CACHE_DIR");
  }
  return folder;
}

}  // namespace meridian::graphics

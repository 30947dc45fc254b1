#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>

namespace meridian::test {

/// A file or folder of the real data that are no part of the project: in MERIDIAN_SHARED_DATA, by default beside it.
inline std::string sharedData(const std::string& name) {
  const char* folder = std::getenv("MERIDIAN_SHARED_DATA");
  const std::filesystem::path root = folder != nullptr ? folder : MERIDIAN_SOURCE_FOLDER "/../shared/data";
  return (root.lexically_normal() / name).string();
}

}  // namespace meridian::test

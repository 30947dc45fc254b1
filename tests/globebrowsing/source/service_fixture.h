#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "globebrowsing/source/capabilities.h"
#include "raster_fixture.h"

namespace meridian::globebrowsing::test {

using Bytes = std::vector<std::uint8_t>;

inline Bytes bytesOf(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

inline std::string textOf(const std::string& path) {
  const Bytes bytes = bytesOf(path);
  return {bytes.begin(), bytes.end()};
}

inline Bytes toBytes(std::string_view text) {
  return {text.begin(), text.end()};
}

inline Result<Capabilities> parse(std::string_view text, const std::string& url = "http://example.org/service") {
  return parseCapabilities(toBytes(text), url);
}

/// A document of /capabilities of the shared data, read; without layers where there is no such file.
inline Capabilities realCapabilities(const std::string& name, const std::string& url = {}) {
  const std::string path = sharedData("capabilities/" + name);
  if (!std::filesystem::exists(path)) {
    return {};
  }
  auto read = parseCapabilities(bytesOf(path), url.empty() ? path : url);
  EXPECT_TRUE(read) << name << ": " << (read ? "" : read.error().message());
  return read ? std::move(*read) : Capabilities{};
}

}  // namespace meridian::globebrowsing::test

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

inline TileService serviceOfLayer(const Capabilities& capabilities, const std::string& layer,
                                  const LayerChoices& choices = {}) {
  const CapabilitiesLayer* found = capabilities.find(layer);
  EXPECT_NE(found, nullptr) << layer;
  if (found == nullptr) {
    return {};
  }
  auto service = serviceOf(capabilities, *found, choices);
  EXPECT_TRUE(service) << (service ? "" : service.error().message());
  return service ? std::move(*service) : TileService{};
}

/// Of every matrix the first and the last tile.
inline std::vector<TileAddress> cornersOf(const TileService& service) {
  std::vector<TileAddress> addresses;
  for (std::size_t i = 0; i < service.matrices.size(); ++i) {
    const TileMatrix& matrix = service.matrices[i];
    addresses.push_back({i, matrix.firstColumn, matrix.firstRow});
    addresses.push_back({i, matrix.lastColumn, matrix.lastRow});
  }
  return addresses;
}

}  // namespace meridian::globebrowsing::test

#pragma once

#include <cstddef>
#include <string>

#include "globebrowsing/network/fetcher.h"

namespace meridian::globebrowsing {

/// Capabilities: large services list tens of thousands of layers. As source/xml_document.h.
inline constexpr std::size_t largestDocument = std::size_t{64} << 20;

/// To be fetched; anything else is a file.
[[nodiscard]] inline bool isWebAddress(const std::string& url) {
  return url.starts_with("http://") || url.starts_with("https://");
}

/// A description of a service that lies in a file, as if it had been fetched. Errors: it cannot be read, or is too
/// large.
[[nodiscard]] Result<Fetched> readDocumentFile(const std::string& path);

/// A text file. Errors: it cannot be read, or is longer than `mostBytes`; then `remedy` says what to do.
[[nodiscard]] Result<std::string> readTextFile(const std::string& path, std::size_t mostBytes, const std::string& where,
                                               const std::string& remedy);

}  // namespace meridian::globebrowsing

#pragma once

#include <cstdint>
#include <optional>

#include <glm/vec2.hpp>

#include "host/api/error.h"

namespace meridian::app {

/// Bytes that this machine can still give to programs without swapping; nothing where that cannot be known.
[[nodiscard]] std::optional<std::uint64_t> availableMemory();

/// Whether frames of that size (pixels) fit into that memory together with what is drawn. Nothing fits always.
/// Errors: they do not; the remedy names a size that does.
[[nodiscard]] Result<void> checkPictureFits(glm::ivec2 size, std::optional<std::uint64_t> availableBytes);

}  // namespace meridian::app

#pragma once

#include <filesystem>

#include "host/api/error.h"

namespace meridian::assets {

/// Unpacks a ZIP archive into a folder, over files that are there. Errors: no archive; an entry that leads out of the
/// folder; more than 100 000 entries or 16 GiB; what cannot be written. What was unpacked by then stays.
Result<void> unpackZip(const std::filesystem::path& archive, const std::filesystem::path& folder);

}  // namespace meridian::assets

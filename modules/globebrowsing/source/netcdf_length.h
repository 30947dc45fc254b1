#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

namespace meridian::globebrowsing {

/// How long a netCDF file of a classic format (CDF-1, 2 and 5) is at least, by its header: to the end of the last
/// variable. The library reads what lies beyond the file's end as zeros, without a word. Nothing where the file is of
/// another format or its header is damaged. (Files of netCDF-4, which are HDF5, are checked by their library.)
/// Blocking.
[[nodiscard]] std::optional<std::uint64_t> classicNetcdfLength(const std::filesystem::path& file);

}  // namespace meridian::globebrowsing

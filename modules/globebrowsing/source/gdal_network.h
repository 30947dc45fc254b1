#pragma once

#include <optional>
#include <string>

#include "globebrowsing/network/network_options.h"
#include "host/api/error.h"

namespace meridian::globebrowsing {

/// Has GDAL ask servers, where it does so itself, as our own network does: User-Agent, time limits, verified
/// certificates, and nothing at all in the mode cache-only. An option that the user gives GDAL (by the environment or
/// its file of options) stays, but GDAL_HTTP_UNSAFESSL, and CPL_VSIL_CURL_ALLOWED_FILENAME while offline. GDAL's WMS
/// driver takes the time of a whole transfer from the description (300 s where it has no Timeout); stalls end its
/// requests as others. For what is sent afterwards; safe from any thread.
void setGdalNetwork(const NetworkOptions& options);
/// In the mode cache-only.
[[nodiscard]] bool isGdalOffline();

/// What opening and reading a raster asks of servers.
struct GdalReach {
  std::optional<std::string> server{};  ///< an address, or GDAL's name for one; nothing: only files are read
  bool isUnverified = false;            ///< a description wants certificates not to be verified
  /// A description that is too large to be looked through: whether it names a server is not known.
  std::optional<std::string> unchecked{};
};

/// A path, or in its place the text of the <GDAL_WMS> that it is or names, without its UnsafeSSL. Reads the file.
[[nodiscard]] std::string withVerifiedCertificates(const std::string& path);
/// Of a path as RasterDescription has it. Reads it where it is a description of a service or a VRT, and what that
/// names, so call it on a worker; asks no server. Rasters of which a file in another format refers to a server are not
/// seen; GDAL then finds no file there while it is offline.
[[nodiscard]] GdalReach gdalReach(const std::string& path);
/// Whether that may be opened and read now. Errors: offline; certificates that are not to be verified.
[[nodiscard]] Result<void> checkReach(const GdalReach& reach, const std::string& where);

}  // namespace meridian::globebrowsing

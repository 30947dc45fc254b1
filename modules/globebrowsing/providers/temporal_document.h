#pragma once

#include <string>
#include <string_view>

#include "globebrowsing/providers/time_series.h"

namespace meridian::globebrowsing {

/// Whether a FilePath is the text of an <OpenSpaceTemporalGDALDataset>: temporal layers up to OpenSpace 0.17.
[[nodiscard]] bool isTemporalDocument(std::string_view filePath);

/// Reads such a text (openspace-formats.md, d.2). Errors: no XML; no such root; no GDAL_WMS and no FilePath in it; an
/// unknown OpenSpaceTimeIdFormat. Neither document types nor entities of their own are looked at.
[[nodiscard]] Result<PrototypedSeries::Description> readTemporalDocument(std::string_view text,
                                                                         const std::string& where);

}  // namespace meridian::globebrowsing

#include <algorithm>
#include <cmath>
#include <limits>

#include "globebrowsing/source/capabilities_parts.h"
#include "globebrowsing/source/service_text.h"
#include "globebrowsing/source/tile_pyramid.h"
#include "globebrowsing/source/tile_url.h"

namespace meridian::globebrowsing {

namespace {

/// The link to take: the chosen one; else degrees before EPSG:3857 before all others, the most matrices first.
Result<const MatrixSetLink*> chooseLink(const Capabilities& capabilities, const CapabilitiesLayer& layer,
                                        const LayerChoices& choices) {
  const MatrixSetLink* best = nullptr;
  std::pair<int, std::ptrdiff_t> bestRank{};
  std::string names;
  for (const MatrixSetLink& link : layer.matrixSets) {
    const MatrixSet& set = capabilities.matrixSets[link.set];
    names += (names.empty() ? "" : ", ") + set.identifier;
    const bool isWanted = choices.matrixSet.empty()
                              ? choices.crs.empty() || canonicalCrsName(choices.crs) == canonicalCrsName(set.crs)
                              : set.identifier == choices.matrixSet;
    const auto crs = MapCrs::of(set.crs, capabilities.url);
    if (!isWanted || !set.problem.empty() || !crs) {
      continue;
    }
    const std::pair rank{crs->isGeographic()    ? 0
                         : crs->isWebMercator() ? 1
                                                : 2,
                         -static_cast<std::ptrdiff_t>(set.matrices.size())};
    if (best == nullptr || rank < bestRank) {
      best = &link;
      bestRank = rank;
    }
  }
  if (best == nullptr) {
    return failure("the layer '" + layer.title + "' has no matrix set '" +
                       (choices.matrixSet.empty() ? choices.crs : choices.matrixSet) + "' that can be used",
                   capabilities.url, "choose one of: " + names);
  }
  return best;
}

std::vector<TileMatrix> limited(const MatrixSet& set, const MatrixSetLink& link) {
  if (link.limits.empty()) {
    return set.matrices;
  }
  std::vector<TileMatrix> matrices;
  for (TileMatrix matrix : set.matrices) {
    for (const MatrixSetLink::Limits& limits : link.limits) {
      // Some write "SET:MATRIX" here.
      if (limits.matrix == matrix.identifier || limits.matrix == set.identifier + ":" + matrix.identifier) {
        matrix.firstRow = std::max(matrix.firstRow, limits.firstRow);
        matrix.lastRow = std::min(matrix.lastRow, limits.lastRow);
        matrix.firstColumn = std::max(matrix.firstColumn, limits.firstColumn);
        matrix.lastColumn = std::min(matrix.lastColumn, limits.lastColumn);
        matrices.push_back(matrix);
        break;
      }
    }
  }
  return matrices;
}

/// What the layer says of its extent, in units of the set's CRS: a box there is exact; without end where it says
/// nothing.
Extent extentIn(const MapCrs& crs, const CapabilitiesLayer& layer, const std::string& crsName) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const bool isCylindrical = crs.isGeographic() || crs.isWebMercator();  // exact from degrees, and no further than they
  for (const auto& [boxCrs, box] : layer.boundingBoxes) {
    if (!isCylindrical && canonicalCrsName(boxCrs) == canonicalCrsName(crsName)) {
      return box;
    }
  }
  const Extent unknown =
      crs.isGeographic() ? Extent{-180.0, -90.0, 180.0, 90.0} : Extent{-infinity, -infinity, infinity, infinity};
  return layer.extent ? crs.fromDegrees(toDegrees(*layer.extent)).value_or(unknown) : unknown;
}

/// An extent over the antimeridian, or of 0 to 360 degrees, on the one turn that a set of tiles has: moved there, or
/// the whole turn where it lies at both of its ends.
Extent onTurn(Extent extent, const MapCrs& crs, const std::vector<TileMatrix>& matrices) {
  if (!(crs.isGeographic() || crs.isWebMercator()) || matrices.empty() || !std::isfinite(extent.west + extent.east)) {
    return extent;
  }
  const double turn = crs.isGeographic() ? 360.0 : 2 * webMercatorHalfWidth;
  const double near = 1e-9 * turn;
  const TileMatrix& last = matrices.back();
  const double span = static_cast<double>(last.lastColumn + 1) * last.tileWidth * last.pixelWidth;
  const bool beginsAtZero = std::abs(last.left) < near && span > 0.5 * turn + near;
  const double west = beginsAtZero ? 0.0 : -0.5 * turn;
  for (const double shift : {0.0, -turn, turn}) {
    if (extent.west + shift >= west - near && extent.east + shift <= west + turn + near) {
      return {extent.west + shift, extent.south, extent.east + shift, extent.north};
    }
  }
  return {west, extent.south, west + turn, extent.north};
}

/// Corners as if their axes had been written the other way round.
std::vector<TileMatrix> turned(std::vector<TileMatrix> matrices) {
  for (TileMatrix& matrix : matrices) {
    std::swap(matrix.left, matrix.top);
  }
  return matrices;
}

Result<AddressTemplate> chooseAddress(const Capabilities& capabilities, const CapabilitiesLayer& layer,
                                      const LayerChoices& choices) {
  std::vector<AddressTemplate> addresses = layer.addresses;
  std::stable_sort(addresses.begin(), addresses.end(), [&](const AddressTemplate& a, const AddressTemplate& b) {
    return formatRank(a.format).value_or(99) < formatRank(b.format).value_or(99);
  });
  if (choices.format.empty()) {
    return addresses.front();
  }
  for (const AddressTemplate& address : addresses) {
    if (equalIgnoringCase(address.format, choices.format)) {
      return address;
    }
  }
  return failure("the layer '" + layer.title + "' has no format '" + choices.format + "'", capabilities.url,
                 "choose one of: " + joined(layer.formats, ", "));
}

Result<std::string> chooseStyle(const Capabilities& capabilities, const CapabilitiesLayer& layer,
                                const LayerChoices& choices) {
  if (choices.style.empty()) {
    return layer.styles.empty() ? std::string() : layer.styles.front().identifier;
  }
  for (const LayerStyle& style : layer.styles) {
    if (style.identifier == choices.style) {
      return style.identifier;
    }
  }
  return failure("the layer '" + layer.title + "' has no style '" + choices.style + "'", capabilities.url);
}

Result<TileUrl> addressOf(const Capabilities& capabilities, const CapabilitiesLayer& layer, const LayerChoices& choices,
                          const MatrixSet& set) {
  auto chosen = chooseAddress(capabilities, layer, choices);
  if (!chosen) {
    return tl::make_unexpected(std::move(chosen.error()));
  }
  auto style = chooseStyle(capabilities, layer, choices);
  if (!style) {
    return tl::make_unexpected(std::move(style.error()));
  }
  std::vector<std::string> names;  // placeholders point into them
  std::vector<std::string> values;
  names.reserve(layer.dimensions.size());
  for (const LayerDimension& dimension : layer.dimensions) {
    auto value = dimensionValue(dimension, choices, capabilities.url);
    if (!value) {
      return tl::make_unexpected(std::move(value.error()));
    }
    names.push_back("{" + dimension.name + "}");
    values.push_back(value->value);
  }
  const auto literal = [](const std::string& text) {
    return std::vector<TileUrl::Piece>{{UrlPart::Literal, percentEncoded(text, ":,")}};
  };
  std::vector<TileUrl::Placeholder> placeholders{{"{TileMatrixSet}", literal(set.identifier)},
                                                 {"{Style}", literal(*style)},
                                                 {"{TileSet}", {{UrlPart::MatrixAsIs}}},
                                                 {"{TileMatrix}", {{UrlPart::Matrix}}},
                                                 {"{TileRow}", {{UrlPart::Row}}},
                                                 {"{TileRowFromSouth}", {{UrlPart::RowFromSouth}}},
                                                 {"{TileCol}", {{UrlPart::Column}}}};
  for (TileUrl::Placeholder& window : windowPlaceholders()) {
    placeholders.push_back(std::move(window));
  }
  for (std::size_t i = 0; i < names.size(); ++i) {
    placeholders.push_back({names[i], literal(values[i])});
  }
  std::string address = chosen->address;
  if (!choices.parameters.empty()) {
    QueryParameters parameters;
    for (const auto& [name, value] : choices.parameters) {
      parameters.emplace_back(percentEncoded(name), percentEncoded(value));
    }
    address = withParameters(address, parameters);
  }
  return TileUrl::cut(address, placeholders);
}

}  // namespace

Result<TileService> tilesOf(const Capabilities& capabilities, const CapabilitiesLayer& layer,
                            const LayerChoices& choices) {
  auto link = chooseLink(capabilities, layer, choices);
  if (!link) {
    return tl::make_unexpected(std::move(link.error()));
  }
  const MatrixSet& set = capabilities.matrixSets[(*link)->set];
  auto url = addressOf(capabilities, layer, choices, set);
  if (!url) {
    return tl::make_unexpected(std::move(url.error()));
  }
  const MapCrs crs = *MapCrs::of(set.crs, capabilities.url);  // chosen because it is known
  TileService service;
  service.where = capabilities.url;
  service.name = layer.title;
  service.crs = crs.definition();
  service.attribution = creditText(layer.attribution.empty() ? capabilities.attribution : layer.attribution);
  const std::vector<TileMatrix> matrices = limited(set, **link);
  const Extent extent = onTurn(extentIn(crs, layer, set.crs), crs, matrices);
  auto placed = setMatrices(service, matrices, extent);
  if (!placed && !set.southOrigin) {
    placed = setMatrices(service, turned(matrices), extent);
  }
  if (!placed) {
    placed.error().what = "the layer '" + layer.title + "' has no tiles within the extent that it declares";
    return tl::make_unexpected(std::move(placed.error()));
  }
  if (set.southOrigin) {
    std::vector<std::int64_t> rowCounts;
    for (const TileMatrix& matrix : service.matrices) {
      rowCounts.push_back(std::llround((matrix.top - *set.southOrigin) / (matrix.tileHeight * matrix.pixelHeight)));
    }
    url->setRowCounts(std::move(rowCounts));
  }
  service.url = TileUrl::bind(std::move(*url), service.matrices);
  return service;
}

}  // namespace meridian::globebrowsing

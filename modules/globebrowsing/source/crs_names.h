#pragma once

#include <cstddef>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace meridian::globebrowsing {

/// The names of the CRSs that maps of a layer can be asked in, as the service spells them, each once. Immutable. What a
/// layer inherits is not copied but shared, for GeoServer lists thousands that a thousand layers inherit; nor is a name
/// looked at more than once.
class CrsNames {
 public:
  CrsNames() = default;
  explicit CrsNames(std::vector<std::string> names) : CrsNames(CrsNames().with(std::move(names))) {}
  /// These and, of `more`, those that are not among them.
  [[nodiscard]] CrsNames with(std::vector<std::string> more) const;

  [[nodiscard]] bool isEmpty() const { return own_ == nullptr; }
  [[nodiscard]] bool contains(const std::string& name) const;
  /// What suits a globe best comes first: CRS:84, EPSG:4326, all others, and EPSG:3857, which ends before the poles;
  /// among those alike what is inherited, and else as they were listed.
  [[nodiscard]] std::vector<std::string> names(std::size_t most = std::numeric_limits<std::size_t>::max()) const;

 private:
  struct Part;
  std::shared_ptr<const Part> own_;  ///< and what it inherits; null: none
};

}  // namespace meridian::globebrowsing

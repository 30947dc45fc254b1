#include "globebrowsing/source/crs_names.h"

#include <algorithm>
#include <array>
#include <unordered_set>

#include "globebrowsing/source/map_crs.h"

namespace meridian::globebrowsing {

namespace {

constexpr std::size_t rankCount = 4;

std::size_t rankOf(const std::string& name) {
  const std::string canonical = canonicalCrsName(name);
  return canonical == "CRS:84" ? 0 : canonical == "EPSG:4326" ? 1 : canonical == "EPSG:3857" ? 3 : 2;
}

}  // namespace

struct CrsNames::Part {
  std::shared_ptr<const Part> inherited;
  std::unordered_set<std::string> names;
  std::array<std::vector<const std::string*>, rankCount> ranked;  ///< of `names`
};

CrsNames CrsNames::with(std::vector<std::string> more) const {
  const auto part = std::make_shared<Part>();
  part->inherited = own_;
  for (std::string& name : more) {
    if (contains(name)) {
      continue;
    }
    if (const auto [place, isNew] = part->names.insert(std::move(name)); isNew) {
      part->ranked[rankOf(*place)].push_back(&*place);
    }
  }
  CrsNames result = *this;
  if (!part->names.empty()) {
    result.own_ = part;
  }
  return result;
}

bool CrsNames::contains(const std::string& name) const {
  const Part* part = own_.get();
  while (part != nullptr && !part->names.contains(name)) {
    part = part->inherited.get();
  }
  return part != nullptr;
}

std::vector<std::string> CrsNames::names(std::size_t most) const {
  std::vector<const Part*> parts;
  for (const Part* part = own_.get(); part != nullptr; part = part->inherited.get()) {
    parts.insert(parts.begin(), part);
  }
  std::vector<std::string> result;
  for (std::size_t rank = 0; rank < rankCount; ++rank) {
    for (const Part* part : parts) {
      for (const std::string* name : part->ranked[rank]) {
        if (result.size() == most) {
          return result;
        }
        result.push_back(*name);
      }
    }
  }
  return result;
}

}  // namespace meridian::globebrowsing

#include "globebrowsing/layers/structure_key.h"

#include <cstdint>

namespace meridian::globebrowsing {

void StructureKey::append(const StructureKey& other) {
  layers_.insert(layers_.end(), other.layers_.begin(), other.layers_.end());
}

std::string StructureKey::text() const {
  std::string text;
  for (const LayerStructure& layer : layers_) {
    text.append(text.empty() ? "" : ";").append(name(layer.group)).append(":").append(name(layer.sampling));
    text.append(",").append(name(layer.blendMode)).append(",").append(name(layer.adjustment));
  }
  return text;
}

}  // namespace meridian::globebrowsing

std::size_t std::hash<meridian::globebrowsing::StructureKey>::operator()(
    const meridian::globebrowsing::StructureKey& key) const noexcept {
  std::uint64_t code = 0xCBF29CE484222325ULL;  // FNV-1a
  for (const meridian::globebrowsing::LayerStructure& layer : key.layers()) {
    for (const unsigned part : {static_cast<unsigned>(layer.group), static_cast<unsigned>(layer.sampling),
                                static_cast<unsigned>(layer.blendMode), static_cast<unsigned>(layer.adjustment)}) {
      code = (code ^ part) * 0x100000001B3ULL;
    }
  }
  return code;
}

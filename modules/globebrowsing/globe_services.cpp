#include "globebrowsing/globe_services.h"

namespace meridian::globebrowsing {

GlobeServices::GlobeServices(PropertyOwner& owner, Statistics& statistics)
    : statistics_(statistics), streamer_(workers_, statistics) {
  owner.addProperty(tileCacheSize);
  owner.addProperty(texturePoolSize);
  owner.addProperty(compositionBudget);
  const auto setBudget = [this] { streamer_.setBudget(static_cast<std::size_t>(tileCacheSize.get()) << 20); };
  setBudget();
  tileCacheSize.onChange(setBudget);
}

void GlobeServices::enterFrame(std::uint64_t frame) {
  if (frame != frame_) {
    streamer_.endFrame();
    streamer_.beginFrame();
    statistics_.chunks = {};
    statistics_.memory.texturePool = 0;
    poolShares_.beginFrame();
    frame_ = frame;
  }
}

}  // namespace meridian::globebrowsing

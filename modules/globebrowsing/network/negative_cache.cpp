#include "globebrowsing/network/negative_cache.h"

namespace meridian::globebrowsing {

void NegativeCache::setLimits(std::chrono::milliseconds lifetime, std::size_t maximumEntries) {
  if (lifetime == lifetime_ && maximumEntries == maximumEntries_) {
    return;
  }
  lifetime_ = lifetime;
  maximumEntries_ = maximumEntries;
  places_.clear();
  entries_.clear();
}

void NegativeCache::add(const std::string& key, int status, TimePoint now) {
  if (lifetime_.count() <= 0 || maximumEntries_ == 0) {
    return;
  }
  if (const auto known = places_.find(key); known != places_.end()) {
    entries_.erase(known->second);
    places_.erase(known);
  }
  while (!entries_.empty() && (entries_.front().end <= now || entries_.size() >= maximumEntries_)) {
    places_.erase(entries_.front().key);
    entries_.pop_front();
  }
  entries_.push_back({key, status, now + lifetime_});
  places_.emplace(key, std::prev(entries_.end()));
}

std::optional<int> NegativeCache::find(const std::string& key, TimePoint now) {
  const auto known = places_.find(key);
  if (known == places_.end() || known->second->end <= now) {
    return std::nullopt;
  }
  return known->second->status;
}

}  // namespace meridian::globebrowsing

#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <optional>
#include <unordered_map>
#include <utility>
#include <vector>

namespace meridian::globebrowsing {

/// Which key lives in which of a fixed number of slots (array layers, vertex ranges). The key that went unused for the
/// longest makes room; one used in the present frame never does. Steady frames allocate nothing.
template <class Key>
class SlotPool {
 public:
  explicit SlotPool(std::uint32_t capacity) : slots_(capacity) { byKey_.reserve(capacity); }

  [[nodiscard]] std::uint32_t capacity() const { return static_cast<std::uint32_t>(slots_.size()); }
  [[nodiscard]] std::size_t used() const { return byKey_.size(); }

  /// The key's slot, without marking it used.
  [[nodiscard]] std::optional<std::uint32_t> peek(const Key& key) const {
    const auto found = byKey_.find(key);
    return found == byKey_.end() ? std::nullopt : std::optional(found->second);
  }

  /// The key's slot, marked as used in that frame; a later mark stays.
  std::optional<std::uint32_t> use(const Key& key, std::uint64_t frame) {
    const auto found = byKey_.find(key);
    if (found == byKey_.end()) {
      return std::nullopt;
    }
    std::uint64_t& lastUsed = slots_[found->second].lastUsed;
    lastUsed = std::max(lastUsed, frame);
    return found->second;
  }

  /// Whether the key has a slot that is marked as used in that frame or later.
  [[nodiscard]] bool isUsed(const Key& key, std::uint64_t frame) const {
    const auto found = byKey_.find(key);
    return found != byKey_.end() && slots_[found->second].lastUsed >= frame;
  }

  /// A slot for a key that has none, taken from the key longest unused, which `evicted` is told. Nothing when every
  /// slot was used in this frame.
  template <class Evicted>
  std::optional<std::uint32_t> take(const Key& key, std::uint64_t frame, Evicted&& evicted) {
    std::uint32_t oldest = 0;
    for (std::uint32_t i = 0; i < capacity(); ++i) {
      if (!slots_[i].occupied) {
        oldest = i;
        break;
      }
      if (slots_[i].lastUsed < slots_[oldest].lastUsed) {
        oldest = i;
      }
    }
    Slot& slot = slots_[oldest];
    if (slot.occupied) {
      if (slot.lastUsed >= frame) {
        return std::nullopt;
      }
      byKey_.erase(slot.key);
      evicted(slot.key);
    }
    slot = {key, frame, true};
    byKey_.emplace(key, oldest);
    return oldest;
  }

  /// Two keys that have slots take each other's.
  void exchange(const Key& a, const Key& b) {
    std::uint32_t& slotOfA = byKey_.at(a);
    std::uint32_t& slotOfB = byKey_.at(b);
    std::swap(slotOfA, slotOfB);
    slots_[slotOfA].key = a;
    slots_[slotOfB].key = b;
  }

  /// Lets every key go for which `gone(key)` holds.
  template <class Predicate>
  void release(Predicate&& gone) {
    for (Slot& slot : slots_) {
      if (slot.occupied && gone(slot.key)) {
        byKey_.erase(slot.key);
        slot = {};
      }
    }
  }

 private:
  struct Slot {
    Key key{};
    std::uint64_t lastUsed = 0;
    bool occupied = false;
  };
  std::vector<Slot> slots_;
  std::unordered_map<Key, std::uint32_t> byKey_;
};

}  // namespace meridian::globebrowsing

#pragma once

#include <chrono>
#include <cstddef>
#include <list>
#include <optional>
#include <string>
#include <unordered_map>

namespace meridian::globebrowsing {

/// Remembers for a while that there is nothing at an address. In memory only, bounded: the oldest are forgotten first.
class NegativeCache {
 public:
  using TimePoint = std::chrono::steady_clock::time_point;

  /// A lifetime of 0 remembers nothing.
  NegativeCache(std::chrono::milliseconds lifetime, std::size_t maximumEntries)
      : lifetime_(lifetime), maximumEntries_(maximumEntries) {}

  /// Forgets everything if one of them is another than before.
  void setLimits(std::chrono::milliseconds lifetime, std::size_t maximumEntries);
  void add(const std::string& key, int status, TimePoint now);
  /// The status that said so, while that still counts.
  [[nodiscard]] std::optional<int> find(const std::string& key, TimePoint now);
  [[nodiscard]] std::size_t size() const { return places_.size(); }

 private:
  struct Entry {
    std::string key;
    int status;
    TimePoint end;
  };

  std::chrono::milliseconds lifetime_;
  std::size_t maximumEntries_;
  std::list<Entry> entries_;  ///< oldest first; all live equally long, so also in the order of their ends
  std::unordered_map<std::string, std::list<Entry>::iterator> places_;
};

}  // namespace meridian::globebrowsing

#pragma once

#include <atomic>
#include <cstdint>

namespace meridian::globebrowsing {

/// What the network has done since it began. Any thread may read; the last four are of this moment.
struct NetworkStatistics {
  using Counter = std::atomic<std::uint64_t>;

  Counter requests{0};      ///< calls of fetch
  Counter joined{0};        ///< of them, answered by what was already under way for another
  Counter cacheHits{0};     ///< answered from disk without asking
  Counter revalidated{0};   ///< answered from disk after the server said that it is still good
  Counter stale{0};         ///< answered from disk past its lifetime because the server could not be asked
  Counter negativeHits{0};  ///< answered "nothing here" without asking
  Counter transfers{0};     ///< sent to servers, tries again included
  Counter retries{0};       ///< of them, tries again
  Counter bytes{0};         ///< of bodies that came from servers, decoded
  Counter connections{0};   ///< opened
  Counter failures{0};      ///< requests that ended in an error
  Counter cancelled{0};
  Counter wakeUps{0};  ///< of the network's thread: to send, to receive, to try again, or because it was told something
  Counter stored{0};   ///< answers written to disk
  Counter evicted{0};  ///< and dropped from it to stay within the budget

  Counter waiting{0};  ///< for their turn, for the cache, or to be tried again
  Counter running{0};  ///< under way to a server
  Counter hostsDown{0};
  Counter cacheBytes{0};
};

}  // namespace meridian::globebrowsing

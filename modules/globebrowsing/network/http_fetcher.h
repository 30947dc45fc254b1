#pragma once

#include <cstdint>
#include <memory>

#include "globebrowsing/network/fetcher.h"
#include "globebrowsing/network/network_options.h"
#include "globebrowsing/network/network_statistics.h"

namespace meridian::globebrowsing {

/// Fetches over HTTP, through a cache on disk (docs/network.md). One thread does all that concerns servers and calls
/// every `done`; another one reads and writes the cache. Both sleep while there is nothing to do.
///
/// Requests for the same thing that are under way at the same time share one transfer.
class HttpFetcher final : public Fetcher {
 public:
  explicit HttpFetcher(NetworkOptions options);
  HttpFetcher(const HttpFetcher&) = delete;
  HttpFetcher& operator=(const HttpFetcher&) = delete;
  /// Cancels everything, then writes what has been accepted. Not from within a `done`.
  ~HttpFetcher() override;

  [[nodiscard]] std::unique_ptr<PendingFetch> fetch(FetchRequest request, Done done) override;
  void accept(const FetchRequest& request, const Fetched& answer) override;
  void reject(const FetchRequest& request) override;

  /// Requests made afterwards heed them; what is under way goes on as it began. The cache stays in its folder, and the
  /// certificates are those of the beginning. From any thread.
  void setOptions(const NetworkOptions& options);
  /// What it goes by: those set last as soon as its thread has seen them. From any thread.
  [[nodiscard]] NetworkOptions options() const;

  /// Waits until everything that was accepted is on disk.
  void drainCache();
  [[nodiscard]] const NetworkStatistics& statistics() const;

 private:
  class Engine;
  std::unique_ptr<Engine> engine_;
};

}  // namespace meridian::globebrowsing

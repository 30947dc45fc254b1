#pragma once

#include <memory>
#include <shared_mutex>

#include "globebrowsing/network/http_fetcher.h"

namespace meridian::globebrowsing {

/// An HttpFetcher that is made when something is fetched for the first time: until then there is no thread, no file and
/// no connection. Whoever owns this ends the network with close(), whoever else still holds it.
class OnDemandFetcher final : public Fetcher {
 public:
  explicit OnDemandFetcher(NetworkOptions options);
  OnDemandFetcher(const OnDemandFetcher&) = delete;
  OnDemandFetcher& operator=(const OnDemandFetcher&) = delete;
  ~OnDemandFetcher() override;

  [[nodiscard]] std::unique_ptr<PendingFetch> fetch(FetchRequest request, Done done) override;
  void accept(const FetchRequest& request, const Fetched& answer) override;
  void reject(const FetchRequest& request) override;

  /// As HttpFetcher's.
  void setOptions(const NetworkOptions& options);
  [[nodiscard]] NetworkOptions options() const;

  [[nodiscard]] bool hasStarted() const;
  /// Cancels everything; what is asked for afterwards stays unanswered. Not from within a `done`.
  void close();

 private:
  /// Calls `use(HttpFetcher&)` if there is one.
  template <class Use>
  void ifStarted(Use use) const;

  mutable std::shared_mutex mutex_;  ///< for `fetcher_` itself: exclusive to make it or to end it
  NetworkOptions options_;
  std::unique_ptr<HttpFetcher> fetcher_;
  bool isClosed_ = false;
};

}  // namespace meridian::globebrowsing

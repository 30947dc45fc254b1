#include "globebrowsing/network/on_demand_fetcher.h"

#include <mutex>
#include <utility>

namespace meridian::globebrowsing {

OnDemandFetcher::OnDemandFetcher(NetworkOptions options) : options_(std::move(options)) {}

OnDemandFetcher::~OnDemandFetcher() = default;

template <class Use>
void OnDemandFetcher::ifStarted(Use use) const {
  const std::shared_lock lock(mutex_);
  if (fetcher_ != nullptr) {
    use(*fetcher_);
  }
}

std::unique_ptr<PendingFetch> OnDemandFetcher::fetch(FetchRequest request, Done done) {
  if (!hasStarted()) {
    const std::lock_guard lock(mutex_);
    if (fetcher_ == nullptr && !isClosed_) {
      fetcher_ = std::make_unique<HttpFetcher>(options_);
    }
  }
  std::unique_ptr<PendingFetch> pending;
  ifStarted([&](HttpFetcher& fetcher) { pending = fetcher.fetch(std::move(request), std::move(done)); });
  class Unanswered final : public PendingFetch {
    void setPriority(double /*priority*/) override {}
  };
  return pending != nullptr ? std::move(pending) : std::make_unique<Unanswered>();
}

void OnDemandFetcher::accept(const FetchRequest& request, const Fetched& answer) {
  ifStarted([&](HttpFetcher& fetcher) { fetcher.accept(request, answer); });
}

void OnDemandFetcher::reject(const FetchRequest& request) {
  ifStarted([&](HttpFetcher& fetcher) { fetcher.reject(request); });
}

void OnDemandFetcher::setOptions(const NetworkOptions& options) {
  const std::lock_guard lock(mutex_);
  setRunningOptions(options_, options);
  if (fetcher_ != nullptr) {
    fetcher_->setOptions(options);
  }
}

NetworkOptions OnDemandFetcher::options() const {
  const std::shared_lock lock(mutex_);
  return fetcher_ != nullptr ? fetcher_->options() : options_;
}

bool OnDemandFetcher::hasStarted() const {
  const std::shared_lock lock(mutex_);
  return fetcher_ != nullptr;
}

void OnDemandFetcher::close() {
  std::unique_ptr<HttpFetcher> ended;  // under no lock: a `done` that runs just now may be about to fetch
  {
    const std::lock_guard lock(mutex_);
    isClosed_ = true;
    ended = std::move(fetcher_);
  }
}

}  // namespace meridian::globebrowsing

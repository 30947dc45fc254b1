#pragma once

#include <algorithm>
#include <condition_variable>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "globebrowsing/network/fetcher.h"

namespace meridian::globebrowsing::test {

/// A fetcher whose server is a function. It answers on a thread of its own, one request after the other, that of
/// greatest priority first, and keeps a ledger.
class FakeFetcher final : public Fetcher {
 public:
  using Server = std::function<Result<Fetched>(const std::string& url)>;

  explicit FakeFetcher(Server server, bool isStalled = false)
      : server_(std::move(server)), isStalled_(isStalled), thread_([this] { serve(); }) {}
  ~FakeFetcher() override {
    {
      const std::lock_guard lock(mutex_);
      isEnding_ = true;
    }
    changed_.notify_all();
    thread_.join();
  }

  std::unique_ptr<PendingFetch> fetch(FetchRequest request, Done done) override {
    const std::lock_guard lock(mutex_);
    auto item = std::make_shared<Item>();
    item->url = request.url;
    item->priority = request.priority;
    item->done = std::move(done);
    items_.push_back(item);
    ++asked_[request.url];
    changed_.notify_all();
    return std::make_unique<Pending>(*this, item);
  }
  void accept(const FetchRequest& request, const Fetched& /*answer*/) override {
    const std::lock_guard lock(mutex_);
    ++accepted_[request.url];
  }
  void reject(const FetchRequest& request) override {
    const std::lock_guard lock(mutex_);
    ++rejected_[request.url];
  }

  /// While stalled, nothing is answered, and each request says so.
  void stall(bool isStalled) {
    const std::lock_guard lock(mutex_);
    isStalled_ = isStalled;
    changed_.notify_all();
  }
  using Ledger = std::map<std::string, int>;
  [[nodiscard]] Ledger asked() const { return locked(asked_); }
  [[nodiscard]] Ledger accepted() const { return locked(accepted_); }
  [[nodiscard]] Ledger rejected() const { return locked(rejected_); }
  /// In the order of answering.
  [[nodiscard]] std::vector<std::string> answered() const { return locked(answered_); }
  /// Waiting requests with their priorities.
  [[nodiscard]] std::map<std::string, double> waiting() const {
    const std::lock_guard lock(mutex_);
    std::map<std::string, double> result;
    for (const auto& item : items_) {
      result[item->url] = item->priority;
    }
    return result;
  }
  void forget() {
    const std::lock_guard lock(mutex_);
    asked_.clear();
    answered_.clear();
  }

 private:
  struct Item {
    std::string url;
    double priority = 0.0;
    Done done;
  };

  class Pending final : public PendingFetch {
   public:
    Pending(FakeFetcher& fetcher, std::shared_ptr<Item> item) : fetcher_(fetcher), item_(std::move(item)) {}
    ~Pending() override {
      std::unique_lock lock(fetcher_.mutex_);
      std::erase(fetcher_.items_, item_);
      if (std::this_thread::get_id() != fetcher_.thread_.get_id()) {
        fetcher_.changed_.wait(lock, [this] { return fetcher_.running_ != item_; });
      }
    }
    void setPriority(double priority) override {
      const std::lock_guard lock(fetcher_.mutex_);
      item_->priority = priority;
    }
    [[nodiscard]] std::optional<Error> lastFailure() const override {
      const std::lock_guard lock(fetcher_.mutex_);
      return fetcher_.isStalled_ ? std::optional(Error{"the server is stalled", item_->url}) : std::nullopt;
    }

   private:
    FakeFetcher& fetcher_;
    std::shared_ptr<Item> item_;
  };

  template <class Value>
  Value locked(const Value& value) const {
    const std::lock_guard lock(mutex_);
    return value;
  }

  void serve() {
    std::unique_lock lock(mutex_);
    while (true) {
      changed_.wait(lock, [this] { return isEnding_ || (!isStalled_ && !items_.empty()); });
      if (isEnding_) {
        return;
      }
      const auto best = std::max_element(items_.begin(), items_.end(),
                                         [](const auto& a, const auto& b) { return a->priority < b->priority; });
      running_ = *best;
      items_.erase(best);
      answered_.push_back(running_->url);
      lock.unlock();
      running_->done(server_(running_->url));
      lock.lock();
      running_.reset();
      changed_.notify_all();
    }
  }

  Server server_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<std::shared_ptr<Item>> items_;
  std::shared_ptr<Item> running_;
  std::vector<std::string> answered_;
  Ledger asked_;
  Ledger accepted_;
  Ledger rejected_;
  bool isStalled_;
  bool isEnding_ = false;
  std::thread thread_;
};

}  // namespace meridian::globebrowsing::test

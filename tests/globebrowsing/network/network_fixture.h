#pragma once

#include <chrono>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <future>
#include <memory>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "globebrowsing/network/http_fetcher.h"

namespace meridian::globebrowsing {

/// A folder that goes with the test.
class TestFolder {
 public:
  TestFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "meridian-network-XXXXXX").string();
    path_ = mkdtemp(name.data());
  }
  TestFolder(const TestFolder&) = delete;
  TestFolder& operator=(const TestFolder&) = delete;
  ~TestFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// As the defaults, but with waits that a test can wait for.
inline NetworkOptions quickOptions() {
  NetworkOptions options;
  options.retry.firstDelay = std::chrono::milliseconds(1);
  options.retry.maximumDelay = std::chrono::milliseconds(5);
  options.retry.firstPause = std::chrono::milliseconds(5);
  options.retry.maximumPause = std::chrono::milliseconds(20);
  return options;
}

inline std::string textOf(const Fetched& fetched) {
  return fetched.body == nullptr ? "(nothing)" : std::string(fetched.body->begin(), fetched.body->end());
}

/// A fetch whose answer can be waited for.
class Asked {
 public:
  Asked(Fetcher& fetcher, FetchRequest request)
      : promise_(std::make_shared<std::promise<Result<Fetched>>>()),
        answer_(promise_->get_future()),
        pending_(fetcher.fetch(std::move(request), [promise = promise_](Result<Fetched> result) {
          promise->set_value(std::move(result));
        })) {}

  [[nodiscard]] bool isThere() const { return answer_.wait_for(std::chrono::seconds(0)) == std::future_status::ready; }
  [[nodiscard]] Result<Fetched> wait() {
    if (answer_.wait_for(std::chrono::seconds(60)) != std::future_status::ready) {
      return failure("no answer within a minute");
    }
    return answer_.get();
  }
  [[nodiscard]] PendingFetch& pending() { return *pending_; }

 private:
  std::shared_ptr<std::promise<Result<Fetched>>> promise_;
  std::future<Result<Fetched>> answer_;
  std::unique_ptr<PendingFetch> pending_;
};

inline Result<Fetched> ask(Fetcher& fetcher, FetchRequest request) {
  return Asked(fetcher, std::move(request)).wait();
}
inline Result<Fetched> askFor(Fetcher& fetcher, std::string url) {
  return ask(fetcher, FetchRequest{.url = std::move(url)});
}

/// Until it is so, or a minute has passed.
template <class Condition>
bool eventually(Condition condition) {
  for (int i = 0; i < 6000; ++i) {
    if (condition()) {
      return true;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return false;
}

}  // namespace meridian::globebrowsing

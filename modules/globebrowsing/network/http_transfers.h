#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <unordered_map>
#include <vector>

#include "globebrowsing/network/cache_policy.h"
#include "globebrowsing/network/network_options.h"
#include "globebrowsing/network/network_statistics.h"
#include "globebrowsing/network/transfer_failure.h"
#include "globebrowsing/network/web_address.h"

namespace meridian::globebrowsing {

/// One request as it is sent.
struct TransferRequest {
  WebAddress address;
  std::vector<std::string> headers{};  ///< "Name: value"
  std::size_t maximumBytes = 0;        ///< of the decoded body
};

/// How it ended. With a status there is an answer, whatever it says; without, `failure` tells why not.
struct TransferEnding {
  std::uint64_t id = 0;
  int status = 0;
  AnswerFacts facts{};               ///< with all header fields of the last answer, after redirects
  std::vector<std::uint8_t> body{};  ///< of a 2xx only
  bool isMultiplexed = false;        ///< the server speaks HTTP/2
  TransferFailure failure{};
};

/// HTTP over one `curl_multi`: sends what it is given at once, under all limits of NetworkOptions but those of
/// concurrency, and says how it ended. For one thread, but for wake().
///
/// curl keeps connections open for the next request to the same host, negotiates HTTP/2 within TLS, decodes content
/// encodings, and reads the usual proxy variables.
class HttpTransfers {
 public:
  /// Both outlive it. Counts transfers, bytes and connections.
  HttpTransfers(const NetworkOptions& options, NetworkStatistics& statistics);
  HttpTransfers(const HttpTransfers&) = delete;
  HttpTransfers& operator=(const HttpTransfers&) = delete;
  /// Breaks off what is under way.
  ~HttpTransfers();

  /// The options have changed: what is started from now on heeds them, what is under way goes on as it began.
  void optionsChanged();
  void start(std::uint64_t id, TransferRequest request);
  /// Its ending is not told.
  void cancel(std::uint64_t id);

  /// Moves everything on, waiting at most so long for something to happen, and appends what has ended.
  void run(std::chrono::milliseconds timeout, std::vector<TransferEnding>& endings);
  /// Makes a run() that waits, or the next one, return early. From any thread.
  void wake();

 private:
  struct Multi;
  struct Transfer;

  void perform(std::vector<TransferEnding>& endings);
  void setConnections();
  [[nodiscard]] TransferEnding endingOf(Transfer& transfer, int code) const;

  const NetworkOptions* options_;
  NetworkStatistics* statistics_;
  std::string userAgent_;
  unsigned generation_ = 0;  ///< of the options: handles of an older one are not used again
  std::unique_ptr<Multi> multi_;
  std::unordered_map<std::uint64_t, std::unique_ptr<Transfer>> transfers_;
  std::vector<TransferEnding> early_;  ///< ended before they began
};

}  // namespace meridian::globebrowsing

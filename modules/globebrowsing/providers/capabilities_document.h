#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "globebrowsing/network/fetcher.h"
#include "globebrowsing/source/capabilities.h"

namespace meridian::globebrowsing {

/// A capabilities document, fetched and read once, however many ask for it. What failed is tried again by the next who
/// asks. Safe from any thread.
class CapabilitiesDocument {
 public:
  /// `url`: to be fetched, or a file. The fetcher may be null for a file.
  CapabilitiesDocument(std::string url, std::shared_ptr<Fetcher> fetcher);
  CapabilitiesDocument(const CapabilitiesDocument&) = delete;
  CapabilitiesDocument& operator=(const CapabilitiesDocument&) = delete;
  ~CapabilitiesDocument();

  [[nodiscard]] const std::string& url() const { return url_; }
  /// Begins the fetch. Returns whether nothing is missing: then capabilities() can be called. If not, `wake` is called
  /// once, from any thread, perhaps before this returns; then prepare again. Blocks for no server; while that is down,
  /// waits until it is back.
  [[nodiscard]] bool prepare(const std::function<void()>& wake);
  /// Reads what was fetched, or the file; another's reading is waited for. Errors: it could not be had, or is of no
  /// use.
  [[nodiscard]] Result<std::shared_ptr<const Capabilities>> capabilities();
  /// Why it is not there yet, if the fetch has failed before and waits to be tried again. Waits for nobody.
  [[nodiscard]] std::optional<Error> lastFailure() const;

 private:
  struct Arrival;
  [[nodiscard]] Result<Capabilities> read();
  [[nodiscard]] Result<Fetched> take();

  const std::string url_;
  const std::shared_ptr<Fetcher> fetcher_;
  FetchRequest request_;
  mutable std::mutex mutex_;  ///< of all that follows; held while reading
  std::shared_ptr<const Capabilities> capabilities_;
  std::shared_ptr<Arrival> arrival_;  ///< null: not fetched
  std::unique_ptr<PendingFetch> fetch_;
  std::optional<Error> error_;  ///< of the last reading, for whoever comes too late for its answer
};

}  // namespace meridian::globebrowsing

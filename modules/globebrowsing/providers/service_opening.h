#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "globebrowsing/network/fetcher.h"
#include "globebrowsing/providers/capabilities_document.h"
#include "globebrowsing/source/service_description.h"

namespace meridian::globebrowsing {

/// What the steps of a series have in common. Safe from any thread.
class SeriesShare {
 public:
  /// Whether nobody has asked before: what holds for all of them is logged once.
  [[nodiscard]] bool isFirstToTell() { return !told_.exchange(true); }
  /// The document at that address: the last one asked for, where it is the same.
  [[nodiscard]] std::shared_ptr<CapabilitiesDocument> documentOf(const std::string& url,
                                                                 const std::shared_ptr<Fetcher>& fetcher);

 private:
  std::atomic<bool> told_{false};
  std::mutex mutex_;
  std::shared_ptr<CapabilitiesDocument> document_;
};

/// Finds out whether the data of a layer are the tiles of a map service, and if so of which: reads the description and
/// has the capabilities fetched that it refers to. One thread at a time, a worker's, but for lastFailure().
class ServiceOpening {
 public:
  /// `filePath`, `where` and `settings` as describeService takes them; `share` of a series.
  ServiceOpening(std::string filePath, std::string where, std::shared_ptr<Fetcher> fetcher,
                 std::shared_ptr<SeriesShare> share, TileSettings settings = {})
      : filePath_(std::move(filePath)),
        where_(std::move(where)),
        fetcher_(std::move(fetcher)),
        share_(std::move(share)),
        settings_(settings) {}
  /// Of a layer of capabilities that are there.
  ServiceOpening(CapabilitiesReference reference, std::shared_ptr<CapabilitiesDocument> document);

  /// Asks for what is missing, without blocking. Returns whether nothing is: then service() can be called. If not,
  /// `wake` is called once, from any thread, perhaps before this returns; then prepare again.
  [[nodiscard]] bool prepare(const std::function<void()>& wake);

  /// The service; nothing: the data are GDAL's business. Errors: in the description; capabilities that could not be had
  /// or are of no use.
  [[nodiscard]] Result<std::optional<TileService>> service();
  /// The layer of capabilities that the data are; nothing where they are something else. Errors: in the description.
  [[nodiscard]] Result<std::optional<CapabilitiesReference>> reference();
  /// Of a reference: what it refers to.
  [[nodiscard]] const std::shared_ptr<CapabilitiesDocument>& document() const { return document_; }
  /// Why capabilities are waited for, if they are. From any thread.
  [[nodiscard]] std::optional<Error> lastFailure() const;
  /// Where the data are GDAL's business: why.
  [[nodiscard]] std::string reason() const;
  /// Gives up what it has read, once the service is known.
  void end();
  /// What the description says and is not heeded, for the log.
  [[nodiscard]] std::vector<std::string> notes() const;

 private:
  const Result<ServiceDescription>& describe();

  std::string filePath_;
  std::string where_;
  std::shared_ptr<Fetcher> fetcher_;
  std::shared_ptr<SeriesShare> share_;
  TileSettings settings_;
  std::optional<Result<ServiceDescription>> description_;
  mutable std::mutex mutex_;  ///< of document_'s changes, and of reading it elsewhere
  std::shared_ptr<CapabilitiesDocument> document_;
};

}  // namespace meridian::globebrowsing

#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "globebrowsing/network/fetcher.h"
#include "globebrowsing/source/service_description.h"

namespace meridian::globebrowsing {

/// Finds out whether the data of a layer are the tiles of a map service, and if so of which: reads the description and
/// has the capabilities fetched that it refers to. One thread at a time, a worker's.
class ServiceOpening {
 public:
  /// `filePath` and `where` as describeService takes them.
  ServiceOpening(std::string filePath, std::string where, std::shared_ptr<Fetcher> fetcher)
      : filePath_(std::move(filePath)), where_(std::move(where)), fetcher_(std::move(fetcher)) {}

  /// Asks for what is missing, without blocking. Returns whether nothing is: then service() can be called. If not,
  /// `wake` is called once, from any thread, perhaps before this returns; then prepare again.
  [[nodiscard]] bool prepare(const std::function<void()>& wake);

  /// The service; nothing: the data are GDAL's business. Errors: in the description; capabilities that could not be had
  /// (at once where their server is down) or are of no use.
  [[nodiscard]] Result<std::optional<TileService>> service();
  /// What the description says and is not heeded, for the log.
  [[nodiscard]] std::vector<std::string> notes() const;

 private:
  struct Document;
  [[nodiscard]] Result<Fetched> read(const std::string& url) const;

  std::string filePath_;
  std::string where_;
  std::shared_ptr<Fetcher> fetcher_;
  std::optional<Result<ServiceDescription>> description_;
  std::shared_ptr<Document> document_;
  FetchRequest request_;
  std::unique_ptr<PendingFetch> fetch_;
};

}  // namespace meridian::globebrowsing

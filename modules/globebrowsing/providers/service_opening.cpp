#include "globebrowsing/providers/service_opening.h"

#include <mutex>
#include <utility>
#include <vector>

#include "globebrowsing/source/capabilities.h"
#include "globebrowsing/source/document_file.h"

namespace meridian::globebrowsing {

namespace {

/// Before every tile: without it there is none.
constexpr double documentPriority = 1e9;

}  // namespace

/// What the fetcher's thread brings. It outlives the opening where that is given up.
struct ServiceOpening::Document {
  std::mutex mutex;
  std::optional<Result<Fetched>> answer;

  [[nodiscard]] bool isThere() {
    const std::lock_guard lock(mutex);
    return answer.has_value();
  }
};

bool ServiceOpening::prepare(const std::function<void()>& wake) {
  if (!description_) {
    description_ = describeService(filePath_, where_);
  }
  if (!*description_ || !(*description_)->reference || !isWebAddress((*description_)->reference->url)) {
    return true;
  }
  if (document_ != nullptr) {
    return document_->isThere();
  }
  document_ = std::make_shared<Document>();
  request_.url = (*description_)->reference->url;
  request_.priority = documentPriority;
  request_.maximumBytes = largestDocument;
  request_.emptyStatuses = {};
  request_.isPatient = false;
  fetch_ = fetcher_->fetch(request_, [document = document_, wake](Result<Fetched> answer) {
    {
      const std::lock_guard lock(document->mutex);
      document->answer = std::move(answer);
    }
    wake();
  });
  return false;
}

Result<std::optional<TileService>> ServiceOpening::service() {
  if (!description_) {
    description_ = describeService(filePath_, where_);
  }
  if (!*description_) {
    return tl::make_unexpected(description_->error());
  }
  ServiceDescription& description = **description_;
  if (!description.reference) {
    return std::move(description.service);
  }
  const CapabilitiesReference& reference = *description.reference;
  const Result<Fetched> document = read(reference.url);
  if (!document) {
    return tl::make_unexpected(document.error());
  }
  const Result<Capabilities> capabilities = parseCapabilities(*document->body, reference.url);
  if (!capabilities) {
    return tl::make_unexpected(capabilities.error());
  }
  if (document_ != nullptr) {
    fetcher_->accept(request_, *document);
  }
  return serviceOf(reference, *capabilities).map([](TileService service) {
    return std::optional<TileService>(std::move(service));
  });
}

Result<Fetched> ServiceOpening::read(const std::string& url) const {
  if (document_ != nullptr) {
    const std::lock_guard lock(document_->mutex);
    if (!document_->answer) {
      return failure("the capabilities have not arrived", url);
    }
    if (*document_->answer && (*document_->answer)->body == nullptr) {
      return failure("there are no capabilities at that address", url, "check the address");
    }
    return *document_->answer;
  }
  if (isWebAddress(url)) {
    return failure("the capabilities have to be fetched, which nobody waits for here", url);
  }
  return readDocumentFile(url);
}

std::vector<std::string> ServiceOpening::notes() const {
  return description_ && *description_ ? (*description_)->notes : std::vector<std::string>();
}

}  // namespace meridian::globebrowsing

#include "globebrowsing/providers/capabilities_document.h"

#include <optional>
#include <utility>
#include <vector>

#include "globebrowsing/source/document_file.h"

namespace meridian::globebrowsing {

namespace {

/// Before every tile: without it there is none.
constexpr double documentPriority = 1e9;

}  // namespace

/// What the fetcher's thread brings. It outlives the document where that is given up.
struct CapabilitiesDocument::Arrival {
  std::mutex mutex;
  std::optional<Result<Fetched>> answer;
  std::vector<std::function<void()>> waiting;

  /// Whether it is there; if not, whoever asks is woken.
  [[nodiscard]] bool isThere(const std::function<void()>& wake) {
    const std::lock_guard lock(mutex);
    if (!answer) {
      waiting.push_back(wake);
    }
    return answer.has_value();
  }
  void put(Result<Fetched> found) {
    std::vector<std::function<void()>> woken;
    {
      const std::lock_guard lock(mutex);
      answer = std::move(found);
      woken.swap(waiting);
    }
    for (const std::function<void()>& wake : woken) {
      wake();
    }
  }
};

CapabilitiesDocument::CapabilitiesDocument(std::string url, std::shared_ptr<Fetcher> fetcher)
    : url_(std::move(url)), fetcher_(std::move(fetcher)) {
  request_.url = url_;
  request_.priority = documentPriority;
  request_.maximumBytes = largestDocument;
  request_.emptyStatuses = {};
}

CapabilitiesDocument::~CapabilitiesDocument() = default;

bool CapabilitiesDocument::prepare(const std::function<void()>& wake) {
  const std::lock_guard lock(mutex_);
  if (capabilities_ != nullptr || !isWebAddress(url_) || fetcher_ == nullptr) {
    return true;
  }
  if (arrival_ != nullptr) {
    return arrival_->isThere(wake);
  }
  arrival_ = std::make_shared<Arrival>();
  arrival_->waiting.push_back(wake);
  // Only the arrival's own lock is taken by what the fetcher calls, so a former fetch may end under this one.
  fetch_ = fetcher_->fetch(request_, [arrival = arrival_](Result<Fetched> answer) { arrival->put(std::move(answer)); });
  return false;
}

Result<std::shared_ptr<const Capabilities>> CapabilitiesDocument::capabilities() {
  const std::lock_guard lock(mutex_);
  if (capabilities_ != nullptr) {
    return capabilities_;
  }
  Result<Capabilities> found = read();
  if (!found) {
    error_ = found.error();
    return tl::make_unexpected(std::move(found.error()));
  }
  capabilities_ = std::make_shared<const Capabilities>(std::move(*found));
  return capabilities_;
}

std::optional<Error> CapabilitiesDocument::lastFailure() const {
  const std::unique_lock lock(mutex_, std::try_to_lock);
  return lock && fetch_ != nullptr ? fetch_->lastFailure() : std::nullopt;
}

Result<Capabilities> CapabilitiesDocument::read() {
  const Result<Fetched> document = take();
  if (!document) {
    return tl::make_unexpected(document.error());
  }
  Result<Capabilities> found = parseCapabilities(*document->body, url_);
  if (found && isWebAddress(url_)) {
    fetcher_->accept(request_, *document);
  }
  return found;
}

Result<Fetched> CapabilitiesDocument::take() {
  if (!isWebAddress(url_)) {
    return readDocumentFile(url_);
  }
  const std::shared_ptr<Arrival> arrival = std::exchange(arrival_, nullptr);
  if (arrival == nullptr) {
    return error_ ? tl::make_unexpected(*error_) : failure("the capabilities have not been fetched", url_);
  }
  const std::lock_guard lock(arrival->mutex);
  if (!arrival->answer) {
    arrival_ = arrival;
    return error_ ? tl::make_unexpected(*error_) : failure("the capabilities have not arrived", url_);
  }
  if (*arrival->answer && (*arrival->answer)->body == nullptr) {
    return failure("there are no capabilities at that address", url_, "check the address");
  }
  return *arrival->answer;
}

}  // namespace meridian::globebrowsing

#include "globebrowsing/providers/service_opening.h"

#include <utility>

#include "globebrowsing/source/capabilities.h"

namespace meridian::globebrowsing {

std::shared_ptr<CapabilitiesDocument> SeriesShare::documentOf(const std::string& url,
                                                              const std::shared_ptr<Fetcher>& fetcher) {
  const std::lock_guard lock(mutex_);
  if (document_ == nullptr || document_->url() != url) {
    document_ = std::make_shared<CapabilitiesDocument>(url, fetcher);
  }
  return document_;
}

ServiceOpening::ServiceOpening(CapabilitiesReference reference, std::shared_ptr<CapabilitiesDocument> document)
    : document_(std::move(document)) {
  ServiceDescription description;
  description.reference = std::move(reference);
  description_ = std::move(description);
}

const Result<ServiceDescription>& ServiceOpening::describe() {
  if (!description_) {
    description_ = describeService(filePath_, where_, settings_);
    if (*description_ && (*description_)->reference) {
      const std::string& url = (*description_)->reference->url;
      const std::lock_guard lock(mutex_);
      document_ = share_ ? share_->documentOf(url, fetcher_) : std::make_shared<CapabilitiesDocument>(url, fetcher_);
    }
  }
  return *description_;
}

bool ServiceOpening::prepare(const std::function<void()>& wake) {
  describe();
  return document_ == nullptr || document_->prepare(wake);
}

Result<std::optional<TileService>> ServiceOpening::service() {
  const Result<ServiceDescription>& description = describe();
  if (!description) {
    return tl::make_unexpected(description.error());
  }
  if (!description->reference) {
    return description->service;
  }
  return document_->capabilities().and_then([&](const std::shared_ptr<const Capabilities>& capabilities) {
    return serviceOf(*description->reference, *capabilities).map([](TileService service) {
      return std::optional<TileService>(std::move(service));
    });
  });
}

Result<std::optional<CapabilitiesReference>> ServiceOpening::reference() {
  return describe().map([](const ServiceDescription& description) { return description.reference; });
}

std::optional<Error> ServiceOpening::lastFailure() const {
  const std::lock_guard lock(mutex_);
  return document_ != nullptr ? document_->lastFailure() : std::nullopt;
}

void ServiceOpening::end() {
  description_.reset();
  const std::lock_guard lock(mutex_);
  document_.reset();
}

std::string ServiceOpening::reason() const {
  return description_ && *description_ ? (*description_)->reason : std::string();
}

std::vector<std::string> ServiceOpening::notes() const {
  return description_ && *description_ ? (*description_)->notes : std::vector<std::string>();
}

}  // namespace meridian::globebrowsing

#include "globebrowsing/network/http_flight.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace meridian::globebrowsing {

double orderable(double priority) {
  return std::isnan(priority) ? -std::numeric_limits<double>::infinity() : priority;
}

double greatestPriority(const Flight& flight) {
  double greatest = -std::numeric_limits<double>::infinity();
  for (const auto& waiter : flight.waiters) {
    greatest = std::max(greatest, waiter->priority.load());
  }
  return greatest;
}

std::string cacheKey(const WebAddress& address, const FetchRequest& request) {
  std::string key = address.url;
  for (const std::string& header : request.headers) {
    key += '\n' + header;
  }
  return key;
}

std::string identityOf(const std::string& key, const FetchRequest& request) {
  std::string identity = key + '\n' + (request.maximumBytes ? std::to_string(*request.maximumBytes) : "-") +
                         (request.isPatient ? "" : " !");
  for (const int status : request.emptyStatuses) {
    identity += ' ' + std::to_string(status);
  }
  return identity;
}

bool isEmptyStatus(const FetchRequest& request, int status) {
  return status == nothingHere ||
         std::find(request.emptyStatuses.begin(), request.emptyStatuses.end(), status) != request.emptyStatuses.end();
}

std::string contentTypeOf(const AnswerFacts& facts) {
  return std::string(facts.fields.find("Content-Type").value_or(""));
}

Fetched fetchedFromCache(const CachedAnswer& kept, bool isStale) {
  return {.contentType = contentTypeOf(kept.facts), .body = kept.body, .isFromCache = true, .isStale = isStale};
}

}  // namespace meridian::globebrowsing

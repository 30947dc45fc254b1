#include "globebrowsing/network/http_flight.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace meridian::globebrowsing {

std::pair<Flights::Id, bool> Flights::join(std::string identity, const std::shared_ptr<Waiter>& waiter) {
  const auto [place, isNew] = byIdentity_.try_emplace(std::move(identity), lastId_ + 1);
  const Id id = place->second;
  Flight& flight = byId_[id];
  if (isNew) {
    ++lastId_;
    flight.identity = place->first;
  }
  flight.waiters.push_back(waiter);
  waiter->flight = id;
  return {id, isNew};
}

Flight* Flights::find(Id id) {
  const auto place = byId_.find(id);
  return place == byId_.end() ? nullptr : &place->second;
}

Flight Flights::take(Id id) {
  const auto place = byId_.find(id);
  Flight flight = std::move(place->second);
  byId_.erase(place);
  byIdentity_.erase(flight.identity);
  return flight;
}

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

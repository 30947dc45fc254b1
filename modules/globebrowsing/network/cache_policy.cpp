#include "globebrowsing/network/cache_policy.h"

#include <algorithm>
#include <array>
#include <optional>

#include <curl/curl.h>

namespace meridian::globebrowsing {

namespace {

/// RFC 9111, section 1.2.2: a number too great to hold is taken as this one.
constexpr std::int64_t greatestDelta = 2147483648;

/// Non-negative seconds; nothing for any other text.
std::optional<std::int64_t> parseDelta(std::string_view text) {
  if (text.size() >= 2 && text.front() == '"' && text.back() == '"') {
    text = text.substr(1, text.size() - 2);
  }
  if (text.empty()) {
    return std::nullopt;
  }
  std::int64_t seconds = 0;
  for (const char digit : text) {
    if (digit < '0' || digit > '9') {
      return std::nullopt;
    }
    seconds = std::min(seconds * 10 + (digit - '0'), greatestDelta);
  }
  return seconds;
}

struct CacheControl {
  bool noStore = false;
  bool noCache = false;
  bool mustRevalidate = false;
  std::optional<std::int64_t> maxAge;
  std::optional<std::int64_t> staleIfError;
};

/// The next member of a comma-separated list, with commas in quotes left alone; shortens `rest`.
std::string_view takeMember(std::string_view& rest) {
  bool quoted = false;
  std::size_t end = 0;
  for (; end < rest.size() && (quoted || rest[end] != ','); ++end) {
    quoted = rest[end] == '"' ? !quoted : quoted;
  }
  const std::string_view member = trimmed(rest.substr(0, end));
  rest.remove_prefix(std::min(end + 1, rest.size()));
  return member;
}

CacheControl cacheControlOf(const HeaderFields& fields) {
  CacheControl control;
  const std::string list = fields.list("Cache-Control");
  for (std::string_view rest = list; !rest.empty();) {
    const std::string_view directive = takeMember(rest);
    const std::size_t equals = std::min(directive.find('='), directive.size());
    const std::string_view name = trimmed(directive.substr(0, equals));
    const std::string_view value = trimmed(directive.substr(std::min(equals + 1, directive.size())));
    if (equalIgnoringCase(name, "no-store")) {
      control.noStore = true;
    } else if (equalIgnoringCase(name, "no-cache")) {
      // With field names it would only mean those fields; asking is always allowed.
      control.noCache = true;
    } else if (equalIgnoringCase(name, "must-revalidate")) {
      control.mustRevalidate = true;
    } else if (equalIgnoringCase(name, "max-age") && !control.maxAge) {
      control.maxAge = parseDelta(value).value_or(0);
    } else if (equalIgnoringCase(name, "stale-if-error") && !control.staleIfError) {
      control.staleIfError = parseDelta(value).value_or(0);
    }
  }
  return control;
}

std::optional<UnixTime> dateIn(const HeaderFields& fields, std::string_view name) {
  const auto text = fields.find(name);
  return text ? parseHttpDate(*text) : std::nullopt;
}

}  // namespace

std::optional<UnixTime> parseHttpDate(std::string_view text) {
  // curl_getdate also takes bare numbers ("0" as Expires), which are no dates.
  if (trimmed(text).size() < 16) {
    return std::nullopt;
  }
  const time_t time = curl_getdate(std::string(text).c_str(), nullptr);
  return time == -1 ? std::nullopt : std::optional<UnixTime>(time);
}

bool isStorable(int status, const HeaderFields& fields) {
  return status == 200 && !cacheControlOf(fields).noStore && fields.list("Vary").find('*') == std::string::npos;
}

std::int64_t freshnessLifetime(const AnswerFacts& facts, const CacheRules& rules) {
  if (const auto maxAge = cacheControlOf(facts.fields).maxAge) {
    return *maxAge;
  }
  const UnixTime date = dateIn(facts.fields, "Date").value_or(facts.responseTime);
  if (facts.fields.find("Expires")) {
    return std::max<std::int64_t>(dateIn(facts.fields, "Expires").value_or(date) - date, 0);
  }
  if (const auto modified = dateIn(facts.fields, "Last-Modified")) {
    const double unchanged = static_cast<double>(std::max<std::int64_t>(date - *modified, 0));
    return std::min<std::int64_t>(static_cast<std::int64_t>(unchanged * rules.heuristicFraction),
                                  rules.maximumHeuristic.count());
  }
  return rules.defaultLifetime.count();
}

std::int64_t currentAge(const AnswerFacts& facts, UnixTime now) {
  const UnixTime date = dateIn(facts.fields, "Date").value_or(facts.responseTime);
  const std::int64_t apparent = std::max<std::int64_t>(facts.responseTime - date, 0);
  const std::int64_t told = parseDelta(facts.fields.find("Age").value_or("0")).value_or(0);
  const std::int64_t delay = std::max<std::int64_t>(facts.responseTime - facts.requestTime, 0);
  // A clock that was put back makes nothing younger than it was.
  const std::int64_t resident = std::max<std::int64_t>(now - facts.responseTime, 0);
  return std::max(apparent, told + delay) + resident;
}

bool isFresh(const AnswerFacts& facts, const CacheRules& rules, UnixTime now) {
  return !cacheControlOf(facts.fields).noCache && currentAge(facts, now) < freshnessLifetime(facts, rules);
}

bool mayServeStale(const AnswerFacts& facts, const CacheRules& rules, UnixTime now) {
  const CacheControl control = cacheControlOf(facts.fields);
  if (control.noCache || control.mustRevalidate) {
    return false;
  }
  const std::int64_t staleness = currentAge(facts, now) - freshnessLifetime(facts, rules);
  return staleness <= control.staleIfError.value_or(rules.staleIfError.count());
}

std::vector<std::string> conditionalHeaders(const AnswerFacts& facts) {
  std::vector<std::string> headers;
  if (const auto tag = facts.fields.find("ETag"); tag && !tag->empty()) {
    headers.push_back("If-None-Match: " + std::string(*tag));
  }
  if (const auto date = facts.fields.find("Last-Modified"); date && parseHttpDate(*date)) {
    headers.push_back("If-Modified-Since: " + std::string(*date));
  }
  return headers;
}

AnswerFacts refreshed(const AnswerFacts& kept, const AnswerFacts& of304) {
  AnswerFacts facts{kept.fields, of304.requestTime, of304.responseTime};
  // An Age or a Date that the 304 does not repeat would be counted from its own time.
  facts.fields.remove("Age");
  facts.fields.remove("Date");
  const HeaderFields renewed = relevantFields(of304.fields);
  for (const auto& [name, value] : renewed.all()) {
    // What the body is has not changed; some servers say text/html of their empty 304.
    if (!equalIgnoringCase(name, "Content-Type")) {
      facts.fields.remove(name);
    }
  }
  for (const auto& [name, value] : renewed.all()) {
    if (!equalIgnoringCase(name, "Content-Type")) {
      facts.fields.add(name, value);
    }
  }
  return facts;
}

HeaderFields relevantFields(const HeaderFields& fields) {
  constexpr std::array<std::string_view, 8> names{"Age",  "Cache-Control", "Content-Type",  "Date",
                                                  "ETag", "Expires",       "Last-Modified", "Vary"};
  HeaderFields relevant;
  for (const auto& [name, value] : fields.all()) {
    if (std::any_of(names.begin(), names.end(),
                    [&name = name](std::string_view known) { return equalIgnoringCase(known, name); })) {
      relevant.add(name, value);
    }
  }
  return relevant;
}

}  // namespace meridian::globebrowsing

#include "globebrowsing/source/service_text.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <limits>
#include <system_error>

#include <fmt/format.h>

namespace meridian::globebrowsing {

namespace {

char lower(char c) {
  return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

bool isUnreserved(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' || c == '.' ||
         c == '_' || c == '~';
}

/// Where the path of "scheme://host/path" begins; 0 where there is no scheme.
std::size_t pathBegin(std::string_view url) {
  const std::size_t scheme = url.find("://");
  if (scheme == std::string_view::npos) {
    return 0;
  }
  return std::min(url.find_first_of("/?#", scheme + 3), url.size());
}

/// Segments "." and ".." of the path carried out (RFC 3986, section 5.2.4); those that lead out of a relative path
/// stay.
std::string withoutDots(std::string_view url) {
  const std::size_t begin = pathBegin(url);
  const std::size_t end = std::min(url.find_first_of("?#", begin), url.size());
  const bool isAbsolute = url.substr(begin, 1) == "/";
  std::vector<std::string_view> kept;
  for (std::size_t at = begin + (isAbsolute ? 1 : 0); at <= end;) {
    const std::size_t next = std::min(url.find('/', at), end);
    const std::string_view segment = url.substr(at, next - at);
    const bool isUpward = segment == "..";
    if (isUpward && !kept.empty() && kept.back() != "..") {
      kept.pop_back();
    } else if (isUpward ? !isAbsolute : segment != ".") {
      kept.push_back(segment);
    }
    if (next == end && (isUpward || segment == ".")) {
      kept.emplace_back();  // a folder
    }
    at = next + 1;
  }
  std::string result(url.substr(0, begin));
  const char* separator = isAbsolute ? "/" : "";
  for (const std::string_view segment : kept) {
    result.append(separator).append(segment);
    separator = "/";
  }
  return result.append(url.substr(end));
}

}  // namespace

std::string lowerCase(std::string_view text) {
  std::string result(text);
  std::transform(result.begin(), result.end(), result.begin(), lower);
  return result;
}

bool containsIgnoringCase(std::string_view text, std::string_view part) {
  return std::search(text.begin(), text.end(), part.begin(), part.end(),
                     [](char x, char y) { return lower(x) == lower(y); }) != text.end();
}

std::vector<std::string> split(std::string_view text, std::string_view separators) {
  std::vector<std::string> parts;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find_first_of(separators), text.size());
    if (const std::string_view part = trimmed(text.substr(0, end)); !part.empty()) {
      parts.emplace_back(part);
    }
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return parts;
}

std::string creditText(std::string_view text) {
  std::string plain;
  for (std::size_t at = 0; at < text.size(); ++at) {
    const bool mayBeTag = text[at] == '<' && at + 1 < text.size() &&
                          (text[at + 1] == '/' || std::isalpha(static_cast<unsigned char>(text[at + 1])) != 0);
    if (const std::size_t end = mayBeTag ? text.find('>', at) : std::string_view::npos; end != std::string_view::npos) {
      plain += ' ';
      at = end;
    } else {
      plain += text[at];
    }
  }
  std::string line;
  for (const std::string& word : split(plain, " \t\r\n")) {
    line.append(line.empty() ? "" : " ").append(word);
  }
  return line;
}

std::string replaceAll(std::string text, std::string_view from, std::string_view to) {
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size())) {
    text.replace(at, from.size(), to);
  }
  return text;
}

std::optional<double> number(std::string_view text) {
  text = trimmed(text);
  if (text.starts_with('+')) {
    text.remove_prefix(1);
  }
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) {
    return std::nullopt;
  }
  return value;
}

std::optional<long long> integer(std::string_view text) {
  const std::optional<double> value = number(text);
  if (!value || *value != std::floor(*value) || std::abs(*value) > 1e15) {
    return std::nullopt;
  }
  return static_cast<long long>(*value);
}

std::optional<bool> boolean(std::string_view text) {
  const std::string word = lowerCase(trimmed(text));
  if (word == "true" || word == "1" || word == "yes" || word == "on") {
    return true;
  }
  if (word == "false" || word == "0" || word == "no" || word == "off") {
    return false;
  }
  return std::nullopt;
}

std::string decimal(double value) {
  std::string text = fmt::format("{:.10f}", value);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') {
    text.pop_back();
  }
  return text == "-0" ? "0" : text;
}

std::string percentEncoded(std::string_view text, std::string_view kept) {
  std::string result;
  result.reserve(text.size());
  for (const char c : text) {
    if (isUnreserved(c) || kept.find(c) != std::string_view::npos) {
      result.push_back(c);
    } else {
      result += fmt::format("%{:02X}", static_cast<unsigned char>(c));
    }
  }
  return result;
}

std::string percentDecoded(std::string_view text) {
  std::string result;
  result.reserve(text.size());
  while (!text.empty()) {
    unsigned value = 0;
    const std::string_view digits = text.substr(1, 2);
    if (text.front() == '%' && digits.size() == 2 &&
        std::from_chars(digits.data(), digits.data() + 2, value, 16).ptr == digits.data() + 2) {
      result.push_back(static_cast<char>(value));
      text.remove_prefix(3);
    } else {
      result.push_back(text.front());
      text.remove_prefix(1);
    }
  }
  return result;
}

std::string withParameters(std::string_view url, const QueryParameters& parameters) {
  const std::size_t fragment = std::min(url.find('#'), url.size());
  url = url.substr(0, fragment);
  const std::size_t question = std::min(url.find('?'), url.size());
  std::string result(url.substr(0, question));
  char separator = '?';
  for (const std::string& part : split(url.substr(std::min(question + 1, url.size())), "&")) {
    const std::string_view name = std::string_view(part).substr(0, part.find('='));
    const bool isReplaced = std::any_of(parameters.begin(), parameters.end(), [&](const auto& parameter) {
      return equalIgnoringCase(parameter.first, name);
    });
    if (!isReplaced && part != "?") {
      result += separator;
      result += part;
      separator = '&';
    }
  }
  for (const auto& [name, value] : parameters) {
    result += separator;
    result += name;
    result += '=';
    result += value;
    separator = '&';
  }
  return result;
}

std::optional<std::string> parameterOf(std::string_view url, std::string_view name) {
  const std::size_t question = url.find('?');
  if (question == std::string_view::npos) {
    return std::nullopt;
  }
  for (const std::string& part : split(url.substr(question + 1, url.find('#') - question - 1), "&")) {
    const std::size_t equals = part.find('=');
    if (equalIgnoringCase(part.substr(0, equals), name)) {
      return equals == std::string::npos ? std::string() : part.substr(equals + 1);
    }
  }
  return std::nullopt;
}

bool isGetMapParameter(std::string_view name) {
  static constexpr std::array<std::string_view, 12> own{"service", "version", "request", "layers",
                                                        "styles",  "crs",     "srs",     "bbox",
                                                        "width",   "height",  "format",  "transparent"};
  return std::find(own.begin(), own.end(), lowerCase(name)) != own.end();
}

std::string withoutQuery(std::string_view url) {
  return std::string(url.substr(0, url.find_first_of("?#")));
}

std::string resolvedUrl(std::string_view base, std::string_view reference) {
  reference = trimmed(reference);
  if (reference.empty()) {
    return std::string(base.substr(0, base.find('#')));
  }
  const std::size_t scheme = reference.find("://");
  if (scheme != std::string_view::npos && scheme < reference.find_first_of("/?#")) {
    return withoutDots(reference);
  }
  std::string before = withoutQuery(base);  // what stands before the reference
  const std::size_t path = pathBegin(before);
  if (reference.starts_with("//")) {
    const std::size_t colon = before.find("://");
    before = colon == std::string::npos ? "http:" : before.substr(0, colon + 1);
  } else if (reference.front() == '/') {
    before.resize(path);
  } else if (reference.front() != '?') {
    const std::size_t slash = before.rfind('/');
    const bool hasFolder = slash != std::string::npos && slash >= path;
    before.resize(hasFolder ? slash + 1 : path);
    before += !hasFolder && path > 0 ? "/" : "";
  }
  return withoutDots(before.append(reference));
}

std::string repairedUrl(std::string_view url) {
  std::string result(trimmed(url));
  for (const std::string_view scheme : {std::string_view("http:/"), std::string_view("https:/")}) {
    if (lowerCase(result.substr(0, scheme.size())) == scheme && result.substr(scheme.size(), 1) != "/") {
      result.insert(scheme.size(), "/");
    }
  }
  return result;
}

}  // namespace meridian::globebrowsing

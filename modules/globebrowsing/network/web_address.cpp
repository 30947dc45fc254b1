#include "globebrowsing/network/web_address.h"

#include <algorithm>
#include <memory>

#include <curl/curl.h>

namespace meridian::globebrowsing {

namespace {

struct FreeUrl {
  void operator()(CURLU* url) const { curl_url_cleanup(url); }
};

std::string partOf(CURLU* url, CURLUPart part, unsigned flags = 0) {
  char* text = nullptr;
  if (curl_url_get(url, part, &text, flags) != CURLUE_OK) {
    return {};
  }
  std::string copy = text;
  curl_free(text);
  return copy;
}

}  // namespace

Result<WebAddress> parseWebAddress(const std::string& url) {
  constexpr const char* remedy = "give an address such as https://example.org/tiles/0/0/0.png";
  const auto isControl = [](char letter) { return static_cast<unsigned char>(letter) < 32 || letter == 127; };
  if (std::any_of(url.begin(), url.end(), isControl)) {
    return failure("the address holds control characters", url, remedy);
  }
  const std::unique_ptr<CURLU, FreeUrl> parsed(curl_url());
  if (!parsed) {
    return failure("out of memory", url);
  }
  constexpr unsigned flags = CURLU_URLENCODE | CURLU_NON_SUPPORT_SCHEME;
  if (const CURLUcode code = curl_url_set(parsed.get(), CURLUPART_URL, url.c_str(), flags); code != CURLUE_OK) {
    return failure(std::string("this is no address: ") + curl_url_strerror(code), url, remedy);
  }
  const std::string scheme = partOf(parsed.get(), CURLUPART_SCHEME);
  if (scheme != "http" && scheme != "https") {
    return failure("only http and https are asked for, not \"" + scheme + "\"", url, remedy);
  }
  curl_url_set(parsed.get(), CURLUPART_FRAGMENT, nullptr, 0);
  WebAddress address;
  address.isEncrypted = scheme == "https";
  address.url = partOf(parsed.get(), CURLUPART_URL);
  const std::string name = partOf(parsed.get(), CURLUPART_HOST);
  if (name.empty() || address.url.empty()) {
    return failure("the address names no server", url, remedy);
  }
  address.host = scheme + "://" + name + ":" + partOf(parsed.get(), CURLUPART_PORT, CURLU_DEFAULT_PORT);
  return address;
}

}  // namespace meridian::globebrowsing

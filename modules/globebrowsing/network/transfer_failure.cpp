#include "globebrowsing/network/transfer_failure.h"

#include <string_view>
#include <utility>

#include <curl/curl.h>

namespace meridian::globebrowsing {

namespace {

struct Explanation {
  Outcome outcome;
  const char* what;
  const char* remedy;
};

Explanation explain(CURLcode code) {
  switch (code) {
    case CURLE_COULDNT_RESOLVE_HOST:
    case CURLE_COULDNT_RESOLVE_PROXY:
      return {Outcome::Unreachable, "the server's name is not known", "check the address and the network"};
    case CURLE_COULDNT_CONNECT:
      return {Outcome::Unreachable, "the server takes no connection", "check the network, or wait until it is back"};
    case CURLE_OPERATION_TIMEDOUT:
      return {Outcome::Unreachable, "the server takes too long to answer", "check the network, or wait"};
    case CURLE_GOT_NOTHING:
    case CURLE_SEND_ERROR:
    case CURLE_RECV_ERROR:
    case CURLE_SSL_CONNECT_ERROR:
    case CURLE_PROXY:
      return {Outcome::Unreachable, "the connection broke", "check the network, or wait until the server is back"};
    case CURLE_PARTIAL_FILE:
    case CURLE_HTTP2:
    case CURLE_HTTP2_STREAM:
    case CURLE_CHUNK_FAILED:
    case CURLE_AGAIN:
      return {Outcome::ServerError, "the answer broke off", "try again later"};
    case CURLE_PEER_FAILED_VERIFICATION:
    case CURLE_SSL_ISSUER_ERROR:
    case CURLE_SSL_INVALIDCERTSTATUS:
      return {Outcome::Final, "the server's certificate cannot be verified, so it may be another server",
              "have the certificate mended; for an authority of your own set MERIDIAN_CA_FILE to its certificate"};
    case CURLE_SSL_CACERT_BADFILE:
      return {Outcome::Final, "the file of trusted certificates cannot be read",
              "install ca-certificates, or set MERIDIAN_CA_FILE to a PEM file"};
    case CURLE_TOO_MANY_REDIRECTS:
      return {Outcome::Final, "the server redirects without end", "tell those who run it"};
    case CURLE_UNSUPPORTED_PROTOCOL:
      return {Outcome::Final, "the server redirects to something that is neither http nor https",
              "tell those who run it"};
    case CURLE_URL_MALFORMAT:
      return {Outcome::Final, "the server redirects to what is no address", "tell those who run it"};
    case CURLE_BAD_CONTENT_ENCODING:
      return {Outcome::Final, "the answer's compression is damaged or unknown", "tell those who run the server"};
    case CURLE_WEIRD_SERVER_REPLY:
      return {Outcome::Final, "the server does not speak HTTP", "check the address and its port"};
    default:
      return {Outcome::Final, "the request failed", "see what curl says of it"};
  }
}

std::string_view reason(int status) {
  switch (status) {
    case 400:
      return " (bad request)";
    case 401:
      return " (unauthorized)";
    case 403:
      return " (forbidden)";
    case 404:
      return " (not found)";
    case 408:
      return " (request timeout)";
    case 410:
      return " (gone)";
    case 429:
      return " (too many requests)";
    case 500:
      return " (internal server error)";
    case 502:
      return " (bad gateway)";
    case 503:
      return " (service unavailable)";
    case 504:
      return " (gateway timeout)";
    default:
      return "";
  }
}

const char* remedyOfStatus(int status) {
  if (status == 401 || status == 403 || status == 407) {
    return "check the key or password that the address carries, and whether the service allows this use";
  }
  if (status == 404 || status == 410) {
    return "check the address";
  }
  return status >= 500 || status == 408 || status == 425 || status == 429 ? "try again later"
                                                                          : "check the address against the service";
}

}  // namespace

TransferFailure failureOfCurl(int code, const std::string& detail, const std::string& url) {
  const Explanation explanation = explain(static_cast<CURLcode>(code));
  const std::string said = detail.empty() ? curl_easy_strerror(static_cast<CURLcode>(code)) : detail;
  return {explanation.outcome, Error{explanation.what + (" (" + said + ")"), url, explanation.remedy}};
}

TransferFailure failureOfStatus(int status, const std::string& url) {
  std::string what = "the server answers " + std::to_string(status);
  what += reason(status);
  return {outcomeOfStatus(status), Error{std::move(what), url, remedyOfStatus(status)}};
}

}  // namespace meridian::globebrowsing

#include "globebrowsing/network/http_transfers.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <ctime>
#include <string_view>
#include <utility>

#include <curl/curl.h>

#include "host/api/log.h"

namespace meridian::globebrowsing {

namespace {

/// curl's own global state; the first use makes it, whichever thread that is (curl 7.84 and later).
void initialiseCurl() {
  static const CURLcode code = curl_global_init(CURL_GLOBAL_DEFAULT);
  if (code != CURLE_OK) {
    log::error("the network cannot be used: {}", curl_easy_strerror(code));
  }
}

struct FreeList {
  void operator()(curl_slist* list) const { curl_slist_free_all(list); }
};

}  // namespace

/// The handle of the whole, and handles of transfers that have ended, for the next ones.
struct HttpTransfers::Multi {
  CURLM* handle = curl_multi_init();
  std::vector<CURL*> idle;

  ~Multi() {
    dropIdle();
    curl_multi_cleanup(handle);
  }

  void dropIdle() {
    for (CURL* easy : idle) {
      curl_easy_cleanup(easy);
    }
    idle.clear();
  }

  /// Null when there is none.
  CURL* take() {
    if (idle.empty()) {
      return nullptr;
    }
    CURL* easy = idle.back();
    idle.pop_back();
    return easy;
  }
};

struct HttpTransfers::Transfer {
  std::uint64_t id = 0;
  TransferRequest request{};
  unsigned generation = 0;
  std::size_t maximumHeaderBytes = 0;
  CURL* easy = nullptr;
  std::unique_ptr<curl_slist, FreeList> headers{};
  std::array<char, CURL_ERROR_SIZE> detail{};
  AnswerFacts facts{};
  std::size_t headerBytes = 0;
  std::vector<std::uint8_t> body{};
  std::size_t bytes = 0;  ///< of the body, also where it is not kept
  bool isTooLarge = false;
  bool hasTooMuchHeader = false;

  bool takeHeader(std::string_view line);
  bool takeBody(const char* data, std::size_t size);
  [[nodiscard]] int status() const;
};

int HttpTransfers::Transfer::status() const {
  long status = 0;
  curl_easy_getinfo(easy, CURLINFO_RESPONSE_CODE, &status);
  return static_cast<int>(status);
}

bool HttpTransfers::Transfer::takeHeader(std::string_view line) {
  headerBytes += line.size();
  if (headerBytes > maximumHeaderBytes) {
    hasTooMuchHeader = true;
    return false;
  }
  if (line.substr(0, 5) == "HTTP/") {
    facts.fields = {};  // of a redirect, or of an interim answer
    return true;
  }
  facts.fields.addLine(line);
  return true;
}

bool HttpTransfers::Transfer::takeBody(const char* data, std::size_t size) {
  if (size > request.maximumBytes - bytes) {
    isTooLarge = true;
    return false;
  }
  bytes += size;
  const int code = status();
  if (code < 200 || code >= 300) {
    return true;  // what an error has to say is read, so that the connection can be used again, and not kept
  }
  if (body.empty()) {
    curl_off_t length = -1;
    curl_easy_getinfo(easy, CURLINFO_CONTENT_LENGTH_DOWNLOAD_T, &length);
    if (length > 0) {
      // It may be a lie, or the length before decoding; memory is taken as bytes come.
      body.reserve(std::min<std::size_t>(static_cast<std::size_t>(length), std::size_t{1} << 20));
    }
  }
  body.insert(body.end(), data, data + size);
  return true;
}

namespace {

template <class Transfer>
std::size_t onHeader(char* data, std::size_t, std::size_t size, void* user) {
  return static_cast<Transfer*>(user)->takeHeader({data, size}) ? size : 0;
}

template <class Transfer>
std::size_t onBody(char* data, std::size_t, std::size_t size, void* user) {
  return static_cast<Transfer*>(user)->takeBody(data, size) ? size : CURL_WRITEFUNC_ERROR;
}

void setLimits(CURL* easy, const TransferLimits& limits) {
  curl_easy_setopt(easy, CURLOPT_CONNECTTIMEOUT_MS, static_cast<long>(limits.connectTime.count()));
  curl_easy_setopt(easy, CURLOPT_TIMEOUT_MS, static_cast<long>(limits.totalTime.count()));
  curl_easy_setopt(easy, CURLOPT_LOW_SPEED_TIME, static_cast<long>(limits.stallTime.count()));
  curl_easy_setopt(easy, CURLOPT_LOW_SPEED_LIMIT, limits.minimumSpeed);
  curl_easy_setopt(easy, CURLOPT_FOLLOWLOCATION, limits.redirects > 0 ? 1L : 0L);
  curl_easy_setopt(easy, CURLOPT_MAXREDIRS, std::max(limits.redirects, 0L));
  curl_easy_setopt(easy, CURLOPT_PROTOCOLS_STR, "http,https");
  curl_easy_setopt(easy, CURLOPT_REDIR_PROTOCOLS_STR, "http,https");
}

void setEncryption(CURL* easy, const std::string& certificateFile) {
  curl_easy_setopt(easy, CURLOPT_SSL_VERIFYPEER, 1L);
  curl_easy_setopt(easy, CURLOPT_SSL_VERIFYHOST, 2L);
  if (!certificateFile.empty()) {
    curl_easy_setopt(easy, CURLOPT_CAINFO, certificateFile.c_str());
  }
  // Without a folder of certificates curl keeps the file's in memory, rather than read it for each connection.
  curl_easy_setopt(easy, CURLOPT_CAPATH, nullptr);
}

/// All that is the same for every transfer: set once, which is a third of the work of sending one.
void configure(CURL* easy, const NetworkOptions& options, const std::string& userAgent) {
  curl_easy_setopt(easy, CURLOPT_NOSIGNAL, 1L);
  curl_easy_setopt(easy, CURLOPT_QUICK_EXIT, 1L);  // cancelling does not wait for the name's resolution
  curl_easy_setopt(easy, CURLOPT_USERAGENT, userAgent.c_str());
  curl_easy_setopt(easy, CURLOPT_ACCEPT_ENCODING, "");  // all that this curl decodes
  setLimits(easy, options.limits);
  setEncryption(easy, options.certificateFile.string());
}

bool isFieldLine(const std::string& header) {
  const std::size_t colon = header.find(':');
  return colon != std::string::npos && colon > 0 && header.find_first_of("\r\n") == std::string::npos &&
         header.find_first_of(" \t") > colon;
}

}  // namespace

HttpTransfers::HttpTransfers(const NetworkOptions& options, NetworkStatistics& statistics)
    : options_(&options), statistics_(&statistics), userAgent_(userAgentOf(options)) {
  initialiseCurl();
  multi_ = std::make_unique<Multi>();
  setConnections();
}

void HttpTransfers::optionsChanged() {
  ++generation_;
  userAgent_ = userAgentOf(*options_);
  multi_->dropIdle();
  setConnections();
}

void HttpTransfers::setConnections() {
  const ConcurrencyOptions& concurrency = options_->concurrency;
  curl_multi_setopt(multi_->handle, CURLMOPT_PIPELINING, static_cast<long>(CURLPIPE_MULTIPLEX));
  curl_multi_setopt(multi_->handle, CURLMOPT_MAXCONNECTS, static_cast<long>(std::max(concurrency.total, 1)));
  curl_multi_setopt(multi_->handle, CURLMOPT_MAX_HOST_CONNECTIONS, static_cast<long>(std::max(concurrency.perHost, 1)));
}

HttpTransfers::~HttpTransfers() {
  while (!transfers_.empty()) {
    cancel(transfers_.begin()->first);
  }
}

void HttpTransfers::start(std::uint64_t id, TransferRequest request) {
  auto owned = std::make_unique<Transfer>();
  Transfer& transfer = *owned;
  transfer.id = id;
  transfer.request = std::move(request);
  transfer.generation = generation_;
  transfer.maximumHeaderBytes = options_->limits.headerBytes;
  transfer.facts.requestTime = std::time(nullptr);
  const auto refuse = [&](Error error) { early_.push_back({.id = id, .failure = {Outcome::Final, std::move(error)}}); };
  for (const std::string& header : transfer.request.headers) {
    if (!isFieldLine(header)) {
      return refuse({"this is no header: \"" + header + "\"", transfer.request.address.url, "write \"Name: value\""});
    }
    transfer.headers.reset(curl_slist_append(transfer.headers.release(), header.c_str()));
  }
  CURL* easy = multi_->take();
  if (easy == nullptr) {
    easy = curl_easy_init();
    if (easy == nullptr) {
      return refuse({"out of memory", transfer.request.address.url, ""});
    }
    configure(easy, *options_, userAgent_);
    curl_easy_setopt(easy, CURLOPT_HEADERFUNCTION, &onHeader<Transfer>);
    curl_easy_setopt(easy, CURLOPT_WRITEFUNCTION, &onBody<Transfer>);
  }
  transfer.easy = easy;
  const bool isEncrypted = transfer.request.address.isEncrypted;
  curl_easy_setopt(easy, CURLOPT_URL, transfer.request.address.url.c_str());
  curl_easy_setopt(easy, CURLOPT_HTTPHEADER, transfer.headers.get());
  curl_easy_setopt(easy, CURLOPT_ERRORBUFFER, transfer.detail.data());
  curl_easy_setopt(easy, CURLOPT_HEADERDATA, &transfer);
  curl_easy_setopt(easy, CURLOPT_WRITEDATA, &transfer);
  curl_easy_setopt(easy, CURLOPT_PRIVATE, &transfer);
  // Not without TLS: curl 7.88 breaks HTTP/2 by prior knowledge, and an upgrade costs a round trip.
  curl_easy_setopt(easy, CURLOPT_HTTP_VERSION, isEncrypted ? CURL_HTTP_VERSION_2TLS : CURL_HTTP_VERSION_1_1);
  // Rather than open a connection each, requests wait until it is known whether they can share the first.
  curl_easy_setopt(easy, CURLOPT_PIPEWAIT, isEncrypted ? 1L : 0L);
  if (const CURLMcode code = curl_multi_add_handle(multi_->handle, easy); code != CURLM_OK) {
    curl_easy_cleanup(easy);
    return refuse({curl_multi_strerror(code), transfer.request.address.url, ""});
  }
  ++statistics_->transfers;
  transfers_.emplace(id, std::move(owned));
}

void HttpTransfers::cancel(std::uint64_t id) {
  std::erase_if(early_, [&](const TransferEnding& ending) { return ending.id == id; });
  const auto place = transfers_.find(id);
  if (place == transfers_.end()) {
    return;
  }
  CURL* easy = place->second->easy;
  curl_multi_remove_handle(multi_->handle, easy);
  // Whatever it still points to is set anew before it is used again, but for these.
  curl_easy_setopt(easy, CURLOPT_HTTPHEADER, nullptr);
  curl_easy_setopt(easy, CURLOPT_ERRORBUFFER, nullptr);
  if (place->second->generation == generation_) {
    multi_->idle.push_back(easy);
  } else {
    curl_easy_cleanup(easy);
  }
  transfers_.erase(place);
}

void HttpTransfers::run(std::chrono::milliseconds timeout, std::vector<TransferEnding>& endings) {
  std::move(early_.begin(), early_.end(), std::back_inserter(endings));
  early_.clear();
  perform(endings);
  if (!endings.empty()) {
    return;
  }
  curl_multi_poll(multi_->handle, nullptr, 0, static_cast<int>(std::clamp<std::int64_t>(timeout.count(), 0, 60'000)),
                  nullptr);
  perform(endings);
}

void HttpTransfers::wake() {
  curl_multi_wakeup(multi_->handle);
}

void HttpTransfers::perform(std::vector<TransferEnding>& endings) {
  int running = 0;
  if (const CURLMcode code = curl_multi_perform(multi_->handle, &running); code != CURLM_OK) {
    log::error("the network is in trouble: {}", curl_multi_strerror(code));
  }
  int left = 0;
  while (CURLMsg* message = curl_multi_info_read(multi_->handle, &left)) {
    if (message->msg != CURLMSG_DONE) {
      continue;
    }
    char* user = nullptr;
    curl_easy_getinfo(message->easy_handle, CURLINFO_PRIVATE, &user);
    auto& transfer = *reinterpret_cast<Transfer*>(user);
    endings.push_back(endingOf(transfer, message->data.result));
    cancel(transfer.id);
  }
}

TransferEnding HttpTransfers::endingOf(Transfer& transfer, int code) const {
  TransferEnding ending{.id = transfer.id};
  long opened = 0;
  curl_easy_getinfo(transfer.easy, CURLINFO_NUM_CONNECTS, &opened);
  statistics_->connections += static_cast<std::uint64_t>(std::max(opened, 0L));
  const std::string& url = transfer.request.address.url;
  if (transfer.isTooLarge) {
    ending.failure.error = {"the answer is larger than " + std::to_string(transfer.request.maximumBytes) + " bytes",
                            url, "check the address; it may not be what it is taken for"};
    return ending;
  }
  if (transfer.hasTooMuchHeader) {
    ending.failure.error = {
        "the answer's headers are larger than " + std::to_string(transfer.maximumHeaderBytes) + " bytes", url,
        "tell those who run the server"};
    return ending;
  }
  if (code != CURLE_OK) {
    ending.failure = failureOfCurl(code, transfer.detail.data(), url);
    return ending;
  }
  long version = 0;
  curl_easy_getinfo(transfer.easy, CURLINFO_HTTP_VERSION, &version);
  ending.isMultiplexed = version >= CURL_HTTP_VERSION_2_0;
  ending.status = transfer.status();
  ending.facts = std::move(transfer.facts);
  ending.facts.responseTime = std::time(nullptr);
  ending.body = std::move(transfer.body);
  statistics_->bytes += transfer.bytes;
  return ending;
}

}  // namespace meridian::globebrowsing

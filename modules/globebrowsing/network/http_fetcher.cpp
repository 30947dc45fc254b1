#include "globebrowsing/network/http_fetcher.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <ctime>
#include <mutex>
#include <random>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <pthread.h>
#include <signal.h>

#include "globebrowsing/network/cache_worker.h"
#include "globebrowsing/network/http_flight.h"
#include "globebrowsing/network/http_transfers.h"
#include "globebrowsing/network/mailbox.h"
#include "globebrowsing/network/negative_cache.h"

namespace meridian::globebrowsing {

/// What the network thread owns and does. The functions of the first part are for any thread.
class HttpFetcher::Engine {
 public:
  explicit Engine(NetworkOptions options);
  ~Engine();

  std::unique_ptr<PendingFetch> fetch(FetchRequest request, Done done);
  void accept(const Fetched& answer);
  void reject(const FetchRequest& request);
  void setOptions(const NetworkOptions& options);
  [[nodiscard]] NetworkOptions options() const;
  void drainCache() { cache_.drain(); }
  [[nodiscard]] const NetworkStatistics& statistics() const { return statistics_; }

 private:
  class Handle;
  using Id = RequestQueue::Id;
  using Clock = std::chrono::steady_clock;

  void run();
  void apply(const NetworkOptions& options);
  void begin(FetchRequest request, const std::shared_ptr<Waiter>& waiter);
  void renew(const std::shared_ptr<Waiter>& waiter);
  void cancel(const std::shared_ptr<Waiter>& waiter);

  void lookUp(Id id, Flight& flight);
  void found(Id id, std::optional<CachedAnswer> kept);
  void enqueue(Id id, Flight& flight);
  void startTransfers();
  void ended(TransferEnding ending);
  bool finishAttempt(Id id, const RequestQueue::Ending& ending);
  void answered(Id id, TransferEnding& ending);
  void failed(Id id, TransferFailure failure, const HeaderFields& fields);
  void serveStale(Id id);
  void serveStaleOf(const std::string& host);
  void finish(Id id, const Result<Fetched>& result);
  void updateGauges();
  [[nodiscard]] bool mayServeStale(const Flight& flight) const;

  mutable std::mutex optionsMutex_;  ///< for changing options_, and for reading it elsewhere than on the network thread
  NetworkOptions options_;
  NetworkStatistics statistics_;
  const bool hasCache_;
  std::atomic<CacheMode> cacheMode_;
  std::atomic<std::uint64_t> cacheBytes_;
  std::atomic<bool> stopping_{false};
  HttpTransfers transfers_;
  std::shared_ptr<Mailbox> mailbox_;
  CacheWorker cache_;

  // The network thread's.
  RequestQueue queue_;
  NegativeCache negatives_;
  Flights flights_;
  std::thread thread_;
};

/// What a caller holds.
class HttpFetcher::Engine::Handle final : public PendingFetch {
 public:
  Handle(Engine& engine, std::shared_ptr<Waiter> waiter)
      : engine_(&engine), mailbox_(engine.mailbox_), waiter_(std::move(waiter)) {}
  ~Handle() override {
    if (waiter_->delivery.cancel()) {
      mailbox_->post([engine = engine_, waiter = waiter_] { engine->cancel(waiter); });
    }
  }

  void setPriority(double priority) override {
    priority = orderable(priority);
    // Many change every frame: no waking for it, and not more than one task each.
    if (waiter_->priority.exchange(priority) != priority && !waiter_->isRenewed.exchange(true)) {
      mailbox_->post([engine = engine_, waiter = waiter_] { engine->renew(waiter); }, false);
    }
  }

  [[nodiscard]] std::optional<Error> lastFailure() const override { return waiter_->delivery.lastFailure(); }

 private:
  Engine* engine_;  ///< touched by tasks only, which run while it lives
  std::shared_ptr<Mailbox> mailbox_;
  std::shared_ptr<Waiter> waiter_;
};

HttpFetcher::Engine::Engine(NetworkOptions options)
    : options_(std::move(options)),
      hasCache_(!options_.cache.folder.empty()),
      cacheMode_(options_.cache.mode),
      cacheBytes_(options_.cache.maximumBytes),
      transfers_(options_, statistics_),
      mailbox_(std::make_shared<Mailbox>([this] { transfers_.wake(); })),
      cache_(options_.cache, statistics_),
      queue_(options_.concurrency, options_.retry,
             [random = std::mt19937_64(std::random_device{}())]() mutable {
               return std::uniform_real_distribution<double>(0.0, 1.0)(random);
             }),
      negatives_(options_.cache.negativeLifetime, options_.cache.maximumNegatives),
      thread_([this] { run(); }) {}

HttpFetcher::Engine::~Engine() {
  stopping_ = true;
  transfers_.wake();
  thread_.join();
  mailbox_->close();
  flights_.forEach([](Id, const Flight& flight) {
    for (const auto& waiter : flight.waiters) {
      waiter->delivery.cancel();
    }
  });
}

std::unique_ptr<PendingFetch> HttpFetcher::Engine::fetch(FetchRequest request, Done done) {
  ++statistics_.requests;
  auto waiter = std::make_shared<Waiter>(std::move(done), orderable(request.priority));
  mailbox_->post([this, request = std::move(request), waiter]() mutable { begin(std::move(request), waiter); });
  return std::make_unique<Handle>(*this, std::move(waiter));
}

void HttpFetcher::Engine::accept(const Fetched& answer) {
  if (answer.origin == nullptr || answer.body == nullptr || !hasCache_ || cacheMode_ != CacheMode::ReadWrite ||
      !isStorable(answer.origin->status, answer.origin->facts.fields) || answer.origin->isAccepted.exchange(true)) {
    return;
  }
  cache_.store(answer.origin->key, {answer.origin->facts, answer.body});
}

void HttpFetcher::Engine::reject(const FetchRequest& request) {
  const auto address = parseWebAddress(request.url);
  if (!address) {
    return;
  }
  std::string key = cacheKey(*address, request);
  if (cacheMode_ == CacheMode::ReadWrite) {
    cache_.remove(key);
  }
  mailbox_->post([this, key = std::move(key)] { negatives_.add(key, nothingHere, Clock::now()); });
}

void HttpFetcher::Engine::setOptions(const NetworkOptions& options) {
  const CacheOptions& cache = options.cache;
  if (cacheMode_.exchange(cache.mode) != cache.mode) {
    cache_.setMode(cache.mode);
  }
  if (cacheBytes_.exchange(cache.maximumBytes) != cache.maximumBytes) {
    cache_.setMaximumBytes(cache.maximumBytes);
  }
  mailbox_->post([this, options] { apply(options); });
}

NetworkOptions HttpFetcher::Engine::options() const {
  const std::lock_guard lock(optionsMutex_);
  return options_;
}

void HttpFetcher::Engine::apply(const NetworkOptions& options) {
  {
    const std::lock_guard lock(optionsMutex_);
    setRunningOptions(options_, options);
  }
  queue_.setOptions(options_.concurrency, options_.retry);
  negatives_.setLimits(options_.cache.negativeLifetime, options_.cache.maximumNegatives);
  transfers_.optionsChanged();
}

void HttpFetcher::Engine::run() {
  pthread_setname_np(pthread_self(), "network");
  // curl writes to connections that others have closed; told to use no signals it leaves this one to us.
  sigset_t pipe;
  sigemptyset(&pipe);
  sigaddset(&pipe, SIGPIPE);
  pthread_sigmask(SIG_BLOCK, &pipe, nullptr);

  std::vector<TransferEnding> endings;
  while (!stopping_) {
    for (const Mailbox::Task& task : mailbox_->take()) {
      task();
    }
    startTransfers();
    updateGauges();
    const auto now = Clock::now();
    auto timeout = std::chrono::milliseconds(60'000);
    if (const auto wake = queue_.wakeAt(now)) {
      timeout = std::min(timeout, std::chrono::ceil<std::chrono::milliseconds>(*wake - now));
    }
    ++statistics_.wakeUps;
    transfers_.run(mailbox_->maySleep() ? timeout : std::chrono::milliseconds(0), endings);
    for (TransferEnding& ending : endings) {
      ended(std::move(ending));
    }
    endings.clear();
  }
}

void HttpFetcher::Engine::begin(FetchRequest request, const std::shared_ptr<Waiter>& waiter) {
  auto address = parseWebAddress(request.url);
  if (!address) {
    ++statistics_.failures;
    waiter->delivery.deliver(tl::make_unexpected(std::move(address.error())));
    return;
  }
  request.maximumBytes = request.maximumBytes.value_or(options_.limits.bodyBytes);
  std::string key = cacheKey(*address, request);
  if (const auto status = negatives_.find(key, Clock::now()); status && isEmptyStatus(request, *status)) {
    ++statistics_.negativeHits;
    waiter->delivery.deliver(Fetched{.status = *status});
    return;
  }
  std::string identity = identityOf(key, request);
  const auto [id, isNew] = flights_.join(std::move(identity), waiter);
  if (!isNew) {
    ++statistics_.joined;
    renew(waiter);
    return;
  }
  Flight& flight = flights_.at(id);
  flight.request = std::move(request);
  flight.address = std::move(*address);
  flight.key = std::move(key);
  lookUp(id, flight);
}

void HttpFetcher::Engine::renew(const std::shared_ptr<Waiter>& waiter) {
  waiter->isRenewed = false;
  if (const Flight* flight = flights_.find(waiter->flight); flight != nullptr && flight->isQueued) {
    queue_.setPriority(waiter->flight, greatestPriority(*flight));
  }
}

void HttpFetcher::Engine::cancel(const std::shared_ptr<Waiter>& waiter) {
  ++statistics_.cancelled;
  const Id id = waiter->flight;
  Flight* const flight = flights_.find(id);
  if (flight == nullptr) {
    return;
  }
  std::erase(flight->waiters, waiter);
  if (flight->waiters.empty()) {
    queue_.remove(id, Clock::now());
    transfers_.cancel(id);
    flights_.take(id);
  } else {
    renew(waiter);
  }
}

void HttpFetcher::Engine::lookUp(Id id, Flight& flight) {
  if (cacheMode_ == CacheMode::Off || !hasCache_) {
    found(id, std::nullopt);
    return;
  }
  cache_.find(flight.key, [this, id](std::optional<CachedAnswer> kept) {
    mailbox_->post([this, id, kept = std::move(kept)]() mutable { found(id, std::move(kept)); });
  });
}

void HttpFetcher::Engine::found(Id id, std::optional<CachedAnswer> kept) {
  Flight* const known = flights_.find(id);
  if (known == nullptr) {
    return;  // cancelled meanwhile
  }
  Flight& flight = *known;
  if (kept && kept->body->size() > *flight.request.maximumBytes) {
    kept.reset();
  }
  const bool isGood = kept && isFresh(kept->facts, options_.cache.rules, std::time(nullptr));
  if (isGood || (kept && cacheMode_ == CacheMode::CacheOnly)) {
    ++statistics_.cacheHits;
    finish(id, fetchedFromCache(*kept, !isGood));
    return;
  }
  if (cacheMode_ == CacheMode::CacheOnly) {
    finish(id,
           failure("it is not in the cache, and no server is asked in the cache mode cache-only", flight.request.url,
                   "go online: unset MERIDIAN_OFFLINE and MERIDIAN_CACHE_MODE, or set the property NetworkCacheMode to "
                   "read-write"));
    return;
  }
  flight.kept = std::move(kept);
  const bool isDown = !queue_.mayAsk(flight.address.host, Clock::now());
  if (isDown && mayServeStale(flight)) {
    serveStale(id);
    return;
  }
  if (isDown && !flight.request.isPatient) {
    finish(id, failure("its server does not answer at the moment", flight.request.url,
                       "try again later, or check the network"));
    return;
  }
  enqueue(id, flight);
}

void HttpFetcher::Engine::enqueue(Id id, Flight& flight) {
  flight.isQueued = true;
  queue_.add(id, flight.address.host, greatestPriority(flight), flight.request.isPatient);
}

void HttpFetcher::Engine::startTransfers() {
  while (const auto id = queue_.start(Clock::now())) {
    Flight& flight = flights_.at(*id);
    if (++flight.attempts > 1) {
      ++statistics_.retries;
    }
    TransferRequest transfer{flight.address, flight.request.headers, *flight.request.maximumBytes};
    if (flight.kept) {
      for (std::string& header : conditionalHeaders(flight.kept->facts)) {
        transfer.headers.push_back(std::move(header));
      }
    }
    transfers_.start(*id, std::move(transfer));
  }
}

void HttpFetcher::Engine::ended(TransferEnding ending) {
  const Id id = ending.id;
  const Flight* const known = flights_.find(id);
  if (known == nullptr || !queue_.isRunning(id)) {
    return;  // cancelled by a `done` of the same round, or recalled in it
  }
  const Flight& flight = *known;
  if (ending.isMultiplexed) {
    queue_.setMultiplexed(flight.address.host);
  }
  if (ending.status == 0) {
    failed(id, std::move(ending.failure), {});
    return;
  }
  const bool isSuccess = ending.status >= 200 && ending.status < 300;
  const bool isStillGood = ending.status == 304 && flight.kept;
  if (isSuccess || isStillGood || isEmptyStatus(flight.request, ending.status)) {
    answered(id, ending);
    return;
  }
  TransferFailure failure = failureOfStatus(ending.status, flight.request.url);
  if (failure.outcome == Outcome::Done) {
    failure.outcome = Outcome::Final;  // a 304 that nobody asked for
  }
  failed(id, std::move(failure), ending.facts.fields);
}

/// True when it will be tried again.
bool HttpFetcher::Engine::finishAttempt(Id id, const RequestQueue::Ending& ending) {
  const bool isTriedAgain = queue_.finish(id, ending, Clock::now());
  for (const Id hanging : queue_.recallProbes(flights_.at(id).address.host)) {
    transfers_.cancel(hanging);
  }
  return isTriedAgain;
}

void HttpFetcher::Engine::answered(Id id, TransferEnding& ending) {
  finishAttempt(id, {Outcome::Done});
  Flight& flight = flights_.at(id);
  if (isEmptyStatus(flight.request, ending.status)) {
    negatives_.add(flight.key, ending.status, Clock::now());
    if (flight.kept && cacheMode_ == CacheMode::ReadWrite) {
      cache_.remove(flight.key);
    }
    finish(id, Fetched{.status = ending.status, .contentType = contentTypeOf(ending.facts)});
    return;
  }
  if (ending.status == 304) {
    ++statistics_.revalidated;
    if (cacheMode_ == CacheMode::ReadWrite) {
      cache_.refresh(flight.key, refreshed(flight.kept->facts, ending.facts));
    }
    finish(id, fetchedFromCache(*flight.kept, false));
    return;
  }
  auto origin = std::make_shared<AnswerOrigin>();
  origin->key = flight.key;
  origin->status = ending.status;
  Fetched fetched{.status = ending.status, .contentType = contentTypeOf(ending.facts)};
  fetched.body = std::make_shared<const std::vector<std::uint8_t>>(std::move(ending.body));
  origin->facts = std::move(ending.facts);
  fetched.origin = std::move(origin);
  finish(id, std::move(fetched));
}

void HttpFetcher::Engine::failed(Id id, TransferFailure failure, const HeaderFields& fields) {
  Flight& flight = flights_.at(id);
  const std::string host = flight.address.host;
  RequestQueue::Ending ending{failure.outcome};
  if (const auto wait = fields.find("Retry-After"); wait && failure.outcome != Outcome::Final) {
    ending.retryAfter = retryAfter(options_.retry, *wait, std::time(nullptr));
  }
  const bool isTriedAgain = finishAttempt(id, ending);
  if (failure.outcome != Outcome::Final && mayServeStale(flight)) {
    queue_.remove(id, Clock::now());
    serveStale(id);
  } else if (isTriedAgain) {
    for (const auto& waiter : flight.waiters) {
      waiter->delivery.setLastFailure(failure.error);
    }
  } else {
    finish(id, tl::make_unexpected(std::move(failure.error)));
  }
  if (!queue_.mayAsk(host, Clock::now())) {
    serveStaleOf(host);
  }
}

bool HttpFetcher::Engine::mayServeStale(const Flight& flight) const {
  return flight.kept && globebrowsing::mayServeStale(flight.kept->facts, options_.cache.rules, std::time(nullptr));
}

void HttpFetcher::Engine::serveStale(Id id) {
  ++statistics_.stale;
  finish(id, fetchedFromCache(*flights_.at(id).kept, true));
}

/// What waits for a server that has turned out to be down, and need not.
void HttpFetcher::Engine::serveStaleOf(const std::string& host) {
  std::vector<Id> served;
  flights_.forEach([&](Id id, const Flight& flight) {
    if (flight.isQueued && flight.address.host == host && mayServeStale(flight)) {
      served.push_back(id);
    }
  });
  for (const Id id : served) {
    queue_.remove(id, Clock::now());
    transfers_.cancel(id);
    serveStale(id);
  }
}

void HttpFetcher::Engine::finish(Id id, const Result<Fetched>& result) {
  const Flight flight = flights_.take(id);
  for (const auto& waiter : flight.waiters) {
    statistics_.failures += result ? 0U : 1U;
    waiter->delivery.deliver(result);
  }
}

void HttpFetcher::Engine::updateGauges() {
  statistics_.running = queue_.running();
  statistics_.waiting = flights_.size() - queue_.running();
  statistics_.hostsDown = queue_.hostsDown();
}

HttpFetcher::HttpFetcher(NetworkOptions options) : engine_(std::make_unique<Engine>(std::move(options))) {}

HttpFetcher::~HttpFetcher() = default;

std::unique_ptr<PendingFetch> HttpFetcher::fetch(FetchRequest request, Done done) {
  return engine_->fetch(std::move(request), std::move(done));
}

void HttpFetcher::accept(const FetchRequest&, const Fetched& answer) {
  engine_->accept(answer);
}

void HttpFetcher::reject(const FetchRequest& request) {
  engine_->reject(request);
}

void HttpFetcher::setOptions(const NetworkOptions& options) {
  engine_->setOptions(options);
}

NetworkOptions HttpFetcher::options() const {
  return engine_->options();
}

void HttpFetcher::drainCache() {
  engine_->drainCache();
}

const NetworkStatistics& HttpFetcher::statistics() const {
  return engine_->statistics();
}

}  // namespace meridian::globebrowsing

#include "host/graphics/program_cache.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <map>
#include <mutex>
#include <string>
#include <thread>
#include <utility>

#include <fmt/format.h>
#include <sys/resource.h>

#include "host/api/log.h"
#include "host/api/statistics.h"
#include "host/graphics/default_state.h"

namespace meridian::graphics {

namespace {

using Clock = std::chrono::steady_clock;

// The render thread's context finds the machine code of a warm-up draw in Mesa's disk cache, which a thread of Mesa's
// fills some time after the draw. A program drawn with before that is compiled again, by the frame: seen in one of
// five. Builds shorter than `compiled` found everything in the cache.
constexpr std::chrono::milliseconds compiled(20);
constexpr std::chrono::milliseconds cacheWriting(100);

/// Of the warm-up thread, beyond the render thread's; workers' is greater, for programs are waited for.
constexpr int niceness = 5;

/// Compiles, links and warms with the current context, which it leaves in the default state.
Result<GLuint> build(const ProgramDescription& description, Statistics& statistics) {
  const Clock::time_point start = Clock::now();
  auto program = compileProgram(description);
  if (program && description.warmUp) {
    applyDefaultState();
    glUseProgram(*program);
    description.warmUp(*program);
    applyDefaultState();
    glFinish();
  }
  const double milliseconds = std::chrono::duration<double, std::milli>(Clock::now() - start).count();
  if (program) {
    ++statistics.programs.built;
    log::debug("program {} built in {:.1f} ms", description.key, milliseconds);
  }
  double longest = statistics.programs.buildMsMax.load();
  while (longest < milliseconds && !statistics.programs.buildMsMax.compare_exchange_weak(longest, milliseconds)) {
  }
  return program;
}

}  // namespace

struct ProgramHandle::Entry {
  enum class State { Building, Ready, Failed };

  std::string key;
  ProgramDescription description;  ///< the builder's, empty once built
  /// Whoever builds writes the next three, then the state.
  GLuint program = 0;
  Error error;
  Clock::time_point usableFrom{};  ///< when the driver has kept the machine code
  std::atomic<State> state{State::Building};
  bool isUrgent = true;  ///< guarded by the cache's mutex
  // The render thread's.
  std::uint64_t lastUse = 0;
  bool settled = false;  ///< usableFrom has passed

  [[nodiscard]] bool usable() {
    if (state.load(std::memory_order_acquire) != State::Ready) {
      return false;
    }
    settled = settled || Clock::now() >= usableFrom;
    return settled;
  }

  void finish(Result<GLuint> result) {
    description = {};
    if (result) {
      program = *result;
      state.store(State::Ready, std::memory_order_release);
    } else {
      error = std::move(result.error());
      log::error("{}", error.message());
      state.store(State::Failed, std::memory_order_release);
    }
  }
};

struct ProgramCache::Implementation {
  using Entry = ProgramHandle::Entry;
  using Entries = std::map<std::string, std::shared_ptr<Entry>, std::less<>>;

  Implementation(std::unique_ptr<Context> warmUpContext, std::unique_ptr<Context> proofContext, Statistics& figures,
                 const Options& chosen)
      : context(std::move(warmUpContext)), proof(std::move(proofContext)), statistics(figures), options(chosen) {}

  std::unique_ptr<Context> context;  ///< the warm-up thread's, as is the next
  std::unique_ptr<Context> proof;
  Statistics& statistics;
  Options options;

  // The render thread's.
  Entries entries;
  std::uint64_t uses = 0;
  bool inFrame = false;
  bool waitedInFrame = false;

  // Both threads'.
  std::mutex mutex;
  std::condition_variable changed;
  std::deque<std::shared_ptr<Entry>> queue;
  bool building = false;
  bool stopping = false;
  std::thread thread;

  void run();
  /// The first that is urgent, else the first; the queue is not empty and the mutex held.
  [[nodiscard]] std::shared_ptr<Entry> takeNext();
  /// Draws again on a context that has not seen the program: it finds the machine code in the driver's cache, or takes
  /// as long as the cache needs to be written, however busy the machine is.
  void proveCached(const ProgramDescription& description, GLuint program) const;
  /// Counts a frame that waited for a compiler.
  void noteWaiting() {
    if (inFrame && !waitedInFrame) {
      waitedInFrame = true;
      ++statistics.programs.framesWaited;
    }
  }
  void dropUnwantedRequests();
  void evict();
};

void ProgramCache::Implementation::proveCached(const ProgramDescription& description, GLuint program) const {
  std::this_thread::sleep_for(std::chrono::milliseconds(10));
  context->release();
  if (proof->makeCurrent()) {
    applyDefaultState();
    glUseProgram(program);
    description.warmUp(program);
    applyDefaultState();
    glFinish();
    proof->release();
  }
  if (const auto back = context->makeCurrent(); !back) {
    log::error("{}", back.error().message());
  }
}

std::shared_ptr<ProgramHandle::Entry> ProgramCache::Implementation::takeNext() {
  auto next =
      std::find_if(queue.begin(), queue.end(), [](const std::shared_ptr<Entry>& entry) { return entry->isUrgent; });
  next = next == queue.end() ? queue.begin() : next;
  std::shared_ptr<Entry> entry = std::move(*next);
  queue.erase(next);
  return entry;
}

void ProgramCache::Implementation::run() {
  // Frames come first; on Linux both calls are about the calling thread alone. Refused it stays as it is.
  setpriority(PRIO_PROCESS, 0, getpriority(PRIO_PROCESS, 0) + niceness);
  const auto current = context->makeCurrent();
  if (current) {
    applyDefaultState();
  }
  std::unique_lock lock(mutex);
  for (;;) {
    changed.wait(lock, [this] { return stopping || !queue.empty(); });
    if (stopping) {
      break;
    }
    const std::shared_ptr<Entry> entry = takeNext();
    building = true;
    lock.unlock();
    const bool warms = entry->description.warmUp != nullptr;
    const Clock::time_point start = Clock::now();
    auto program =
        current ? build(entry->description, statistics) : Result<GLuint>(tl::make_unexpected(current.error()));
    const Clock::time_point end = Clock::now();
    if (warms && end - start > compiled) {
      entry->usableFrom = end + cacheWriting;
      if (program) {
        proveCached(entry->description, *program);
      }
    }
    entry->finish(std::move(program));
    lock.lock();
    building = false;
    changed.notify_all();
  }
  lock.unlock();
  context->release();
}

void ProgramCache::Implementation::dropUnwantedRequests() {
  const std::lock_guard lock(mutex);
  // Handles are made on this thread only, so one that only `entries` and `queue` hold stays so during this call.
  std::erase_if(queue, [this](const std::shared_ptr<Entry>& entry) {
    if (entry.use_count() > 2) {
      return false;
    }
    entries.erase(entry->key);
    return true;
  });
  if (queue.empty()) {
    changed.notify_all();
  }
}

void ProgramCache::Implementation::evict() {
  for (;;) {
    std::size_t unheld = 0;
    auto oldest = entries.end();
    for (auto entry = entries.begin(); entry != entries.end(); ++entry) {
      const bool built = entry->second->state.load(std::memory_order_acquire) != Entry::State::Building;
      if (!built || entry->second.use_count() > 1) {
        continue;
      }
      ++unheld;
      if (oldest == entries.end() || entry->second->lastUse < oldest->second->lastUse) {
        oldest = entry;
      }
    }
    if (unheld <= options.capacity) {
      return;
    }
    glDeleteProgram(oldest->second->program);
    entries.erase(oldest);
  }
}

ProgramCache::ProgramCache(std::unique_ptr<Implementation> implementation)
    : implementation_(std::move(implementation)) {
  implementation_->thread = std::thread([self = implementation_.get()] { self->run(); });
}

Result<std::unique_ptr<ProgramCache>> ProgramCache::create(Context& context, Statistics& statistics,
                                                           const Options& options) {
  auto second = context.createShared();
  if (!second) {
    return tl::make_unexpected(std::move(second.error()));
  }
  auto proof = context.createShared();
  if (!proof) {
    return tl::make_unexpected(std::move(proof.error()));
  }
  return std::unique_ptr<ProgramCache>(
      new ProgramCache(std::make_unique<Implementation>(std::move(*second), std::move(*proof), statistics, options)));
}

ProgramCache::~ProgramCache() {
  {
    const std::lock_guard lock(implementation_->mutex);
    implementation_->stopping = true;
  }
  implementation_->changed.notify_all();
  implementation_->thread.join();
  for (const auto& [key, entry] : implementation_->entries) {
    glDeleteProgram(entry->program);
  }
}

ProgramHandle ProgramCache::request(ProgramDescription description, Urgency urgency) {
  Implementation& self = *implementation_;
  const bool isUrgent = urgency == Urgency::Now;
  if (ProgramHandle known = find(description.key)) {
    ++self.statistics.programs.cached;
    const std::lock_guard lock(self.mutex);
    known.entry_->isUrgent = known.entry_->isUrgent || isUrgent;
    return known;
  }
  auto entry = std::make_shared<ProgramHandle::Entry>();
  entry->key = description.key;
  entry->description = std::move(description);
  entry->isUrgent = isUrgent;
  entry->lastUse = ++self.uses;
  self.entries.emplace(entry->key, entry);
  {
    const std::lock_guard lock(self.mutex);
    self.queue.push_back(entry);
  }
  self.changed.notify_all();
  ProgramHandle handle(std::move(entry));
  self.dropUnwantedRequests();
  self.evict();
  return handle;
}

ProgramHandle ProgramCache::find(std::string_view key) const {
  const auto found = implementation_->entries.find(key);
  return found != implementation_->entries.end() ? ProgramHandle(found->second) : ProgramHandle();
}

bool ProgramCache::hasFailed(const ProgramHandle& handle) const {
  return handle && handle.entry_->state.load(std::memory_order_acquire) == ProgramHandle::Entry::State::Failed;
}

Result<GLuint> ProgramCache::get(const ProgramHandle& handle) const {
  if (hasFailed(handle)) {
    return tl::make_unexpected(handle.entry_->error);
  }
  return ready(handle);
}

GLuint ProgramCache::ready(const ProgramHandle& handle) const {
  if (!handle || !handle.entry_->usable()) {
    return 0;
  }
  handle.entry_->lastUse = ++implementation_->uses;
  return handle.entry_->program;
}

Result<ProgramHandle> ProgramCache::buildNow(const ProgramDescription& description) {
  Implementation& self = *implementation_;
  if (ProgramHandle known = find(description.key)) {
    ++self.statistics.programs.cached;
    auto program = get(known);
    if (program && *program == 0) {
      waitAll();
      program = get(known);
    }
    return program ? Result<ProgramHandle>(std::move(known)) : tl::make_unexpected(std::move(program.error()));
  }
  self.noteWaiting();
  auto entry = std::make_shared<ProgramHandle::Entry>();
  entry->key = description.key;
  entry->lastUse = ++self.uses;
  self.entries.emplace(entry->key, entry);
  entry->finish(build(description, self.statistics));
  ProgramHandle handle(std::move(entry));
  self.evict();
  auto program = get(handle);
  return program ? Result<ProgramHandle>(std::move(handle)) : tl::make_unexpected(std::move(program.error()));
}

void ProgramCache::waitAll() {
  Implementation& self = *implementation_;
  self.dropUnwantedRequests();
  std::unique_lock lock(self.mutex);
  const auto idle = [&self] { return self.queue.empty() && !self.building; };
  if (!idle()) {
    self.noteWaiting();
    self.changed.wait(lock, idle);
  }
  lock.unlock();
  for (const auto& [key, entry] : self.entries) {
    if (entry->state.load(std::memory_order_acquire) == ProgramHandle::Entry::State::Ready && !entry->usable()) {
      self.noteWaiting();
      std::this_thread::sleep_until(entry->usableFrom);
    }
  }
}

std::size_t ProgramCache::pending() const {
  const std::lock_guard lock(implementation_->mutex);
  return implementation_->queue.size() + (implementation_->building ? 1 : 0);
}

std::size_t ProgramCache::size() const {
  return implementation_->entries.size();
}

void ProgramCache::beginFrame() {
  implementation_->inFrame = true;
  implementation_->waitedInFrame = false;
}

void ProgramCache::endFrame() {
  implementation_->inFrame = false;
  implementation_->dropUnwantedRequests();
  implementation_->evict();
}

}  // namespace meridian::graphics

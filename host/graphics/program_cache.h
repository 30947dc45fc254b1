#pragma once

#include <cstddef>
#include <memory>
#include <string_view>

#include <epoxy/gl.h>

#include "host/api/error.h"
#include "host/graphics/context.h"
#include "host/graphics/program.h"

namespace meridian {
class Statistics;
}

namespace meridian::graphics {

class ProgramCache;

/// Stands for a requested program and keeps it in the cache; cheap to copy. Empty when default-constructed.
class ProgramHandle {
 public:
  ProgramHandle() = default;
  explicit operator bool() const { return entry_ != nullptr; }
  friend bool operator==(const ProgramHandle&, const ProgramHandle&) = default;

 private:
  friend class ProgramCache;
  struct Entry;
  explicit ProgramHandle(std::shared_ptr<Entry> entry) : entry_(std::move(entry)) {}
  std::shared_ptr<Entry> entry_;
};

/// Builds programs on a warm-up thread with a second, shared context, and keeps them.
///
/// A program is ready only after its warm-up draw (docs/architecture.md, Programs; measured on llvmpipe: linking takes
/// 15 ms, the first draw up to a second). Where that compiled something, the draw is repeated on a third context, which
/// proves that the driver has kept the machine code where the first context finds it. So a frame that uses it never
/// waits.
/// Programs that somebody holds a handle to stay; of the others the `capacity` most recently used stay. A request whose
/// handles are all gone before its turn is dropped. Requests are built in their order, those for later after the
/// others.
///
/// All functions are for the render thread, with the first context current. It must die before that context does.
class ProgramCache {
 public:
  struct Options {
    std::size_t capacity = 64;  ///< programs kept that nobody holds
  };
  enum class Urgency { Now, Later };

  /// Starts the warm-up thread. Errors: no second context.
  [[nodiscard]] static Result<std::unique_ptr<ProgramCache>> create(Context& context, Statistics& statistics,
                                                                    const Options& options);
  [[nodiscard]] static Result<std::unique_ptr<ProgramCache>> create(Context& context, Statistics& statistics) {
    return create(context, statistics, Options{});
  }
  /// Waits for the program being built (at most about a second), drops the rest and deletes all programs.
  ~ProgramCache();
  ProgramCache(const ProgramCache&) = delete;
  ProgramCache& operator=(const ProgramCache&) = delete;

  /// The program of that key, building it when it is new. One that was asked for later may be asked for now. Never
  /// waits.
  [[nodiscard]] ProgramHandle request(ProgramDescription description, Urgency urgency = Urgency::Now);
  /// The program of that key if it has been requested and is still kept, ready or not; else an empty handle.
  [[nodiscard]] ProgramHandle find(std::string_view key) const;
  /// 0 while it is being built. Errors: it cannot be built; a compiler's error carries template file and line.
  [[nodiscard]] Result<GLuint> get(const ProgramHandle& handle) const;
  /// The program if it is ready, else 0; no error, no allocation: for the frame.
  [[nodiscard]] GLuint ready(const ProgramHandle& handle) const;
  /// Whether it cannot be built; as cheap.
  [[nodiscard]] bool hasFailed(const ProgramHandle& handle) const;

  /// Builds at once, on the calling thread and the first context, with its warm-up draw: for the few tiny programs that
  /// the first frame needs. When called between frames begun and ended it counts as a frame that waited.
  [[nodiscard]] Result<ProgramHandle> buildNow(const ProgramDescription& description);
  /// Waits until nothing is being built: for tests and for pictures that are written. Counts as buildNow does.
  void waitAll();

  /// How many requests are not built yet; ask ready() whether one is to be drawn with.
  [[nodiscard]] std::size_t pending() const;
  /// How many programs it knows: ready, failed or being built.
  [[nodiscard]] std::size_t size() const;

  /// Frame marks for Statistics.programs.framesWaited.
  void beginFrame();
  void endFrame();

 private:
  struct Implementation;
  explicit ProgramCache(std::unique_ptr<Implementation> implementation);
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace meridian::graphics

#pragma once

#include <functional>
#include <optional>
#include <stop_token>

#include "globebrowsing/streaming/tile_data.h"
#include "host/api/error.h"

namespace meridian::globebrowsing {

/// Makes one tile on a worker. Made and destroyed anywhere, run at most once; it holds all that it needs (by shared
/// pointers), because whoever asked for it may be gone when it runs. One thread at a time.
class TileJob {
 public:
  virtual ~TileJob() = default;
  /// Before run(): asks for what comes from elsewhere. Returns whether nothing is missing. If not, the job is put aside
  /// without holding a worker until `wake` is called (from any thread, perhaps before this returns); then it is
  /// prepared again. On a worker; does not block. What the job asked for is dropped with it.
  [[nodiscard]] virtual bool prepare(double /*priority*/, const std::function<void()>& /*wake*/) { return true; }
  /// Every frame while it is aside; quick.
  virtual void setPriority(double /*priority*/) {}
  /// After run(): why something is missing in the tile that it made.
  [[nodiscard]] virtual std::optional<Error> flaw() const { return std::nullopt; }
  /// Looks at the token where the work is long and then gives up with any error, which nobody reads. Never gives null.
  [[nodiscard]] virtual Result<TileDataPointer> run(const std::stop_token& stop) = 0;
};

}  // namespace meridian::globebrowsing

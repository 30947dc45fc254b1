#pragma once

#include <stop_token>

#include "globebrowsing/streaming/tile_data.h"
#include "host/api/error.h"

namespace meridian::globebrowsing {

/// Makes one tile on a worker. Made and destroyed anywhere, run at most once; it holds all that it needs (by shared
/// pointers), because whoever asked for it may be gone when it runs.
class TileJob {
 public:
  virtual ~TileJob() = default;
  /// Looks at the token where the work is long and then gives up with any error, which nobody reads. Never gives null.
  [[nodiscard]] virtual Result<TileDataPointer> run(const std::stop_token& stop) = 0;
};

}  // namespace meridian::globebrowsing

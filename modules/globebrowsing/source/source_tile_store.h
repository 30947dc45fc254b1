#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "globebrowsing/network/fetcher.h"
#include "globebrowsing/source/source_tile.h"

namespace meridian::globebrowsing {

/// What came of a source tile.
struct SourceTileAnswer {
  SourceTilePointer tile{};      ///< null: there is nothing at that address, or an error
  std::optional<Error> error{};  ///< it was fetched or decoded in vain, for good
};

/// Decoded tiles of services, fetched and decoded once for all that want them (docs/architecture.md, A tile).
///
/// A tile is fetched while somebody wants it, at the greatest priority of those who do, and cancelled when nobody does
/// any more. It is decoded on a worker, most urgent first, and only then accepted into (or rejected from) the fetcher's
/// cache; neither where only our description or limits speak against it. Decoded tiles stay, least recently wanted
/// dropped first, within the budget; what is wanted or held is never dropped. What failed, and what is not there, is
/// not remembered here: that is the fetcher's to do.
///
/// Safe from any thread. Two services share a tile when address, headers and meaning of the pixels are the same.
class SourceTileStore {
 public:
  /// Has a function called on a worker, or dropped when there will be none any more.
  using Post = std::function<void(std::function<void()>)>;
  struct Parts {
    std::shared_ptr<Fetcher> fetcher;
    Post post;
    TileDecoder decode;  ///< called from several threads at once
  };

  explicit SourceTileStore(Parts parts, std::size_t budgetBytes = std::size_t{128} << 20);
  SourceTileStore(const SourceTileStore&) = delete;
  SourceTileStore& operator=(const SourceTileStore&) = delete;
  /// Cancels everything; wants may outlive the store, but will not be woken.
  ~SourceTileStore();

  /// Some tiles of a service that somebody wants. Ending it ends the wanting. One thread at a time.
  class Want {
   public:
    virtual ~Want() = default;
    virtual void setPriority(double priority) = 0;
    /// Whether all have been answered.
    [[nodiscard]] virtual bool isSettled() const = 0;
    /// By the order of asking; once settled.
    [[nodiscard]] virtual SourceTileAnswer answer(std::size_t number) const = 0;
  };
  struct Request {
    std::shared_ptr<const TileService> service;
    PixelKind kind = PixelKind::Colours;
    std::vector<TileAddress> tiles;
    double priority = 0.0;
    /// Called once, from any thread and under no lock, when all have been answered; not at all if they are at once.
    std::function<void()> settled;
  };
  [[nodiscard]] std::unique_ptr<Want> want(Request request);

  /// For what else a service has to be asked.
  [[nodiscard]] const std::shared_ptr<Fetcher>& fetcher() const;

  void setBudget(std::size_t bytes);
  /// Of all decoded tiles.
  [[nodiscard]] std::size_t bytes() const;
  /// Of a service whose tiles wait for a server that has failed and is asked again: why. The very service that was
  /// given in a Request.
  [[nodiscard]] std::optional<Error> lastFailure(const TileService& service) const;
  /// Tiles that are being fetched or decoded.
  [[nodiscard]] std::size_t pending() const;

 private:
  class State;
  class HeldWant;
  std::shared_ptr<State> state_;
};

}  // namespace meridian::globebrowsing

#include "globebrowsing/providers/tile_provider.h"

#include <exception>
#include <string>
#include <utility>

#include "host/api/log.h"

namespace meridian::globebrowsing {

std::optional<Error> TileProvider::error() const {
  // error_ is written once, before Failed is published.
  return state() == State::Failed ? error_ : std::nullopt;
}

bool TileProvider::prepare(const std::function<void()>& wake) {
  const std::lock_guard lock(opening_);
  if (state() == State::Ready || state() == State::Failed) {
    return true;
  }
  try {
    return prepareData(wake);
  } catch (const std::exception&) {
    return true;  // opening it meets the same, and says so
  }
}

Result<void> TileProvider::open() {
  const std::lock_guard lock(opening_);
  if (state() == State::Ready) {
    return {};
  }
  if (state() == State::Failed) {
    return tl::make_unexpected(*error_);
  }
  state_.store(State::Opening, std::memory_order_release);
  Result<void> opened = openGuarded();
  if (!opened) {
    error_ = opened.error();
  }
  state_.store(opened ? State::Ready : State::Failed, std::memory_order_release);
  return opened;
}

Result<void> TileProvider::openGuarded() {
  // Libraries that read files may run out of memory on what a file claims.
  try {
    return openData();
  } catch (const std::exception& exception) {
    return failure(std::string("opening the data threw: ") + exception.what());
  }
}

void TileProvider::openOn(WorkerPool& workers, std::shared_ptr<TileProvider> provider, bool logFailure) {
  State expected = State::NotOpened;
  if (provider->state_.compare_exchange_strong(expected, State::Opening)) {
    workers.post([&workers, provider = std::move(provider), logFailure](const std::stop_token&) {
      openWhenPrepared(workers, provider, logFailure);
    });
  }
}

void TileProvider::openWhenPrepared(WorkerPool& workers, const std::shared_ptr<TileProvider>& provider,
                                    bool logFailure) {
  // Only weakly: a provider that nobody wants any more need not be opened, and must not end on the network's thread.
  const auto wake = [&workers, weak = std::weak_ptr(provider), logFailure] {
    workers.post([&workers, weak, logFailure](const std::stop_token&) {
      if (const std::shared_ptr<TileProvider> still = weak.lock()) {
        openWhenPrepared(workers, still, logFailure);
      }
    });
  };
  if (!provider->prepare(wake)) {
    return;
  }
  // The outcome is kept in state() and error(), but a user who looks at a bare globe looks at the log first.
  if (const Result<void> opened = provider->open(); !opened && logFailure) {
    log::error("{}", opened.error().message());
  }
}

Result<void> TileProvider::requireReady() const {
  switch (state()) {
    case State::Ready:
      return {};
    case State::Failed:
      return tl::make_unexpected(*error_);
    case State::NotOpened:
    case State::Opening:
      break;
  }
  return failure("the provider is not open");
}

std::unique_ptr<ColourTask> TileProvider::colourTask(const Tiling& tiling, const TileIndex& index) const {
  return state() == State::Ready ? makeColourTask(tiling, index) : nullptr;
}

std::unique_ptr<HeightTask> TileProvider::heightTask(const Tiling& tiling, const TileIndex& index,
                                                     const TileLayout& layout) const {
  return state() == State::Ready ? makeHeightTask(tiling, index, layout) : nullptr;
}

Result<ColourPixels> TileProvider::colours(const Tiling& tiling, const TileIndex& index, std::stop_token stop) const {
  return requireReady().and_then([&] { return makeColours(tiling, index, std::move(stop)); });
}

Result<HeightPixels> TileProvider::heights(const Tiling& tiling, const TileIndex& index, const TileLayout& layout,
                                           std::stop_token stop) const {
  return requireReady().and_then([&] { return makeHeights(tiling, index, layout, std::move(stop)); });
}

bool TileProvider::overlaps(const Tiling& tiling, const TileIndex& index) const {
  return state() == State::Ready && dataOverlap(tiling, index);
}

bool TileProvider::hasFinerColours(const Tiling& tiling, const TileIndex& index) const {
  return hasFiner(tiling, index, colourLayout);
}

bool TileProvider::hasFinerHeights(const Tiling& tiling, const TileIndex& index) const {
  return hasFiner(tiling, index, heightLayout);
}

bool TileProvider::hasFiner(const Tiling& tiling, const TileIndex& index, const TileLayout& layout) const {
  return state() == State::Ready && dataFiner(tiling, index, layout);
}

}  // namespace meridian::globebrowsing

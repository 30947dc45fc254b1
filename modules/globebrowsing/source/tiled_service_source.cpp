#include "globebrowsing/source/tiled_service_source.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "globebrowsing/source/resample_parts.h"
#include "globebrowsing/source/tile_plan.h"

namespace meridian::globebrowsing {

namespace {

template <class Pixels>
struct Kind;
template <>
struct Kind<ColourPixels> {
  static constexpr PixelKind kind = PixelKind::Colours;
  static constexpr auto read = readColours;
  using Pixel = Rgba;
};
template <>
struct Kind<HeightPixels> {
  static constexpr PixelKind kind = PixelKind::Heights;
  static constexpr auto read = readHeights;
  using Pixel = float;
};

template <class Pixels>
class ServiceTask final : public PixelTask<Pixels> {
 public:
  ServiceTask(const TiledServiceSource& source, const TileRequest& tile)
      : source_(source), tile_(tile), plan_(source.pyramid()) {}

  bool prepare(double priority, const std::function<void()>& wake) override {
    if (!isPlanned_) {
      isPlanned_ = true;
      if (source_.overlaps(tile_.tiling, tile_.index)) {
        if (auto planned = sampleTile(plan_, tile_, static_cast<typename Kind<Pixels>::Pixel*>(nullptr), {});
            !planned) {
          error_ = std::move(planned.error());
          return true;
        }
      }
    }
    while (true) {
      if (!wants_.empty() && !wants_.back()->isSettled()) {
        return false;
      }
      takeAnswers();
      plan_.addStandIns(Kind<Pixels>::kind);
      if (!ask(priority, wake)) {
        return true;
      }
    }
  }

  void setPriority(double priority) override {
    if (!wants_.empty()) {
      wants_.back()->setPriority(priority);
    }
  }

  Result<Pixels> make(const std::stop_token& stop) override {
    if (error_) {
      return tl::make_unexpected(*error_);
    }
    const bool isAny = std::any_of(plan_.tiles().begin(), plan_.tiles().end(),
                                   [](const auto& tile) { return tile.second.tile != nullptr; });
    if (!isAny) {
      Pixels nothing;
      nothing.size = tile_.layout.size();
      return flaw_ ? Result<Pixels>(tl::make_unexpected(*flaw_)) : nothing;
    }
    TileMosaic mosaic(source_.pyramid(), plan_.tiles(), source_.heightLimits());
    auto pixels = Kind<Pixels>::read(mosaic, tile_, stop);
    if (mosaic.implausible() && !flaw_) {
      flaw_ = implausibleHeight(*mosaic.implausible(), source_.heightLimits(), source_.service().where);
    }
    return pixels;
  }

  std::optional<Error> flaw() const override { return flaw_; }

 private:
  /// Of the last want, which is settled.
  void takeAnswers() {
    for (std::size_t i = 0; i < asked_.size(); ++i) {
      SourceTileAnswer answer = wants_.back()->answer(i);
      PlannedTile& planned = plan_.tiles().at(asked_[i]);
      planned.tile = std::move(answer.tile);
      planned.isAbsent = planned.tile == nullptr;
      if (answer.error) {
        flaw_ = std::move(answer.error);
      }
    }
    asked_.clear();
  }

  /// False when there is nothing left to ask for. Earlier wants are kept, so that their tiles stay in memory and what
  /// turned out to be absent is not asked for again meanwhile.
  bool ask(double priority, const std::function<void()>& wake) {
    for (const auto& [address, tile] : plan_.tiles()) {
      if (tile.tile == nullptr && !tile.isAbsent) {
        asked_.push_back(address);
      }
    }
    if (asked_.empty()) {
      return false;
    }
    wants_.push_back(source_.store().want({source_.sharedService(), Kind<Pixels>::kind, asked_, priority, wake}));
    return true;
  }

  const TiledServiceSource& source_;
  TileRequest tile_;
  std::vector<std::unique_ptr<SourceTileStore::Want>> wants_;
  std::vector<TileAddress> asked_;  ///< of the last want, until its answers have been taken
  bool isPlanned_ = false;
  TilePlan plan_;  ///< after the wants: it lets go of tiles before they are unwanted
  std::optional<Error> error_;
  std::optional<Error> flaw_;
};

tl::unexpected<Error> notAtOnce(const TileService& service) {
  return failure("the tiles of a map service cannot be had at once", service.where);
}

}  // namespace

Result<std::shared_ptr<TiledServiceSource>> TiledServiceSource::make(TileService service,
                                                                     std::shared_ptr<SourceTileStore> store,
                                                                     const HeightLimits& limits) {
  if (!service.url) {
    return failure("the tile service has no addresses", service.where, "give the address of its tiles");
  }
  auto pyramid = ServicePyramid::of(service);
  if (!pyramid) {
    return tl::make_unexpected(pyramid.error());
  }
  return std::shared_ptr<TiledServiceSource>(
      new TiledServiceSource(std::move(service), std::move(*pyramid), std::move(store), limits));
}

bool TiledServiceSource::overlaps(const Tiling& tiling, const TileIndex& index) const {
  return reaches(pyramid_.pyramid().georeference, tiling, index);
}

bool TiledServiceSource::hasDataFiner(const Tiling& tiling, const TileIndex& index, const TileLayout& layout) const {
  if (!overlaps(tiling, index)) {
    return false;
  }
  return isFinerAt(pyramid_.pyramid(), {nominalSpacing(tiling, index, layout)}, tiling.geodetic(index, {0.5, 0.5}));
}

Result<ColourPixels> TiledServiceSource::colours(const Tiling& /*tiling*/, const TileIndex& /*index*/,
                                                 const TileLayout& /*layout*/, std::stop_token /*stop*/) const {
  return notAtOnce(*service_);
}

Result<HeightPixels> TiledServiceSource::heights(const Tiling& /*tiling*/, const TileIndex& /*index*/,
                                                 const TileLayout& /*layout*/, std::stop_token /*stop*/) const {
  return notAtOnce(*service_);
}

std::unique_ptr<ColourTask> TiledServiceSource::colourTask(const Tiling& tiling, const TileIndex& index,
                                                           const TileLayout& layout) const {
  return std::make_unique<ServiceTask<ColourPixels>>(*this, TileRequest{tiling, index, layout});
}

std::unique_ptr<HeightTask> TiledServiceSource::heightTask(const Tiling& tiling, const TileIndex& index,
                                                           const TileLayout& layout) const {
  return std::make_unique<ServiceTask<HeightPixels>>(*this, TileRequest{tiling, index, layout});
}

}  // namespace meridian::globebrowsing

#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <glm/vec4.hpp>

#include "globebrowsing/gpu/composer.h"
#include "globebrowsing/gpu/composite_gathering.h"
#include "globebrowsing/gpu/composite_generations.h"
#include "globebrowsing/gpu/composite_key.h"
#include "globebrowsing/gpu/composite_owners.h"
#include "globebrowsing/gpu/fade_watch.h"
#include "globebrowsing/gpu/opening_wait.h"
#include "globebrowsing/gpu/slot_pool.h"
#include "globebrowsing/layers/layer_manager.h"
#include "globebrowsing/streaming/tile_streamer.h"

namespace meridian::globebrowsing {

/// The colours of tiles, as composites in slots of an array texture: knows what each was made from, has those that are
/// wanted composed, nearest first, under the frame's budget, and says what a chunk draws: its own tile's composite, or
/// beyond the finest data an ancestor's (CompositeOwners). When layers or settings change the composites of before are
/// drawn until they have been composed anew. What each is made from, CompositeGathering brings.
///
/// When a layer moves on to another step in time, composites of the new step are made beside the old
/// (CompositeGenerations); as soon as they cover all that the last frame drew, they are exchanged at once. If the pool
/// has no room for both, the new ones replace the old one by one. Between two steps of a layer that interpolates, both
/// are there and what is drawn is a mixture, until time leaves them.
///
/// While the opacity of one layer of one kind moves, a second composite lies beside each that is drawn, in which that
/// layer has the opacity of the other end (as a rule 0 or 1): what is drawn is a mixture, and nothing is composed anew
/// in each frame. When the opacity rests, the second takes the first one's place, or the first is composed anew. Where
/// mixtures are not exact (mixesExactly), several layers fade, or the pool has no room, each change is composed. Only
/// one thing is mixed on a globe, and what is being interpolated before what fades.
/// Owned by GlobeTiles. Render thread only; a steady frame allocates nothing.
class CompositeStore {
 public:
  /// Layers and streamer must outlive the store.
  CompositeStore(std::shared_ptr<const Tiling> tiling, LayerManager& layers, TileStreamer& streamer,
                 std::unique_ptr<Composer> composer, std::uint32_t capacity);

  /// What it has is drawn from now on, or would be: it no longer belongs to a surface that is filled in place of
  /// another.
  void setShown() { isShown_ = true; }
  void beginFrame(std::uint64_t frame);
  void endFrame();

  /// What a tile's colours lack.
  struct State {
    bool present = true;  ///< every kind in use has the tile's own composite, if only of an earlier setting
    bool current = true;  ///< and they are of the present structure and settings
    State& operator&=(const State& other) {
      present = present && other.present;
      current = current && other.current;
      return *this;
    }
  };
  /// Asks for what the tile's colours lack; it draws composites of at most that level.
  State want(const TileIndex& index, int colourLevel, double priority);
  /// The same without asking.
  [[nodiscard]] State state(const TileIndex& index, int colourLevel) const;
  void keep(const TileIndex& index, int colourLevel);
  /// Composes what has all its raw tiles, greatest priority first, for about that long; at least one each frame.
  /// Drivers draw later than they are told, so the time is reckoned from the texels, not measured.
  void compose(double milliseconds);

  /// Whether some enabled layer has finer data within the tile than the tile's own composites show.
  [[nodiscard]] bool hasFiner(const TileIndex& index) const { return owners_.hasFiner(index); }

  /// Before a frame's first place(), also where nothing is placed: what was drawn before is not drawn any more. In
  /// frames that are not drawn it counts as drawn: a host without a window draws none while it waits for a view to
  /// settle.
  void beginDrawing();
  /// What a chunk draws of a kind: its own composite or the nearest ancestor's; nothing where there is none.
  struct Placement {
    std::uint32_t slot = 0;
    glm::vec4 transform{0.0F};    ///< texture coordinate = xy + zw * unit square of the chunk
    std::uint32_t otherSlot = 0;  ///< what to mix with, at the same texture coordinate
    float otherWeight = 0.0F;     ///< and how much of it, 0 to 1
  };
  [[nodiscard]] std::optional<Placement> place(CompositeKind kind, const TileIndex& index, int colourLevel);

  /// Whether any enabled layer is of that kind and can be composed; Base always is in use.
  [[nodiscard]] bool inUse(CompositeKind kind) const {
    return kind == CompositeKind::Base ||
           (!generations(kind).layers().empty() && !composer_->programs().hasFailed(kind));
  }
  /// Whether the base's alpha is less than 1 where there is water.
  [[nodiscard]] bool hasWater() const { return !layers_.group(LayerGroupId::WaterMasks).enabledLayers().empty(); }
  /// The kind of which two composites should be mixed in this frame.
  [[nodiscard]] std::optional<CompositeKind> fading() const { return fading_; }
  /// Every frame, before anything is wanted: the kind of which two composites can be mixed by what draws.
  void setMixing(std::optional<CompositeKind> kind) { mixing_ = kind; }
  /// How many composites were composed, ever.
  [[nodiscard]] std::uint64_t composedCount() const { return composedCount_; }
  [[nodiscard]] const Composer& composer() const { return *composer_; }
  /// Why what is asked for is not complete, or an empty string. `areTilesStale`: whether some of the tiles that this is
  /// asked about were wanted in this frame and not current.
  [[nodiscard]] std::string waitingFor(bool areTilesStale) const;
  /// Whether the last compose() had more composites to hold than the pool can: what is missing then stays missing.
  [[nodiscard]] bool full() const { return unplaced_ > 0; }
  /// Bytes of the composites and raw tiles that are there.
  [[nodiscard]] std::size_t residentBytes() const {
    return slots_.used() * Composer::bytesPerComposite() + composer_->rawTileBytes();
  }

 private:
  /// What to draw a composite mixed with.
  struct Mixture {
    std::uint32_t slot = 0;
    float weight = 0.0F;
    bool exact = false;  ///< it shows the present opacities, not those nearest to them
  };
  struct Kind {
    OpeningWait opening;
    FadeWatch fade;
    bool noRoomToFade = false;  ///< the pool has none for second composites, as long as this fade goes on
    std::vector<CompositeGathering::Drawn> drawn;  ///< in the last frame that was drawn, where the kind has steps
    bool isExchanged = false;  ///< what was wanted in this frame is of steps that are not drawn any more, or not alone
  };

  [[nodiscard]] Kind& of(CompositeKind kind) { return kinds_[static_cast<std::size_t>(kind)]; }
  [[nodiscard]] const Kind& of(CompositeKind kind) const { return kinds_[static_cast<std::size_t>(kind)]; }
  [[nodiscard]] CompositeGenerations& generations(CompositeKind kind) {
    return generations_[static_cast<std::size_t>(kind)];
  }
  [[nodiscard]] const CompositeGenerations& generations(CompositeKind kind) const {
    return generations_[static_cast<std::size_t>(kind)];
  }
  [[nodiscard]] const CompositeContents* find(const CompositeKey& key) const;

  void updateKind(CompositeKind kind);
  [[nodiscard]] CompositeKey nextKey(CompositeKind kind, const TileIndex& index, int colourLevel) const;
  [[nodiscard]] bool nextCovers(CompositeKind kind) const;
  void wantNext(CompositeKind kind);

  /// Calls `use` with the keys of all composites that a tile draws.
  template <class Use>
  void forEachKey(const TileIndex& index, int colourLevel, Use use) const;
  State wantComposite(const CompositeKey& key, double priority);
  /// Asks for what the composite is made from, unless it is queued already.
  void request(CompositeGathering::Request request);
  [[nodiscard]] State stateOf(const CompositeKey& key) const;
  enum class Composed { Done, NoSlot, NoRawTiles };
  Composed composeOne(const CompositeGathering::Queued& queued);
  void noteFull(const CompositeKey& key);
  /// Where that tile's composite is drawn; nothing where there is none.
  [[nodiscard]] std::optional<Placement> placeAt(const CompositeKey& key, const glm::vec4& transform);

  void updateMixing();
  /// The kind that is to be mixed because it is between two steps.
  [[nodiscard]] std::optional<CompositeKind> kindBetweenSteps() const;
  /// What the composite of that key is drawn mixed with in a fade, if anything.
  [[nodiscard]] std::optional<Mixture> mixture(const CompositeKey& key) const;
  /// The opacity with which a second composite would bring the one of that key up to date, if any would.
  [[nodiscard]] std::optional<LayerOpacity> otherEnd(const CompositeKey& key) const;
  /// After a fade: has what is drawn mixed become one composite again.
  void endMixing(const CompositeKey& key, const Mixture& mixture, double priority);
  void useOther(const CompositeKey& key, std::uint64_t frame);
  /// Adds what the composite is mixed with in a fade.
  [[nodiscard]] Placement mixedPlacement(const CompositeKey& key, Placement placement);
  /// Adds the composite of the other step; nothing where there is none.
  [[nodiscard]] std::optional<Placement> pairedPlacement(const CompositeKey& other, Placement placement);

  std::shared_ptr<const Tiling> tiling_;
  LayerManager& layers_;
  std::unique_ptr<Composer> composer_;
  CompositeOwners::Generations generations_;
  CompositeGathering gathering_;
  CompositeOwners owners_;
  SlotPool<CompositeKey> slots_;
  std::vector<CompositeContents> slotContents_;
  std::array<Kind, compositeKindCount> kinds_;
  std::uint64_t frame_ = 0;
  std::optional<CompositeKind> fading_;
  bool interpolates_ = false;  ///< `fading_` is mixed because it is between two steps in time
  std::optional<CompositeKind> mixing_;
  bool isDrawnOld_ = true;  ///< what kinds have in `drawn` is of an earlier frame
  bool isShown_ = false;
  bool drewMixed_ = false;  ///< since the last beginFrame()
  bool mixedLast_ = false;  ///< in the last frame
  std::uint64_t composedCount_ = 0;
  std::size_t missing_ = 0;   ///< shown composites wanted in this frame that are not current
  bool lackedSome_ = false;   ///< in the last frame
  std::size_t unplaced_ = 0;  ///< of these, those that have their raw tiles but no room
};

}  // namespace meridian::globebrowsing

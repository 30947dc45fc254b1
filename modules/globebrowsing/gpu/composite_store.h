#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include <glm/vec4.hpp>

#include "globebrowsing/gpu/composer.h"
#include "globebrowsing/gpu/composite_kind.h"
#include "globebrowsing/gpu/fade_watch.h"
#include "globebrowsing/gpu/height_composition.h"
#include "globebrowsing/gpu/opening_wait.h"
#include "globebrowsing/gpu/slot_pool.h"
#include "globebrowsing/gpu/stand_in.h"
#include "globebrowsing/layers/layer_manager.h"
#include "globebrowsing/streaming/tile_streamer.h"

namespace meridian::globebrowsing {

/// Names a composite.
struct CompositeKey {
  CompositeKind kind = CompositeKind::Base;
  TileIndex index;
  std::uint8_t side = 0;  ///< 0 or 1: composites of two times lie side by side; fadeSide: the other end of a fade
  static constexpr std::uint8_t fadeSide = 2;
  bool operator==(const CompositeKey&) const = default;
};

}  // namespace meridian::globebrowsing

template <>
struct std::hash<meridian::globebrowsing::CompositeKey> {
  std::size_t operator()(const meridian::globebrowsing::CompositeKey& key) const noexcept {
    return std::hash<meridian::globebrowsing::TileIndex>()(key.index) * 9 + 3 * static_cast<std::size_t>(key.kind) +
           key.side;
  }
};

namespace meridian::globebrowsing {

/// The colours of tiles: decides which tile's composite a chunk draws (its own, or beyond the finest data that of an
/// ancestor), asks for the raw tiles that it needs, and has it composed. When layers or settings change the composites
/// of before are drawn until they have been composed anew, nearest first, under the frame's budget. A layer whose tile
/// is late does not hold up the others: an ancestor's tile stands in for it, or the layers below show, and when it
/// comes the composite is composed anew.
///
/// When a layer moves on to another step in time, composites of the new step are made beside the old; as soon as they
/// cover all that the last frame drew, they are exchanged at once. If the pool has no room for both, the new ones
/// replace the old one by one. Between two steps of a layer that interpolates, both are there and what is drawn is a
/// mixture, until time leaves them.
///
/// While the opacity of one layer of one kind moves, a second composite lies beside each that is drawn, in which that
/// layer has the opacity of the other end (as a rule 0 or 1): what is drawn is a mixture, and nothing is composed anew
/// in each frame. When the opacity rests, the second takes the first one's place, or the first is composed anew. Where
/// mixtures are not exact (mixesExactly), several layers fade, or the pool has no room, each change is composed. Only
/// one thing is mixed on a globe, and what is being interpolated before what fades.
/// Render thread only; a steady frame allocates nothing.
class CompositeStore {
 public:
  /// Both must outlive the store.
  CompositeStore(std::shared_ptr<const Tiling> tiling, LayerManager& layers, TileStreamer& streamer,
                 std::unique_ptr<Composer> composer, std::uint32_t capacity);

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
  [[nodiscard]] bool hasFiner(const TileIndex& index) const;

  /// What a chunk draws of a kind: its own composite or the nearest ancestor's; nothing where there is none.
  struct Placement {
    std::uint32_t slot = 0;
    glm::vec4 transform{0.0F};    ///< texture coordinate = xy + zw * unit square of the chunk
    std::uint32_t otherSlot = 0;  ///< what to mix with, at the same texture coordinate
    float otherWeight = 0.0F;     ///< and how much of it, 0 to 1
  };
  [[nodiscard]] std::optional<Placement> place(CompositeKind kind, const TileIndex& index, int colourLevel);

  /// Whether any enabled layer is of that kind; Base always is in use.
  [[nodiscard]] bool inUse(CompositeKind kind) const;
  /// Whether the base's alpha is less than 1 where there is water.
  [[nodiscard]] bool hasWater() const { return !layers_.group(LayerGroupId::WaterMasks).enabledLayers().empty(); }
  /// The kind of which two composites should be mixed in this frame.
  [[nodiscard]] std::optional<CompositeKind> fading() const { return fading_; }
  /// Every frame, before anything is wanted: the kind of which two composites can be mixed by what draws.
  void setMixing(std::optional<CompositeKind> kind) { mixing_ = kind; }
  /// How many composites were composed, ever.
  [[nodiscard]] std::uint64_t composedCount() const { return composedCount_; }
  [[nodiscard]] const Composer& composer() const { return *composer_; }
  /// Why what is asked for is not complete, or an empty string.
  [[nodiscard]] std::string waitingFor() const;
  /// Whether the last compose() had more composites to hold than the pool can: what is missing then stays missing.
  [[nodiscard]] bool full() const { return unplaced_ > 0; }
  /// Bytes of the composites and raw tiles that are there.
  [[nodiscard]] std::size_t residentBytes() const {
    return slots_.used() * Composer::bytesPerComposite() + composer_->rawTileBytes();
  }

 private:
  /// Facts of tiles long gone are dropped when there are that many.
  static constexpr std::size_t mostFacts = 1 << 15;
  /// What is known of a tile's colours as long as no layer changes.
  struct Facts {
    std::array<std::uint8_t, compositeKindCount> ownerLevel{};  ///< of the tile whose composite is drawn
    bool finer = false;
  };
  /// The layers of a kind, each at one of its steps.
  struct Generation {
    std::vector<LayerStepPointer> steps;  ///< by layer; null where it has none yet
    std::uint8_t side = 0;                ///< of its composites' keys
    std::uint64_t since = 0;              ///< composites with an earlier stamp show other steps
    std::uint64_t stamp = 0;              ///< composites with an earlier stamp are to be composed anew
  };
  /// What a slot's composite was made from.
  struct Contents {
    std::uint64_t stamp = 0;
    LayerOpacities layers;
    std::uint64_t drawn = 0;  ///< the last frame that drew it
    unsigned lack = 0;        ///< Lack::coarser
  };
  /// What to draw a composite mixed with.
  struct Mixture {
    std::uint32_t slot = 0;
    float weight = 0.0F;
    bool exact = false;  ///< it shows the present opacities, not those nearest to them
  };
  struct Drawn {
    TileIndex index;
    int colourLevel = 0;
  };
  /// Of `next`, as long as it is mixed with what is shown, or is going to be.
  struct Pair {
    bool isPair = false;   ///< both are of the same tiles, those that either needs
    bool isMixed = false;  ///< it covers the view: both are drawn
    bool isHeld = false;   ///< time is between the two: they are not exchanged
    double weight = 0.0;   ///< how much of `next` is seen, 0 to 1
  };
  struct KindState {
    std::uint64_t version = 0;       ///< of the groups' settings
    std::vector<Layer*> layers;      ///< that are enabled
    StructureKey key;                ///< of these
    std::uint32_t reliefStream = 0;  ///< that its composites were last made from, if any of its layers colours heights
    OpeningWait opening;
    FadeWatch fade;
    bool noRoomToFade = false;  ///< the pool has none for second composites, as long as this fade goes on
    Generation shown;
    Generation next;
    bool hasNext = false;  ///< `next` is being composed, or mixed with what is shown
    Pair pair;
    std::optional<std::size_t> interpolated;   ///< the topmost layer that is between two steps
    std::optional<std::uint64_t> crowdedStep;  ///< of such a layer, for whose other step the pool has no room
    bool crowded = false;                      ///< the pool has no room for it
    bool hasSteps = false;
    std::uint64_t lastStamp = 0;
    std::unordered_map<TileIndex, std::uint8_t> nextOwnerLevels;
    std::vector<Drawn> drawn;  ///< since the last compose(), where the kind has steps
    bool wasDrawn = false;     ///< in the last frame: a surface that is still filled is not
  };
  struct Request {
    CompositeKey key;
    double priority = 0.0;
    std::size_t firstPart = 0;
    std::size_t partCount = 0;
    bool isMissing = true;  ///< what is drawn without it is not what it should be
    unsigned lack = 0;      ///< Lack::coarser
  };

  [[nodiscard]] KindState& of(CompositeKind kind) { return kinds_[static_cast<std::size_t>(kind)]; }
  [[nodiscard]] const KindState& of(CompositeKind kind) const { return kinds_[static_cast<std::size_t>(kind)]; }
  [[nodiscard]] const Generation& generationOf(const CompositeKey& key) const;

  /// Whether facts are out of date.
  bool updateKind(CompositeKind kind);
  void takeLayers(CompositeKind kind);
  void keepStandIns();
  void takeSteps(KindState& state);
  /// The same of one generation.
  void takeSteps(KindState& state, Generation& generation);
  void beginNext(CompositeKind kind);
  void dropNext(KindState& state);
  void updateInterpolation(KindState& state) const;
  /// The kind that is to be mixed because it is between two steps.
  [[nodiscard]] std::optional<CompositeKind> kindBetweenSteps() const;
  /// Whether that is so of this one, and no fade is still to end first.
  [[nodiscard]] bool isInterpolated(CompositeKind kind) const;
  /// The step of that layer that is to be shown; `other`: where it is interpolated, the one to mix with that.
  [[nodiscard]] const LayerStepPointer& stepOf(const KindState& state, std::size_t layer, bool other) const;
  /// Whether a generation is of these steps.
  [[nodiscard]] bool isOf(const KindState& state, const Generation& generation, bool other) const;
  void keepPair(CompositeKind kind);
  void weighPair(CompositeKind kind);
  /// The composite that the shown one of that key is drawn mixed with, while two steps are.
  [[nodiscard]] std::optional<CompositeKey> pairedKey(const CompositeKey& key) const;
  void updateFading();
  [[nodiscard]] std::uint64_t settingsVersion(CompositeKind kind) const;
  /// The next generation covers what is drawn, or has no room.
  void endNext(KindState& state);
  void exchange(KindState& state);
  [[nodiscard]] bool nextCovers(CompositeKind kind) const;
  void wantNext(CompositeKind kind);
  void fetchAhead(CompositeKind kind);

  [[nodiscard]] TileIndex ancestor(TileIndex index, int level) const;
  [[nodiscard]] const Facts& facts(const TileIndex& index) const;
  [[nodiscard]] bool anyFiner(CompositeKind kind, const Generation& generation, const TileIndex& index) const;
  /// The same of what is drawn.
  [[nodiscard]] bool anyFiner(CompositeKind kind, const TileIndex& index) const;
  /// Whether that layer shows more in composites that are finer than the tile's.
  [[nodiscard]] bool isFiner(const Layer& layer, const LayerStepPointer& step, const TileIndex& index) const;
  [[nodiscard]] CompositeKey shownKey(CompositeKind kind, const TileIndex& index, int colourLevel) const;
  [[nodiscard]] CompositeKey nextKey(CompositeKind kind, const TileIndex& index, int colourLevel) const;
  [[nodiscard]] std::uint8_t nextOwnerLevel(CompositeKind kind, const TileIndex& index) const;
  State wantComposite(const CompositeKey& key, double priority);
  /// Asks for what the composite is made from, unless that was done in this frame. `other`: an opacity to compose it
  /// with instead of the layer's own.
  void request(Request request, const LayerOpacity& other = {});
  [[nodiscard]] State stateOf(const CompositeKey& key) const;
  Lack gather(const CompositeKey& key, double priority, const LayerOpacity& other);
  /// What that layer adds to the composite; asks for it unless it is there, or never will be.
  Lack gatherPart(CompositionPart& part, const LayerStepPointer& step, const CompositeKey& key, double priority);
  /// Whether a composite of the parts from that one on, something of which is late, is better than what there is.
  [[nodiscard]] bool isGain(const Request& request) const;
  /// Whether the composite is drawn, but of earlier steps (or heights) of its layers.
  [[nodiscard]] bool showsEarlier(const CompositeKey& key) const;
  /// Whether a composite may be without the layer's tile, if that is late. What shows a layer at another time is better
  /// than what does not show it.
  [[nodiscard]] bool mayLack(const Layer& layer, const CompositeKey& key) const;
  /// What the composite of that key is drawn mixed with, if anything.
  [[nodiscard]] std::optional<Mixture> mixture(const CompositeKey& key) const;
  /// The opacity with which a second composite would bring the one of that key up to date, if any would.
  [[nodiscard]] std::optional<LayerOpacity> otherEnd(const CompositeKey& key) const;
  /// After a fade: has what is drawn mixed become one composite again.
  void endMixing(const CompositeKey& key, const Mixture& mixture, double priority);
  enum class Composed { Done, NoSlot, NoRawTiles };
  Composed composeOne(const Request& request);
  void noteFull(const Request& request);
  void useOther(const CompositeKey& key, std::uint64_t frame);
  /// Where that tile's composite is drawn; nothing where there is none.
  [[nodiscard]] std::optional<Placement> placeAt(const CompositeKey& key, const glm::vec4& transform);
  [[nodiscard]] std::optional<Placement> pairedPlacement(const CompositeKey& other, Placement placement);
  /// Adds what the composite is mixed with.
  [[nodiscard]] Placement mixedPlacement(const CompositeKey& key, Placement placement);

  std::shared_ptr<const Tiling> tiling_;
  LayerManager& layers_;
  TileStreamer& streamer_;
  std::unique_ptr<Composer> composer_;
  HeightComposition relief_;
  SlotPool<CompositeKey> slots_;
  std::vector<Contents> slotContents_;
  mutable std::array<KindState, compositeKindCount> kinds_;
  mutable std::unordered_map<TileIndex, Facts> facts_;
  std::vector<Request> requests_;
  std::vector<CompositionPart> parts_;
  std::vector<TileDataPointer> held_;  ///< the raw tiles of parts_
  std::uint64_t frame_ = 0;
  std::optional<CompositeKind> fading_;
  bool interpolates_ = false;  ///< `fading_` is mixed because it is between two steps in time
  std::optional<CompositeKind> mixing_;
  bool drewMixed_ = false;  ///< since the last beginFrame()
  bool mixedLast_ = false;  ///< in the last frame
  std::uint64_t composedCount_ = 0;
  std::size_t missing_ = 0;   ///< shown composites wanted in this frame that are not current
  bool lackedSome_ = false;   ///< in the last frame
  std::size_t unplaced_ = 0;  ///< of these, those that have their raw tiles but no room
};

}  // namespace meridian::globebrowsing

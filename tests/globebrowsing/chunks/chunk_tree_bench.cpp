// Selection, culling, skirts and sorting for a number of visited chunks, low over the Earth; the goal is 0.5 ms for
// 1000, that is 500 ns a chunk. `per_visited` is printed with its unit.

#include <cmath>
#include <unordered_map>
#include <vector>

#include <benchmark/benchmark.h>

#include "globebrowsing/chunks/chunk_tree.h"
#include "globebrowsing/tiling/geodetic_tiling.h"
#include "test_views.h"

namespace meridian::globebrowsing {
namespace {

/// Costs nothing itself, so that selection alone is measured.
class FreeResidency : public TileResidency {
 public:
  void want(const TileIndex&, int, double, std::uint32_t) override {}
  void renewShape(const TileIndex&, double, std::uint32_t) override {}
  void keep(const TileIndex&, int) override {}
  [[nodiscard]] State state(const TileIndex&, int) const override { return State::Complete; }
  [[nodiscard]] HeightRange heightRange(const TileIndex&) const override { return {-100.0, 4000.0}; }
  [[nodiscard]] unsigned heightVersion(const TileIndex&) const override { return 1; }
  [[nodiscard]] SurfaceErrors surfaceErrors(const TileIndex& index) const override {
    SurfaceErrors errors;
    double error = std::ldexp(1e6, -2 * index.level);
    for (double& vertical : errors.vertical) {
      vertical = error;
      error *= 0.25;
    }
    return errors;
  }
  [[nodiscard]] bool hasFinerColours(const TileIndex&) const override { return true; }
};

/// Looks every answer up in a hash table, as a real one has to.
class TableResidency final : public FreeResidency {
 public:
  void want(const TileIndex& index, int /*colourLevel*/, double priority, std::uint32_t /*views*/) override {
    tiles_[index].priority = priority;
  }
  void keep(const TileIndex& index, int /*colourLevel*/) override { tiles_[index].kept = true; }
  [[nodiscard]] State state(const TileIndex& index, int /*colourLevel*/) const override { return find(index).state; }
  [[nodiscard]] unsigned heightVersion(const TileIndex& index) const override { return find(index).version; }
  [[nodiscard]] SurfaceErrors surfaceErrors(const TileIndex& index) const override {
    SurfaceErrors errors = FreeResidency::surfaceErrors(index);
    const double scale = find(index).error;
    for (double& vertical : errors.vertical) {
      vertical *= scale;
    }
    return errors;
  }
  [[nodiscard]] bool hasFinerColours(const TileIndex& index) const override { return find(index).version > 0; }

 private:
  struct Tile {
    State state = State::Complete;
    unsigned version = 1;
    double error = 1.0;
    double priority = 0.0;
    bool kept = false;
  };
  [[nodiscard]] const Tile& find(const TileIndex& index) const { return tiles_[index]; }
  mutable std::unordered_map<TileIndex, Tile> tiles_;
};

template <class Residency>
void select(benchmark::State& state) {
  const GeodeticTiling tiling(testEarth());
  ChunkTree tree(tiling);
  Residency residency;
  SelectionSettings settings;
  const std::vector<SelectionView> views{viewAbove(testEarth(), {0.7, 0.2, 2e4}, 0.3, 0.3)};
  // As fine a picture as visits that many.
  for (tree.select(views, settings, residency); tree.figures().visited < state.range(0); settings.scale *= 1.02) {
    tree.select(views, settings, residency);
  }
  for (auto _ : state) {
    tree.select(views, settings, residency);
    benchmark::DoNotOptimize(tree.selected().data());
  }
  const double visited = tree.figures().visited;
  state.counters["visited"] = visited;
  state.counters["drawn"] = static_cast<double>(tree.selected().size());
  state.counters["per_visited"] =
      benchmark::Counter(visited, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}
BENCHMARK_TEMPLATE(select, FreeResidency)->Arg(250)->Arg(1000)->Arg(4000);
BENCHMARK_TEMPLATE(select, TableResidency)->Arg(1000);

}  // namespace
}  // namespace meridian::globebrowsing

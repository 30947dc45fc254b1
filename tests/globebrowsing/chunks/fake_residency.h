#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <vector>

#include <gtest/gtest.h>

#include "globebrowsing/streaming/tile_residency.h"

namespace meridian::globebrowsing {

/// A residency without memory: what a tile has is decided by functions of its index, and what is asked for is recorded
/// in a table of fixed size, so that it allocates nothing.
class FakeResidency final : public TileResidency {
 public:
  std::function<State(const TileIndex&)> stateOf = [](const TileIndex&) { return State::Complete; };
  std::function<bool(const TileIndex&)> finerColours = [](const TileIndex&) { return true; };
  /// Of an Earth drawn with 2 segments a side: the sagitta, and relief.
  double errorAtRoot = 1e6;
  HeightRange range{0.0, 0.0};
  unsigned version = 1;

  struct Wish {
    TileIndex index;
    double priority = 0.0;
    bool kept = false;
    bool wanted = false;
    bool renewed = false;
    [[nodiscard]] bool isMade() const { return kept || wanted || renewed; }
  };
  static constexpr std::size_t size = 1U << 16U;

  FakeResidency() : wishes(size) {}

  void newFrame() { std::fill(wishes.begin(), wishes.end(), Wish{}); }
  [[nodiscard]] const Wish* wish(const TileIndex& index) const {
    const Wish& found = wishes[slot(index)];
    return (found.kept || found.wanted) && found.index == index ? &found : nullptr;
  }

  void want(const TileIndex& index, int /*colourLevel*/, double priority, std::uint32_t /*views*/) override {
    Wish& wish = wishes[slot(index)];
    wish.index = index;
    wish.wanted = true;
    wish.priority = priority;
    allFinite = allFinite && std::isfinite(priority);
  }
  void renewShape(const TileIndex& index, double priority, std::uint32_t /*views*/) override {
    Wish& wish = wishes[slot(index)];
    EXPECT_FALSE(wish.wanted && wish.index == index) << "asked for twice";
    wish.index = index;
    wish.renewed = true;
    wish.priority = priority;
    allFinite = allFinite && std::isfinite(priority);
  }
  void keep(const TileIndex& index, int /*colourLevel*/) override {
    Wish& wish = wishes[slot(index)];
    wish.index = index;
    wish.kept = true;
  }
  [[nodiscard]] State state(const TileIndex& index, int /*colourLevel*/) const override { return stateOf(index); }
  [[nodiscard]] HeightRange heightRange(const TileIndex&) const override {
    ++rangesAsked;
    return range;
  }
  [[nodiscard]] unsigned heightVersion(const TileIndex&) const override { return version; }
  [[nodiscard]] SurfaceErrors surfaceErrors(const TileIndex& index) const override {
    SurfaceErrors errors;
    double error = errorAtRoot * std::ldexp(1.0, -2 * index.level);
    for (double& vertical : errors.vertical) {
      vertical = error;
      error *= 0.25;
    }
    errors.unlike = index.x % 2 == 1 ? unlikeInOddColumns : 0.0;
    return errors;
  }
  [[nodiscard]] bool hasFinerColours(const TileIndex& index) const override { return finerColours(index); }

  double unlikeInOddColumns = 0.0;
  std::vector<Wish> wishes;
  bool allFinite = true;
  mutable int rangesAsked = 0;

 private:
  [[nodiscard]] std::size_t slot(const TileIndex& index) const {
    std::size_t place = std::hash<TileIndex>()(index) % size;
    while (wishes[place].isMade() && wishes[place].index != index) {
      place = (place + 1) % size;
    }
    return place;
  }
};

}  // namespace meridian::globebrowsing

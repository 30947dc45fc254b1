#include "globebrowsing/gpu/composer.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <future>
#include <random>
#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "globebrowsing/layers/blend.h"
#include "globebrowsing/layers/layer_manager.h"
#include "globebrowsing/source/tile_layout.h"
#include "gpu_fixture.h"

namespace meridian::globebrowsing {
namespace {

constexpr int side = colourLayout.size();
using Fields = std::map<std::string, Value, std::less<>>;

glm::dvec4 texel(const std::vector<std::uint8_t>& pixels, int size, int x, int y) {
  const std::size_t at =
      4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(size) + static_cast<std::size_t>(x));
  return glm::dvec4(pixels[at], pixels[at + 1], pixels[at + 2], pixels[at + 3]) / 255.0;
}

class ComposerTest : public GpuTest {
 protected:
  void SetUp() override {
    GpuTest::SetUp();
    if (!graphics_) {
      return;
    }
    auto made = Composer::create(*graphics_, {4, 8});
    ASSERT_TRUE(made) << made.error().message();
    composer_ = std::move(*made);
    graphics_->programs().waitAll();
  }

  Layer* addTileLayer() {
    const std::string name = "Layer" + std::to_string(++count_);
    const auto added = manager_.addLayer(
        "ColorLayers",
        {Table{{}, {{"Identifier", name}, {"FilePath", "none.tif"}, {"Enabled", true}}}, "test", "", ""});
    EXPECT_TRUE(added) << (added ? "" : added.error().message());
    return added ? *added : nullptr;
  }
  Layer* addSolidLayer(const glm::dvec3& colour) {
    const std::string name = "Solid" + std::to_string(++count_);
    const auto added = manager_.addLayer(
        "ColorLayers",
        {Table{{}, {{"Identifier", name}, {"Type", "SolidColor"}, {"Color", Value(colour)}, {"Enabled", true}}}, "test",
         "", ""});
    EXPECT_TRUE(added) << (added ? "" : added.error().message());
    return added ? *added : nullptr;
  }

  std::shared_ptr<const ColourTile> randomTile(bool opaque = false) {
    ColourPixels pixels{side, {}, true, false};
    pixels.rgba.resize(Composer::bytesPerRawTile());
    std::generate(pixels.rgba.begin(), pixels.rgba.end(), [&] { return static_cast<std::uint8_t>(random_()); });
    for (std::size_t alpha = 3; opaque && alpha < pixels.rgba.size(); alpha += 4) {
      pixels.rgba[alpha] = 255;
    }
    return std::make_shared<const ColourTile>(std::move(pixels));
  }

  /// A level of a composite, as numbers from 0 to 255.
  std::vector<std::uint8_t> read(std::uint32_t slot, int level = 0) {
    const int size = side >> level;
    std::vector<std::uint8_t> pixels(4 * static_cast<std::size_t>(size) * static_cast<std::size_t>(size));
    glGetTextureSubImage(composer_->composites(), level, 0, 0, static_cast<GLint>(slot), size, size, 1, GL_RGBA,
                         GL_UNSIGNED_BYTE, static_cast<GLsizei>(pixels.size()), pixels.data());
    return pixels;
  }

  bool compose(std::uint32_t slot, const std::vector<CompositionPart>& parts) {
    composer_->beginFrame(++frame_);
    const bool done = composer_->compose(slot, CompositeKind::Base, parts);
    composer_->endFrame();
    return done;
  }
  void useStructure(bool wait = true) {
    composer_->programs().setStructure(CompositeKind::Base, manager_.group(LayerGroupId::ColorLayers).structureKey());
    if (wait) {
      graphics_->programs().waitAll();
      ASSERT_TRUE(composer_->programs().isOwnReady(CompositeKind::Base))
          << composer_->programs().error(CompositeKind::Base);
    }
  }
  CompositionPart part(const Layer* layer, const ColourTile* tile, UnitSquareTransform transform = {}) {
    CompositionPart part;
    part.layer = layer;
    part.tile = tile;
    part.key = {++stream_, {}};
    part.transform = transform;
    part.opacity = static_cast<float>(layer->effectiveOpacity());
    return part;
  }

  std::mt19937 random_{2016};
  LayerManager manager_;
  std::unique_ptr<Composer> composer_;
  std::uint64_t frame_ = 0;
  std::uint32_t stream_ = 0;
  int count_ = 0;
};

/// Keeps the warm-up thread busy for as long as it lives, so that programs requested meanwhile are not built.
class HeldBuilder {
 public:
  explicit HeldBuilder(graphics::ProgramCache& programs)
      : handle_(programs.request(
            {fmt::format("held {}", ++count), source("void main() { gl_Position = vec4(0.0); }\n", "held.vert"),
             source("void main() {}\n", "held.frag"), [ended = end_.get_future().share()](GLuint) { ended.wait(); }})) {
  }
  HeldBuilder(const HeldBuilder&) = delete;
  HeldBuilder& operator=(const HeldBuilder&) = delete;
  ~HeldBuilder() { end_.set_value(); }

 private:
  static graphics::ShaderSource source(const std::string& body, const std::string& name) {
    return {"#version 450 core\n" + body, {name}};
  }

  static inline int count = 0;  // a known key would hold nothing
  std::promise<void> end_;
  graphics::ProgramHandle handle_;
};

/// What one texel goes through, by the reference; nothing where float and double may decide otherwise.
std::optional<glm::dvec4> reference(const Layer& layer, glm::dvec4 own, const glm::dvec4& below) {
  if (layer.adjustment() == Adjustment::ChromaKey) {
    const double tolerance = layer.chromaKeyTolerance.get();
    if (std::abs(glm::distance(glm::dvec3(own), layer.chromaKeyColour.get()) - tolerance) < 1e-4) {
      return std::nullopt;
    }
    own = chromaKey(own, layer.chromaKeyColour.get(), tolerance);
  }
  own = applySettings(own, layer.settings());
  own.w *= layer.effectiveOpacity();
  return blend(layer.blend(), below, own);
}

TEST_F(ComposerTest, ComposesWhatTheReferenceComputes) {
  Layer* lower = addTileLayer();
  Layer* solid = addSolidLayer({0.2, 0.9, 0.4});
  Layer* upper = addTileLayer();
  solid->opacity.put(0.3);
  const auto lowerTile = randomTile();
  const auto upperTile = randomTile();
  struct Settings {
    double gamma, multiplier, offset, opacity;
  };
  for (const Settings& settings : {Settings{1.0, 1.0, 0.0, 1.0}, Settings{2.2, 0.7, 0.1, 0.6}}) {
    for (int mode = 0; mode < static_cast<int>(blendModeNames().size()); ++mode) {
      for (int adjustment = 0; adjustment < static_cast<int>(adjustmentNames().size()); ++adjustment) {
        upper->blendMode.put(mode);
        upper->adjustmentType.put(adjustment);
        upper->chromaKeyColour.put({0.5, 0.5, 0.5});
        upper->chromaKeyTolerance.put(0.35);
        upper->gamma.put(settings.gamma);
        upper->multiplier.put(settings.multiplier);
        upper->offset.put(settings.offset);
        upper->opacity.put(settings.opacity);
        useStructure();
        const std::vector<CompositionPart> parts{part(lower, lowerTile.get()), part(solid, nullptr),
                                                 part(upper, upperTile.get())};
        ASSERT_TRUE(compose(1, parts));
        const std::vector<std::uint8_t> found = read(1);
        for (int n = 0; n < 3000; ++n) {
          const int x = static_cast<int>(random_() % side);
          const int y = static_cast<int>(random_() % side);
          std::optional<glm::dvec4> expected = glm::dvec4(0.3, 0.3, 0.3, 1.0);
          expected = reference(*lower, texel(lowerTile->pixels().rgba, side, x, y), *expected);
          expected = reference(*solid, glm::dvec4(solid->colour.get(), 1.0), *expected);
          expected = reference(*upper, texel(upperTile->pixels().rgba, side, x, y), *expected);
          if (!expected) {
            continue;
          }
          expected->w = 1.0;  // there is no water
          const glm::dvec4 clamped = glm::clamp(*expected, 0.0, 1.0);
          const glm::dvec4 pixel = texel(found, side, x, y);
          for (int i = 0; i < 4; ++i) {
            // 0.5 of rounding, and one for float pow() and the hue's divisions.
            ASSERT_NEAR(255.0 * pixel[i], 255.0 * clamped[i], 1.5)
                << blendModeNames()[static_cast<std::size_t>(mode)] << " adjustment " << adjustment << " component "
                << i << " at " << x << ", " << y;
          }
        }
      }
    }
  }
}

TEST_F(ComposerTest, ALayerThatHidesAllOthersIsWhatBlendingItGives) {
  Layer* lower = addTileLayer();
  Layer* upper = addTileLayer();
  useStructure();
  const auto lowerTile = randomTile();
  const auto upperTile = randomTile(true);
  ASSERT_TRUE(upperTile->isOpaque());
  std::vector<CompositionPart> parts{part(lower, lowerTile.get()), part(upper, upperTile.get())};
  const double asOne = composer_->estimatedMilliseconds(parts);
  ASSERT_TRUE(compose(1, parts));
  // So little less than 1 that no byte shows it, but then it is blended.
  parts.back().opacity = 0.9999F;
  EXPECT_LT(asOne, composer_->estimatedMilliseconds(parts));
  ASSERT_TRUE(compose(2, parts));
  for (int level = 0; level < Composer::levelCount; ++level) {
    const std::vector<std::uint8_t> whole = read(1, level);
    const std::vector<std::uint8_t> blended = read(2, level);
    for (std::size_t i = 0; i < whole.size(); ++i) {
      ASSERT_NEAR(int{whole[i]}, int{blended[i]}, 1) << "level " << level << ", byte " << i;
    }
  }
}

TEST_F(ComposerTest, TheLoopingProgramDrawsWhatTheUnrolledOneDoes) {
  Layer* lower = addTileLayer();
  Layer* solid = addSolidLayer({0.9, 0.2, 0.1});
  Layer* upper = addTileLayer();
  solid->opacity.put(0.5);
  lower->gamma.put(1.7);
  upper->blendMode.put(static_cast<int>(BlendMode::Color));
  upper->adjustmentType.put(static_cast<int>(Adjustment::ChromaKey));
  upper->chromaKeyTolerance.put(0.4);
  upper->opacity.put(0.8);
  const auto lowerTile = randomTile();
  const auto upperTile = randomTile();
  const std::vector<CompositionPart> parts{part(lower, lowerTile.get()), part(solid, nullptr),
                                           part(upper, upperTile.get())};
  composer_->programs().setLooping(true);
  graphics_->programs().waitAll();
  std::vector<std::uint8_t> looped;
  {
    const HeldBuilder held(graphics_->programs());
    useStructure(false);
    ASSERT_FALSE(composer_->programs().isOwnReady(CompositeKind::Base));
    ASSERT_NE(composer_->programs().program(CompositeKind::Base), 0U);
    ASSERT_TRUE(compose(0, parts));
    looped = read(0);
  }
  useStructure();
  ASSERT_TRUE(compose(0, parts));
  const std::vector<std::uint8_t> unrolled = read(0);
  int worst = 0;
  for (std::size_t i = 0; i < looped.size(); ++i) {
    worst = std::max(worst, std::abs(int{looped[i]} - int{unrolled[i]}));
  }
  EXPECT_LE(worst, 1);
}

TEST_F(ComposerTest, TheFasterProgramDrawsWhatTheStructuresOwnDoes) {
  Layer* lower = addTileLayer();
  Layer* solid = addSolidLayer({0.9, 0.2, 0.1});
  Layer* upper = addTileLayer();
  solid->opacity.put(0.5);
  upper->opacity.put(0.8);
  for (int mode = 0; mode < static_cast<int>(blendModeNames().size()); ++mode) {
    upper->blendMode.put(mode);
    upper->adjustmentType.put(mode % static_cast<int>(adjustmentNames().size()));
    upper->chromaKeyTolerance.put(0.4);
    useStructure();
    const CompositionPrograms& programs = composer_->programs();
    ASSERT_NE(programs.program(CompositeKind::Base, true), programs.program(CompositeKind::Base));
    const auto lowerTile = randomTile();
    const auto upperTile = randomTile();
    std::vector<CompositionPart> parts{part(lower, lowerTile.get()), part(solid, nullptr),
                                       part(upper, upperTile.get())};
    const double faster = composer_->estimatedMilliseconds(parts);
    ASSERT_TRUE(compose(0, parts));
    // A shift that no byte shows, but then tiles are scaled.
    parts[0].transform.offset.x = 1e-9;
    EXPECT_LT(faster, composer_->estimatedMilliseconds(parts));
    ASSERT_TRUE(compose(1, parts));
    for (int level = 0; level < Composer::levelCount; ++level) {
      const std::vector<std::uint8_t> unchanged = read(0, level);
      const std::vector<std::uint8_t> general = read(1, level);
      for (std::size_t i = 0; i < general.size(); ++i) {
        ASSERT_NEAR(int{unchanged[i]}, int{general[i]}, 1)
            << blendModeNames()[static_cast<std::size_t>(mode)] << ", level " << level << ", byte " << i;
      }
    }
  }
}

TEST_F(ComposerTest, ScaledTilesAndSettingsAreNotTakenForUnchanged) {
  Layer* lower = addTileLayer();
  Layer* upper = addTileLayer();
  upper->opacity.put(0.7);
  useStructure();
  const auto lowerTile = randomTile();
  const auto upperTile = randomTile();
  const UnitSquareTransform quarter{{0.5, 0.25}, {0.25, 0.25}};
  ASSERT_TRUE(compose(0, {part(lower, lowerTile.get()), part(upper, upperTile.get())}));
  ASSERT_TRUE(compose(1, {part(lower, lowerTile.get()), part(upper, upperTile.get(), quarter)}));
  EXPECT_NE(read(0), read(1)) << "scaled";
  upper->gamma.put(2.0);
  ASSERT_TRUE(compose(1, {part(lower, lowerTile.get()), part(upper, upperTile.get())}));
  EXPECT_NE(read(0), read(1)) << "gamma";
}

TEST_F(ComposerTest, TheLoopingProgramStandsInOnlyWhereItMay) {
  for (const bool loops : {true, false}) {
    composer_->programs().setLooping(loops);
    graphics_->programs().waitAll();
    addSolidLayer({0.1, 0.2, 0.3});
    const HeldBuilder held(graphics_->programs());
    useStructure(false);
    ASSERT_FALSE(composer_->programs().isOwnReady(CompositeKind::Base));
    EXPECT_EQ(composer_->programs().program(CompositeKind::Base) != 0, loops);
  }
}

TEST_F(ComposerTest, WhatNeedsNoBlendingWaitsForNoProgram) {
  Layer* lower = addTileLayer();
  Layer* upper = addTileLayer();
  const auto tile = randomTile();
  const auto hiding = randomTile(true);
  const std::vector<CompositionPart> blended{part(lower, hiding.get()), part(upper, tile.get())};
  const std::vector<CompositionPart> hidden{part(lower, tile.get()), part(upper, hiding.get())};
  composer_->programs().setLooping(false);
  {
    const HeldBuilder held(graphics_->programs());
    useStructure(false);
    EXPECT_TRUE(composer_->programs().isOwnPending(CompositeKind::Base));
    EXPECT_FALSE(composer_->canCompose(CompositeKind::Base, blended));
    ASSERT_TRUE(composer_->canCompose(CompositeKind::Base, hidden));
    ASSERT_TRUE(compose(0, hidden));
    EXPECT_EQ(read(0), hiding->pixels().rgba);
  }
  useStructure();
  EXPECT_FALSE(composer_->programs().isOwnPending(CompositeKind::Base));
  EXPECT_TRUE(composer_->canCompose(CompositeKind::Base, blended));
}

TEST_F(ComposerTest, AProgramThatCannotBeBuiltIsTold) {
  const std::filesystem::path folder = std::filesystem::path(MERIDIAN_TEST_FOLDER) / "broken shaders";
  std::filesystem::remove_all(folder);
  std::filesystem::copy(paths_.shaders, folder, std::filesystem::copy_options::recursive);
  std::ofstream(folder / "gpu" / "compose.frag", std::ios::app) << "broken\n";
  paths_.shaders = folder;
  composer_.reset();
  graphics_.reset();
  auto graphics = graphics::Graphics::create(*context_, paths_, statistics_);
  ASSERT_TRUE(graphics) << graphics.error().message();
  graphics_ = std::move(*graphics);
  auto made = Composer::create(*graphics_, {4, 8});
  ASSERT_TRUE(made) << made.error().message();
  composer_ = std::move(*made);
  const CompositionPrograms& programs = composer_->programs();
  addTileLayer();
  composer_->programs().setStructure(CompositeKind::Base, manager_.group(LayerGroupId::ColorLayers).structureKey());
  EXPECT_FALSE(programs.hasFailed(CompositeKind::Base));
  EXPECT_TRUE(programs.error(CompositeKind::Base).empty());
  graphics_->programs().waitAll();
  EXPECT_TRUE(programs.hasFailed(CompositeKind::Base));
  EXPECT_FALSE(programs.isOwnPending(CompositeKind::Base));
  EXPECT_EQ(programs.program(CompositeKind::Base), 0U);
  EXPECT_THAT(programs.error(CompositeKind::Base), testing::HasSubstr("compose.frag"));
  EXPECT_FALSE(programs.hasFailed(CompositeKind::Night)) << "nobody asked for it";
}

TEST_F(ComposerTest, HalfSizesAreTheMeansOfFourTexels) {
  Layer* layer = addTileLayer();
  const auto tile = randomTile();
  useStructure();
  ASSERT_TRUE(compose(2, {part(layer, tile.get())}));
  for (int level = 1; level < Composer::levelCount; ++level) {
    const std::vector<std::uint8_t> larger = read(2, level - 1);
    const std::vector<std::uint8_t> smaller = read(2, level);
    const int size = side >> level;
    for (int y = 0; y < size; ++y) {
      for (int x = 0; x < size; ++x) {
        const glm::dvec4 mean =
            0.25 * (texel(larger, 2 * size, 2 * x, 2 * y) + texel(larger, 2 * size, 2 * x + 1, 2 * y) +
                    texel(larger, 2 * size, 2 * x, 2 * y + 1) + texel(larger, 2 * size, 2 * x + 1, 2 * y + 1));
        for (int i = 0; i < 4; ++i) {
          ASSERT_NEAR(255.0 * texel(smaller, size, x, y)[i], 255.0 * mean[i], 0.6) << "level " << level;
        }
      }
    }
  }
}

/// Colours that are linear in the unit square come out linear, so any shift of the transform shows.
TEST_F(ComposerTest, TakesAnAncestorsTileByTheExactTransform) {
  Layer* layer = addTileLayer();
  ColourPixels ramp{side, {}, true, true};
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      ramp.rgba.insert(ramp.rgba.end(), {static_cast<std::uint8_t>(x / 4), static_cast<std::uint8_t>(y / 4),
                                         static_cast<std::uint8_t>(x % 256), 255});
    }
  }
  const ColourTile tile(std::move(ramp));
  useStructure();
  const UnitSquareTransform child{{0.5, 0.0}, {0.5, 0.5}};
  for (const UnitSquareTransform& transform :
       {UnitSquareTransform{}, child, child.then(child), UnitSquareTransform{{0.25, 0.5}, {1.0 / 64, 1.0 / 64}}}) {
    ASSERT_TRUE(compose(0, {part(layer, &tile, transform)}));
    const std::vector<std::uint8_t> found = read(0);
    for (int n = 0; n < 4000; ++n) {
      const int x = colourLayout.border + static_cast<int>(random_() % colourLayout.interior);
      const int y = colourLayout.border + static_cast<int>(random_() % colourLayout.interior);
      // Where that texel's centre lies in the tile, in texels, and what lies there between four texels.
      const glm::dvec2 at =
          transform.apply(colourLayout.uv(x, y)) * double{colourLayout.interior} + double{colourLayout.border} - 0.5;
      const glm::dvec2 low = glm::floor(at);
      const glm::dvec2 share = at - low;
      const auto column = static_cast<int>(low.x);
      const auto row = static_cast<int>(low.y);
      const auto next = [](int i) { return std::min(i + 1, side - 1); };
      const auto& rgba = tile.pixels().rgba;
      const glm::dvec4 expected = glm::mix(
          glm::mix(texel(rgba, side, column, row), texel(rgba, side, next(column), row), share.x),
          glm::mix(texel(rgba, side, column, next(row)), texel(rgba, side, next(column), next(row)), share.x), share.y);
      const glm::dvec4 pixel = texel(found, side, x, y);
      ASSERT_NEAR(255.0 * pixel.x, 255.0 * expected.x, 1.01) << x << ", " << y;
      ASSERT_NEAR(255.0 * pixel.y, 255.0 * expected.y, 1.01) << x << ", " << y;
      if (column % 256 != 255) {  // where the blue ramp does not begin anew
        ASSERT_NEAR(255.0 * pixel.z, 255.0 * expected.z, 1.01) << x << ", " << y;
      }
    }
  }
}

TEST_F(ComposerTest, ShowsWhatIsBelowWhereALayerHasNoTile) {
  Layer* layer = addTileLayer();
  Layer* other = addTileLayer();
  const auto tile = randomTile();
  const ColourTile nothing(ColourPixels{side, {}, false, false});
  useStructure();
  ASSERT_TRUE(compose(0, {part(layer, tile.get()), part(other, nullptr)}));
  const std::vector<std::uint8_t> without = read(0);
  ASSERT_TRUE(compose(1, {part(layer, tile.get()), part(other, &nothing)}));
  EXPECT_EQ(read(1), without);
}

TEST_F(ComposerTest, RefusesMoreTilesThanItsPoolHoldsAndGoesOn) {
  std::vector<CompositionPart> parts;
  const auto tile = randomTile();
  for (int n = 0; n < 9; ++n) {
    parts.push_back(part(addTileLayer(), tile.get()));
  }
  useStructure();
  EXPECT_FALSE(compose(0, parts));
  EXPECT_EQ(composer_->rawTileCapacity(), 8U);
  parts.back().tile = nullptr;
  EXPECT_TRUE(compose(0, parts));
  EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));
}

TEST_F(ComposerTest, LeavesTheFramesStateAsItWas) {
  Layer* layer = addTileLayer();
  const auto tile = randomTile();
  useStructure();
  glViewport(1, 2, 30, 40);
  ASSERT_TRUE(compose(0, {part(layer, tile.get())}));
  std::array<GLint, 4> viewport{};
  glGetIntegerv(GL_VIEWPORT, viewport.data());
  GLint framebuffer = -1;
  glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &framebuffer);
  EXPECT_EQ(viewport, (std::array<GLint, 4>{1, 2, 30, 40}));
  EXPECT_EQ(framebuffer, 0);
  EXPECT_TRUE(glIsEnabled(GL_DEPTH_TEST));
  EXPECT_FALSE(glIsEnabled(GL_BLEND));
}

}  // namespace
}  // namespace meridian::globebrowsing

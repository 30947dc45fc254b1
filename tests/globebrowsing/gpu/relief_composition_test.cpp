#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include <gdal_priv.h>
#include <gdal_utils.h>

#include "../source/raster_fixture.h"
#include "globebrowsing/gpu/composer.h"
#include "globebrowsing/layers/layer_manager.h"
#include "gpu_fixture.h"

namespace meridian::globebrowsing {
namespace {

using Fields = std::map<std::string, Value, std::less<>>;
constexpr int side = ReliefTile::size;
constexpr int interior = colourLayout.interior;
constexpr int border = colourLayout.border;

/// Composites of layers that colour the heights of a real elevation model, against what gdaldem makes of the same.
class ReliefCompositionTest : public GpuTest {
 protected:
  void SetUp() override {
    const std::string file = test::sharedData("dem/earth/N00E010.hgt");
    MERIDIAN_NEEDS(file);
    GpuTest::SetUp();
    if (!graphics_) {
      return;
    }
    auto made = Composer::create(*graphics_, {2, 2});
    ASSERT_TRUE(made) << made.error().message();
    composer_ = std::move(*made);
    const auto source = test::open({file});
    ASSERT_NE(source, nullptr);
    const HeightPixels pixels = test::heights(*source, tiling_, index_, reliefLayout);
    ASSERT_GT(pixels.maximum - pixels.minimum, 100.0F) << "no relief to speak of";
    heights_ = pixels.metres;
    tile_ = std::make_unique<ReliefTile>(tiling_, index_, heights_);
  }

  /// The composite's interior, 4 bytes a pixel.
  std::vector<std::uint8_t> compose(Fields fields) {
    fields.insert({{"Identifier", "L" + std::to_string(++count_)}, {"Enabled", true}});
    for (const auto& layer : manager_.group(LayerGroupId::Overlays).layers()) {
      layer->enabled.put(false);
    }
    const auto added = manager_.addLayer("Overlays", {Table{{}, std::move(fields)}, "test", "", ""});
    EXPECT_TRUE(added) << (added ? "" : added.error().message());
    composer_->programs().setStructure(CompositeKind::Overlay, manager_.group(LayerGroupId::Overlays).structureKey());
    graphics_->programs().waitAll();
    EXPECT_TRUE(composer_->programs().isOwnReady(CompositeKind::Overlay))
        << composer_->programs().error(CompositeKind::Overlay);
    CompositionPart part;
    part.layer = *added;
    part.relief = tile_.get();
    part.key = {1, index_};
    part.pixelMetres = pixelMetres(tiling_, index_);
    composer_->beginFrame(static_cast<std::uint64_t>(count_));
    EXPECT_TRUE(composer_->compose(0, CompositeKind::Overlay, {&part, 1}));
    composer_->endFrame();
    std::vector<std::uint8_t> pixels(std::size_t{4} * interior * interior);
    glGetTextureSubImage(composer_->composites(), 0, border, border, 0, interior, interior, 1, GL_RGBA,
                         GL_UNSIGNED_BYTE, static_cast<GLsizei>(pixels.size()), pixels.data());
    return pixels;
  }

  /// What gdaldem makes of the same heights, as a raster in metres with the pixels of the tile's middle, band by band.
  std::vector<std::vector<double>> gdaldem(const std::string& mode, std::vector<std::string> words,
                                           const std::string& ramp = {}) {
    GDALAllRegister();
    const double down = pixelMetres(tiling_, index_);
    const double across = glm::distance(tiling_.position(index_, {0.5 - 0.5 / interior, 0.5}),
                                        tiling_.position(index_, {0.5 + 0.5 / interior, 0.5}));
    GDALDatasetUniquePtr raster(GetGDALDriverManager()->GetDriverByName("MEM")->Create(
        "", reliefLayout.size(), reliefLayout.size(), 1, GDT_Float32, nullptr));
    std::array<double, 6> transform{0.0, across, 0.0, 0.0, 0.0, -down};
    raster->SetGeoTransform(transform.data());
    EXPECT_EQ(CE_None, raster->GetRasterBand(1)->RasterIO(GF_Write, 0, 0, reliefLayout.size(), reliefLayout.size(),
                                                          heights_.data(), reliefLayout.size(), reliefLayout.size(),
                                                          GDT_Float32, 0, 0, nullptr));
    words.insert(words.end(), {"-of", "MEM"});
    char** arguments = nullptr;
    for (const std::string& word : words) {
      arguments = CSLAddString(arguments, word.c_str());
    }
    GDALDEMProcessingOptions* options = GDALDEMProcessingOptionsNew(arguments, nullptr);
    CSLDestroy(arguments);
    GDALDatasetUniquePtr made(GDALDataset::FromHandle(
        GDALDEMProcessing("", raster.get(), mode.c_str(), ramp.empty() ? nullptr : ramp.c_str(), options, nullptr)));
    GDALDEMProcessingOptionsFree(options);
    EXPECT_NE(made, nullptr);
    std::vector<std::vector<double>> bands;
    for (int band = 1; made != nullptr && band <= made->GetRasterCount(); ++band) {
      bands.emplace_back(std::size_t{interior} * interior);
      EXPECT_EQ(CE_None, made->GetRasterBand(band)->RasterIO(GF_Read, reliefLayout.border, reliefLayout.border,
                                                             interior, interior, bands.back().data(), interior,
                                                             interior, GDT_Float64, 0, 0, nullptr));
    }
    return bands;
  }

  static void expectAlike(const std::vector<std::uint8_t>& found, const std::vector<std::vector<double>>& expected,
                          double tolerance) {
    ASSERT_FALSE(expected.empty());
    for (std::size_t i = 0; i < std::size_t{interior} * interior; ++i) {
      for (std::size_t band = 0; band < expected.size(); ++band) {
        const double difference = std::abs(found[4 * i + band] - expected[band][i]);
        ASSERT_LE(difference, tolerance) << "pixel " << i << " band " << band;
      }
    }
  }

  [[nodiscard]] double heightAt(int column, int row) const {
    return static_cast<double>(
        tile_->heights()[static_cast<std::size_t>(row + border) * side + static_cast<std::size_t>(column + border)]);
  }

  GeodeticTiling tiling_ = test::earth();
  TileIndex index_ = test::tileAt(tiling_, 0.35, 10.35, 9);
  std::vector<float> heights_;
  std::unique_ptr<ReliefTile> tile_;
  LayerManager manager_;
  std::unique_ptr<Composer> composer_;
  int count_ = 0;
};

TEST_F(ReliefCompositionTest, HillshadeIsGdaldems) {
  expectAlike(compose({{"Type", "Hillshade"}}), gdaldem("hillshade", {}), 1.01);
  expectAlike(compose({{"Type", "Hillshade"}, {"Azimuth", 100.0}, {"Altitude", 20.0}, {"ZFactor", 5.0}}),
              gdaldem("hillshade", {"-az", "100", "-alt", "20", "-z", "5"}), 1.51);
}

TEST_F(ReliefCompositionTest, SlopeIsGdaldems) {
  // A grey of 4 a degree, up to 60 degrees.
  const std::vector<std::uint8_t> found = compose(
      {{"Type", "Slope"}, {"ColorRamp", "0% 0 0 0; 100% 240 240 240"}, {"Range", Value(glm::dvec2(0.0, 60.0))}});
  std::vector<std::vector<double>> expected = gdaldem("slope", {});
  ASSERT_EQ(expected.size(), 1U);
  for (double& degrees : expected[0]) {
    degrees = std::min(4.0 * degrees, 240.0);
  }
  expectAlike(found, expected, 1.01);
}

TEST_F(ReliefCompositionTest, ColorReliefIsGdaldems) {
  const std::string text = "0 30 60 200\n40% 10 90 20\n400 200 180 90 200\n401 red\n900,255,255,255,255\n";
  const std::string file = "/vsimem/ramp.txt";
  const std::string gdals = "0 30 60 200\n300 10 90 20\n400 200 180 90 200\n401 red\n900,255,255,255,255\n";
  VSIFCloseL(VSIFileFromMemBuffer(file.c_str(), reinterpret_cast<GByte*>(const_cast<char*>(gdals.data())), gdals.size(),
                                  FALSE));
  expectAlike(compose({{"Type", "ColorRelief"}, {"ColorRamp", text}, {"Range", Value(glm::dvec2(100.0, 600.0))}}),
              gdaldem("color-relief", {"-alpha"}, file), 1.01);
  VSIUnlink(file.c_str());
}

TEST_F(ReliefCompositionTest, IsolinesAreWhereHeightsAreMultiplesOfTheInterval) {
  // Not a whole number: this model has whole metres, and whole plains would lie at a line's very height.
  constexpr double interval = 47.3;
  const std::vector<std::uint8_t> found = compose(
      {{"Type", "Isolines"}, {"Interval", interval}, {"LineWidth", 1.5}, {"LineColor", Value(glm::dvec3(1, 0, 0))}});
  const auto covered = [&](int column, int row) {
    return found[4 * (static_cast<std::size_t>(row) * interior + static_cast<std::size_t>(column)) + 3];
  };
  int lines = 0;
  int missed = 0;
  int stray = 0;
  for (int row = 2; row < interior - 2; ++row) {
    for (int column = 2; column < interior - 2; ++column) {
      double lowest = heightAt(column, row);
      double highest = lowest;
      for (int j = -2; j <= 2; ++j) {
        for (int i = -2; i <= 2; ++i) {
          lowest = std::min(lowest, heightAt(column + i, row + j));
          highest = std::max(highest, heightAt(column + i, row + j));
        }
      }
      // No multiple among all the heights around: no line either, but for a trace where a slope ends just below one.
      stray += covered(column, row) > 128 && std::floor(lowest / interval) == std::floor(highest / interval) &&
                       std::fmod(lowest, interval) > 0.0
                   ? 1
                   : 0;
      // A line passes between these two pixels, and not so steep that lines touch: one of them is drawn.
      const double here = heightAt(column, row) / interval;
      const double there = heightAt(column + 1, row) / interval;
      if (std::floor(here) != std::floor(there) && highest - lowest < interval / 2.0 && highest - lowest > 4.0) {
        ++lines;
        missed += std::max(covered(column, row), covered(column + 1, row)) < 100 ? 1 : 0;
      }
    }
  }
  EXPECT_GT(lines, 500);
  // Distances are by Horn's gradient, a mean of three rows: in a ravine it may be half of what it is in the middle.
  EXPECT_LT(missed, lines / 20) << "of " << lines;
  EXPECT_LT(stray, lines / 20) << "of " << lines;
}

TEST_F(ReliefCompositionTest, TheLoopingProgramDrawsThemToo) {
  const std::vector<std::uint8_t> own = compose({{"Type", "Hillshade"}});
  composer_->programs().setLooping(true);
  graphics_->programs().waitAll();
  // Enabled layers of more kinds than any program has been made for.
  const auto added = manager_.addLayer(
      "Overlays",
      {Table{{}, {{"Identifier", "Slope"}, {"Type", "Slope"}, {"Enabled", true}, {"Opacity", 0.0}}}, "test", "", ""});
  ASSERT_TRUE(added);
  composer_->programs().setStructure(CompositeKind::Overlay, manager_.group(LayerGroupId::Overlays).structureKey());
  std::vector<CompositionPart> parts(2);
  for (std::size_t i = 0; i < 2; ++i) {
    parts[i].layer = manager_.group(LayerGroupId::Overlays).enabledLayers()[i];
    parts[i].relief = tile_.get();
    parts[i].key = {1, index_};
    parts[i].opacity = static_cast<float>(parts[i].layer->effectiveOpacity());
  }
  composer_->beginFrame(99);
  ASSERT_NE(composer_->programs().program(CompositeKind::Overlay), 0U);
  ASSERT_TRUE(composer_->compose(1, CompositeKind::Overlay, parts));
  composer_->endFrame();
  std::vector<std::uint8_t> looped(own.size());
  glGetTextureSubImage(composer_->composites(), 0, border, border, 1, interior, interior, 1, GL_RGBA, GL_UNSIGNED_BYTE,
                       static_cast<GLsizei>(looped.size()), looped.data());
  int worst = 0;
  for (std::size_t i = 0; i < own.size(); ++i) {
    worst = std::max(worst, std::abs(int{own[i]} - int{looped[i]}));
  }
  EXPECT_LE(worst, 1);
}

TEST_F(ReliefCompositionTest, SaysOnceWhichLayerFindsNoPlaceForItsRamp) {
  compose({{"Type", "ColorRelief"}});
  std::vector<const Layer*> layers;
  for (int i = 0; i < 67; ++i) {
    const auto added = manager_.addLayer(
        "Overlays", {Table{{}, {{"Identifier", "R" + std::to_string(i)}, {"Type", "ColorRelief"}}}, "test", "", ""});
    ASSERT_TRUE(added);
    layers.push_back(*added);
  }
  testing::internal::CaptureStderr();
  composer_->beginFrame(99);
  for (const Layer* layer : layers) {
    CompositionPart part;
    part.layer = layer;
    part.relief = tile_.get();
    part.key = {1, index_};
    EXPECT_TRUE(composer_->compose(0, CompositeKind::Overlay, {&part, 1}));
  }
  composer_->endFrame();
  const std::string said = testing::internal::GetCapturedStderr();
  const std::size_t first = said.find("Overlays.R64 shows nothing");
  EXPECT_NE(first, std::string::npos) << said;
  EXPECT_EQ(said.find("shows nothing"), said.rfind("shows nothing")) << said;
}

}  // namespace
}  // namespace meridian::globebrowsing

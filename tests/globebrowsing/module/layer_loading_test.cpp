#include <chrono>
#include <filesystem>
#include <thread>

#include "globe_fixture.h"
#include "globebrowsing/surface/chunked_surface.h"

namespace meridian::globebrowsing {
namespace {

/// Many layers, of which few are enabled.
class LayerLoadingTest : public GlobeTest {
 protected:
  static std::ptrdiff_t entries(const char* folder) {
    return std::distance(std::filesystem::directory_iterator(folder), std::filesystem::directory_iterator());
  }
  /// Once the driver, whose own threads write its cache now and then, has closed what it had open.
  static bool comesDownTo(const char* folder, std::ptrdiff_t count) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    while (entries(folder) > count && std::chrono::steady_clock::now() < end) {
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    return entries(folder) <= count;
  }
};

TEST_F(LayerLoadingTest, DisabledLayersTakeNoThreadFileOrRequest) {
  const std::string file = uniformRaster("c.tif", {10, 20, 30});
  RenderableGlobe& globe = addGlobe({{"ColorLayers", listOf({fileLayer("Shown", file)})}});
  ASSERT_TRUE(settle());
  graphics_->programs().waitAll();
  const auto threads = entries("/proc/self/task");
  const auto files = entries("/proc/self/fd");
  const auto requested = statistics_.tiles.requested.load();
  for (int n = 0; n < 500; ++n) {
    const std::string name = "L" + std::to_string(n);
    const std::string path = n % 2 == 0 ? file : "http://127.0.0.1:9/" + name + "/{z}/{x}/{y}.png";
    ASSERT_TRUE(
        globe.layers().addLayer("ColorLayers", {fileLayer(name, path, {{"Enabled", false}}), "test", "Layer", ""}));
  }
  ASSERT_TRUE(settle());
  EXPECT_TRUE(comesDownTo("/proc/self/task", threads));
  EXPECT_TRUE(comesDownTo("/proc/self/fd", files));
  EXPECT_EQ(statistics_.tiles.requested, requested);
  EXPECT_EQ(globe.layers().layerCount(), 501U);
}

TEST_F(LayerLoadingTest, ATogglesFirstChunkIsTheMiddlesAndSoonThere) {
  std::vector<Value> layers;
  for (int n = 0; n < 50; ++n) {
    const std::string name = "L" + std::to_string(n);
    layers.push_back(fileLayer(name, uniformRaster(name + ".tif", {5 * n, 100, 100}, 256), {{"Enabled", n < 8}}));
  }
  // The corner of four tiles lies beside the middle.
  look(0.05, 0.05, 8e6);
  RenderableGlobe& globe = addGlobe({{"ColorLayers", listOf(layers)}});
  ASSERT_TRUE(settle());
  Layer* layer = globe.layers().group(LayerGroupId::ColorLayers).find("L49");
  for (const bool enabled : {true, false}) {
    layer->enabled.put(enabled);
    ASSERT_TRUE(settle());
    graphics_->programs().waitAll();
  }
  // Everything is cached now.
  const CompositeStore& store = dynamic_cast<ChunkedSurface&>(*globe.surface()).tiles().composites();
  const Pixel before = centre();
  layer->enabled.put(true);
  int frames = 0;
  int framesUntilMiddle = 0;
  std::uint64_t most = 0;
  std::uint64_t composed = store.composedCount();
  const std::uint64_t start = composed;
  ASSERT_TRUE(settle([&] {
    ++frames;
    framesUntilMiddle = framesUntilMiddle == 0 && centre() != before ? frames : framesUntilMiddle;
    most = std::max(most, store.composedCount() - composed);
    composed = store.composedCount();
  }));
  EXPECT_GE(composed - start, 2U);
  EXPECT_GE(framesUntilMiddle, 1);
  EXPECT_LE(framesUntilMiddle, 2);
  // The layer hides those below, so its composites take the least.
  const double each = store.composer().estimatedMilliseconds({});
  EXPECT_LE(static_cast<double>(most - 1) * each, 2.0) << most << " in one frame";
}

}  // namespace
}  // namespace meridian::globebrowsing

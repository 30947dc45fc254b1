#include <cstdlib>
#include <new>

#include "globe_fixture.h"

namespace {
/// Of the thread that draws: the driver's threads and the workers are their own business.
thread_local bool counting = false;
thread_local std::size_t allocations = 0;

void* counted(std::size_t size, std::size_t alignment) {
  allocations += counting ? 1 : 0;
  void* memory = alignment > alignof(std::max_align_t)
                     ? std::aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment)
                     : std::malloc(size == 0 ? 1 : size);
  if (memory == nullptr) {
    throw std::bad_alloc();
  }
  return memory;
}
}  // namespace

// Not inlined: at some levels of optimisation GCC sees malloc or free at only one side of a pair and warns.
[[gnu::noinline]] void* operator new(std::size_t size) {
  return counted(size, 0);
}
// The address sanitizer's own would not match our delete; elsewhere the standard library's calls the one above.
[[gnu::noinline]] void* operator new(std::size_t size, const std::nothrow_t& /*tag*/) noexcept {
  allocations += counting ? 1 : 0;
  return std::malloc(size == 0 ? 1 : size);
}
[[gnu::noinline]] void* operator new(std::size_t size, std::align_val_t alignment) {
  return counted(size, static_cast<std::size_t>(alignment));
}
[[gnu::noinline]] void operator delete(void* memory) noexcept {
  std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::align_val_t) noexcept {
  std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::size_t, std::align_val_t) noexcept {
  std::free(memory);
}

namespace meridian::globebrowsing {
namespace {

class SteadyFrameTest : public GlobeTest {
 protected:
  std::size_t allocationsInAFrame() {
    const std::array<View, 1> views{view_};
    const FrameContext context{{}, 0.0, 0.0, ++number_, views};
    graphics_->beginFrame();
    target_->bind();
    target_->clear({0.0F, 0.0F, 0.0F, 1.0F});
    allocations = 0;
    counting = true;
    for (const auto& [name, renderable] : host_->renderables) {
      renderable->update(context);
    }
    for (const auto& [name, renderable] : host_->renderables) {
      renderable->draw(context, 0);
    }
    counting = false;
    graphics_->endFrame();
    return allocations;
  }
};

TEST_F(SteadyFrameTest, AllocatesNothing) {
  const std::string colours = raster(
      "c.tif", [](int band, double longitude, double) { return 100.0 + 20.0 * band + 0.2 * longitude; }, 3, GDT_Byte,
      2048);
  const std::string heights = raster(
      "h.tif",
      [](int, double longitude, double latitude) {
        return 4000.0 * std::sin(0.3 * longitude) * std::cos(0.2 * latitude);
      },
      1, GDT_Float32, 1024);
  addGlobe({{"ColorLayers", listOf({fileLayer("A", colours), fileLayer("B", colours, {{"Opacity", 0.5}})})},
            {"HeightLayers", listOf({fileLayer("H", heights)})},
            {"NightLayers", listOf({fileLayer("N", colours)})},
            {"Overlays", listOf({solidLayer("O", {1, 1, 0}, {{"Opacity", 0.1}})})}},
           {{"PerformShading", true}, {"UseAccurateNormals", true}});
  counting = true;
  allocations = 0;
  { const std::string probe(100, 'x'); }
  counting = false;
  ASSERT_GE(allocations, 1U) << "the count works";
  for (const double distance : {2e7, 7e6, 6.45e6}) {
    look(0.5, 0.7, distance);
    ASSERT_TRUE(settle());
    ASSERT_EQ(host_->renderables.begin()->second->ground()->settled(0).reason, "");
    for (int n = 0; n < 3; ++n) {
      frame();
    }
    std::size_t most = 0;
    for (int n = 0; n < 20; ++n) {
      most = std::max(most, allocationsInAFrame());
    }
    EXPECT_GT(statistics_.chunks.drawn, 0U);
    EXPECT_EQ(most, 0U) << "at " << distance;
  }
}

}  // namespace
}  // namespace meridian::globebrowsing

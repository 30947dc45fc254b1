#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "eye.h"
#include "globebrowsing/globe_services.h"
#include "globebrowsing/renderable_globe.h"
#include "host/api/module.h"
#include "host/api/statistics.h"
#include "host/graphics/context.h"
#include "host/graphics/graphics.h"
#include "host/graphics/render_target.h"
#include "picture_check.h"
#include "smooth_world.h"

namespace meridian::globebrowsing::test {

/// A globe with one colour and one height layer, without light, on an off-screen target: made as an asset makes it.
class GlobeStage {
 public:
  /// Writes the world's rasters into `folder`. Needs `context` current. Throws std::runtime_error.
  GlobeStage(graphics::Context& context, const SmoothWorld& world, const std::filesystem::path& folder);
  ~GlobeStage();
  GlobeStage(const GlobeStage&) = delete;
  GlobeStage& operator=(const GlobeStage&) = delete;

  /// One frame, whatever is loaded.
  void draw(const Eye& eye);
  /// Frames until the view is settled; why it is not if that takes more than `seconds`, else an empty string.
  [[nodiscard]] std::string settle(const Eye& eye, double seconds);
  [[nodiscard]] Pixels pixels() const { return target_->readPixels(); }
  [[nodiscard]] RenderableGlobe& globe() { return *globe_; }
  [[nodiscard]] const Statistics& statistics() const { return statistics_; }

 private:
  Paths paths_;
  Statistics statistics_;
  PropertyOwner owner_{"Stage"};
  std::unique_ptr<graphics::Graphics> graphics_;
  std::unique_ptr<GlobeServices> services_;
  std::unique_ptr<Renderable> renderable_;
  RenderableGlobe* globe_ = nullptr;
  std::unique_ptr<graphics::RenderTarget> target_;
  std::uint64_t frame_ = 0;
};

}  // namespace meridian::globebrowsing::test

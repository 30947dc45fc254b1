#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <glm/vec2.hpp>

#include "host/api/error.h"
#include "host/api/frame_context.h"
#include "host/api/module.h"
#include "host/api/settled.h"
#include "host/api/statistics.h"
#include "host/graphics/context.h"
#include "host/graphics/frame_fence.h"
#include "host/graphics/gpu_timer.h"
#include "host/graphics/graphics.h"
#include "host/graphics/render_target.h"
#include "host/navigation/camera.h"
#include "host/scene/scene.h"

namespace meridian::app {

/// Draws the scene's renderables into a render target of its own: updates all, then draws the opaque ones from near to
/// far and the others from far to near, through one view of the camera. Render thread only, with the context current.
/// Dies before the context, the paths and the statistics; the nodes may go before or after it.
class SceneRenderer {
 public:
  /// What a frame is drawn for.
  struct Moment {
    Time time;
    double deltaSeconds = 0.0;
    double wallSeconds = 0.0;
    std::uint64_t number = 0;
    /// False: everything is brought up to date, but not drawn.
    bool isDrawn = true;
  };

  /// Errors: no second context, no such render target.
  [[nodiscard]] static Result<std::unique_ptr<SceneRenderer>> create(graphics::Context& context, const Paths& paths,
                                                                     Statistics& statistics, scene::Scene& scene);
  SceneRenderer(const SceneRenderer&) = delete;
  SceneRenderer& operator=(const SceneRenderer&) = delete;
  /// Takes graphics from every renderable that has them.
  ~SceneRenderer();

  /// Around the whole frame.
  void beginFrame() { graphics_->beginFrame(); }
  void endFrame() { graphics_->endFrame(); }

  /// Between the two. The scene has been evaluated at the moment's time. A size without pixels draws nothing. New
  /// renderables get their graphics first; one that fails at it is logged and left out. Errors: the target cannot be
  /// made in that shape.
  [[nodiscard]] Result<void> draw(const Moment& moment, const navigation::Camera& camera,
                                  const graphics::RenderTarget::Shape& shape);

  /// Waits until everything drawn is there, and takes the time that the GPU needed for it.
  void waitForFrame();
  /// Marks the frame's end without waiting, unless the GPU is behind by more than two frames.
  void markFrame();

  /// Whether every globe's view is what it will be; if not, the first that is not says why. Of the frame drawn last.
  [[nodiscard]] Settled settled() const;

  /// Whom the data are to be credited to that the frame drawn last shows.
  [[nodiscard]] const std::vector<std::string>& attributions() const { return attributions_; }
  /// The same, parted by " | "; empty: nobody.
  [[nodiscard]] const std::string& attribution() const { return attribution_; }

  [[nodiscard]] const graphics::RenderTarget& target() const { return target_; }
  [[nodiscard]] graphics::Graphics& graphics() { return *graphics_; }

 private:
  struct Item {
    scene::SceneNode* node;
    Renderable* renderable;
    std::vector<View> views;
    double distance = 0.0;  ///< metres from the eye to the node's origin
    bool failed = false;
  };

  SceneRenderer(Statistics& statistics, scene::Scene& scene, std::unique_ptr<graphics::Graphics> graphics,
                graphics::RenderTarget target);
  void takeNewRenderables();
  void forget(const scene::SceneNode& node);
  void takeGpuTime();
  void drawItems(const FrameContext& frame);
  void gatherAttributions();

  Statistics& statistics_;
  scene::Scene& scene_;
  std::unique_ptr<graphics::Graphics> graphics_;
  graphics::RenderTarget target_;
  graphics::FrameFence fence_;
  graphics::GpuTimer timer_;
  std::vector<Item> items_;
  std::vector<Item*> order_;
  std::vector<std::string_view> gathered_;  ///< good only until the next update
  std::vector<std::string> attributions_;
  std::string attribution_;
  std::size_t nodesSeen_ = 0;
  unsigned structureSeen_ = 0;
  int removalKey_;
  std::chrono::steady_clock::time_point created_ = std::chrono::steady_clock::now();
};

}  // namespace meridian::app

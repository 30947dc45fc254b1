#include "host/app/scene_renderer.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "host/api/log.h"

namespace meridian::app {

Result<std::unique_ptr<SceneRenderer>> SceneRenderer::create(graphics::Context& context, const Paths& paths,
                                                             Statistics& statistics, scene::Scene& scene) {
  auto graphics = graphics::Graphics::create(context, paths, statistics);
  if (!graphics) {
    return tl::make_unexpected(graphics.error());
  }
  auto target = graphics::RenderTarget::create({});
  if (!target) {
    return tl::make_unexpected(target.error());
  }
  return std::unique_ptr<SceneRenderer>(new SceneRenderer(statistics, scene, std::move(*graphics), std::move(*target)));
}

SceneRenderer::SceneRenderer(Statistics& statistics, scene::Scene& scene, std::unique_ptr<graphics::Graphics> graphics,
                             graphics::RenderTarget target)
    : statistics_(statistics),
      scene_(scene),
      graphics_(std::move(graphics)),
      target_(std::move(target)),
      removalKey_(scene_.onRemove([this](scene::SceneNode& node) { forget(node); })) {}

SceneRenderer::~SceneRenderer() {
  scene_.forget(removalKey_);
  for (Item& item : items_) {
    item.renderable->deinitializeGraphics();
  }
}

void SceneRenderer::forget(const scene::SceneNode& node) {
  const auto found = std::find_if(items_.begin(), items_.end(), [&](const Item& item) { return item.node == &node; });
  if (found != items_.end()) {
    found->renderable->deinitializeGraphics();
    items_.erase(found);
  }
  nodesSeen_ = 0;
}

void SceneRenderer::takeNewRenderables() {
  const auto& nodes = scene_.nodes();
  if (nodes.size() == nodesSeen_ && scene_.structureVersion() == structureSeen_) {
    return;
  }
  for (const auto& node : nodes) {
    const bool known =
        std::any_of(items_.begin(), items_.end(), [&](const Item& item) { return item.node == node.get(); });
    if (known || node->renderable() == nullptr) {
      continue;
    }
    Item item{node.get(), node->renderable(), {}, 0.0, false};
    if (const auto made = item.renderable->initializeGraphics(*graphics_); !made) {
      log::error("{} is not drawn: {}", node->identifier(), made.error().message());
      item.failed = true;
    }
    items_.push_back(std::move(item));
  }
  nodesSeen_ = nodes.size();
  structureSeen_ = scene_.structureVersion();
  order_.reserve(items_.size());
}

Result<void> SceneRenderer::draw(const Moment& moment, const navigation::Camera& camera,
                                 const graphics::RenderTarget::Shape& shape) {
  if (shape.size.x <= 0 || shape.size.y <= 0) {
    return {};
  }
  if (auto reshaped = target_.reshape(shape); !reshaped) {
    return reshaped;
  }
  takeNewRenderables();

  if (moment.isDrawn) {
    timer_.begin();
  }
  FrameContext frame;
  frame.time = moment.time;
  frame.deltaSeconds = moment.deltaSeconds;
  frame.wallSeconds = moment.wallSeconds;
  frame.number = moment.number;
  const navigation::Viewport viewport{.size = shape.size};
  order_.clear();
  for (Item& item : items_) {
    if (item.failed) {
      continue;
    }
    navigation::makeViews(camera, *item.node, {&viewport, 1}, item.views);
    item.distance = camera.distanceTo(*item.node);
    frame.views = item.views;
    // Also what is not drawn: it may hold what another needs.
    item.renderable->update(frame);
    if (item.renderable->enabled.get()) {
      order_.push_back(&item);
    }
  }

  if (moment.isDrawn) {
    target_.bind();
    // With what is drawn, not before: a software renderer then clears each part of the picture where it draws it next,
    // while that is in the processor's cache.
    target_.clear({0.0F, 0.0F, 0.0F, 1.0F});
    drawItems(frame);
    timer_.end();
    gatherAttributions();
  }
  return {};
}

void SceneRenderer::gatherAttributions() {
  // All three keep their memory.
  gathered_.clear();
  for (const Item* item : order_) {
    item->renderable->addAttributions(gathered_);
  }
  attributions_.resize(gathered_.size());
  attribution_.clear();
  for (std::size_t i = 0; i < gathered_.size(); ++i) {
    attributions_[i] = gathered_[i];
    attribution_.append(attribution_.empty() ? "" : " | ").append(gathered_[i]);
  }
  gathered_.clear();
}

void SceneRenderer::drawItems(const FrameContext& frame) {
  const auto isOpaque = [](const Item* item) { return item->renderable->effectiveOpacity() >= 1.0; };
  std::sort(order_.begin(), order_.end(), [&](const Item* a, const Item* b) {
    if (isOpaque(a) != isOpaque(b)) {
      return isOpaque(a);
    }
    return isOpaque(a) ? a->distance < b->distance : a->distance > b->distance;
  });
  FrameContext mine = frame;
  for (Item* item : order_) {
    mine.views = item->views;
    for (std::size_t view = 0; view < item->views.size(); ++view) {
      item->renderable->draw(mine, view);
    }
  }
}

void SceneRenderer::takeGpuTime() {
  // Without waiting for the fence this is the time of a frame a little while ago.
  const std::chrono::duration<double, std::milli> age = std::chrono::steady_clock::now() - created_;
  while (const auto milliseconds = timer_.take()) {
    // llvmpipe's first span begins when the machine was started.
    if (*milliseconds <= age.count()) {
      statistics_.frame.gpu = *milliseconds;
    }
  }
}

void SceneRenderer::waitForFrame() {
  fence_.mark();
  if (!fence_.wait()) {
    log::warning("the GPU needs more than ten seconds for a frame");
  }
  takeGpuTime();
}

void SceneRenderer::markFrame() {
  fence_.mark();
  takeGpuTime();
}

Settled SceneRenderer::settled() const {
  for (const Item& item : items_) {
    Ground* const ground = item.renderable->ground();
    if (item.failed || !item.renderable->enabled.get() || ground == nullptr) {
      continue;
    }
    for (std::size_t view = 0; view < item.views.size(); ++view) {
      if (Settled settled = ground->settled(view); !settled.complete) {
        settled.reason = fmt::format("{}: {}", item.node->identifier(), settled.reason);
        return settled;
      }
    }
  }
  return {};
}

}  // namespace meridian::app

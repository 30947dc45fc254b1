#include "settled_globe.h"

#include <chrono>
#include <thread>

#include "globebrowsing/module.h"
#include "host/app/locations.h"
#include "host/app/start_view.h"
#include "host/graphics/shader_cache_folder.h"
#include "host/navigation/geodetic_pose.h"

namespace meridian::bench {

namespace {

using Clock = std::chrono::steady_clock;

double millisecondsSince(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

}  // namespace

Result<std::unique_ptr<SettledGlobe>> SettledGlobe::create(const std::string& place, glm::ivec2 size,
                                                           const std::filesystem::path& asset, const char* time) {
  std::unique_ptr<SettledGlobe> globe(new SettledGlobe);
  globe->size_ = size;
  Result<Paths> found = app::findPaths(std::filesystem::temp_directory_path());
  if (!found) {
    return tl::make_unexpected(found.error());
  }
  const Paths paths = *std::move(found);
  if (const auto cache = graphics::useShaderCacheFolder(paths.cache); !cache) {
    return tl::make_unexpected(cache.error());
  }
  auto context = graphics::OffscreenContext::create();
  if (!context) {
    return tl::make_unexpected(context.error());
  }
  globe->context_ = *std::move(context);
  if (Result<void> current = globe->context_->makeCurrent(); !current) {
    return tl::make_unexpected(current.error());
  }
  globe->application_ = std::make_unique<app::Application>(paths);
  app::Application& application = *globe->application_;
  std::vector<std::unique_ptr<Module>> modules;
  modules.push_back(globebrowsing::makeModule());
  application.addModules(std::move(modules));
  if (Result<void> loaded = application.load((asset.empty() ? paths.data / "assets/default.asset" : asset).string());
      !loaded) {
    return tl::make_unexpected(loaded.error());
  }
  // One colour and one height layer are what the goals are for.
  constexpr auto onlyThose =
      "openspace.setPropertyValueSingle('Scene.Earth.Renderable.Layers.NightLayers.CityLights.Enabled', false)";
  if (Result<void> set = asset.empty() ? application.scripts().run(onlyThose, "settled_globe.cpp") : Result<void>();
      !set) {
    return tl::make_unexpected(set.error());
  }
  application.clock().setTime(*Time::fromUtc(time));
  application.scene().evaluate(application.clock().time());
  const auto pose = navigation::geodeticPoseFromText(place);
  if (!pose) {
    return tl::make_unexpected(pose.error());
  }
  if (Result<void> placed = app::placeCamera(application.camera(), "Earth", *pose); !placed) {
    return tl::make_unexpected(placed.error());
  }
  auto renderer =
      app::SceneRenderer::create(*globe->context_, application.paths(), application.statistics(), application.scene());
  if (!renderer) {
    return tl::make_unexpected(renderer.error());
  }
  globe->renderer_ = *std::move(renderer);
  globe->shown_ = graphics::Texture::image2D(GL_RGBA8, size.x, size.y);
  globe->showing_ = graphics::Framebuffer::create();
  globe->showing_.attach(GL_COLOR_ATTACHMENT0, globe->shown_);
  return globe->settle().map([&] { return std::move(globe); });
}

SettledGlobe::~SettledGlobe() {
  if (application_) {
    static_cast<void>(context_->makeCurrent());
    application_->unload();
  }
}

Result<void> SettledGlobe::settle() {
  const auto start = Clock::now();
  do {
    frame();
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
    if (millisecondsSince(start) > 60000.0) {
      return failure("the view does not settle: " + renderer_->settled().reason);
    }
  } while (!renderer_->settled().complete || isPreparing());
  return {};
}

bool SettledGlobe::isPreparing() const {
  const auto& tiles = application_->statistics().tiles;
  return tiles.requested > tiles.loaded + tiles.failed + tiles.cancelled ||
         renderer_->graphics().programs().pending() > 0;
}

double SettledGlobe::frame() {
  static_cast<void>(context_->makeCurrent());  // there may be other globes
  const auto start = Clock::now();
  renderer_->beginFrame();
  const app::SceneRenderer::Moment moment{application_->clock().time(), 0.0, 0.0, frames_++};
  if (const Result<void> drawn = renderer_->draw(moment, application_->camera(), {size_, 1}); !drawn) {
    return 0.0;
  }
  blit();
  renderer_->endFrame();
  renderer_->waitForFrame();
  return millisecondsSince(start);
}

void SettledGlobe::blit() {
  renderer_->target().blit(showing_.id(), size_);
}

std::vector<std::uint8_t> SettledGlobe::picture() const {
  static_cast<void>(context_->makeCurrent());
  std::vector<std::uint8_t> rgba(std::size_t{4} * static_cast<std::size_t>(size_.x) *
                                 static_cast<std::size_t>(size_.y));
  glGetTextureImage(shown_.id(), 0, GL_RGBA, GL_UNSIGNED_BYTE, static_cast<GLsizei>(rgba.size()), rgba.data());
  return rgba;
}

globebrowsing::ChunkedSurface& SettledGlobe::surface() {
  auto* globe = dynamic_cast<globebrowsing::RenderableGlobe*>(application_->renderable("Earth"));
  return dynamic_cast<globebrowsing::ChunkedSurface&>(*globe->surface());
}

View SettledGlobe::view() const {
  std::vector<View> views;
  const navigation::Viewport viewport{.size = size_};
  navigation::makeViews(application_->camera(), *application_->scene().node("Earth"), {&viewport, 1}, views);
  return views.front();
}

}  // namespace meridian::bench

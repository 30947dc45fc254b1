#include "globe_stage.h"

#include <chrono>
#include <stdexcept>
#include <thread>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include "host/graphics/projection.h"

namespace meridian::globebrowsing::test {

namespace {

template <typename T>
T valueOf(Result<T> result) {
  if (!result) {
    throw std::runtime_error(result.error().message());
  }
  return *std::move(result);
}

Value layer(const char* identifier, const std::filesystem::path& file) {
  Table layer;
  layer.fields["Identifier"] = identifier;
  layer.fields["FilePath"] = file.string();
  layer.fields["Enabled"] = true;
  return layer;
}

View viewOf(const Eye& eye) {
  const glm::dvec3 right = glm::cross(eye.forward, eye.up);
  const glm::dmat3 cameraFromModel = glm::transpose(glm::dmat3(right, eye.up, -eye.forward));
  View view;
  view.size = pictureSize;
  view.clipFromCamera = graphics::reversedInfinitePerspective(
      eye.verticalFieldOfView, static_cast<double>(pictureSize.x) / pictureSize.y, eye.nearPlane);
  view.cameraFromModel = glm::dmat4(cameraFromModel);
  view.cameraFromModel[3] = glm::dvec4(-(cameraFromModel * eye.position), 1.0);
  view.cameraPosition = eye.position;
  view.pixelsPerRadian = graphics::pixelsPerRadian(eye.verticalFieldOfView, pictureSize.y);
  return view;
}

}  // namespace

GlobeStage::GlobeStage(graphics::Context& context, const SmoothWorld& world, const std::filesystem::path& folder) {
  paths_.shaders = std::filesystem::path(MERIDIAN_SOURCE_FOLDER) / "shaders";
  paths_.cache = folder;
  graphics_ = valueOf(graphics::Graphics::create(context, paths_, statistics_));
  services_ = std::make_unique<GlobeServices>(owner_, statistics_, folder);
  if (!services_->compositionBudget.set(Value(100.0))) {
    throw std::runtime_error("no such composition budget");
  }

  Table colours;
  world.writeColours(folder / "colours.tif");
  colours.list.push_back(layer("Colours", folder / "colours.tif"));
  if (world.spot.half > 0.0) {
    world.writeSpot(folder / "spot.tif");
    colours.list.push_back(layer("Spot", folder / "spot.tif"));
  }
  Table heights;
  world.writeHeights(folder / "heights.tif");
  heights.list.push_back(layer("Heights", folder / "heights.tif"));
  Table groups;
  groups.fields["ColorLayers"] = std::move(colours);
  groups.fields["HeightLayers"] = std::move(heights);
  Table table;
  table.fields["Type"] = "RenderableGlobe";
  table.fields["Radii"] = Value(world.radii);
  table.fields["PerformShading"] = false;
  // Three times as fine as usual: a small picture then has as many chunks as one of ordinary size.
  table.fields["TargetLodScaleFactor"] = 45.0;
  table.fields["Layers"] = std::move(groups);
  renderable_ = valueOf(RenderableGlobe::create({std::move(table), world.name, folder.string(), "World"}, *services_));
  globe_ = dynamic_cast<RenderableGlobe*>(renderable_.get());
  if (!globe_->refusedLayers().empty()) {
    throw std::runtime_error(globe_->refusedLayers().front().error.message());
  }
  if (Result<void> made = globe_->initializeGraphics(*graphics_); !made) {
    throw std::runtime_error(made.error().message());
  }
  target_ = std::make_unique<graphics::RenderTarget>(valueOf(graphics::RenderTarget::create({pictureSize, 1})));
}

GlobeStage::~GlobeStage() {
  if (globe_ != nullptr) {
    globe_->deinitializeGraphics();
  }
}

void GlobeStage::draw(const Eye& eye) {
  const View view = viewOf(eye);
  FrameContext frame;
  frame.number = ++frame_;
  frame.views = {&view, 1};
  graphics_->beginFrame(100.0);
  globe_->update(frame);
  target_->bind();
  target_->clear(glm::vec4(glm::vec3(background) / 255.0F, 1.0F));
  globe_->draw(frame, 0);
  graphics_->endFrame();
  statistics_.endFrame();
}

std::string GlobeStage::settle(const Eye& eye, double seconds) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
  for (;;) {
    draw(eye);
    const Settled settled = globe_->settled(0);
    if (settled.complete) {
      return {};
    }
    if (std::chrono::steady_clock::now() > end) {
      return settled.reason;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
}

}  // namespace meridian::globebrowsing::test

#include "globebrowsing/renderable_globe.h"

#include <algorithm>

#include <glm/geometric.hpp>

#include "globebrowsing/surface/chunked_surface.h"
#include "globebrowsing/tiling/geodetic_tiling.h"
#include "host/api/log.h"

namespace meridian::globebrowsing {

namespace {

/// A globe out of sight for that many frames gives its textures back.
constexpr int framesUntilRelease = 1000;
/// OpenSpace's middle of the scale.
constexpr double ordinaryLodScaleFactor = 15.0;

glm::dvec3 radiiOf(const Value& table, const RenderableRequest& request) {
  const Value* radii = table.find("Radii");
  if (radii == nullptr || radii->isNil()) {
    log::warning("{}: Renderable.Radii is missing; taking those of WGS84", request.where);
    return {6378137.0, 6378137.0, 6356752.314245};
  }
  if (const std::optional<double> one = radii->number()) {
    return glm::dvec3(*one);
  }
  const std::vector<double> three = *radii->numbers(3);
  return {three[0], three[1], three[2]};
}

}  // namespace

const Schema& RenderableGlobe::schema() {
  using Type = Schema::Type;
  static const Schema instance({
      {"Radii", Type::NumberOrVector3, "the ellipsoid's semi-axes along x, y and z in metres, or a sphere's radius"},
      {"Enabled", Type::Boolean, "whether it is drawn"},
      {"Opacity", Type::Number, "0 is invisible, 1 opaque", false, 0.0, 1.0},
      {"PerformShading", Type::Boolean, "whether the light source lights it"},
      {"UseAccurateNormals", Type::Boolean, "whether relief is shaded"},
      {"AmbientIntensity", Type::Number, "share of the light that reaches the night side", false, 0.0, 1.0},
      {"RenderAtDistance", Type::Boolean, "whether it is drawn when smaller than a pixel"},
      {"TargetLodScaleFactor", Type::Number, "15: one texel a pixel", false, 1.0, 50.0},
      {"Tag", Type::StringOrStrings, "names by which scripts can address it"},
      {"Layers", Type::Table, "layer groups, each a list of layers"},
  });
  return instance;
}

Result<std::unique_ptr<Renderable>> RenderableGlobe::create(const RenderableRequest& request, GlobeServices& services) {
  if (Result<void> valid = schema().validate(request.table, request.where, "Renderable"); !valid) {
    return tl::make_unexpected(valid.error());
  }
  const Result<Ellipsoid> ellipsoid = Ellipsoid::fromRadii(radiiOf(request.table, request));
  if (!ellipsoid) {
    Error error = ellipsoid.error();
    error.where = request.where + ": Renderable.Radii";
    return tl::make_unexpected(std::move(error));
  }
  std::unique_ptr<RenderableGlobe> globe(
      new RenderableGlobe(std::make_shared<const GeodeticTiling>(*ellipsoid), services));
  if (Result<void> loaded = globe->load(request); !loaded) {
    return tl::make_unexpected(loaded.error());
  }
  return globe;
}

RenderableGlobe::RenderableGlobe(std::shared_ptr<const Tiling> tiling, GlobeServices& services)
    : Renderable("RenderableGlobe"),
      tiling_(std::move(tiling)),
      services_(services),
      layers_({&services.workers(), &services.streamer()}) {
  addProperties();
}

RenderableGlobe::~RenderableGlobe() = default;

void RenderableGlobe::addProperties() {
  for (Property* property : std::initializer_list<Property*>{&performShading, &useAccurateNormals, &renderAtDistance,
                                                             &ambientIntensity, &targetLodScaleFactor}) {
    addProperty(*property);
  }
  for (Property* property :
       std::initializer_list<Property*>{&showChunkEdges, &performFrustumCulling, &performHorizonCulling, &evaluator}) {
    debugOwner.addProperty(*property);
  }
  addChild(debugOwner);
  addChild(layers_);
}

Result<void> RenderableGlobe::load(const RenderableRequest& request) {
  for (Property* property : properties()) {
    const Value* value = request.table.find(property->identifier());
    if (value == nullptr || value->isNil()) {
      continue;
    }
    if (Result<void> set = property->set(*value); !set) {
      return failure(set.error().what, request.where + ": Renderable." + property->identifier(), set.error().remedy);
    }
  }
  if (const Value* layers = request.table.find("Layers")) {
    layerErrors_ = layers_.load(*layers, request.where, "Renderable.Layers", request.folder);
    for (const Error& error : layerErrors_) {
      log::error("{}", error.message());
    }
  }
  return {};
}

Result<void> RenderableGlobe::initializeGraphics(graphics::Graphics& graphics) {
  graphics_ = &graphics;
  return {};
}

void RenderableGlobe::deinitializeGraphics() {
  surface_.reset();
  graphics_ = nullptr;
}

bool RenderableGlobe::isLargeEnough(const FrameContext& frame) const {
  return renderAtDistance.get() || std::any_of(frame.views.begin(), frame.views.end(), [&](const View& view) {
           const double distance = glm::length(view.cameraPosition);
           return boundingSphere() * view.pixelsPerRadian >= 0.5 * distance;
         });
}

void RenderableGlobe::makeSurface() {
  const GlobeTiles::Options options{static_cast<std::size_t>(services_.texturePoolSize.get()) << 20};
  Result<std::unique_ptr<ChunkedSurface>> made =
      ChunkedSurface::create({graphics_, &layers_, &services_.streamer(), tiling_}, options);
  if (made) {
    surface_ = *std::move(made);
  } else {
    log::error("{}", made.error().message());
    surfaceFailed_ = true;
  }
}

SurfaceSettings RenderableGlobe::settings() const {
  SurfaceSettings settings;
  settings.selection.evaluator = static_cast<Evaluator>(evaluator.get());
  settings.selection.scale = targetLodScaleFactor.get() / ordinaryLodScaleFactor;
  settings.selection.frustumCulling = performFrustumCulling.get();
  settings.selection.horizonCulling = performHorizonCulling.get();
  settings.shading = performShading.get();
  settings.accurateNormals = useAccurateNormals.get();
  settings.showEdges = showChunkEdges.get();
  settings.ambient = ambientIntensity.get();
  settings.opacity = opacity.get();
  settings.compositionMilliseconds = services_.compositionBudget.get();
  return settings;
}

void RenderableGlobe::update(const FrameContext& frame) {
  services_.enterFrame(frame.number);
  drawn_ = graphics_ != nullptr && enabled.get() && opacity.get() > 0.0 && isLargeEnough(frame);
  if (!drawn_) {
    if (surface_ && ++framesUnseen_ > framesUntilRelease) {
      surface_.reset();
    }
    return;
  }
  framesUnseen_ = 0;
  layers_.update();
  if (!surface_ && !surfaceFailed_) {
    makeSurface();
  }
  if (surface_) {
    surface_->update(frame, settings());
  }
}

void RenderableGlobe::draw(const FrameContext& frame, std::size_t view) {
  if (drawn_ && surface_) {
    surface_->draw(frame, view);
  }
}

Renderable::Contents RenderableGlobe::contents() const {
  Contents found{1, layerErrors_.size(), 0};
  for (const LayerGroupId id : allLayerGroups) {
    for (const auto& layer : layers_.group(id).layers()) {
      ++found.layers;
      found.usableLayers += layer->provider()->check() ? 1 : 0;
    }
  }
  return found;
}

glm::dvec3 RenderableGlobe::cartesian(const GeodeticPosition& position) const {
  return tiling_->ellipsoid().cartesian(position);
}

GeodeticPosition RenderableGlobe::geodetic(const glm::dvec3& position) const {
  return tiling_->ellipsoid().geodetic(position);
}

glm::dvec3 RenderableGlobe::normal(double latitude, double longitude) const {
  return tiling_->ellipsoid().normal(latitude, longitude);
}

double RenderableGlobe::heightAt(double latitude, double longitude) const {
  return surface_ ? surface_->heightAt(latitude, longitude) : 0.0;
}

std::optional<glm::dvec3> RenderableGlobe::pick(const glm::dvec3& origin, const glm::dvec3& direction) const {
  return surface_ ? surface_->pick(origin, direction) : std::nullopt;
}

Settled RenderableGlobe::settled(std::size_t view) const {
  return drawn_ && surface_ ? surface_->settled(view) : Settled{};
}

}  // namespace meridian::globebrowsing

#include "globebrowsing/renderable_globe.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <glm/geometric.hpp>

#include "globebrowsing/chunks/culling.h"
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
      {"WaterReflectance", Type::Number, "scales the Sun's glint on water; 1: as of a sea in a breeze", false, 0.0,
       10.0},
      {"LightSourceNode", Type::String, "the node whose light falls on it; left out: the Sun"},
      {"RenderAtDistance", Type::Boolean, "whether it is drawn when smaller than a pixel"},
      {"TargetLodScaleFactor", Type::Number, "15: one texel a pixel", false, 1.0, 50.0},
      {"OrenNayarRoughness", Type::Number, "without effect", false, 0.0, 1.0},
      {"DimInAtmosphere", Type::Boolean, "without effect"},
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
      layers_({&services.workers(), &services.streamer(), services.sourceTiles(), tiling_->ellipsoid().heightLimits(),
               services.tokenFolder()}),
      seenTimesAllowed_(services.timesAllowed()) {
  addProperties();
}

RenderableGlobe::~RenderableGlobe() {
  dropSurfaces();
}

void RenderableGlobe::addProperties() {
  for (Property* property : std::initializer_list<Property*>{
           &performShading, &useAccurateNormals, &renderAtDistance, &ambientIntensity, &lightSource, &waterReflectance,
           &targetLodScaleFactor, &currentLodScaleFactor, &activeLayers}) {
    addProperty(*property);
  }
  for (Property* property :
       std::initializer_list<Property*>{&showChunkEdges, &performFrustumCulling, &performHorizonCulling, &evaluator,
                                        &levelByProjectedArea, &resetTileProviders}) {
    debugOwner.addProperty(*property);
  }
  addChild(debugOwner);
  foreign_.addTo(*this, debugOwner);
  addChild(layers_);
  connectProperties();
}

void RenderableGlobe::connectProperties() {
  targetLodScaleFactor.onChange([this] { currentLodScaleFactor.put(targetLodScaleFactor.get()); });
  levelByProjectedArea.onChange([this] {
    const bool byDistance = evaluator.get() == static_cast<int>(Evaluator::Distance);
    if (byDistance == levelByProjectedArea.get()) {
      evaluator.put(static_cast<int>(byDistance ? Evaluator::ScreenSpaceError : Evaluator::Distance));
    }
  });
  evaluator.onChange([this] { levelByProjectedArea.put(evaluator.get() != static_cast<int>(Evaluator::Distance)); });
  resetTileProviders.onChange([this] {
    for (const LayerGroupId id : allLayerGroups) {
      for (const auto& layer : layers_.group(id).layers()) {
        layer->reset.fire();
      }
    }
  });
}

Result<void> RenderableGlobe::load(const RenderableRequest& request) {
  for (const Schema::Field& field : schema().fields()) {
    Property* property = this->property(field.key);
    const Value* value = request.table.find(field.key);
    if (property == nullptr || value == nullptr || value->isNil()) {
      continue;
    }
    if (Result<void> set = property->set(*value); !set) {
      return failure(set.error().what, request.where + ": Renderable." + field.key, set.error().remedy);
    }
  }
  static constexpr std::string_view laterOrNever[] = {"Type",
                                                      "Atmosphere",
                                                      "CameraMinHeight",
                                                      "Debug",
                                                      "Labels",
                                                      "LightSource",
                                                      "RenderBinMode",
                                                      "Rings",
                                                      "ShadowGroup",
                                                      "SegmentsPerPatch",
                                                      "Shadows",
                                                      "InteractionDepthBelowEllipsoid",
                                                      "ModelSpaceRenderingCutoffLevel"};
  for (const UnknownKey& unknown : unknownKeys(request.table, {&schema()}, laterOrNever)) {
    notes_.push_back(noteOf(unknown, request.where + ": Renderable"));
  }
  if (const Value* layers = request.table.find("Layers")) {
    refusedLayers_ = layers_.load(*layers, request.where, "Renderable.Layers", request.folder);
    for (const RefusedLayer& refused : refusedLayers_) {
      log::error("{}", refused.error.message());
    }
  }
  return {};
}

Result<void> RenderableGlobe::initializeGraphics(graphics::Graphics& graphics) {
  graphics_ = &graphics;
  return {};
}

void RenderableGlobe::deinitializeGraphics() {
  dropSurfaces();
  graphics_ = nullptr;
}

double RenderableGlobe::apparentRadius(const FrameContext& frame) const {
  double largest = 0.0;
  for (const View& view : frame.views) {
    const double pixels = boundingSphere() * view.pixelsPerRadian / glm::length(view.cameraPosition);
    largest = std::isfinite(pixels) ? std::max(largest, pixels) : largest;
  }
  return largest;
}

bool RenderableGlobe::isInView(const FrameContext& frame) const {
  OrientedBox box;
  box.half = radii();
  return std::any_of(frame.views.begin(), frame.views.end(), [&](const View& view) {
    return Frustum(view.clipFromCamera * view.cameraFromModel).touches(box);
  });
}

GlobeTiles::Options RenderableGlobe::poolOptions(TexturePoolShares::Share share) const {
  std::size_t most = 1;
  for (const CompositeKind kind : allCompositeKinds) {
    std::size_t count = 0;
    for (const LayerGroupId group : layerGroups(kind)) {
      count += layers_.group(group).enabledLayers().size();
    }
    most = std::max(most, count);
  }
  // In steps, and never less than before, so that toggling layers does not make surfaces anew.
  const auto rawTiles = static_cast<std::uint32_t>((most + 7) / 8 * 8);
  const std::size_t pool = static_cast<std::size_t>(services_.texturePoolSize.get()) << 20;
  return {TexturePoolShares::bytes(share, pool), std::max(rawTiles, pool_.leastRawTiles)};
}

std::unique_ptr<Surface> RenderableGlobe::makeSurface(const GlobeTiles::Options& pool) {
  Result<std::unique_ptr<ChunkedSurface>> made =
      ChunkedSurface::create({graphics_, &layers_, &services_.streamer(), tiling_}, pool);
  if (!made) {
    surfaceError_ = made.error().message();
    log::error("{}", surfaceError_);
    return nullptr;
  }
  return *std::move(made);
}

void RenderableGlobe::updateSurfaces(const FrameContext& frame, TexturePoolShares::Share share) {
  using Share = TexturePoolShares::Share;
  const GlobeTiles::Options wanted = poolOptions(share);
  const auto hold = [&] {
    if (share == Share::Large) {
      services_.poolShares().hold(this);
    } else {
      services_.poolShares().release(this);
    }
  };
  if (!surface_) {
    surface_ = makeSurface(wanted);
    if (surface_) {
      surface_->setShown();
    }
    pool_ = wanted;
    hold();
  } else if (wanted == pool_) {
    replacement_.reset();
    hold();  // or the share taken for it would be kept from the others
  } else if (!replacement_ || wanted != replacementPool_) {
    replacement_ = makeSurface(wanted);
    replacementPool_ = wanted;
    if (share == Share::Large) {
      hold();
    }
  }
  if (surface_) {
    surface_->update(frame, settings());
  }
  if (replacement_) {
    replacement_->update(frame, settings());
    // A server that is down must not keep this globe from its share, nor from giving it up.
    bool isSettled = true;
    for (std::size_t view = 0; view < frame.views.size(); ++view) {
      isSettled = isSettled && replacement_->settled(view).complete;
    }
    if (isSettled || replacement_->filled()) {
      surface_ = std::move(replacement_);
      surface_->setShown();
      pool_ = replacementPool_;
      hold();
    }
  }
}

void RenderableGlobe::dropSurfaces() {
  surface_.reset();
  replacement_.reset();
  services_.poolShares().release(this);
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
  settings.opacity = effectiveOpacity();
  settings.waterReflectance = waterReflectance.get();
  settings.compositionMilliseconds = services_.compositionBudget.get();
  return settings;
}

void RenderableGlobe::update(const FrameContext& frame) {
  services_.enterFrame(frame.number);
  std::size_t active = 0;
  for (const LayerGroupId id : allLayerGroups) {
    active += layers_.group(id).enabledLayers().size();
  }
  activeLayers.put(static_cast<int>(active));
  const double radius = apparentRadius(frame);
  drawn_ =
      graphics_ != nullptr && enabled.get() && effectiveOpacity() > 0.0 && (renderAtDistance.get() || radius >= 0.5);
  inView_ = drawn_ && isInView(frame);
  if (drawn_) {
    framesUnseen_ = 0;
    if (std::exchange(seenTimesAllowed_, services_.timesAllowed()) != services_.timesAllowed()) {
      layers_.retryFailed();
    }
    layers_.update(frame.time);
    const std::optional<TexturePoolShares::Share> share = services_.poolShares().bid(this, radius);
    if (share && surfaceError_.empty()) {
      updateSurfaces(frame, *share);
    }
    if (!surfaceError_.empty()) {
      services_.poolShares().release(this);
    }
  } else if (surface_ && (++framesUnseen_ > framesUntilRelease || services_.poolShares().isWaitedFor(this))) {
    dropSurfaces();
  }
  for (const Surface* surface : {surface_.get(), replacement_.get()}) {
    services_.statistics().memory.texturePool += surface != nullptr ? surface->residentBytes() : 0;
  }
}

void RenderableGlobe::draw(const FrameContext& frame, std::size_t view) {
  if (drawn_ && surface_) {
    surface_->draw(frame, view);
  }
}

void RenderableGlobe::addAttributions(std::vector<std::string_view>& list) const {
  if (!inView_) {
    return;
  }
  for (const LayerGroupId id : allLayerGroups) {
    for (const Layer* layer : layers_.group(id).enabledLayers()) {
      const std::string_view text = layer->attribution.get();
      if (!text.empty() && layer->effectiveOpacity() > 0.0 && std::find(list.begin(), list.end(), text) == list.end()) {
        list.push_back(text);
      }
    }
  }
}

std::size_t RenderableGlobe::numberOfNext(LayerGroupId group) const {
  const std::string start(globebrowsing::name(group));
  const auto refused = std::count_if(refusedLayers_.begin(), refusedLayers_.end(), [&](const RefusedLayer& one) {
    return one.name.starts_with(start + '.') || one.name.starts_with(start + '[');
  });
  return layers_.group(group).layers().size() + static_cast<std::size_t>(refused) + 1;
}

Result<Layer*> RenderableGlobe::addLayer(const std::string& group, const ProviderRequest& request, bool isUsers) {
  const std::optional<NamedGroup> named = layerGroupFromName(group);
  const Value* identifier = request.table.find("Identifier");
  const bool isTaken = named && identifier != nullptr && identifier->string() != nullptr &&
                       layers_.group(named->group).find(*identifier->string()) != nullptr;
  if (isTaken) {
    log::info("{}: {} has a layer {} already; the other one is left out", request.where, group, *identifier->string());
    return nullptr;
  }
  const std::size_t number = named ? numberOfNext(named->group) : 1;
  ProviderRequest placed = request;
  placed.path += ' ' + layerName(group, request.table, number);
  Result<Layer*> added = layers_.addLayer(group, placed);
  if (added && isUsers) {
    (*added)->setUsers();
  }
  if (added || !named) {
    return added;
  }
  log::error("{}", added.error().message());
  refusedLayers_.push_back({layerName(globebrowsing::name(named->group), request.table, number), added.error()});
  if (identifier != nullptr && identifier->string() != nullptr) {
    refused_.insert(*identifier->string());
  }
  return nullptr;
}

Renderable::Contents RenderableGlobe::contents() const {
  Contents found;
  found.globes = 1;
  found.notes = notes_;
  for (const LayerGroupId id : allLayerGroups) {
    for (const auto& layer : layers_.group(id).layers()) {
      const Result<void> checked = layer->provider()->check();
      found.layers.push_back({std::string(globebrowsing::name(id)) + '.' + layer->identifier(),
                              checked ? std::nullopt : std::optional(checked.error())});
      const std::vector<Error> unknown = unknownLayerKeys(layer->request());
      found.notes.insert(found.notes.end(), unknown.begin(), unknown.end());
    }
  }
  for (const RefusedLayer& refused : refusedLayers_) {
    found.layers.push_back({refused.name, refused.error});
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
  if (!drawn_ || !surfaceError_.empty()) {
    return {true, surfaceError_};
  }
  if (!surface_) {
    return {false, "the globe has not been prepared yet"};
  }
  if (replacement_ || services_.poolShares().waits(this)) {
    return {false, "the globe moves to textures of another size"};
  }
  return surface_->settled(view);
}

}  // namespace meridian::globebrowsing

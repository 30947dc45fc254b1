#pragma once

#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "globebrowsing/foreign_properties.h"
#include "globebrowsing/globe_services.h"
#include "globebrowsing/gpu/globe_tiles.h"
#include "globebrowsing/layers/layer_manager.h"
#include "globebrowsing/surface/surface.h"
#include "globebrowsing/tiling/tiling.h"
#include "host/api/renderable.h"
#include "host/api/schema.h"

namespace meridian::globebrowsing {

/// A planet or moon: an asset's `Renderable = { Type = "RenderableGlobe", ... }`. Owns its layers and its surface, and
/// is the ground that cameras and flights stand on.
class RenderableGlobe final : public Renderable, public Ground {
 public:
  /// Errors: a table that fails the schema, radii that are no ellipsoid. A layer that is wrong is left out and its
  /// error kept in refusedLayers(). `services` outlives the globe.
  [[nodiscard]] static Result<std::unique_ptr<Renderable>> create(const RenderableRequest& request,
                                                                  GlobeServices& services);
  ~RenderableGlobe() override;

  /// What an asset's table may hold.
  [[nodiscard]] static const Schema& schema();

  [[nodiscard]] LayerManager& layers() { return layers_; }
  /// Adds a layer by its table, as scripts do: one that is wrong is logged, kept in refusedLayers() and left out, and
  /// an identifier that the group has is left out with a note in the log; null then. `isUsers`: rather than an asset's.
  /// `request.path` is what adds it ("addLayer"); errors have the layer's name after that.
  /// Errors: an unknown group.
  Result<Layer*> addLayer(const std::string& group, const ProviderRequest& request, bool isUsers = false);
  /// In the order of their being refused.
  [[nodiscard]] const std::vector<RefusedLayer>& refusedLayers() const { return refusedLayers_; }
  /// Whether addLayer left out a layer of that name because its table was wrong.
  [[nodiscard]] bool wasRefused(const std::string& identifier) const { return refused_.count(identifier) != 0; }

  Result<void> initializeGraphics(graphics::Graphics& graphics) override;
  void deinitializeGraphics() override;
  void update(const FrameContext& frame) override;
  void draw(const FrameContext& frame, std::size_t view) override;
  [[nodiscard]] double boundingSphere() const override { return tiling_->ellipsoid().maximumRadius(); }
  [[nodiscard]] Ground* ground() override { return this; }
  [[nodiscard]] std::string_view lightSourceNode() const override { return lightSource.get(); }
  void addAttributions(std::vector<std::string_view>& list) const override;
  [[nodiscard]] Contents contents() const override;

  [[nodiscard]] glm::dvec3 radii() const override { return tiling_->ellipsoid().radii(); }
  [[nodiscard]] glm::dvec3 cartesian(const GeodeticPosition& position) const override;
  [[nodiscard]] GeodeticPosition geodetic(const glm::dvec3& position) const override;
  [[nodiscard]] glm::dvec3 normal(double latitude, double longitude) const override;
  [[nodiscard]] double heightAt(double latitude, double longitude) const override;
  [[nodiscard]] std::optional<glm::dvec3> pick(const glm::dvec3& origin, const glm::dvec3& direction) const override;
  [[nodiscard]] Settled settled(std::size_t view) const override;

  /// The surface while the globe is near enough to be drawn, else null; for benchmarks and tests.
  [[nodiscard]] Surface* surface() { return surface_.get(); }

  BoolProperty performShading{{"PerformShading", "Shading", "Whether the light source lights it"}, true};
  BoolProperty useAccurateNormals{
      {"UseAccurateNormals", "Accurate normals", "Whether relief is shaded, or only the ellipsoid"}, false};
  BoolProperty renderAtDistance{
      {"RenderAtDistance", "Render at distance", "Whether it is drawn when smaller than a pixel"}, false};
  FloatProperty ambientIntensity{
      {"AmbientIntensity", "Ambient light", "Share of the light that reaches the night side"}, 0.05, {0.0, 1.0}};
  FloatProperty waterReflectance{
      {"WaterReflectance", "Water reflectance", "Scales the Sun's glint on water; 1: as of a sea in a breeze"},
      1.0,
      {0.0, 10.0}};
  FloatProperty targetLodScaleFactor{
      {"TargetLodScaleFactor", "Level of detail", "15: one texel a pixel; twice that is twice as fine"},
      15.0,
      {1.0, 50.0}};

  FloatProperty currentLodScaleFactor{
      {"CurrentLodScaleFactor", "Current level of detail", "Always the same as TargetLodScaleFactor", true}, 15.0};
  StringProperty lightSource{{"LightSourceNode", "Light source", "The node whose light falls on it; empty: the Sun"}};
  IntProperty activeLayers{{"NActiveLayers", "Active layers", "How many layers are enabled", true}, 0};

  PropertyOwner debugOwner{"Debug", "Debug", "For looking into how the globe is drawn"};
  BoolProperty showChunkEdges{{"ShowChunkEdges", "Chunk edges", "Draws the outlines of chunks"}, false};
  BoolProperty performFrustumCulling{{"PerformFrustumCulling", "Frustum culling"}, true};
  BoolProperty performHorizonCulling{{"PerformHorizonCulling", "Horizon culling"}, true};
  OptionProperty evaluator{{"Evaluator", "Evaluator", "What decides how fine a chunk must be"},
                           {"ScreenSpaceError", "Distance", "ProjectedArea", "AvailableData"}};
  BoolProperty levelByProjectedArea{
      {"LevelByProjectedAreaElseDistance", "Level by projected area", "False is the evaluator Distance"}, true};
  TriggerProperty resetTileProviders{{"ResetTileProviders", "Reset tile providers", "Resets every layer"}};

 private:
  RenderableGlobe(std::shared_ptr<const Tiling> tiling, GlobeServices& services);
  void addProperties();
  void connectProperties();
  Result<void> load(const RenderableRequest& request);
  /// The place of the next layer of a group, from 1, if those that were refused count.
  [[nodiscard]] std::size_t numberOfNext(LayerGroupId group) const;
  /// In pixels, of the view that shows it largest.
  [[nodiscard]] double apparentRadius(const FrameContext& frame) const;
  [[nodiscard]] bool isInView(const FrameContext& frame) const;
  [[nodiscard]] SurfaceSettings settings() const;
  [[nodiscard]] GlobeTiles::Options poolOptions(TexturePoolShares::Share share) const;
  [[nodiscard]] std::unique_ptr<Surface> makeSurface(const GlobeTiles::Options& pool);
  /// Makes the surface, or another one when the pool should be of another size: that one draws when it is complete.
  void updateSurfaces(const FrameContext& frame, TexturePoolShares::Share share);
  void dropSurfaces();

  std::shared_ptr<const Tiling> tiling_;
  GlobeServices& services_;
  ForeignProperties foreign_;
  LayerManager layers_;
  std::vector<RefusedLayer> refusedLayers_;
  std::set<std::string> refused_;  ///< identifiers of layers that addLayer left out
  std::vector<Error> notes_;
  graphics::Graphics* graphics_ = nullptr;
  std::unique_ptr<Surface> surface_;
  std::unique_ptr<Surface> replacement_;  ///< of surface_, as soon as it is settled
  GlobeTiles::Options pool_;              ///< of surface_
  GlobeTiles::Options replacementPool_;
  std::string surfaceError_;  ///< why there can be no surface
  bool drawn_ = false;        ///< in this frame
  bool inView_ = false;       ///< likewise: drawn, and not beside the picture
  int framesUnseen_ = 0;
  std::uint64_t seenTimesAllowed_;  ///< of services_
};

}  // namespace meridian::globebrowsing

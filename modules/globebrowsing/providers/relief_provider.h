#pragma once

#include <optional>

#include "globebrowsing/providers/provider_registry.h"
#include "globebrowsing/providers/relief_style.h"
#include "globebrowsing/providers/tileless_provider.h"
#include "host/api/property.h"
#include "host/api/property_owner.h"

namespace meridian::globebrowsing {

/// Colours made from the heights of all height layers, types of ours named in gdaldem's words: ColorRelief, Hillshade,
/// Slope; and Isolines. What is set of them while they run is in `properties`. Render thread only, but for openData.
class ReliefProvider : public TilelessProvider {
 public:
  [[nodiscard]] const ReliefStyle* relief() final;
  [[nodiscard]] PropertyOwner* properties() final { return &owner_; }

 protected:
  explicit ReliefProvider(ReliefKind kind) { style_.kind = kind; }
  /// Adds a property whose change changes the style.
  void add(Property& property);
  ReliefStyle& style() { return style_; }

 private:
  /// Brings style() up to date with the properties.
  virtual void restyle() = 0;
  /// Once, as soon as the provider is open.
  virtual void takeOpened() {}

  PropertyOwner owner_{"TileProvider", "Tile provider", "How heights are coloured"};
  ReliefStyle style_;
  bool isStyled_ = false;
  bool hasTaken_ = false;
};

/// By a colour ramp over metres (ColorRelief) or over the slope's degrees (Slope).
class RampProvider final : public ReliefProvider {
 public:
  [[nodiscard]] static const Schema& schema();
  [[nodiscard]] static Result<std::shared_ptr<TileProvider>> makeColourRelief(const ProviderRequest& request);
  [[nodiscard]] static Result<std::shared_ptr<TileProvider>> makeSlope(const ProviderRequest& request);

  RampProvider(ReliefKind kind, std::string ramp, const glm::dvec2& values);

  [[nodiscard]] Result<void> check() const override;

  StringProperty colourRamp;
  /// One of the properties where the table names a file; empty once another ramp was set.
  StringProperty rampFile{{"ColorRampFile", "Color ramp file", "Where the color ramp was read from", true}};
  Vec2Property range;

 private:
  [[nodiscard]] static Result<std::shared_ptr<TileProvider>> make(const ProviderRequest& request, ReliefKind kind);
  /// Reads the ramp's file, if it has one.
  [[nodiscard]] Result<void> openData() override;
  void restyle() override;
  void takeOpened() override;

  std::optional<std::string> file_;
  bool isRampSet_ = false;  ///< while it runs
  bool isTaking_ = false;   ///< ColorRamp becomes the file's
  std::string where_;       ///< of the file, for errors
  std::string fileText_;    ///< written once, before the provider is Ready
};

class HillshadeProvider final : public ReliefProvider {
 public:
  [[nodiscard]] static const Schema& schema();
  [[nodiscard]] static Result<std::shared_ptr<TileProvider>> make(const ProviderRequest& request);

  HillshadeProvider();

  FloatProperty azimuth;
  FloatProperty altitude;
  FloatProperty zFactor;

 private:
  void restyle() override;
};

class IsolinesProvider final : public ReliefProvider {
 public:
  [[nodiscard]] static const Schema& schema();
  [[nodiscard]] static Result<std::shared_ptr<TileProvider>> make(const ProviderRequest& request);

  IsolinesProvider();

  FloatProperty interval;
  FloatProperty lineWidth;
  Vec3Property lineColour;
  FloatProperty lineOpacity;

 private:
  void restyle() override;
};

}  // namespace meridian::globebrowsing

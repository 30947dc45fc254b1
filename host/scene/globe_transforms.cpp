#include "host/scene/globe_transforms.h"

#include <cmath>
#include <numbers>
#include <optional>
#include <string>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "host/api/ground.h"
#include "host/api/property.h"
#include "host/api/schema.h"
#include "host/scene/scene.h"

namespace meridian::scene {

namespace {

using Type = Schema::Type;

constexpr double degree = std::numbers::pi / 180.0;

const Schema& globeSchema() {
  static const Schema schema({{"Globe", Type::String, "Identifier of a node with a RenderableGlobe", true},
                              {"Latitude", Type::Number, "Degrees", false, -90.0, 90.0},
                              {"Longitude", Type::Number, "Degrees, east positive", false, -360.0, 360.0},
                              {"Altitude", Type::Number, "Metres over the ellipsoid"},
                              {"Angle", Type::Number, "Degrees about the vertical"},
                              {"UseHeightmap", Type::Boolean, "Whether the altitude counts from the terrain"},
                              {"UseCamera", Type::Boolean, "Whether latitude and longitude are the camera's"},
                              {"UseCameraAltitude", Type::Boolean, "Whether the altitude is the camera's, too"}});
  return schema;
}

double numberOr(const Value& table, std::string_view key, double otherwise) {
  const Value* value = table.find(key);
  return value != nullptr ? value->number().value_or(otherwise) : otherwise;
}

bool flag(const Value& table, std::string_view key) {
  const Value* value = table.find(key);
  return value != nullptr && value->boolean().value_or(false);
}

/// A globe of the scene, looked for by name each time: it may come and go.
class GlobeReference {
 public:
  explicit GlobeReference(const TransformRequest& request)
      : scene_(request.scene), identifier_(*request.table.find("Globe")->string()) {}
  [[nodiscard]] const Ground* ground() const {
    const SceneNode* node = scene_ != nullptr ? scene_->node(identifier_) : nullptr;
    return node != nullptr ? node->ground() : nullptr;
  }
  /// Where the eye is over it.
  [[nodiscard]] std::optional<GeodeticPosition> eye() const {
    const SceneNode* node = scene_ != nullptr ? scene_->node(identifier_) : nullptr;
    const auto eye = node != nullptr && node->ground() != nullptr ? scene_->eyeIn(*node) : std::nullopt;
    return eye ? std::optional(node->ground()->geodetic(*eye)) : std::nullopt;
  }

 private:
  const Scene* scene_;
  std::string identifier_;
};

class GlobeTranslation final : public Translation {
 public:
  explicit GlobeTranslation(const TransformRequest& request)
      : globe_(request),
        latitude_({"Latitude", "Latitude", "Degrees"}, numberOr(request.table, "Latitude", 0.0), {-90.0, 90.0}),
        longitude_({"Longitude", "Longitude", "Degrees"}, numberOr(request.table, "Longitude", 0.0), {-360.0, 360.0}),
        altitude_({"Altitude", "Altitude", "Metres"}, numberOr(request.table, "Altitude", 0.0), {-1e12, 1e12}),
        useHeightmap_({"UseHeightmap", "Use height map", "Whether the altitude counts from the terrain"},
                      flag(request.table, "UseHeightmap")),
        useCamera_({"UseCamera", "Use camera", "Whether it stands below the camera"}, flag(request.table, "UseCamera")),
        useCameraAltitude_({"UseCameraAltitude", "Use camera altitude", "Whether it stands where the camera is"},
                           flag(request.table, "UseCameraAltitude")) {
    addProperty(latitude_);
    addProperty(longitude_);
    addProperty(altitude_);
    addProperty(useHeightmap_);
    addProperty(useCamera_);
    addProperty(useCameraAltitude_);
  }
  [[nodiscard]] glm::dvec3 position(const Time& /*time*/) const override {
    const Ground* ground = globe_.ground();
    if (ground == nullptr) {
      return glm::dvec3(0.0);
    }
    GeodeticPosition place{latitude_.get() * degree, longitude_.get() * degree, altitude_.get()};
    if (const auto eye = useCamera_.get() ? globe_.eye() : std::nullopt) {
      place = {eye->latitude, eye->longitude, useCameraAltitude_.get() ? eye->height : place.height};
    }
    if (useHeightmap_.get()) {
      place.height += ground->heightAt(place.latitude, place.longitude);
    }
    return ground->cartesian(place);
  }

 private:
  GlobeReference globe_;
  FloatProperty latitude_;
  FloatProperty longitude_;
  FloatProperty altitude_;
  BoolProperty useHeightmap_;
  BoolProperty useCamera_;
  BoolProperty useCameraAltitude_;
};

class GlobeRotation final : public Rotation {
 public:
  explicit GlobeRotation(const TransformRequest& request)
      : globe_(request),
        latitude_({"Latitude", "Latitude", "Degrees"}, numberOr(request.table, "Latitude", 0.0), {-90.0, 90.0}),
        longitude_({"Longitude", "Longitude", "Degrees"}, numberOr(request.table, "Longitude", 0.0), {-360.0, 360.0}),
        angle_({"Angle", "Angle", "Degrees about the vertical"}, numberOr(request.table, "Angle", 0.0)),
        useCamera_({"UseCamera", "Use camera", "Whether the place is below the camera"},
                   flag(request.table, "UseCamera")) {
    addProperty(latitude_);
    addProperty(longitude_);
    addProperty(angle_);
    addProperty(useCamera_);
  }
  [[nodiscard]] glm::dmat3 matrix(const Time& /*time*/) const override {
    const Ground* ground = globe_.ground();
    if (ground == nullptr) {
      return glm::dmat3(1.0);
    }
    double latitude = latitude_.get() * degree;
    double longitude = longitude_.get() * degree;
    if (const auto eye = useCamera_.get() ? globe_.eye() : std::nullopt) {
      latitude = eye->latitude;
      longitude = eye->longitude;
    }
    const glm::dvec3 up = ground->normal(latitude, longitude);
    // Across the meridian, so that the poles have an east as well.
    const glm::dvec3 meridian(std::cos(longitude), std::sin(longitude), 0.0);
    glm::dvec3 east(-meridian.y, meridian.x, 0.0);
    east = glm::normalize(east - glm::dot(east, up) * up);
    const glm::dmat3 place(east, up, glm::cross(east, up));
    return place * glm::mat3_cast(glm::angleAxis(angle_.get() * degree, glm::dvec3(0.0, 1.0, 0.0)));
  }

 private:
  GlobeReference globe_;
  FloatProperty latitude_;
  FloatProperty longitude_;
  FloatProperty angle_;
  BoolProperty useCamera_;
};

}  // namespace

Result<std::unique_ptr<Translation>> makeGlobeTranslation(const TransformRequest& request) {
  return globeSchema().validate(request.table, request.where, request.path).map([&] {
    return std::make_unique<GlobeTranslation>(request);
  });
}

Result<std::unique_ptr<Rotation>> makeGlobeRotation(const TransformRequest& request) {
  return globeSchema().validate(request.table, request.where, request.path).map([&] {
    return std::make_unique<GlobeRotation>(request);
  });
}

}  // namespace meridian::scene

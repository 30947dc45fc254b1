#include <cmath>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "host/scene/scene.h"
#include "host/scene/spice_translation.h"

namespace meridian::scene {

namespace {

constexpr ephemeris::BodyId sun = 10;

glm::dvec3 unitOrX(const glm::dvec3& vector) {
  const double length = glm::length(vector);
  return std::isfinite(length) && length > 0.0 ? vector / length : glm::dvec3(1.0, 0.0, 0.0);
}

/// The innermost ancestor, or the node itself, that the ephemeris places.
const SceneNode* placedByEphemeris(const SceneNode& node) {
  for (const SceneNode* each = &node; each->parentNode() != nullptr; each = each->parentNode()) {
    const auto* spice = dynamic_cast<const SpiceTranslation*>(each->translation());
    if (spice != nullptr && spice->target()) {
      return each;
    }
  }
  return nullptr;
}

}  // namespace

glm::dvec3 Scene::lightDirection(const SceneNode& target) const {
  const std::string_view wanted = target.renderable() != nullptr ? target.renderable()->lightSourceNode() : "";
  if (!wanted.empty() && wanted != target.identifier()) {
    if (const SceneNode* source = node(wanted)) {
      return unitOrX(relativeTransform(*source, target).translation);
    }
    warnOnce(
        "LightSourceNode of " + target.identifier(),
        target.identifier() + ": there is no node \"" + std::string(wanted) + "\" to be its light; taking the Sun");
  }
  if (const SceneNode* source = node("Sun"); source != nullptr && source != &target) {
    return unitOrX(relativeTransform(*source, target).translation);
  }
  if (const SceneNode* placed = placedByEphemeris(target)) {
    const auto& spice = static_cast<const SpiceTranslation&>(*placed->translation());
    const Time moment = spice.moment(time_);
    const glm::dvec3 icrf = ephemeris::relativePosition(sun, *spice.target(), moment);
    const glm::dvec3 inParent = glm::transpose(spice.frame().icrfFromFrame(moment)) * icrf;
    return unitOrX(relativeTransform(*placed->parentNode(), target).direction(inParent));
  }
  return unitOrX(relativeTransform(root(), target).translation);
}

}  // namespace meridian::scene

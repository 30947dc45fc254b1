#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/matrix.hpp>

#include "host/navigation/camera.h"

namespace meridian::navigation {

glm::dmat4 reversedPerspective(double verticalFieldOfView, double aspect, double near) {
  const double focal = 1.0 / std::tan(0.5 * verticalFieldOfView);
  glm::dmat4 clip(0.0);
  clip[0][0] = focal / aspect;
  clip[1][1] = focal;
  clip[2][3] = -1.0;
  clip[3][2] = near;
  return clip;
}

void makeViews(const Camera& camera, const scene::SceneNode& node, std::span<const Viewport> viewports,
               std::vector<View>& views) {
  const scene::Scene& scene = camera.scene();
  const double anchorScale = scene.worldFromNode(camera.anchor()).scale;
  const double nodeScale = scene.worldFromNode(node).scale;
  // The camera in its anchor's units; then the camera's frame, metres again, as seen from the node.
  const scene::Transform anchorFromCamera{camera.pose().position / anchorScale, glm::mat3_cast(camera.pose().rotation),
                                          1.0 / anchorScale};
  scene::Transform nodeFromCamera = scene::Scene::relativeTransform(camera.anchor(), node) * anchorFromCamera;
  nodeFromCamera.scale = 1.0 / nodeScale;
  const glm::dmat4 cameraFromNode = nodeFromCamera.inverse().matrix();
  const glm::dvec3 light = scene.lightDirection(node);
  views.clear();
  for (const Viewport& viewport : viewports) {
    const glm::ivec2 size(std::max(1, viewport.size.x), std::max(1, viewport.size.y));
    const double fieldOfView = viewport.verticalFieldOfView > 0.0
                                   ? viewport.verticalFieldOfView
                                   : camera.verticalFieldOfViewDegrees.get() * std::numbers::pi / 180.0;
    View& view = views.emplace_back();
    view.size = size;
    view.clipFromCamera = reversedPerspective(fieldOfView, static_cast<double>(size.x) / size.y, nearPlane);
    view.cameraFromModel = viewport.eyeFromCamera * cameraFromNode;
    const glm::dvec4 eyeInCamera = glm::inverse(viewport.eyeFromCamera) * glm::dvec4(0.0, 0.0, 0.0, 1.0);
    view.cameraPosition = nodeFromCamera.point(glm::dvec3(eyeInCamera));
    view.lightDirection = light;
    view.pixelsPerRadian = 0.5 * size.y / std::tan(0.5 * fieldOfView);
  }
}

}  // namespace meridian::navigation

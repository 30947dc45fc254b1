#include "globebrowsing/chunks/view_demand.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>

namespace meridian::globebrowsing {

namespace {

/// Metres: nothing is nearer than the near plane; keeps the camera inside a box from asking for endless detail.
constexpr double nearestDistance = 0.01;
bool isUsable(const SelectionView& view) {
  constexpr double farthest = 1e30;
  constexpr double fewestPixels = 1e-6;
  constexpr double mostPixels = 1e12;
  if (!(glm::length(view.cameraPosition) < farthest) || !(view.pixelsPerRadian > fewestPixels) ||
      !(view.pixelsPerRadian < mostPixels)) {
    return false;
  }
  for (int column = 0; column < 4; ++column) {
    for (int row = 0; row < 4; ++row) {
      if (!std::isfinite(view.clipFromModel[column][row])) {
        return false;
      }
    }
  }
  return true;
}

/// The cosine between the middle of the picture and its corners, 1 where the matrix has no perspective. The rows of a
/// perspective matrix are the picture's axes, as long as a radian is in half pictures.
double cornerCosine(const glm::dmat4& clipFromModel) {
  const auto rowLength = [&](int row) {
    return glm::length(glm::dvec3(clipFromModel[0][row], clipFromModel[1][row], clipFromModel[2][row]));
  };
  const double ahead = rowLength(3);
  const double across = ahead / rowLength(0);
  const double up = ahead / rowLength(1);
  const double cosine = 1.0 / std::sqrt(1.0 + across * across + up * up);
  return ahead > 0.0 && std::isfinite(cosine) ? cosine : 1.0;
}

}  // namespace

void PreparedViews::prepare(std::span<const SelectionView> views, const SelectionSettings& settings,
                            const glm::dvec3& radii) {
  settings_ = settings;
  evaluator_ = &evaluatorOf(settings.evaluator);
  occluderScale_ = Horizon::occluderScale(radii, settings_.lowestHeight);
  count_ = 0;
  for (std::size_t i = 0; i < std::min(views.size(), mostViews); ++i) {
    const SelectionView& view = views[i];
    if (!isUsable(view)) {
      continue;
    }
    PreparedView& prepared = views_[count_++];
    prepared.position = view.cameraPosition;
    prepared.pixelsPerRadian = view.pixelsPerRadian;
    prepared.bit = std::uint32_t{1} << i;
    prepared.frustum = settings_.frustumCulling ? Frustum(view.clipFromModel) : Frustum();
    // From the middle of the globe the horizon hides nothing.
    prepared.horizon =
        Horizon(radii, settings_.lowestHeight, settings_.horizonCulling ? view.cameraPosition : glm::dvec3(0.0));
    const glm::dvec3 ahead(view.clipFromModel[0][3], view.clipFromModel[1][3], view.clipFromModel[2][3]);
    const double length = glm::length(ahead);
    prepared.forward = length > 0.0 && std::isfinite(length) ? ahead / length : glm::dvec3(0.0);
    prepared.leastCosine = cornerCosine(view.clipFromModel);
  }
}

double PreparedViews::finestPixels() const {
  double finest = 0.0;
  for (std::size_t i = 0; i < count_; ++i) {
    finest = std::max(finest, views_[i].pixelsPerRadian);
  }
  return finest;
}

/// A displacement along the vertical moves across the picture by the sine of the angle at which it is seen. From
/// farther than the tile's edge that hardly bends between a few of its points; from nearer every angle occurs.
ErrorScale PreparedViews::errorScale(const ChunkBounds& bounds, const PreparedView& view, double distance) {
  ErrorScale scale;
  if (distance < bounds.edgeLength) {
    scale.along = view.pixelsPerRadian / (distance * view.leastCosine * view.leastCosine);
    scale.vertical = scale.along;
    return scale;
  }
  constexpr double betweenPoints = 1.02;
  double verticalSquared = 0.0;
  for (std::size_t i = 0; i < bounds.points.size(); ++i) {
    const glm::dvec3 towards = view.position - bounds.points[i];
    const double inverse = 1.0 / glm::length(towards);
    const double cosine = std::max(0.0, glm::dot(towards, bounds.normals[i]) * inverse);
    const double offAxis = std::max(view.leastCosine, -glm::dot(towards, view.forward) * inverse);
    const double here = betweenPoints * view.pixelsPerRadian * inverse / (offAxis * offAxis);
    scale.along = std::max(scale.along, here);
    verticalSquared = std::max(verticalSquared, here * here * (1.0 - cosine * cosine));
  }
  scale.vertical = std::sqrt(verticalSquared);
  return scale;
}

Demand PreparedViews::demandOn(const ChunkBounds& bounds, const HorizonCap& cap) const {
  Demand demand;
  demand.distance = 1e300;
  const OrientedBox& box = bounds.box;
  for (std::size_t i = 0; i < count_; ++i) {
    const PreparedView& view = views_[i];
    if (view.horizon.hides(cap)) {
      continue;
    }
    if (view.frustum.touches(box)) {
      demand.views |= view.bit;
    } else {
      demand.beside |= view.bit;
    }
    // A tile that a view turns its back on still counts by its distance, so that views in all directions agree.
    TileMeasure measure;
    measure.edgeLength = bounds.edgeLength;
    measure.area = bounds.area;
    measure.distance = std::max(box.distance(view.position), nearestDistance);
    measure.pixelsPerRadian = view.pixelsPerRadian;
    const glm::dvec3 towards = view.position - box.centre;
    const double centreDistance = std::max(glm::length(towards), nearestDistance);
    const double tilt = std::abs(glm::dot(towards, bounds.normal)) / centreDistance;
    measure.facing = std::min(1.0, tilt + 0.5 * measure.edgeLength / centreDistance);
    demand.urgency = std::max(demand.urgency, evaluator_->urgency(measure, settings_));
    const double pixelsPerMetre = view.pixelsPerRadian / measure.distance;
    demand.pixelsPerMetre = std::max(demand.pixelsPerMetre, pixelsPerMetre);
    const ErrorScale scale = errorScale(bounds, view, measure.distance);
    demand.error.vertical = std::max(demand.error.vertical, scale.vertical);
    demand.error.along = std::max(demand.error.along, scale.along);
    demand.distance = std::min(demand.distance, measure.distance);
    demand.centred = std::max(demand.centred, 0.5 - 0.5 * glm::dot(towards, view.forward) / centreDistance);
  }
  return demand;
}

}  // namespace meridian::globebrowsing

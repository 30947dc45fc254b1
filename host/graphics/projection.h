#pragma once

#include <glm/mat4x4.hpp>

namespace meridian::graphics {

/// The projection of all views (docs/architecture.md, Depth): clip from camera space (metres, -z ahead, +y up), depth =
/// near / distance along -z, so 1 at the near plane and 0 at infinity; there is no far plane. Relative depth resolution
/// in a float buffer is then about 2^-24 at every distance (Upchurch & Desbrun 2012, "Tightening the precision of
/// perspective rendering").
///
/// verticalFieldOfView: the whole angle, in radians, in (0, pi); aspect: width / height, > 0; near: metres, > 0. All
/// finite; anything else is misuse and asserts.
[[nodiscard]] glm::dmat4 reversedInfinitePerspective(double verticalFieldOfView, double aspect, double near);

/// Pixels per radian at the middle of a picture of that height: what View::pixelsPerRadian holds.
[[nodiscard]] double pixelsPerRadian(double verticalFieldOfView, double heightPixels);

}  // namespace meridian::graphics

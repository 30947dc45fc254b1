#pragma once

#include <optional>
#include <span>
#include <string_view>

namespace meridian::scripting {

/// The course of an interpolation: from 0 at t = 0 to 1 at t = 1. All grow monotonically but Elastic and Bounce;
/// Elastic leaves 0..1 on its way. After R. Penner, "Motion, Tweening, and Easing" (2002).
using Easing = double (*)(double t);

struct NamedEasing {
  std::string_view name;
  Easing function;
};

/// "Linear" and "QuadraticEaseIn", "QuadraticEaseOut", "QuadraticEaseInOut", likewise Cubic, Quartic, Quintic, Sine,
/// Circular, Exponential, Elastic and Bounce.
[[nodiscard]] std::span<const NamedEasing> easings();
[[nodiscard]] std::optional<Easing> easingFromName(std::string_view name);

}  // namespace meridian::scripting

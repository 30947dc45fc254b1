#include "host/scripting/easing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace meridian::scripting {

namespace {

constexpr double pi = std::numbers::pi;

// Each curve is written once, as its ease-in; the others are its reflections.
template <int Degree>
double power(double t) {
  double out = t;
  for (int i = 1; i < Degree; ++i) {
    out *= t;
  }
  return out;
}

double sine(double t) {
  return 1.0 - std::cos(t * pi / 2.0);
}

double circular(double t) {
  return 1.0 - std::sqrt(std::max(0.0, 1.0 - t * t));
}

double exponential(double t) {
  return t <= 0.0 ? 0.0 : std::exp2(10.0 * (t - 1.0));
}

double elastic(double t) {
  return std::sin(13.0 * pi / 2.0 * t) * exponential(t);
}

/// Four parabolas, each a bounce half as long as the one before it; Penner's constants.
double bounceOut(double t) {
  constexpr double steepness = 7.5625;
  constexpr double width = 2.75;
  if (t < 1.0 / width) {
    return steepness * t * t;
  }
  const auto arc = [&](double middle, double height) { return steepness * (t - middle) * (t - middle) + height; };
  if (t < 2.0 / width) {
    return arc(1.5 / width, 0.75);
  }
  if (t < 2.5 / width) {
    return arc(2.25 / width, 0.9375);
  }
  return arc(2.625 / width, 0.984375);
}

double bounce(double t) {
  return 1.0 - bounceOut(1.0 - t);
}

double linear(double t) {
  return t;
}

template <Easing Curve>
double easeIn(double t) {
  return Curve(t);
}

template <Easing Curve>
double easeOut(double t) {
  return 1.0 - Curve(1.0 - t);
}

template <Easing Curve>
double easeInOut(double t) {
  return t < 0.5 ? Curve(2.0 * t) / 2.0 : 1.0 - Curve(2.0 - 2.0 * t) / 2.0;
}

constexpr std::array<NamedEasing, 28> table{{{"Linear", linear},
                                             {"QuadraticEaseIn", easeIn<power<2>>},
                                             {"QuadraticEaseOut", easeOut<power<2>>},
                                             {"QuadraticEaseInOut", easeInOut<power<2>>},
                                             {"CubicEaseIn", easeIn<power<3>>},
                                             {"CubicEaseOut", easeOut<power<3>>},
                                             {"CubicEaseInOut", easeInOut<power<3>>},
                                             {"QuarticEaseIn", easeIn<power<4>>},
                                             {"QuarticEaseOut", easeOut<power<4>>},
                                             {"QuarticEaseInOut", easeInOut<power<4>>},
                                             {"QuinticEaseIn", easeIn<power<5>>},
                                             {"QuinticEaseOut", easeOut<power<5>>},
                                             {"QuinticEaseInOut", easeInOut<power<5>>},
                                             {"SineEaseIn", easeIn<sine>},
                                             {"SineEaseOut", easeOut<sine>},
                                             {"SineEaseInOut", easeInOut<sine>},
                                             {"CircularEaseIn", easeIn<circular>},
                                             {"CircularEaseOut", easeOut<circular>},
                                             {"CircularEaseInOut", easeInOut<circular>},
                                             {"ExponentialEaseIn", easeIn<exponential>},
                                             {"ExponentialEaseOut", easeOut<exponential>},
                                             {"ExponentialEaseInOut", easeInOut<exponential>},
                                             {"ElasticEaseIn", easeIn<elastic>},
                                             {"ElasticEaseOut", easeOut<elastic>},
                                             {"ElasticEaseInOut", easeInOut<elastic>},
                                             {"BounceEaseIn", easeIn<bounce>},
                                             {"BounceEaseOut", easeOut<bounce>},
                                             {"BounceEaseInOut", easeInOut<bounce>}}};

}  // namespace

std::span<const NamedEasing> easings() {
  return table;
}

std::optional<Easing> easingFromName(std::string_view name) {
  const auto found = std::find_if(table.begin(), table.end(), [&](const auto& each) { return each.name == name; });
  return found == table.end() ? std::nullopt : std::optional(found->function);
}

}  // namespace meridian::scripting

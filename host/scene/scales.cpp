#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "host/api/property.h"
#include "host/api/schema.h"
#include "host/scene/composed_transforms.h"
#include "host/scene/lua_transforms.h"
#include "host/scene/node_transforms.h"
#include "host/scene/transform_types.h"

namespace meridian::scene {

namespace {

using Type = Schema::Type;

class StaticScale final : public Scale {
 public:
  explicit StaticScale(double factor)
      : factor_({"Scale", "Scale", "How many units of the parent one of the node's is"}, factor,
                {smallestScale, largestScale}) {
    addProperty(factor_);
  }
  [[nodiscard]] double factor(const Time& /*time*/) const override { return factor_.get(); }

 private:
  FloatProperty factor_;
};

Result<std::unique_ptr<Scale>> makeStatic(const TransformRequest& request) {
  static const Schema schema({{"Scale", Type::Number, "How many units of the parent one of the node's is", true}});
  if (auto valid = schema.validate(request.table, request.where, request.path); !valid) {
    return tl::make_unexpected(valid.error());
  }
  return std::make_unique<StaticScale>(usableScale(*request.table.find("Scale")->number()));
}

/// Our frames are similarities, so that lengths mean the same in all directions.
Result<std::unique_ptr<Scale>> makeNonUniform(const TransformRequest& request) {
  static const Schema schema({{"Scale", Type::NumberOrVector3, "The factors along x, y and z", true}});
  if (auto valid = schema.validate(request.table, request.where, request.path); !valid) {
    return tl::make_unexpected(valid.error());
  }
  const Value& scale = *request.table.find("Scale");
  const std::vector<double> each = scale.numbers(3).value_or(std::vector<double>(3, scale.number().value_or(1.0)));
  if (each[0] != each[1] || each[1] != each[2]) {
    warnOnce(request, "NonUniformStaticScale",
             "scales that differ by axis are not supported; the geometric mean is taken");
  }
  return std::make_unique<StaticScale>(usableScale(std::cbrt(std::abs(each[0] * each[1] * each[2]))));
}

class TimeDependentScale final : public Scale {
 public:
  TimeDependentScale(Time reference, double speed) : reference_(reference), speed_(speed) {}
  [[nodiscard]] double factor(const Time& time) const override { return usableScale((time - reference_) * speed_); }

 private:
  Time reference_;
  double speed_;
};

Result<std::unique_ptr<Scale>> makeTimeDependent(const TransformRequest& request) {
  static const Schema schema({{"ReferenceDate", Type::String, "UTC date at which the scale is 0", true},
                              {"Speed", Type::Number, "What it grows by in a second; 1 without"},
                              {"ClampToPositive", Type::Boolean, "Whether it is never less than 0; here always"}});
  if (auto valid = schema.validate(request.table, request.where, request.path); !valid) {
    return tl::make_unexpected(valid.error());
  }
  const auto reference = Time::fromUtc(*request.table.find("ReferenceDate")->string());
  if (!reference) {
    return failure(reference.error().what, request.place("ReferenceDate"), reference.error().remedy);
  }
  const Value* speed = request.table.find("Speed");
  return std::make_unique<TimeDependentScale>(*reference, speed != nullptr ? *speed->number() : 1.0);
}

class MultiScale final : public Scale {
 public:
  explicit MultiScale(std::vector<std::unique_ptr<Scale>> parts) : parts_(std::move(parts)) {}
  [[nodiscard]] double factor(const Time& time) const override {
    double product = 1.0;
    for (const auto& part : parts_) {
      product = usableScale(product * part->factor(time));
    }
    return product;
  }

 private:
  std::vector<std::unique_ptr<Scale>> parts_;
};

Result<std::unique_ptr<Scale>> makeMulti(const TransformRequest& request) {
  return makeParts<Scale>(request, "Scales", makeScale).map([](auto parts) {
    return std::make_unique<MultiScale>(std::move(parts));
  });
}

class TimelineScale final : public Scale {
 public:
  explicit TimelineScale(Timeline<Scale> timeline) : timeline_(std::move(timeline)) {}
  [[nodiscard]] double factor(const Time& time) const override {
    const auto [before, after, share] = timeline_.at(time);
    const double from = before.factor(time);
    return share > 0.0 ? std::lerp(from, after.factor(time), share) : from;
  }

 private:
  Timeline<Scale> timeline_;
};

Result<std::unique_ptr<Scale>> makeTimeline(const TransformRequest& request) {
  return Timeline<Scale>::make(request, makeScale).map([](auto timeline) {
    return std::make_unique<TimelineScale>(std::move(timeline));
  });
}

constexpr std::array types = {TransformType<Scale>{"StaticScale", makeStatic},
                              TransformType<Scale>{"NonUniformStaticScale", makeNonUniform},
                              TransformType<Scale>{"TimeDependentScale", makeTimeDependent},
                              TransformType<Scale>{"LuaScale", makeLuaScale},
                              TransformType<Scale>{"MultiScale", makeMulti},
                              TransformType<Scale>{"TimelineScale", makeTimeline}};

}  // namespace

double usableScale(double factor) {
  return factor > smallestScale ? std::min(factor, largestScale) : smallestScale;
}

Result<std::unique_ptr<Scale>> makeScale(const TransformRequest& request) {
  return request.table.table()->list.empty() ? makeByType<Scale>(request, types) : makeMulti(request);
}

}  // namespace meridian::scene

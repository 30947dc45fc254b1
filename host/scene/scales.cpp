#include <array>

#include "host/api/property.h"
#include "host/api/schema.h"
#include "host/scene/node_transforms.h"
#include "host/scene/transform_types.h"

namespace meridian::scene {

namespace {

/// Where a scale must lie so that neither it nor its inverse leaves the range of a double's useful numbers.
constexpr double smallestScale = 1e-30;
constexpr double largestScale = 1e30;

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

Result<std::unique_ptr<Scale>> makeStatic(const Value& table, std::string_view where) {
  static const Schema schema({{"Scale", Schema::Type::Number, "How many units of the parent one of the node's is", true,
                               smallestScale, largestScale}});
  if (auto valid = schema.validate(table, where, "Transform.Scale"); !valid) {
    return tl::make_unexpected(valid.error());
  }
  return std::make_unique<StaticScale>(*table.find("Scale")->number());
}

constexpr std::array types = {TransformType<Scale>{"StaticScale", makeStatic}};

constexpr std::array<std::string_view, 5> later = {"NonUniformStaticScale", "TimeDependentScale", "LuaScale",
                                                   "MultiScale", "TimelineScale"};

}  // namespace

Result<std::unique_ptr<Scale>> makeScale(const Value& table, std::string_view where) {
  return makeByType<Scale>(table, where, types, later);
}

}  // namespace meridian::scene

#include <array>
#include <cmath>
#include <numbers>

#include <glm/matrix.hpp>

#include "host/api/log.h"
#include "host/api/property.h"
#include "host/api/schema.h"
#include "host/ephemeris/body_positions.h"
#include "host/ephemeris/frames.h"
#include "host/ephemeris/kepler.h"
#include "host/scene/node_transforms.h"
#include "host/scene/spice_translation.h"
#include "host/scene/transform_types.h"

namespace meridian::scene {

namespace {

using Type = Schema::Type;

double numberOr(const Value& table, std::string_view key, double otherwise) {
  const Value* value = table.find(key);
  return value != nullptr ? value->number().value_or(otherwise) : otherwise;
}

class StaticTranslation final : public Translation {
 public:
  explicit StaticTranslation(const glm::dvec3& position) : position_({"Position", "Position", "Metres"}, position) {
    addProperty(position_);
  }
  [[nodiscard]] glm::dvec3 position(const Time& /*time*/) const override { return position_.get(); }

 private:
  Vec3Property position_;
};

Result<std::unique_ptr<Translation>> makeStatic(const Value& table, std::string_view where) {
  static const Schema schema({{"Position", Type::Vector3, "Metres in the parent's frame", true}});
  if (auto valid = schema.validate(table, where, "Transform.Translation"); !valid) {
    return tl::make_unexpected(valid.error());
  }
  const std::vector<double> position = *table.find("Position")->numbers(3);
  return std::make_unique<StaticTranslation>(glm::dvec3(position[0], position[1], position[2]));
}

class KeplerTranslation final : public Translation {
 public:
  explicit KeplerTranslation(const ephemeris::KeplerElements& elements) : elements_(elements) {}
  [[nodiscard]] glm::dvec3 position(const Time& time) const override { return ephemeris::position(elements_, time); }

 private:
  ephemeris::KeplerElements elements_;
};

Result<std::unique_ptr<Translation>> makeKepler(const Value& table, std::string_view where) {
  static const Schema schema({{"Eccentricity", Type::Number, "0 is a circle", true, 0.0},
                              {"SemiMajorAxis", Type::Number, "Kilometres", true},
                              {"Inclination", Type::Number, "Degrees", true},
                              {"AscendingNode", Type::Number, "Degrees", true},
                              {"ArgumentOfPeriapsis", Type::Number, "Degrees", true},
                              {"MeanAnomaly", Type::Number, "Degrees at the epoch", true},
                              {"Epoch", Type::String, "UTC date", true},
                              {"Period", Type::Number, "Seconds", true}});
  if (auto valid = schema.validate(table, where, "Transform.Translation"); !valid) {
    return tl::make_unexpected(valid.error());
  }
  const auto epoch = Time::fromUtc(*table.find("Epoch")->string());
  if (!epoch) {
    return failure(epoch.error().what, std::string(where) + ": Transform.Translation.Epoch", epoch.error().remedy);
  }
  constexpr double degree = std::numbers::pi / 180.0;
  ephemeris::KeplerElements elements;
  elements.semiMajorAxis = 1e3 * numberOr(table, "SemiMajorAxis", 0.0);
  elements.eccentricity = numberOr(table, "Eccentricity", 0.0);
  elements.inclination = degree * numberOr(table, "Inclination", 0.0);
  elements.ascendingNode = degree * numberOr(table, "AscendingNode", 0.0);
  elements.argumentOfPeriapsis = degree * numberOr(table, "ArgumentOfPeriapsis", 0.0);
  elements.meanAnomalyAtEpoch = degree * numberOr(table, "MeanAnomaly", 0.0);
  elements.epoch = *epoch;
  elements.period = numberOr(table, "Period", 0.0);
  if (auto valid = elements.validate(); !valid) {
    return failure(valid.error().what, std::string(where) + ": Transform.Translation", valid.error().remedy);
  }
  return std::make_unique<KeplerTranslation>(elements);
}

/// A body's name or number. Nothing, with a warning, for a body whose position we cannot give.
Result<std::optional<ephemeris::BodyId>> readBody(const Value& table, std::string_view key, std::string_view where) {
  const Value* value = table.find(key);
  std::string text;
  if (value == nullptr) {
    text = "SSB";
  } else if (const std::string* name = value->string()) {
    text = *name;
  } else if (const auto number = value->number(); number && *number == std::round(*number) && std::abs(*number) < 1e9) {
    text = std::to_string(static_cast<long>(*number));
  } else {
    return failure("expected the name or number of a body",
                   std::string(where) + ": Transform.Translation." + std::string(key), "write it as \"EARTH\" or 399");
  }
  const auto body = ephemeris::bodyId(text);
  if (body && ephemeris::hasPosition(*body)) {
    return body;
  }
  log::warning("{}: the position of '{}' is not known without SPICE kernels; the node stays at its parent's origin",
               where, text);
  return std::nullopt;
}

Result<std::unique_ptr<Translation>> makeSpice(const Value& table, std::string_view where) {
  static const Schema schema({{"Target", Type::Any, "Name or NAIF number of the body", true},
                              {"Observer", Type::Any, "Name or NAIF number; the solar-system barycentre without"},
                              {"Frame", Type::String, "Axes of the parent; GALACTIC without"},
                              {"FixedDate", Type::String, "UTC date at which the body stands still"},
                              {"TimeOffset", Type::Number, "Seconds added to the scene's time"}});
  if (auto valid = schema.validate(table, where, "Transform.Translation"); !valid) {
    return tl::make_unexpected(valid.error());
  }
  const auto target = readBody(table, "Target", where);
  if (!target) {
    return tl::make_unexpected(target.error());
  }
  const auto observer = readBody(table, "Observer", where);
  if (!observer) {
    return tl::make_unexpected(observer.error());
  }
  const Value* frameName = table.find("Frame");
  const auto frame =
      frameName != nullptr ? ephemeris::Frame::fromName(*frameName->string()) : ephemeris::Frame::galactic();
  if (!frame) {
    return failure(frame.error().what, std::string(where) + ": Transform.Translation.Frame", frame.error().remedy);
  }
  const auto clock = TransformClock::fromTable(table, std::string(where) + ": Transform.Translation");
  if (!clock) {
    return tl::make_unexpected(clock.error());
  }
  return std::make_unique<SpiceTranslation>(*target, *observer, *frame, *clock);
}

constexpr std::array types = {TransformType<Translation>{"StaticTranslation", makeStatic},
                              TransformType<Translation>{"KeplerTranslation", makeKepler},
                              TransformType<Translation>{"SpiceTranslation", makeSpice}};

constexpr std::array<std::string_view, 6> later = {"GlobeTranslation", "GPTranslation",    "HorizonsTranslation",
                                                   "LuaTranslation",   "MultiTranslation", "TimelineTranslation"};

}  // namespace

glm::dvec3 SpiceTranslation::position(const Time& time) const {
  if (!target_ || !observer_) {
    return glm::dvec3(0.0);
  }
  const Time moment = clock_.at(time);
  return glm::transpose(frame_.icrfFromFrame(moment)) * ephemeris::relativePosition(*target_, *observer_, moment);
}

Result<TransformClock> TransformClock::fromTable(const Value& table, std::string_view where) {
  TransformClock clock;
  clock.offset_ = numberOr(table, "TimeOffset", 0.0);
  if (!std::isfinite(clock.offset_)) {
    return failure("expected a finite number", std::string(where) + ".TimeOffset", "give the offset in seconds");
  }
  if (const Value* date = table.find("FixedDate");
      date != nullptr && date->string() != nullptr && !date->string()->empty()) {
    const auto fixed = Time::fromUtc(*date->string());
    if (!fixed) {
      return failure(fixed.error().what, std::string(where) + ".FixedDate", fixed.error().remedy);
    }
    clock.fixed_ = *fixed;
  }
  return clock;
}

Result<std::unique_ptr<Translation>> makeTranslation(const Value& table, std::string_view where) {
  return makeByType<Translation>(table, where, types, later);
}

}  // namespace meridian::scene

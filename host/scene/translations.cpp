#include <array>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include <glm/common.hpp>
#include <glm/matrix.hpp>

#include "host/api/property.h"
#include "host/api/schema.h"
#include "host/ephemeris/body_positions.h"
#include "host/ephemeris/frames.h"
#include "host/ephemeris/kepler.h"
#include "host/scene/composed_transforms.h"
#include "host/scene/globe_transforms.h"
#include "host/scene/lua_transforms.h"
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

Result<std::unique_ptr<Translation>> makeStatic(const TransformRequest& request) {
  const Value& table = request.table;
  static const Schema schema({{"Position", Type::Vector3, "Metres in the parent's frame", true}});
  if (auto valid = schema.validate(table, request.where, request.path); !valid) {
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

Result<std::unique_ptr<Translation>> makeKepler(const TransformRequest& request) {
  const Value& table = request.table;
  static const Schema schema({{"Eccentricity", Type::Number, "0 is a circle", true, 0.0},
                              {"SemiMajorAxis", Type::Number, "Kilometres", true},
                              {"Inclination", Type::Number, "Degrees", true},
                              {"AscendingNode", Type::Number, "Degrees", true},
                              {"ArgumentOfPeriapsis", Type::Number, "Degrees", true},
                              {"MeanAnomaly", Type::Number, "Degrees at the epoch", true},
                              {"Epoch", Type::String, "UTC date", true},
                              {"Period", Type::Number, "Seconds", true}});
  if (auto valid = schema.validate(table, request.where, request.path); !valid) {
    return tl::make_unexpected(valid.error());
  }
  const auto epoch = Time::fromUtc(*table.find("Epoch")->string());
  if (!epoch) {
    return failure(epoch.error().what, request.place("Epoch"), epoch.error().remedy);
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
    return failure(valid.error().what, request.place({}), valid.error().remedy);
  }
  return std::make_unique<KeplerTranslation>(elements);
}

/// A body's name or number. Nothing, with a warning, for a body whose position we cannot give.
Result<std::optional<ephemeris::BodyId>> readBody(const TransformRequest& request, std::string_view key) {
  const Value* value = request.table.find(key);
  std::string text;
  if (value == nullptr) {
    text = "SSB";
  } else if (const std::string* name = value->string()) {
    text = *name;
  } else if (const auto number = value->number(); number && *number == std::round(*number) && std::abs(*number) < 1e9) {
    text = std::to_string(static_cast<long>(*number));
  } else {
    return failure("expected the name or number of a body", request.place(key), "write it as \"EARTH\" or 399");
  }
  const auto body = ephemeris::bodyId(text);
  if (body && ephemeris::hasPosition(*body)) {
    return body;
  }
  warnOnce(request, "body " + text,
           "the position of '" + text + "' is not known without SPICE kernels; the node stays at its parent's origin");
  return std::nullopt;
}

Result<std::unique_ptr<Translation>> makeSpice(const TransformRequest& request) {
  const Value& table = request.table;
  static const Schema schema({{"Target", Type::Any, "Name or NAIF number of the body", true},
                              {"Observer", Type::Any, "Name or NAIF number; the solar-system barycentre without"},
                              {"Frame", Type::String, "Axes of the parent; GALACTIC without"},
                              {"FixedDate", Type::String, "UTC date at which the body stands still"},
                              {"TimeOffset", Type::Number, "Seconds added to the scene's time"}});
  if (auto valid = schema.validate(table, request.where, request.path); !valid) {
    return tl::make_unexpected(valid.error());
  }
  const auto target = readBody(request, "Target");
  if (!target) {
    return tl::make_unexpected(target.error());
  }
  const auto observer = readBody(request, "Observer");
  if (!observer) {
    return tl::make_unexpected(observer.error());
  }
  const Value* axes = table.find("Frame");
  auto frame = axes != nullptr ? ephemeris::Frame::fromName(*axes->string()) : ephemeris::Frame::galactic();
  if (!frame) {
    warnOnce(request, "frame " + frame.error().what, frame.error().what + "; GALACTIC is taken instead");
    frame = ephemeris::Frame::galactic();
  }
  const auto clock = TransformClock::fromTable(request);
  if (!clock) {
    return tl::make_unexpected(clock.error());
  }
  return std::make_unique<SpiceTranslation>(*target, *observer, *frame, *clock);
}

/// Of types whose data we do not read.
template <int Which>
Result<std::unique_ptr<Translation>> makeUnknown(const TransformRequest& request) {
  static constexpr std::array names{"GPTranslation", "HorizonsTranslation"};
  warnOnce(request, names[Which],
           std::string("files of ") + names[Which] + " are not read; the node stays at its parent's origin");
  return std::make_unique<StaticTranslation>(glm::dvec3(0.0));
}

class MultiTranslation final : public Translation {
 public:
  explicit MultiTranslation(std::vector<std::unique_ptr<Translation>> parts) : parts_(std::move(parts)) {}
  [[nodiscard]] glm::dvec3 position(const Time& time) const override {
    glm::dvec3 sum(0.0);
    for (const auto& part : parts_) {
      sum += part->position(time);
    }
    return sum;
  }

 private:
  std::vector<std::unique_ptr<Translation>> parts_;
};

Result<std::unique_ptr<Translation>> makeMulti(const TransformRequest& request) {
  return makeParts<Translation>(request, "Translations", makeTranslation).map([](auto parts) {
    return std::make_unique<MultiTranslation>(std::move(parts));
  });
}

class TimelineTranslation final : public Translation {
 public:
  explicit TimelineTranslation(Timeline<Translation> timeline) : timeline_(std::move(timeline)) {}
  [[nodiscard]] glm::dvec3 position(const Time& time) const override {
    const auto [before, after, share] = timeline_.at(time);
    const glm::dvec3 from = before.position(time);
    return share > 0.0 ? glm::mix(from, after.position(time), share) : from;
  }

 private:
  Timeline<Translation> timeline_;
};

Result<std::unique_ptr<Translation>> makeTimeline(const TransformRequest& request) {
  return Timeline<Translation>::make(request, makeTranslation).map([](auto timeline) {
    return std::make_unique<TimelineTranslation>(std::move(timeline));
  });
}

constexpr std::array types = {TransformType<Translation>{"StaticTranslation", makeStatic},
                              TransformType<Translation>{"KeplerTranslation", makeKepler},
                              TransformType<Translation>{"SpiceTranslation", makeSpice},
                              TransformType<Translation>{"GlobeTranslation", makeGlobeTranslation},
                              TransformType<Translation>{"LuaTranslation", makeLuaTranslation},
                              TransformType<Translation>{"MultiTranslation", makeMulti},
                              TransformType<Translation>{"TimelineTranslation", makeTimeline},
                              TransformType<Translation>{"GPTranslation", makeUnknown<0>},
                              TransformType<Translation>{"HorizonsTranslation", makeUnknown<1>}};

}  // namespace

glm::dvec3 SpiceTranslation::position(const Time& time) const {
  if (!target_ || !observer_) {
    return glm::dvec3(0.0);
  }
  const Time moment = clock_.at(time);
  return glm::transpose(frame_.icrfFromFrame(moment)) * ephemeris::relativePosition(*target_, *observer_, moment);
}

Result<TransformClock> TransformClock::fromTable(const TransformRequest& request) {
  const Value& table = request.table;
  TransformClock clock;
  clock.offset_ = numberOr(table, "TimeOffset", 0.0);
  if (!std::isfinite(clock.offset_)) {
    return failure("expected a finite number", request.place("TimeOffset"), "give the offset in seconds");
  }
  if (const Value* date = table.find("FixedDate");
      date != nullptr && date->string() != nullptr && !date->string()->empty()) {
    const auto fixed = Time::fromUtc(*date->string());
    if (!fixed) {
      return failure(fixed.error().what, request.place("FixedDate"), fixed.error().remedy);
    }
    clock.fixed_ = *fixed;
  }
  return clock;
}

Result<std::unique_ptr<Translation>> makeTranslation(const TransformRequest& request) {
  return request.table.table()->list.empty() ? makeByType<Translation>(request, types) : makeMulti(request);
}

}  // namespace meridian::scene

#include "host/scripting/property_animation.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "host/api/log.h"
#include "host/api/property.h"

namespace meridian::scripting {

PropertyAnimation::PropertyAnimation(PropertyIndex& index, std::function<void(std::string)> runLater)
    : index_(&index), runLater_(std::move(runLater)), structureVersion_(index.structureVersion()) {}

void PropertyAnimation::start(const std::vector<Property*>& properties, const Movement& movement) {
  assert(movement.seconds > 0.0 && movement.easing != nullptr);
  dropTheGone();
  const auto shared = std::make_shared<Movement>(movement);
  for (Property* property : properties) {
    assert(property->isNumeric());
    cancel(*property);
    records_.push_back({property->uri(), property, property->value(), shared});
  }
}

void PropertyAnimation::cancel(const Property& property) {
  std::erase_if(records_, [&](const Record& record) { return record.property == &property; });
}

bool PropertyAnimation::stopBouncing(std::string_view uri) {
  return std::erase_if(records_, [&](const Record& record) { return record.uri == uri && record.movement->bouncing; }) >
         0;
}

void PropertyAnimation::advance(double seconds) {
  dropTheGone();
  // Callbacks of properties may start and cancel movements, or remove properties, while we walk.
  std::vector<Record> now;
  now.swap(records_);
  const unsigned version = index_->structureVersion();
  std::vector<Record> going;
  for (Record& record : now) {
    const auto isReplaced = [&] {
      return std::any_of(records_.begin(), records_.end(),
                         [&](const Record& other) { return other.property == record.property; });
    };
    if (index_->structureVersion() != version && index_->find(record.uri) != record.property) {
      continue;
    }
    if (!isReplaced() && !step(record, seconds) && !isReplaced()) {
      going.push_back(std::move(record));
    }
  }
  records_.insert(records_.begin(), std::make_move_iterator(going.begin()), std::make_move_iterator(going.end()));
}

bool PropertyAnimation::isMoving(const Property& property) const {
  return std::any_of(records_.begin(), records_.end(),
                     [&](const Record& record) { return record.property == &property; });
}

bool PropertyAnimation::awaitsScript() const {
  return std::any_of(records_.begin(), records_.end(), [](const Record& record) {
    return !record.movement->bouncing && !record.movement->postScript.empty();
  });
}

void PropertyAnimation::dropTheGone() {
  if (structureVersion_ == index_->structureVersion()) {
    return;
  }
  structureVersion_ = index_->structureVersion();
  std::erase_if(records_, [&](const Record& record) { return index_->find(record.uri) != record.property; });
}

bool PropertyAnimation::step(Record& record, double seconds) {
  record.elapsed += seconds;
  const std::shared_ptr<Movement> movement = record.movement;
  double t = record.elapsed / movement->seconds;
  if (movement->bouncing) {
    t = std::fmod(t, 2.0);
    t = t > 1.0 ? 2.0 - t : t;
  } else if (t >= 1.0) {
    if (Result<void> done = record.property->set(movement->target); !done) {
      log::error("{}", done.error().message());
    }
    if (!movement->postScript.empty()) {
      runLater_(std::exchange(movement->postScript, {}));
    }
    return true;
  }
  // An easing may leave the range for a while: the property then waits at the last value that it took.
  (void)record.property->set(interpolate(record.from, movement->target, movement->easing(t)));
  return false;
}

}  // namespace meridian::scripting

#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "host/api/value.h"
#include "host/scripting/easing.h"
#include "host/scripting/property_index.h"

namespace meridian::scripting {

/// Moves numeric properties to their targets over seconds of frame time, so that a recording at a fixed time step is
/// the same every time. A property has one movement at most: a new one begins at the value the property has by then.
class PropertyAnimation {
 public:
  struct Movement {
    Value target;
    double seconds = 0.0;  ///< more than 0
    Easing easing = nullptr;
    std::string postScript{};  ///< run once when the first of the properties arrives
    bool bouncing = false;     ///< to the target and back again until stopBouncing
  };

  /// `runLater` gets the scripts to run after a movement; index must outlive this.
  PropertyAnimation(PropertyIndex& index, std::function<void(std::string)> runLater);

  /// For properties with isNumeric(). A target that a property refuses when it is reached is logged.
  void start(const std::vector<Property*>& properties, const Movement& movement);
  /// The property stays where it is; a post script that waits for nobody else is dropped.
  void cancel(const Property& property);
  /// True if the property of that URI was bouncing; it stays where it is.
  bool stopBouncing(std::string_view uri);

  /// `seconds` of frame time have gone by.
  void advance(double seconds);
  [[nodiscard]] bool isMoving(const Property& property) const;
  [[nodiscard]] bool isIdle() const { return records_.empty(); }
  /// Whether some movement will end and then run a script.
  [[nodiscard]] bool awaitsScript() const;
  /// Where post scripts go.
  [[nodiscard]] const std::function<void(std::string)>& runLater() const { return runLater_; }

 private:
  struct Record {
    std::string uri;
    Property* property;
    Value from;
    std::shared_ptr<Movement> movement;
    double elapsed = 0.0;
  };

  void dropTheGone();
  /// True when the movement is over.
  bool step(Record& record, double seconds);

  PropertyIndex* index_;
  std::function<void(std::string)> runLater_;
  std::vector<Record> records_;
  unsigned structureVersion_ = 0;
};

}  // namespace meridian::scripting

#pragma once

#include <string>
#include <string_view>

#include "host/api/property.h"

namespace meridian {

/// The widgets that a panel may ask for, without knowing which toolkit draws them.
///
/// Buttons and sections are known by their labels, so two in one section must differ. What follows "##" is not shown
/// and tells apart those that people call the same: "Ice##2".
class PanelBuilder {
 public:
  virtual ~PanelBuilder() = default;
  virtual void text(std::string_view text) = 0;
  /// Text that means trouble, such as a layer's last error.
  virtual void warning(std::string_view text) = 0;
  /// The widget that fits the property: check box, slider, choice, button, text field.
  virtual void property(Property& property) = 0;
  [[nodiscard]] virtual bool button(std::string_view label) = 0;
  /// A foldable section; call endSection only when it returned true.
  [[nodiscard]] virtual bool beginSection(std::string_view title) = 0;
  virtual void endSection() = 0;
};

/// A window of the user interface. Drawn every frame while it is open, on the render thread.
class Panel {
 public:
  virtual ~Panel() = default;
  [[nodiscard]] virtual std::string title() const = 0;
  virtual void build(PanelBuilder& builder) = 0;
};

}  // namespace meridian

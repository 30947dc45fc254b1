#pragma once

#include <functional>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "host/api/error.h"
#include "host/api/value.h"

namespace meridian {

class PropertyOwner;

/// Something that scripts, assets, the panels and the command line can read and set by its URI, as a Value.
/// Render thread only. Setting a value equal to the present one tells nobody.
class Property {
 public:
  struct Description {
    std::string identifier;
    std::string name{};  ///< for people; empty: the identifier
    std::string description{};
    bool readOnly = false;  ///< for scripts, assets and panels; our own code may set it all the same
  };

  explicit Property(Description description) : description_(std::move(description)) {}
  Property(const Property&) = delete;
  Property& operator=(const Property&) = delete;
  virtual ~Property();

  [[nodiscard]] const std::string& identifier() const { return description_.identifier; }
  [[nodiscard]] const std::string& name() const {
    return description_.name.empty() ? description_.identifier : description_.name;
  }
  [[nodiscard]] const std::string& description() const { return description_.description; }
  [[nodiscard]] bool isReadOnly() const { return description_.readOnly; }
  [[nodiscard]] PropertyOwner* owner() const { return owner_; }
  [[nodiscard]] std::string uri() const;

  [[nodiscard]] virtual Value value() const = 0;
  /// Sets from outside. Errors: read only, wrong type, out of range, not finite; the property is then unchanged.
  [[nodiscard]] Result<void> set(const Value& value);
  /// Whether `set` would take a value of this type (range and choices aside): what wildcards filter by.
  [[nodiscard]] virtual bool accepts(const Value& value) const = 0;
  /// Whether values between two others exist, so that a script can ask for a duration.
  [[nodiscard]] virtual bool isNumeric() const { return false; }

  /// Called after every change, in the order of adding, for as long as the property lives.
  void onChange(std::function<void()> callback) { callbacks_.push_back(std::move(callback)); }

 protected:
  [[nodiscard]] virtual Result<void> assign(const Value& value) = 0;
  void changed() const;

 private:
  friend class PropertyOwner;
  Description description_;
  PropertyOwner* owner_ = nullptr;
  std::vector<std::function<void()>> callbacks_;
};

/// The value between `from` and `to` (numbers, or lists of equally many numbers) at `t` in 0..1 (easings may leave it);
/// `to` where there is none.
[[nodiscard]] Value interpolate(const Value& from, const Value& to, double t);

class BoolProperty final : public Property {
 public:
  BoolProperty(Description description, bool value) : Property(std::move(description)), value_(value) {}
  [[nodiscard]] bool get() const { return value_; }
  void put(bool value);
  [[nodiscard]] Value value() const override { return value_; }
  [[nodiscard]] bool accepts(const Value& value) const override { return value.boolean().has_value(); }

 private:
  Result<void> assign(const Value& value) override;
  bool value_;
};

/// A range that ends are part of.
struct NumberRange {
  double minimum = -std::numeric_limits<double>::max();
  double maximum = std::numeric_limits<double>::max();
};

class FloatProperty final : public Property {
 public:
  FloatProperty(Description description, double value, NumberRange range = {})
      : Property(std::move(description)), value_(value), range_(range) {}
  [[nodiscard]] double get() const { return value_; }
  /// Clamps to the range; not a number is ignored.
  void put(double value);
  [[nodiscard]] const NumberRange& range() const { return range_; }
  [[nodiscard]] Value value() const override { return value_; }
  [[nodiscard]] bool accepts(const Value& value) const override { return value.number().has_value(); }
  [[nodiscard]] bool isNumeric() const override { return true; }

 private:
  Result<void> assign(const Value& value) override;
  double value_;
  NumberRange range_;
};

class IntProperty final : public Property {
 public:
  IntProperty(Description description, int value, int minimum = std::numeric_limits<int>::min(),
              int maximum = std::numeric_limits<int>::max())
      : Property(std::move(description)), value_(value), minimum_(minimum), maximum_(maximum) {}
  [[nodiscard]] int get() const { return value_; }
  /// Clamps to the range.
  void put(int value);
  [[nodiscard]] int minimum() const { return minimum_; }
  [[nodiscard]] int maximum() const { return maximum_; }
  [[nodiscard]] Value value() const override { return value_; }
  [[nodiscard]] bool accepts(const Value& value) const override { return value.number().has_value(); }
  [[nodiscard]] bool isNumeric() const override { return true; }

 private:
  /// Rounds to the nearest whole number.
  Result<void> assign(const Value& value) override;
  int value_;
  int minimum_;
  int maximum_;
};

class StringProperty final : public Property {
 public:
  /// Of a value that is set: what to give in its place ("give a line of ASCII"), or an empty text when it is good.
  using Check = std::function<std::string(const std::string&)>;

  StringProperty(Description description, std::string value = {}, Check check = {})
      : Property(std::move(description)), value_(std::move(value)), check_(std::move(check)) {}
  [[nodiscard]] const std::string& get() const { return value_; }
  void put(std::string value);
  [[nodiscard]] Value value() const override { return value_; }
  [[nodiscard]] bool accepts(const Value& value) const override { return value.string() != nullptr; }

 private:
  Result<void> assign(const Value& value) override;
  std::string value_;
  Check check_;
};

/// A glm vector of 2, 3 or 4 doubles; its Value is a list of numbers.
template <class Vector>
class VectorProperty final : public Property {
 public:
  VectorProperty(Description description, const Vector& value, NumberRange range = {})
      : Property(std::move(description)), value_(value), range_(range) {}
  [[nodiscard]] const Vector& get() const { return value_; }
  void put(const Vector& value);
  [[nodiscard]] const NumberRange& range() const { return range_; }
  [[nodiscard]] Value value() const override { return Value(value_); }
  [[nodiscard]] bool accepts(const Value& value) const override;
  [[nodiscard]] bool isNumeric() const override { return true; }

 private:
  Result<void> assign(const Value& value) override;
  Vector value_;
  NumberRange range_;
};
using Vec2Property = VectorProperty<glm::dvec2>;
using Vec3Property = VectorProperty<glm::dvec3>;
using Vec4Property = VectorProperty<glm::dvec4>;

/// One of a fixed list of words. Set by the word or by its place in the list (from 0); read as the place, as
/// OpenSpace's scripts expect of an option property.
class OptionProperty final : public Property {
 public:
  OptionProperty(Description description, std::vector<std::string> options, int value = 0)
      : Property(std::move(description)), options_(std::move(options)), value_(value) {}
  [[nodiscard]] int get() const { return value_; }
  [[nodiscard]] const std::string& word() const { return options_[static_cast<std::size_t>(value_)]; }
  [[nodiscard]] const std::vector<std::string>& options() const { return options_; }
  void put(int value);
  [[nodiscard]] Value value() const override { return value_; }
  [[nodiscard]] bool accepts(const Value& value) const override {
    return value.number().has_value() || value.string() != nullptr;
  }

 private:
  Result<void> assign(const Value& value) override;
  std::vector<std::string> options_;
  int value_;
};

/// A button: setting it to anything calls the callbacks.
class TriggerProperty final : public Property {
 public:
  using Property::Property;
  void fire() const { changed(); }
  [[nodiscard]] Value value() const override { return {}; }
  [[nodiscard]] bool accepts(const Value& /*value*/) const override { return true; }

 private:
  Result<void> assign(const Value& value) override;
};

}  // namespace meridian

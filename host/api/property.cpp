#include "host/api/property.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "host/api/property_owner.h"

namespace meridian {

namespace {

tl::unexpected<Error> wrongType(const Property& property, std::string_view expected, const Value& found) {
  return failure(fmt::format("expected {}, found {}", expected, kindName(found.kind())), property.uri());
}

Result<double> checkedNumber(const Property& property, double number, const NumberRange& range) {
  if (!std::isfinite(number) || number < range.minimum || number > range.maximum) {
    return failure(fmt::format("{} is out of range", number), property.uri(),
                   fmt::format("give a number from {} to {}", range.minimum, range.maximum));
  }
  return number;
}

}  // namespace

Property::~Property() {
  if (owner_ != nullptr) {
    owner_->removeProperty(*this);
  }
}

std::string Property::uri() const {
  const std::string above = owner_ != nullptr ? owner_->uri() : std::string();
  return above.empty() ? identifier() : above + '.' + identifier();
}

Result<void> Property::set(const Value& value) {
  if (isReadOnly()) {
    return failure("the property is read only", uri());
  }
  return assign(value);
}

void Property::changed() const {
  for (const auto& callback : callbacks_) {
    callback();
  }
}

Value interpolate(const Value& from, const Value& to, double t) {
  const auto between = [t](double a, double b) { return a + (b - a) * t; };
  if (from.number() && to.number()) {
    return between(*from.number(), *to.number());
  }
  const auto a = from.numbers();
  const auto b = to.numbers();
  if (!a || !b || a->size() != b->size()) {
    return to;
  }
  std::vector<double> out(a->size());
  std::transform(a->begin(), a->end(), b->begin(), out.begin(), between);
  return Value(std::span<const double>(out));
}

void BoolProperty::put(bool value) {
  if (value != value_) {
    value_ = value;
    changed();
  }
}

Result<void> BoolProperty::assign(const Value& value) {
  if (!value.boolean()) {
    return wrongType(*this, "a boolean", value);
  }
  put(*value.boolean());
  return {};
}

void FloatProperty::put(double value) {
  if (std::isnan(value)) {
    return;
  }
  value = std::clamp(value, range_.minimum, range_.maximum);
  if (value != value_) {
    value_ = value;
    changed();
  }
}

Result<void> FloatProperty::assign(const Value& value) {
  if (!value.number()) {
    return wrongType(*this, "a number", value);
  }
  return checkedNumber(*this, *value.number(), range_).map([this](double number) { put(number); });
}

void IntProperty::put(int value) {
  value = std::clamp(value, minimum_, maximum_);
  if (value != value_) {
    value_ = value;
    changed();
  }
}

Result<void> IntProperty::assign(const Value& value) {
  if (!value.number()) {
    return wrongType(*this, "a whole number", value);
  }
  const NumberRange range{static_cast<double>(minimum_), static_cast<double>(maximum_)};
  return checkedNumber(*this, *value.number(), range).map([this](double number) {
    put(static_cast<int>(std::lround(number)));
  });
}

void StringProperty::put(std::string value) {
  if (value != value_) {
    value_ = std::move(value);
    changed();
  }
}

Result<void> StringProperty::assign(const Value& value) {
  if (value.string() == nullptr) {
    return wrongType(*this, "a string", value);
  }
  if (std::string remedy = check_ ? check_(*value.string()) : std::string(); !remedy.empty()) {
    return failure("the text cannot be taken", uri(), std::move(remedy));
  }
  put(*value.string());
  return {};
}

template <class Vector>
void VectorProperty<Vector>::put(const Vector& value) {
  if (value != value_) {
    value_ = value;
    changed();
  }
}

template <class Vector>
bool VectorProperty<Vector>::accepts(const Value& value) const {
  return value.numbers(static_cast<std::size_t>(Vector::length())).has_value();
}

template <class Vector>
Result<void> VectorProperty<Vector>::assign(const Value& value) {
  const auto numbers = value.numbers(static_cast<std::size_t>(Vector::length()));
  if (!numbers) {
    return wrongType(*this, fmt::format("a list of {} numbers", Vector::length()), value);
  }
  Vector vector{};
  for (glm::length_t i = 0; i < Vector::length(); ++i) {
    const Result<double> number = checkedNumber(*this, (*numbers)[static_cast<std::size_t>(i)], range_);
    if (!number) {
      return tl::make_unexpected(number.error());
    }
    vector[i] = *number;
  }
  put(vector);
  return {};
}

template class VectorProperty<glm::dvec2>;
template class VectorProperty<glm::dvec3>;
template class VectorProperty<glm::dvec4>;

void OptionProperty::put(int value) {
  value = std::clamp(value, 0, static_cast<int>(options_.size()) - 1);
  if (value != value_) {
    value_ = value;
    changed();
  }
}

Result<void> OptionProperty::assign(const Value& value) {
  if (const std::string* word = value.string()) {
    const auto found = std::find(options_.begin(), options_.end(), *word);
    if (found == options_.end()) {
      return failure(fmt::format("unknown option \"{}\"", *word), uri(),
                     fmt::format("use one of: {}", fmt::join(options_, ", ")));
    }
    put(static_cast<int>(found - options_.begin()));
    return {};
  }
  if (!value.number()) {
    return wrongType(*this, "an option's word or number", value);
  }
  const NumberRange range{0.0, static_cast<double>(options_.size()) - 1.0};
  return checkedNumber(*this, *value.number(), range).map([this](double number) {
    put(static_cast<int>(std::lround(number)));
  });
}

Result<void> TriggerProperty::assign(const Value& /*value*/) {
  fire();
  return {};
}

}  // namespace meridian

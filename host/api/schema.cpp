#include "host/api/schema.h"

#include <algorithm>
#include <cctype>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace meridian {

namespace {

bool isIdentifier(const Value& value) {
  const std::string* text = value.string();
  return text != nullptr && !text->empty() &&
         std::none_of(text->begin(), text->end(), [](unsigned char c) { return c == '.' || std::isspace(c) != 0; });
}

bool isStringOrStrings(const Value& value) {
  const Table* table = value.table();
  if (table == nullptr) {
    return value.string() != nullptr;
  }
  return table->fields.empty() && std::all_of(table->list.begin(), table->list.end(),
                                              [](const Value& item) { return item.string() != nullptr; });
}

bool hasType(const Value& value, Schema::Type type) {
  switch (type) {
    case Schema::Type::Boolean:
      return value.boolean().has_value();
    case Schema::Type::Number:
      return value.number().has_value();
    case Schema::Type::Integer:
      return value.number() && std::trunc(*value.number()) == *value.number();
    case Schema::Type::String:
      return value.string() != nullptr;
    case Schema::Type::Identifier:
      return isIdentifier(value);
    case Schema::Type::Table:
      return value.isTable();
    case Schema::Type::Vector2:
      return value.numbers(2).has_value();
    case Schema::Type::Vector3:
      return value.numbers(3).has_value();
    case Schema::Type::Vector4:
      return value.numbers(4).has_value();
    case Schema::Type::NumberOrVector3:
      return value.number() || value.numbers(3);
    case Schema::Type::StringOrStrings:
      return isStringOrStrings(value);
    case Schema::Type::Any:
      return true;
  }
  return false;
}

std::vector<double> numbersIn(const Value& value) {
  if (const std::optional<double> number = value.number()) {
    return {*number};
  }
  return value.numbers().value_or(std::vector<double>{});
}

Result<void> checkField(const Schema::Field& field, const Value& value, const std::string& where) {
  if (!hasType(value, field.type)) {
    return failure(fmt::format("expected {}, found {} {}", typeName(field.type), kindName(value.kind()),
                               value.isTable() ? std::string("of another shape") : value.toLua()),
                   where, fmt::format("{} is: {}", field.key, field.description));
  }
  for (const double number : numbersIn(value)) {
    // Written so that NaN fails.
    const bool inside =
        !(field.minimum && !(number >= *field.minimum)) && !(field.maximum && !(number <= *field.maximum));
    if (!inside) {
      return failure(fmt::format("{} is out of range", number), where,
                     fmt::format("give a number of at least {} and at most {}",
                                 field.minimum ? fmt::format("{}", *field.minimum) : "any",
                                 field.maximum ? fmt::format("{}", *field.maximum) : "any"));
    }
  }
  if (!field.choices.empty() && value.string() != nullptr &&
      std::find(field.choices.begin(), field.choices.end(), *value.string()) == field.choices.end()) {
    return failure(fmt::format("unknown value \"{}\"", *value.string()), where,
                   fmt::format("use one of: {}", fmt::join(field.choices, ", ")));
  }
  return {};
}

}  // namespace

std::string_view typeName(Schema::Type type) {
  switch (type) {
    case Schema::Type::Boolean:
      return "a boolean";
    case Schema::Type::Number:
      return "a number";
    case Schema::Type::Integer:
      return "a whole number";
    case Schema::Type::String:
      return "a string";
    case Schema::Type::Identifier:
      return "an identifier (a string without dots and white space)";
    case Schema::Type::Table:
      return "a table";
    case Schema::Type::Vector2:
      return "a list of 2 numbers";
    case Schema::Type::Vector3:
      return "a list of 3 numbers";
    case Schema::Type::Vector4:
      return "a list of 4 numbers";
    case Schema::Type::NumberOrVector3:
      return "a number or a list of 3 numbers";
    case Schema::Type::StringOrStrings:
      return "a string or a list of strings";
    case Schema::Type::Any:
      return "anything";
  }
  return "anything";
}

Result<void> Schema::validate(const Value& value, std::string_view where, std::string_view path) const {
  const auto placeOf = [&](std::string_view key) {
    return fmt::format("{}{}{}{}{}", where, where.empty() ? "" : ": ", path, path.empty() || key.empty() ? "" : ".",
                       key);
  };
  if (!value.isTable()) {
    return failure(fmt::format("expected a table, found {}", kindName(value.kind())), placeOf({}));
  }
  for (const Field& field : fields_) {
    const Value* found = value.find(field.key);
    if (found == nullptr || found->isNil()) {
      if (field.required) {
        return failure(fmt::format("the required key {} is missing", field.key), placeOf(field.key),
                       fmt::format("give {}: {}", typeName(field.type), field.description));
      }
      continue;
    }
    if (Result<void> checked = checkField(field, *found, placeOf(field.key)); !checked) {
      return checked;
    }
  }
  return {};
}

}  // namespace meridian

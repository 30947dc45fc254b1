#include "host/api/schema.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <numeric>

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

/// How many letters must be changed, added or left out to turn one word into the other, whatever their case.
std::size_t distanceBetween(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const bool same =
          std::tolower(static_cast<unsigned char>(a[i])) == std::tolower(static_cast<unsigned char>(b[j]));
      const std::size_t changed = diagonal + (same ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({changed, row[j] + 1, diagonal + 1});
    }
  }
  return row.back();
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

std::vector<UnknownKey> unknownKeys(const Value& table, std::initializer_list<const Schema*> schemas,
                                    std::span<const std::string_view> ignored) {
  constexpr std::size_t longestKey = 64;
  std::vector<UnknownKey> found;
  if (!table.isTable()) {
    return found;
  }
  for (const auto& [key, value] : table.table()->fields) {
    std::string meant;
    std::size_t best = std::min<std::size_t>(key.size() / 3, 2) + 1;
    bool known = std::find(ignored.begin(), ignored.end(), key) != ignored.end();
    for (const Schema* schema : schemas) {
      for (const Schema::Field& field : schema->fields()) {
        known = known || field.key == key;
        const std::size_t distance = key.size() > longestKey ? best : distanceBetween(key, field.key);
        if (distance < best) {
          best = distance;
          meant = field.key;
        }
      }
    }
    if (!known) {
      found.push_back({key, std::move(meant)});
    }
  }
  return found;
}

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

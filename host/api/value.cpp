#include "host/api/value.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>

#include <fmt/format.h>

namespace meridian {

namespace {

bool isLuaName(std::string_view text) {
  const auto isWord = [](unsigned char c) { return std::isalnum(c) != 0 || c == '_'; };
  return !text.empty() && std::isdigit(static_cast<unsigned char>(text.front())) == 0 &&
         std::all_of(text.begin(), text.end(), isWord);
}

std::string quoted(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    switch (c) {
      case '"':
        out += "\\\"";
        break;
      case '\\':
        out += "\\\\";
        break;
      case '\n':
        out += "\\n";
        break;
      case '\r':
        out += "\\r";
        break;
      case '\0':
        out += "\\0";
        break;
      default:
        out += c;
    }
  }
  return out + '"';
}

std::string numberToLua(double number) {
  if (std::isnan(number)) {
    return "(0/0)";
  }
  if (std::isinf(number)) {
    return number > 0 ? "math.huge" : "-math.huge";
  }
  return fmt::format("{}", number);
}

Table tableOf(std::span<const double> numbers) {
  Table table;
  table.list.assign(numbers.begin(), numbers.end());
  return table;
}

}  // namespace

const Value* Table::find(std::string_view name) const {
  const auto found = fields.find(name);
  return found == fields.end() ? nullptr : &found->second;
}

Value::Value(Table table) : data_(std::make_shared<const Table>(std::move(table))) {}
Value::Value(std::span<const double> numbers) : Value(tableOf(numbers)) {}
Value::Value(const glm::dvec2& vector) : Value(std::span<const double>(std::array{vector.x, vector.y})) {}
Value::Value(const glm::dvec3& vector) : Value(std::span<const double>(std::array{vector.x, vector.y, vector.z})) {}
Value::Value(const glm::dvec4& vector)
    : Value(std::span<const double>(std::array{vector.x, vector.y, vector.z, vector.w})) {}

std::optional<bool> Value::boolean() const {
  const bool* value = std::get_if<bool>(&data_);
  return value != nullptr ? std::optional(*value) : std::nullopt;
}

std::optional<double> Value::number() const {
  const double* value = std::get_if<double>(&data_);
  return value != nullptr ? std::optional(*value) : std::nullopt;
}

const std::string* Value::string() const {
  return std::get_if<std::string>(&data_);
}

const Table* Value::table() const {
  const auto* value = std::get_if<std::shared_ptr<const Table>>(&data_);
  return value != nullptr ? value->get() : nullptr;
}

std::optional<std::vector<double>> Value::numbers(std::size_t count) const {
  const Table* whole = table();
  if (whole == nullptr || (count != 0 && whole->list.size() != count)) {
    return std::nullopt;
  }
  std::vector<double> out;
  out.reserve(whole->list.size());
  for (const Value& item : whole->list) {
    const std::optional<double> number = item.number();
    if (!number) {
      return std::nullopt;
    }
    out.push_back(*number);
  }
  return out;
}

const Value* Value::find(std::string_view name) const {
  const Table* whole = table();
  return whole != nullptr ? whole->find(name) : nullptr;
}

std::string Value::toLua() const {
  switch (kind()) {
    case Kind::Nil:
      return "nil";
    case Kind::Boolean:
      return *boolean() ? "true" : "false";
    case Kind::Number:
      return numberToLua(*number());
    case Kind::String:
      return quoted(*string());
    case Kind::Table:
      break;
  }
  std::string out = "{";
  const char* separator = " ";
  for (const Value& item : table()->list) {
    out += separator + item.toLua();
    separator = ", ";
  }
  for (const auto& [name, item] : table()->fields) {
    out += separator + (isLuaName(name) ? name : "[" + quoted(name) + "]") + " = " + item.toLua();
    separator = ", ";
  }
  return out + " }";
}

bool operator==(const Value& a, const Value& b) {
  const Table* tableA = a.table();
  const Table* tableB = b.table();
  if (tableA != nullptr && tableB != nullptr) {
    return tableA->list == tableB->list && tableA->fields == tableB->fields;
  }
  return a.data_ == b.data_;
}

std::string_view kindName(Value::Kind kind) {
  static constexpr std::array<std::string_view, 5> names{"nil", "boolean", "number", "string", "table"};
  return names[static_cast<std::size_t>(kind)];
}

}  // namespace meridian

#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

namespace meridian {

class Value;

/// A table as Lua has them: a list part (1, 2, 3 ... in Lua, from 0 here) and named fields in alphabetical order.
/// A numeric key outside the list part is kept as a field named by the number.
struct Table {
  std::vector<Value> list;
  std::map<std::string, Value, std::less<>> fields;

  /// The field of that name, or null.
  [[nodiscard]] const Value* find(std::string_view name) const;
};

/// What assets, scripts and properties exchange with C++: nil, boolean, number, string or table. Cheap to copy.
class Value {
 public:
  enum class Kind { Nil, Boolean, Number, String, Table };

  Value() = default;
  Value(bool value) : data_(value) {}                           // NOLINT(google-explicit-constructor)
  Value(double value) : data_(value) {}                         // NOLINT(google-explicit-constructor)
  Value(int value) : data_(static_cast<double>(value)) {}       // NOLINT(google-explicit-constructor)
  Value(std::string value) : data_(std::move(value)) {}         // NOLINT(google-explicit-constructor)
  Value(std::string_view value) : data_(std::string(value)) {}  // NOLINT(google-explicit-constructor)
  Value(const char* value) : data_(std::string(value)) {}       // NOLINT(google-explicit-constructor)
  Value(Table table);                                           // NOLINT(google-explicit-constructor)
  explicit Value(std::span<const double> numbers);
  explicit Value(const glm::dvec2& vector);
  explicit Value(const glm::dvec3& vector);
  explicit Value(const glm::dvec4& vector);

  [[nodiscard]] Kind kind() const { return static_cast<Kind>(data_.index()); }
  [[nodiscard]] bool isNil() const { return kind() == Kind::Nil; }
  [[nodiscard]] bool isTable() const { return kind() == Kind::Table; }

  /// The value if it is of that kind (no conversions), else nothing.
  [[nodiscard]] std::optional<bool> boolean() const;
  [[nodiscard]] std::optional<double> number() const;
  [[nodiscard]] const std::string* string() const;
  [[nodiscard]] const Table* table() const;

  /// A table whose list part is exactly `count` numbers (count 0: any number of them), as numbers.
  [[nodiscard]] std::optional<std::vector<double>> numbers(std::size_t count = 0) const;

  /// The named field of a table; null for any other value.
  [[nodiscard]] const Value* find(std::string_view name) const;

  /// As Lua would write it, on one line: for messages and for recordings.
  [[nodiscard]] std::string toLua() const;

  friend bool operator==(const Value& a, const Value& b);

 private:
  std::variant<std::monostate, bool, double, std::string, std::shared_ptr<const Table>> data_;
};

/// "nil", "boolean", "number", "string", "table".
[[nodiscard]] std::string_view kindName(Value::Kind kind);

}  // namespace meridian

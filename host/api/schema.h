#pragma once

#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "host/api/error.h"
#include "host/api/value.h"

namespace meridian {

/// What an asset's table may hold. One Schema is the source of the checks, of their messages and of the documentation.
///
/// Tables are not exhaustive: keys that the schema does not name are allowed, as OpenSpace allows them, so that old and
/// foreign assets load. A known key of a wrong type, a missing required key and a number out of range are errors.
class Schema {
 public:
  enum class Type {
    Boolean,
    Number,
    Integer,  ///< a number without fraction
    String,
    Identifier,  ///< a string without dots and white space
    Table,       ///< any table
    Vector2,     ///< a list of exactly 2 numbers; likewise the next two
    Vector3,
    Vector4,
    NumberOrVector3,
    StringOrStrings,  ///< a string, or a list of strings
    Any
  };

  struct Field {
    std::string key;
    Type type = Type::Any;
    std::string description;
    bool required = false;
    std::optional<double> minimum{};     ///< inclusive; of every number in a vector
    std::optional<double> maximum{};     ///< inclusive
    std::vector<std::string> choices{};  ///< the strings allowed; empty: any
  };

  explicit Schema(std::vector<Field> fields) : fields_(std::move(fields)) {}

  [[nodiscard]] const std::vector<Field>& fields() const { return fields_; }

  /// Checks `value` against the fields. The first error's `where` is `where` (file and line) and the key's path below
  /// `path`: "earth.asset:12: Renderable.Layers.ColorLayers[1].Opacity".
  [[nodiscard]] Result<void> validate(const Value& value, std::string_view where, std::string_view path = {}) const;

 private:
  std::vector<Field> fields_;
};

/// A key of a table that no schema names.
struct UnknownKey {
  std::string key;
  std::string meant;  ///< the known key that it resembles; empty without one
};
/// Those of `table`, in alphabetical order, but for `ignored`.
[[nodiscard]] std::vector<UnknownKey> unknownKeys(const Value& table, std::initializer_list<const Schema*> schemas,
                                                  std::span<const std::string_view> ignored);

/// "a number", "a list of 3 numbers" ...: how messages call a type.
[[nodiscard]] std::string_view typeName(Schema::Type type);

}  // namespace meridian

#pragma once

#include <string>
#include <string_view>

#include "host/api/error.h"
#include "host/api/value.h"

namespace meridian::assets {

/// JSON text as a Value: objects and arrays are tables, null is nil. Errors, with the line in `where`: what is no JSON;
/// more than 64 levels.
[[nodiscard]] Result<Value> valueFromJson(std::string_view text, const std::string& where);

}  // namespace meridian::assets

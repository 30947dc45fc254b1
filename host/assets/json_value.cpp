#include "host/assets/json_value.h"

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace meridian::assets {

namespace {

constexpr int deepestLevel = 64;

Value converted(const nlohmann::json& json) {
  if (json.is_boolean()) {
    return json.get<bool>();
  }
  if (json.is_number()) {
    return json.get<double>();
  }
  if (json.is_string()) {
    return json.get<std::string>();
  }
  Table table;
  if (json.is_array()) {
    for (const auto& each : json) {
      table.list.push_back(converted(each));
    }
    return table;
  }
  if (json.is_object()) {
    for (const auto& [key, each] : json.items()) {
      table.fields.emplace(key, converted(each));
    }
    return table;
  }
  return {};
}

}  // namespace

Result<Value> valueFromJson(std::string_view text, const std::string& where) {
  bool tooDeep = false;
  const auto guard = [&tooDeep](int depth, nlohmann::json::parse_event_t, nlohmann::json&) {
    tooDeep = tooDeep || depth > deepestLevel;
    return !tooDeep;
  };
  try {
    const nlohmann::json json = nlohmann::json::parse(text, guard);
    if (tooDeep) {
      return failure(fmt::format("the JSON is nested deeper than {} levels", deepestLevel), where);
    }
    return converted(json);
  } catch (const nlohmann::json::parse_error& error) {
    const auto at = text.begin() + static_cast<std::ptrdiff_t>(std::min(error.byte, text.size()));
    // Its message begins with a code and the place.
    const std::string_view message = error.what();
    const std::size_t colon = message.find(": ");
    return failure(fmt::format("this is no JSON: {}", message.substr(colon == message.npos ? 0 : colon + 2)),
                   fmt::format("{}:{}", where, 1 + std::count(text.begin(), at, '\n')));
  } catch (const nlohmann::json::exception& error) {
    return failure(fmt::format("this is no JSON: {}", error.what()), where);
  }
}

}  // namespace meridian::assets

#include "globebrowsing/network/header_fields.h"

#include <algorithm>

namespace meridian::globebrowsing {

namespace {

char lowered(char letter) {
  return letter >= 'A' && letter <= 'Z' ? static_cast<char>(letter - 'A' + 'a') : letter;
}

}  // namespace

bool equalIgnoringCase(std::string_view a, std::string_view b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](char x, char y) { return lowered(x) == lowered(y); });
}

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view blank = " \t\r\n";
  const std::size_t first = text.find_first_not_of(blank);
  if (first == std::string_view::npos) {
    return {};
  }
  return text.substr(first, text.find_last_not_of(blank) - first + 1);
}

void HeaderFields::add(std::string_view name, std::string_view value) {
  fields_.emplace_back(name, value);
}

void HeaderFields::addLine(std::string_view line) {
  const std::size_t colon = line.find(':');
  if (colon == std::string_view::npos || colon == 0) {
    return;
  }
  add(line.substr(0, colon), trimmed(line.substr(colon + 1)));
}

void HeaderFields::remove(std::string_view name) {
  std::erase_if(fields_, [&](const auto& field) { return equalIgnoringCase(field.first, name); });
}

std::optional<std::string_view> HeaderFields::find(std::string_view name) const {
  const auto place = std::find_if(fields_.begin(), fields_.end(),
                                  [&](const auto& field) { return equalIgnoringCase(field.first, name); });
  return place == fields_.end() ? std::nullopt : std::optional<std::string_view>(place->second);
}

std::string HeaderFields::list(std::string_view name) const {
  std::string all;
  for (const auto& [known, value] : fields_) {
    if (equalIgnoringCase(known, name)) {
      all += all.empty() ? "" : ", ";
      all += value;
    }
  }
  return all;
}

std::string HeaderFields::text() const {
  std::string lines;
  for (const auto& [name, value] : fields_) {
    lines.append(name).append(": ").append(value).append("\n");
  }
  return lines;
}

HeaderFields HeaderFields::fromText(std::string_view text) {
  HeaderFields fields;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    fields.addLine(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return fields;
}

}  // namespace meridian::globebrowsing

#include "globebrowsing/source/service_exception.h"

#include <algorithm>
#include <string_view>

#include <nlohmann/json.hpp>

#include "globebrowsing/source/service_text.h"
#include "globebrowsing/source/xml_document.h"

namespace meridian::globebrowsing {

namespace {

constexpr std::size_t longestQuote = 200;
constexpr std::size_t mostBytes = 65536;

/// On one line, white space folded, cut at a character's end.
std::string inOneLine(std::string_view text) {
  std::string line;
  for (const char c : trimmed(text)) {
    const bool isBlank = static_cast<unsigned char>(c) <= ' ';
    if (!isBlank || (!line.empty() && line.back() != ' ')) {
      line += isBlank ? ' ' : c;
    }
    if (line.size() > longestQuote && (static_cast<unsigned char>(c) & 0xC0U) != 0x80U) {
      line.resize(line.size() - 1);
      return line + "...";
    }
  }
  return line;
}

/// The first text of an element of one of these names, in document order.
std::string firstText(const pugi::xml_node& root) {
  for (const std::string_view name : {"ServiceException", "ExceptionText", "Exception", "title", "h1", "Error"}) {
    const pugi::xml_node found =
        root.find_node([&](const pugi::xml_node& node) { return isNamed(node, name) && !text(node).empty(); });
    if (found) {
      return text(found);
    }
  }
  const pugi::xml_node coded = root.find_node([](const pugi::xml_node& node) {
    return !attribute(node, "exceptionCode").empty() || (isNamed(node, "ServiceException") && node.attribute("code"));
  });
  const std::string code = attribute(coded, "exceptionCode");
  return code.empty() ? attribute(coded, "code") : code;
}

/// HTML need not be XML.
std::string titleOf(std::string_view page) {
  const std::string lowered = lowerCase(page);
  const std::size_t open = lowered.find("<title>");
  const std::size_t close = lowered.find("</title>", std::min(open, lowered.size()));
  return close == std::string::npos ? std::string() : std::string(page.substr(open + 7, close - open - 7));
}

std::optional<std::string> ofJson(std::string_view content) {
  const nlohmann::json json = nlohmann::json::parse(content, nullptr, false);
  if (!json.is_object()) {
    return std::nullopt;
  }
  const auto error = json.find("error");
  if (error == json.end()) {
    return std::nullopt;
  }
  if (error->is_object() && error->contains("message") && (*error)["message"].is_string()) {
    return inOneLine((*error)["message"].get<std::string>());
  }
  return inOneLine(error->dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
}

}  // namespace

std::optional<std::string> exceptionText(std::span<const std::uint8_t> bytes) {
  const std::string_view content(reinterpret_cast<const char*>(bytes.data()), std::min(bytes.size(), mostBytes));
  const std::string_view begin = trimmed(content.substr(0, std::min(content.find('\0'), content.size())));
  const std::string_view plain = begin.starts_with("\xEF\xBB\xBF") ? trimmed(begin.substr(3)) : begin;
  if (plain.starts_with('{')) {
    return ofJson(plain);
  }
  const bool isWide = bytes.size() > 3 && ((bytes[0] == 0xFF && bytes[1] == 0xFE && bytes[2] == '<') ||
                                           (bytes[0] == 0xFE && bytes[1] == 0xFF && bytes[3] == '<'));
  if (!plain.starts_with('<') && !isWide) {
    return std::nullopt;
  }
  const auto document = XmlDocument::parse(bytes, {});
  std::string said = document ? firstText(document->root()) : titleOf(plain);
  if (said.empty()) {
    said = isWide ? "a document in place of data" : std::string(plain.substr(0, longestQuote));
  }
  return inOneLine(said);
}

}  // namespace meridian::globebrowsing

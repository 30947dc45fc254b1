#include "globebrowsing/source/xml_document.h"

#include <algorithm>
#include <optional>

#include <cpl_conv.h>
#include <cpl_string.h>
#include <fmt/format.h>

#include "globebrowsing/source/gdal_runtime.h"
#include "globebrowsing/source/service_text.h"

namespace meridian::globebrowsing {

namespace {

void appendUtf8(std::string& text, std::uint32_t code) {
  if (code < 0x80) {
    text += static_cast<char>(code);
  } else if (code < 0x800) {
    text += static_cast<char>(0xC0 | (code >> 6));
    text += static_cast<char>(0x80 | (code & 0x3F));
  } else if (code < 0x10000) {
    text += static_cast<char>(0xE0 | (code >> 12));
    text += static_cast<char>(0x80 | ((code >> 6) & 0x3F));
    text += static_cast<char>(0x80 | (code & 0x3F));
  } else {
    text += static_cast<char>(0xF0 | (code >> 18));
    text += static_cast<char>(0x80 | ((code >> 12) & 0x3F));
    text += static_cast<char>(0x80 | ((code >> 6) & 0x3F));
    text += static_cast<char>(0x80 | (code & 0x3F));
  }
}

/// Code units of 2 or 4 bytes to UTF-8; what is no character becomes U+FFFD.
std::string fromWide(std::span<const std::uint8_t> bytes, std::size_t unit, bool isBigEndian) {
  constexpr std::uint32_t replacement = 0xFFFD;
  std::string text;
  text.reserve(bytes.size() / unit + 16);
  std::uint32_t high = 0;
  for (std::size_t at = 0; at + unit <= bytes.size(); at += unit) {
    std::uint32_t code = 0;
    for (std::size_t i = 0; i < unit; ++i) {
      code = (code << 8) | bytes[at + (isBigEndian ? i : unit - 1 - i)];
    }
    if (high != 0) {
      const bool isPair = code >= 0xDC00 && code < 0xE000;
      appendUtf8(text, isPair ? 0x10000 + ((high - 0xD800) << 10) + (code - 0xDC00) : replacement);
      high = 0;
      if (isPair) {
        continue;
      }
    }
    if (unit == 2 && code >= 0xD800 && code < 0xDC00) {
      high = code;
    } else if (code == 0xFEFF && text.empty()) {
      continue;
    } else {
      appendUtf8(text, code == 0 || code > 0x10FFFF || (code >= 0xD800 && code < 0xE000) ? replacement : code);
    }
  }
  return text;
}

std::string fromLatin1(std::string_view bytes) {
  std::string text;
  for (const char c : bytes) {
    appendUtf8(text, static_cast<unsigned char>(c));
  }
  return text;
}

/// What the XML declaration says, in lower case; empty without one.
std::string declaredEncoding(std::string_view text) {
  const std::string_view head = text.substr(0, std::min(text.find("?>"), std::size_t{200}));
  const std::size_t at = head.starts_with("<?xml") ? head.find("encoding") : std::string_view::npos;
  if (at == std::string_view::npos) {
    return {};
  }
  const std::size_t open = head.find_first_of("\"'", at);
  if (open == std::string_view::npos) {
    return {};
  }
  return lowerCase(head.substr(open + 1, head.find(head[open], open + 1) - open - 1));
}

std::optional<std::string> recoded(const std::string& text, const std::string& encoding) {
  const GdalMessages messages;
  char* utf8 = CPLRecode(text.c_str(), encoding.c_str(), CPL_ENC_UTF8);
  std::optional<std::string> result;
  if (utf8 != nullptr && !messages.hasError()) {
    result = utf8;
  }
  CPLFree(utf8);
  return result;
}

std::string toUtf8(std::span<const std::uint8_t> bytes) {
  const auto starts = [&](std::initializer_list<int> with) {
    return bytes.size() >= with.size() && std::equal(with.begin(), with.end(), bytes.begin());
  };
  if (starts({0xFF, 0xFE, 0, 0}) || starts({'<', 0, 0, 0})) {
    return fromWide(bytes, 4, false);
  }
  if (starts({0, 0, 0xFE, 0xFF}) || starts({0, 0, 0, '<'})) {
    return fromWide(bytes, 4, true);
  }
  // Some put UTF-16's mark before a document in bytes.
  const bool hasStrayMark =
      (starts({0xFF, 0xFE}) || starts({0xFE, 0xFF})) && bytes.size() >= 4 && bytes[2] == '<' && bytes[3] != 0;
  if (!hasStrayMark && (starts({0xFF, 0xFE}) || starts({'<', 0}))) {
    return fromWide(bytes, 2, false);
  }
  if (!hasStrayMark && (starts({0xFE, 0xFF}) || starts({0, '<'}))) {
    return fromWide(bytes, 2, true);
  }
  if (starts({0xEF, 0xBB, 0xBF})) {
    bytes = bytes.subspan(3);
  } else if (hasStrayMark) {
    bytes = bytes.subspan(2);
  }
  std::string text(bytes.begin(), bytes.end());
  const std::string encoding = declaredEncoding(text);
  // A document in bytes that says UTF-16 was converted by somebody who left the declaration.
  if (!encoding.empty() && !encoding.starts_with("utf") && encoding != "us-ascii") {
    if (std::optional<std::string> utf8 = recoded(text, encoding)) {
      return *std::move(utf8);
    }
  }
  return CPLIsUTF8(text.c_str(), static_cast<int>(text.size())) != FALSE ? text : fromLatin1(text);
}

int depthOf(const pugi::xml_node& root) {
  int depth = 1;
  int deepest = 1;
  for (pugi::xml_node node = root; node;) {
    if (node.first_child()) {
      node = node.first_child();
      deepest = std::max(deepest, ++depth);
      continue;
    }
    while (node && node != root && !node.next_sibling()) {
      node = node.parent();
      --depth;
    }
    node = node == root ? pugi::xml_node() : node.next_sibling();
  }
  return deepest;
}

}  // namespace

Result<XmlDocument> XmlDocument::parse(std::span<const std::uint8_t> bytes, const std::string& where,
                                       const Limits& limits) {
  if (bytes.size() > limits.bytes) {
    return failure(fmt::format("the document has {} bytes; at most {} are read", bytes.size(), limits.bytes), where);
  }
  const std::string text = toUtf8(bytes);
  const std::size_t begin = std::min(text.find_first_not_of(" \t\r\n"), text.size());
  if (begin == text.size()) {
    return failure("the document is empty", where, "check the address; it may want another request");
  }
  XmlDocument result;
  result.where_ = where;
  result.lineBegins_.push_back(0);
  for (std::size_t at = text.find('\n'); at != std::string::npos; at = text.find('\n', at + 1)) {
    result.lineBegins_.push_back(at + 1);
  }
  result.document_ = std::make_unique<pugi::xml_document>();
  const pugi::xml_parse_result parsed =
      result.document_->load_buffer(text.data(), text.size(), pugi::parse_default, pugi::encoding_utf8);
  if (!parsed) {
    const std::size_t offset =
        std::min(static_cast<std::size_t>(std::max<std::ptrdiff_t>(parsed.offset, 0)), text.size());
    const auto line = std::upper_bound(result.lineBegins_.begin(), result.lineBegins_.end(), offset);
    return failure(fmt::format("this is no XML: {}", parsed.description()),
                   fmt::format("{}:{}:{}", where, line - result.lineBegins_.begin(), offset - *std::prev(line) + 1),
                   "check that the address gives the document and not a page about it");
  }
  if (depthOf(result.root()) > limits.depth) {
    return failure(fmt::format("the document's elements lie more than {} deep", limits.depth), where);
  }
  return result;
}

Result<XmlDocument> XmlDocument::parse(std::string_view text, const std::string& where) {
  return parse(std::span(reinterpret_cast<const std::uint8_t*>(text.data()), text.size()), where, Limits{});
}

std::string XmlDocument::placeOf(const pugi::xml_node& node) const {
  const std::ptrdiff_t offset = node.offset_debug();
  if (offset < 0) {
    return where_;
  }
  const auto line = std::upper_bound(lineBegins_.begin(), lineBegins_.end(), static_cast<std::size_t>(offset));
  return fmt::format("{}:{}", where_, line - lineBegins_.begin());
}

std::string_view localName(const pugi::xml_node& node) {
  const std::string_view name = node.name();
  const std::size_t colon = name.rfind(':');
  return colon == std::string_view::npos ? name : name.substr(colon + 1);
}

bool isNamed(const pugi::xml_node& node, std::string_view name) {
  return node.type() == pugi::node_element && equalIgnoringCase(localName(node), name);
}

pugi::xml_node child(const pugi::xml_node& node, std::string_view path) {
  pugi::xml_node found = node;
  while (found && !path.empty()) {
    const std::string_view name = path.substr(0, path.find('/'));
    path.remove_prefix(std::min(name.size() + 1, path.size()));
    found = found.find_child([&](const pugi::xml_node& candidate) { return isNamed(candidate, name); });
  }
  return found;
}

std::vector<pugi::xml_node> children(const pugi::xml_node& node, std::string_view name) {
  std::vector<pugi::xml_node> found;
  for (const pugi::xml_node& candidate : node.children()) {
    if (isNamed(candidate, name)) {
      found.push_back(candidate);
    }
  }
  return found;
}

std::string text(const pugi::xml_node& node) {
  std::string result;
  for (const pugi::xml_node& part : node.children()) {
    if (part.type() == pugi::node_pcdata || part.type() == pugi::node_cdata) {
      result += part.value();
    }
  }
  return std::string(trimmed(result));
}

std::string text(const pugi::xml_node& node, std::string_view path) {
  return text(child(node, path));
}

std::string attribute(const pugi::xml_node& node, std::string_view name) {
  for (const pugi::xml_attribute& candidate : node.attributes()) {
    std::string_view local = candidate.name();
    local.remove_prefix(local.rfind(':') == std::string_view::npos ? 0 : local.rfind(':') + 1);
    if (equalIgnoringCase(local, name)) {
      return std::string(trimmed(candidate.value()));
    }
  }
  return {};
}

}  // namespace meridian::globebrowsing

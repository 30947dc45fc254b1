#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <pugixml.hpp>

#include "host/api/error.h"

namespace meridian::globebrowsing {

/// A document of a map service, read so that no document can do harm: document types are skipped, entities other than
/// XML's own five are left as they stand, and size and depth are limited.
class XmlDocument {
 public:
  struct Limits {
    std::size_t bytes = std::size_t{64} << 20;
    int depth = 100;
  };

  /// `where` is a file or URL, for errors. UTF-8, UTF-16 and UTF-32 are told by their first bytes, other encodings by
  /// the declaration; what claims to be UTF-8 and is not is read as Latin-1.
  /// Errors, with line and column: not XML, no element, too large, too deep.
  [[nodiscard]] static Result<XmlDocument> parse(std::span<const std::uint8_t> bytes, const std::string& where,
                                                 const Limits& limits);
  [[nodiscard]] static Result<XmlDocument> parse(std::span<const std::uint8_t> bytes, const std::string& where) {
    return parse(bytes, where, Limits{});
  }
  [[nodiscard]] static Result<XmlDocument> parse(std::string_view text, const std::string& where);

  [[nodiscard]] pugi::xml_node root() const { return document_->document_element(); }
  /// "WHERE:LINE" of a node.
  [[nodiscard]] std::string placeOf(const pugi::xml_node& node) const;
  [[nodiscard]] const std::string& where() const { return where_; }

 private:
  std::unique_ptr<pugi::xml_document> document_;
  std::vector<std::size_t> lineBegins_;
  std::string where_;
};

// Names are compared without prefix and case: services spell namespaces and names as they like, and GDAL's own
// descriptions exist with ServerUrl and ServerURL.
[[nodiscard]] std::string_view localName(const pugi::xml_node& node);
[[nodiscard]] bool isNamed(const pugi::xml_node& node, std::string_view name);
/// The first child of that name, or a null node; "Capability/Request/GetMap" goes down.
[[nodiscard]] pugi::xml_node child(const pugi::xml_node& node, std::string_view path);
[[nodiscard]] std::vector<pugi::xml_node> children(const pugi::xml_node& node, std::string_view name);
/// Character data of the node itself, trimmed.
[[nodiscard]] std::string text(const pugi::xml_node& node);
[[nodiscard]] std::string text(const pugi::xml_node& node, std::string_view path);
/// Empty where there is none.
[[nodiscard]] std::string attribute(const pugi::xml_node& node, std::string_view name);

}  // namespace meridian::globebrowsing

#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "host/scripting/property_pattern.h"

namespace meridian {
class Property;
class PropertyOwner;
}  // namespace meridian

namespace meridian::scripting {

/// All properties below an owner by URI, rebuilt when the tree's structure has changed. Render thread only.
class PropertyIndex {
 public:
  struct Entry {
    std::string uri;
    Property* property;
  };

  /// `root` must outlive the index.
  explicit PropertyIndex(const PropertyOwner& root) : root_(&root) {}

  /// An owner's properties before those of its children, each in the order of adding. Valid until the tree changes.
  [[nodiscard]] const std::vector<Entry>& entries();
  [[nodiscard]] Property* find(std::string_view uri);
  [[nodiscard]] std::vector<Property*> match(const PropertyPattern& pattern);
  /// Changes when pointers that were given out may have become invalid.
  [[nodiscard]] unsigned structureVersion() const;

 private:
  void refresh();

  const PropertyOwner* root_;
  std::optional<unsigned> version_;
  std::vector<Entry> entries_;
  std::unordered_map<std::string_view, Property*> byUri_;
};

}  // namespace meridian::scripting

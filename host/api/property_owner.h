#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace meridian {

class Property;

/// A node of the property tree: "Scene", "Earth", "Renderable", "Layers", ... Its URI is the chain of identifiers from
/// the root, joined with dots; the root itself has an empty identifier and stands in no URI.
///
/// An owner knows its properties and children but does not own them: they are members of whoever derives from it, or
/// are held beside it. Used on the render thread only.
class PropertyOwner {
 public:
  explicit PropertyOwner(std::string identifier, std::string name = {}, std::string description = {});
  PropertyOwner(const PropertyOwner&) = delete;
  PropertyOwner& operator=(const PropertyOwner&) = delete;
  /// Leaves its parent and lets go of its children.
  virtual ~PropertyOwner();

  [[nodiscard]] const std::string& identifier() const { return identifier_; }
  /// For people; the identifier when none was given.
  [[nodiscard]] const std::string& name() const { return name_.empty() ? identifier_ : name_; }
  [[nodiscard]] const std::string& description() const { return description_; }
  [[nodiscard]] PropertyOwner* parent() const { return parent_; }
  [[nodiscard]] std::string uri() const;

  /// In the order of adding. Identifiers are unique among properties and children: a second one asserts.
  [[nodiscard]] const std::vector<Property*>& properties() const { return properties_; }
  [[nodiscard]] const std::vector<PropertyOwner*>& children() const { return children_; }
  [[nodiscard]] PropertyOwner* child(std::string_view identifier) const;
  [[nodiscard]] Property* property(std::string_view identifier) const;

  /// By URI below this owner: property("Renderable.Layers.ColorLayers.BlueMarble.Enabled").
  [[nodiscard]] Property* propertyAt(std::string_view uri) const;

  void addProperty(Property& property);
  void removeProperty(Property& property);
  void addChild(PropertyOwner& child);
  void removeChild(PropertyOwner& child);
  /// Puts a child at that place among its siblings; used when layers are reordered.
  void moveChild(PropertyOwner& child, std::size_t position);

  [[nodiscard]] const std::vector<std::string>& tags() const { return tags_; }
  void addTag(std::string tag);
  void removeTag(std::string_view tag);

  /// Grows whenever an owner or property below the root of this tree comes or goes: what caches by URI compare.
  [[nodiscard]] unsigned structureVersion() const;

 private:
  void structureChanged();

  std::string identifier_;
  std::string name_;
  std::string description_;
  PropertyOwner* parent_ = nullptr;
  std::vector<Property*> properties_;
  std::vector<PropertyOwner*> children_;
  std::vector<std::string> tags_;
  unsigned structureVersion_ = 0;
};

}  // namespace meridian

#include "host/api/property_owner.h"

#include <algorithm>
#include <cassert>

#include "host/api/property.h"

namespace meridian {

PropertyOwner::PropertyOwner(std::string identifier, std::string name, std::string description)
    : identifier_(std::move(identifier)), name_(std::move(name)), description_(std::move(description)) {}

PropertyOwner::~PropertyOwner() {
  if (parent_ != nullptr) {
    parent_->removeChild(*this);
  }
  for (PropertyOwner* child : children_) {
    child->parent_ = nullptr;
  }
  for (Property* property : properties_) {
    property->owner_ = nullptr;
  }
}

std::string PropertyOwner::uri() const {
  const std::string above = parent_ != nullptr ? parent_->uri() : std::string();
  return above.empty() ? identifier_ : above + '.' + identifier_;
}

PropertyOwner* PropertyOwner::child(std::string_view identifier) const {
  const auto found = std::find_if(children_.begin(), children_.end(),
                                  [&](const PropertyOwner* each) { return each->identifier() == identifier; });
  return found == children_.end() ? nullptr : *found;
}

Property* PropertyOwner::property(std::string_view identifier) const {
  const auto found = std::find_if(properties_.begin(), properties_.end(),
                                  [&](const Property* each) { return each->identifier() == identifier; });
  return found == properties_.end() ? nullptr : *found;
}

Property* PropertyOwner::propertyAt(std::string_view uri) const {
  const std::size_t dot = uri.find('.');
  if (dot == std::string_view::npos) {
    return property(uri);
  }
  const PropertyOwner* below = child(uri.substr(0, dot));
  return below != nullptr ? below->propertyAt(uri.substr(dot + 1)) : nullptr;
}

void PropertyOwner::addProperty(Property& added) {
  assert(property(added.identifier()) == nullptr && child(added.identifier()) == nullptr);
  assert(added.owner_ == nullptr);
  added.owner_ = this;
  properties_.push_back(&added);
  structureChanged();
}

void PropertyOwner::removeProperty(Property& removed) {
  std::erase(properties_, &removed);
  removed.owner_ = nullptr;
  structureChanged();
}

void PropertyOwner::addChild(PropertyOwner& added) {
  assert(child(added.identifier()) == nullptr && property(added.identifier()) == nullptr);
  assert(added.parent_ == nullptr);
  added.parent_ = this;
  children_.push_back(&added);
  structureChanged();
}

void PropertyOwner::removeChild(PropertyOwner& removed) {
  std::erase(children_, &removed);
  removed.parent_ = nullptr;
  structureChanged();
}

void PropertyOwner::moveChild(PropertyOwner& moved, std::size_t position) {
  const auto found = std::find(children_.begin(), children_.end(), &moved);
  assert(found != children_.end());
  children_.erase(found);
  position = std::min(position, children_.size());
  children_.insert(children_.begin() + static_cast<std::ptrdiff_t>(position), &moved);
  structureChanged();
}

void PropertyOwner::addTag(std::string tag) {
  if (std::find(tags_.begin(), tags_.end(), tag) == tags_.end()) {
    tags_.push_back(std::move(tag));
    structureChanged();
  }
}

void PropertyOwner::removeTag(std::string_view tag) {
  std::erase(tags_, tag);
  structureChanged();
}

unsigned PropertyOwner::structureVersion() const {
  return parent_ != nullptr ? parent_->structureVersion() : structureVersion_;
}

void PropertyOwner::structureChanged() {
  ++structureVersion_;
  if (parent_ != nullptr) {
    parent_->structureChanged();
  }
}

}  // namespace meridian

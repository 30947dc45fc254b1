#include "host/scripting/property_index.h"

#include "host/api/property.h"
#include "host/api/property_owner.h"

namespace meridian::scripting {

namespace {

void collect(const PropertyOwner& owner, const std::string& prefix, std::vector<PropertyIndex::Entry>& entries) {
  for (Property* property : owner.properties()) {
    entries.push_back({prefix + property->identifier(), property});
  }
  for (const PropertyOwner* child : owner.children()) {
    collect(*child, prefix + child->identifier() + '.', entries);
  }
}

}  // namespace

const std::vector<PropertyIndex::Entry>& PropertyIndex::entries() {
  refresh();
  return entries_;
}

Property* PropertyIndex::find(std::string_view uri) {
  refresh();
  const auto found = byUri_.find(uri);
  return found == byUri_.end() ? nullptr : found->second;
}

std::vector<Property*> PropertyIndex::match(const PropertyPattern& pattern) {
  std::vector<Property*> matching;
  for (const Entry& entry : entries()) {
    if (pattern.matches(entry.uri, entry.property->owner())) {
      matching.push_back(entry.property);
    }
  }
  return matching;
}

unsigned PropertyIndex::structureVersion() const {
  return root_->structureVersion();
}

void PropertyIndex::refresh() {
  if (version_ == root_->structureVersion()) {
    return;
  }
  version_ = root_->structureVersion();
  byUri_.clear();
  entries_.clear();
  const std::string above = root_->uri();
  collect(*root_, above.empty() ? above : above + '.', entries_);
  for (const Entry& entry : entries_) {
    byUri_.emplace(entry.uri, entry.property);
  }
}

}  // namespace meridian::scripting

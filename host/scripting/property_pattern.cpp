#include "host/scripting/property_pattern.h"

#include <algorithm>

#include <fmt/format.h>

#include "host/api/property.h"
#include "host/api/property_owner.h"

namespace meridian::scripting {

namespace {

constexpr std::string_view operators = "&|~";

bool hasTag(const PropertyOwner& owner, const std::string& tag) {
  return std::find(owner.tags().begin(), owner.tags().end(), tag) != owner.tags().end();
}

std::string trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(' ');
  return first == std::string_view::npos ? std::string()
                                         : std::string(text.substr(first, text.find_last_not_of(' ') - first + 1));
}

}  // namespace

Result<PropertyPattern> PropertyPattern::parse(std::string_view text) {
  const auto bad = [whole = std::string(text)](std::string_view why) {
    return failure(fmt::format("\"{}\" is no pattern of properties: {}", whole, why));
  };
  PropertyPattern pattern;
  if (!text.empty() && text.front() == '{') {
    const std::size_t end = text.find('}');
    if (end == std::string_view::npos) {
      return bad("its tag group is not closed");
    }
    const std::string_view group = text.substr(1, end - 1);
    const std::size_t split = group.find_first_of(operators);
    pattern.operator_ = Operator::One;
    pattern.firstTag_ = trimmed(group.substr(0, split));
    if (split != std::string_view::npos) {
      pattern.operator_ =
          group[split] == '&' ? Operator::And : (group[split] == '|' ? Operator::Or : Operator::Without);
      pattern.secondTag_ = trimmed(group.substr(split + 1));
      if (pattern.secondTag_.find_first_of(operators) != std::string::npos) {
        return bad("a tag group takes two tags at most");
      }
      if (pattern.secondTag_.empty()) {
        return bad("its tag group misses a tag");
      }
    }
    if (pattern.firstTag_.empty()) {
      return bad("its tag group misses a tag");
    }
    text.remove_prefix(end + 1);
    if (text.empty() || text.front() != '.') {
      return bad("a dot and the rest of the name must follow the tag group");
    }
  }
  const bool allOfTagged = pattern.operator_ != Operator::None && text == ".*";
  if (text.find_first_not_of(".*") == std::string_view::npos && !allOfTagged) {
    return bad("it names nothing");
  }
  const std::size_t star = text.find('*');
  pattern.hasWildcard_ = star != std::string_view::npos;
  pattern.before_ = text.substr(0, star);
  if (pattern.hasWildcard_) {
    pattern.after_ = text.substr(star + 1);
    if (pattern.after_.find('*') != std::string::npos) {
      return bad("it has more than one *");
    }
  }
  return pattern;
}

bool PropertyPattern::matches(std::string_view uri, const PropertyOwner* innermost) const {
  return matchesText(uri) && (operator_ == Operator::None || matchesTags(innermost));
}

bool PropertyPattern::matchesText(std::string_view uri) const {
  if (!hasWildcard_) {
    return operator_ == Operator::None ? uri == before_ : uri.ends_with(before_);
  }
  if (after_.empty() && operator_ == Operator::None) {
    return uri.starts_with(before_);
  }
  if (!uri.ends_with(after_)) {
    return false;
  }
  return uri.substr(0, uri.size() - after_.size()).find(before_) != std::string_view::npos;
}

bool PropertyPattern::matchesTags(const PropertyOwner* innermost) const {
  for (const PropertyOwner* owner = innermost; owner != nullptr; owner = owner->parent()) {
    const bool first = hasTag(*owner, firstTag_);
    const bool second = operator_ != Operator::One && hasTag(*owner, secondTag_);
    const bool matches = operator_ == Operator::And       ? first && second
                         : operator_ == Operator::Or      ? first || second
                         : operator_ == Operator::Without ? first && !second
                                                          : first;
    if (matches) {
      return true;
    }
  }
  return false;
}

}  // namespace meridian::scripting

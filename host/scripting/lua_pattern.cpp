#include "host/scripting/lua_pattern.h"

#include <algorithm>
#include <cctype>
#include <string>

namespace meridian::scripting {

namespace {

constexpr std::size_t deepestMatching = 200;

/// The class of a letter after '%', or the character itself. Upper-case letters mean the complement.
std::bitset<256> namedClass(unsigned char letter) {
  int (*test)(int) = nullptr;
  switch (std::tolower(letter)) {
    case 'a':
      test = std::isalpha;
      break;
    case 'c':
      test = std::iscntrl;
      break;
    case 'd':
      test = std::isdigit;
      break;
    case 'g':
      test = std::isgraph;
      break;
    case 'l':
      test = std::islower;
      break;
    case 'p':
      test = std::ispunct;
      break;
    case 's':
      test = std::isspace;
      break;
    case 'u':
      test = std::isupper;
      break;
    case 'w':
      test = std::isalnum;
      break;
    case 'x':
      test = std::isxdigit;
      break;
    default:
      break;
  }
  std::bitset<256> found;
  if (std::tolower(letter) == 'z') {
    // Of Lua 5.1: the zero character.
    found.set(0);
    return letter == 'Z' ? ~found : found;
  }
  if (test == nullptr) {
    found.set(letter);
    return found;
  }
  for (int c = 0; c < 256; ++c) {
    found.set(static_cast<std::size_t>(c), test(c) != 0);
  }
  return std::isupper(letter) != 0 ? ~found : found;
}

}  // namespace

class LuaPattern::Parser {
 public:
  Parser(std::string_view text, LuaPattern& pattern) : text_(text), pattern_(pattern) {}

  Result<void> parse() {
    while (at_ < text_.size()) {
      if (Result<void> parsed = parseItem(); !parsed) {
        return parsed;
      }
      if (depth_ > deepestMatching) {
        return failure("the pattern is too complex");
      }
    }
    if (!open_.empty()) {
      return failure("unfinished capture");
    }
    return {};
  }

 private:
  [[nodiscard]] unsigned char next() { return static_cast<unsigned char>(text_[at_++]); }
  [[nodiscard]] bool nextIs(char c) const { return at_ < text_.size() && text_[at_] == c; }
  void add(const Item& item) { pattern_.items_.push_back(item); }
  void addCapture(Kind kind, std::size_t capture) {
    ++depth_;
    Item item;
    item.kind = kind;
    item.capture = capture;
    add(item);
  }

  Result<void> parseItem() {
    if (nextIs('(')) {
      return parseOpen();
    }
    if (nextIs(')')) {
      ++at_;
      if (open_.empty()) {
        return failure("invalid pattern capture");
      }
      addCapture(Kind::Close, open_.back());
      open_.pop_back();
      return {};
    }
    if (nextIs('$') && at_ + 1 == text_.size()) {
      ++at_;
      Item item;
      item.kind = Kind::EndOfText;
      add(item);
      return {};
    }
    if (nextIs('%') && at_ + 1 < text_.size()) {
      const auto after = static_cast<unsigned char>(text_[at_ + 1]);
      if (after == 'b') {
        return parseBalanced();
      }
      if (after == 'f') {
        return parseFrontier();
      }
      if (std::isdigit(after) != 0) {
        return parseReference(after);
      }
    }
    return parseRepeated();
  }

  Result<void> parseOpen() {
    ++at_;
    if (pattern_.captures_ == mostCaptures) {
      return failure("too many captures");
    }
    const std::size_t capture = pattern_.captures_++;
    if (nextIs(')')) {
      ++at_;
      addCapture(Kind::Position, capture);
    } else {
      addCapture(Kind::Open, capture);
      open_.push_back(capture);
    }
    return {};
  }

  Result<void> parseBalanced() {
    at_ += 2;
    if (text_.size() - at_ < 2) {
      return failure("malformed pattern (missing arguments to '%b')");
    }
    Item item;
    item.kind = Kind::Balanced;
    item.first = next();
    item.last = next();
    add(item);
    return {};
  }

  Result<void> parseFrontier() {
    at_ += 2;
    if (!nextIs('[')) {
      return failure("missing '[' after '%f' in pattern");
    }
    return parseClass().map([&](const Class& characters) {
      Item item;
      item.kind = Kind::Frontier;
      item.characters = characters;
      add(item);
    });
  }

  Result<void> parseReference(unsigned char digit) {
    at_ += 2;
    const auto number = static_cast<std::size_t>(digit - '0');
    const bool open = std::find(open_.begin(), open_.end(), number - 1) != open_.end();
    if (number == 0 || number > pattern_.captures_ || open) {
      return failure("invalid capture index %" + std::to_string(number));
    }
    Item item;
    item.kind = Kind::Reference;
    item.capture = number - 1;
    add(item);
    return {};
  }

  Result<void> parseRepeated() {
    return parseClass().map([&](const Class& characters) {
      Item item;
      item.characters = characters;
      static constexpr std::string_view suffixes = "?*+-";
      static constexpr std::array kinds{Kind::Optional, Kind::Greedy, Kind::GreedyOne, Kind::Lazy};
      const std::size_t suffix = at_ < text_.size() ? suffixes.find(text_[at_]) : std::string_view::npos;
      if (suffix != std::string_view::npos) {
        ++at_;
        ++depth_;
        item.kind = kinds[suffix];
      }
      add(item);
    });
  }

  /// A character, '.', '%x' or '[set]'.
  Result<Class> parseClass() {
    const unsigned char c = next();
    if (c == '.') {
      return Class().set();
    }
    if (c == '%') {
      if (at_ == text_.size()) {
        return failure("malformed pattern (ends with '%')");
      }
      return namedClass(next());
    }
    if (c == '[') {
      return parseSet();
    }
    return Class().set(c);
  }

  Result<Class> parseSet() {
    const bool complement = nextIs('^');
    at_ += complement ? 1 : 0;
    Class found;
    // A ']' in the first place is a character of the set.
    for (bool first = true; first || !nextIs(']'); first = false) {
      if (at_ == text_.size()) {
        return failure("malformed pattern (missing ']')");
      }
      const unsigned char c = next();
      if (c == '%') {
        if (at_ == text_.size()) {
          return failure("malformed pattern (missing ']')");
        }
        found |= namedClass(next());
      } else if (nextIs('-') && at_ + 1 < text_.size() && text_[at_ + 1] != ']') {
        ++at_;
        const unsigned char last = next();
        for (std::size_t each = c; each <= last; ++each) {
          found.set(each);
        }
      } else {
        found.set(c);
      }
    }
    ++at_;
    return complement ? ~found : found;
  }

  std::string_view text_;
  LuaPattern& pattern_;
  std::size_t at_ = 0;
  std::size_t depth_ = 0;
  std::vector<std::size_t> open_;
};

/// Goes through the items, calling itself where there is a choice: as deep as there are choices in the pattern.
class LuaPattern::Matcher {
 public:
  Matcher(const std::vector<Item>& items, std::string_view text, std::int64_t& steps, Match& match)
      : items_(items), text_(text), steps_(steps), match_(match) {}

  /// Whether the items from `item` on match the text from `at` on; then match_.end is set.
  bool run(std::size_t item, std::size_t at) {
    for (; item < items_.size(); ++item) {
      if (!spend(1)) {
        return false;
      }
      const Item& each = items_[item];
      switch (each.kind) {
        case Kind::One:
          if (!isIn(each.characters, at)) {
            return false;
          }
          ++at;
          break;
        case Kind::Optional:
          if (isIn(each.characters, at) && run(item + 1, at + 1)) {
            return true;
          }
          break;
        case Kind::Greedy:
        case Kind::GreedyOne:
          return runGreedy(item, at);
        case Kind::Lazy:
          return runLazy(item, at);
        case Kind::Balanced:
          if (!skipBalanced(each, at)) {
            return false;
          }
          break;
        case Kind::Frontier:
          if (each.characters[before(at)] || !each.characters[here(at)]) {
            return false;
          }
          break;
        case Kind::Reference:
          if (!skipReference(match_.captures[each.capture], at)) {
            return false;
          }
          break;
        case Kind::Open:
        case Kind::Position:
        case Kind::Close:
          return runCapture(item, at);
        case Kind::EndOfText:
          if (at != text_.size()) {
            return false;
          }
          break;
      }
    }
    match_.end = at;
    return true;
  }

 private:
  bool spend(std::size_t steps) {
    steps_ -= static_cast<std::int64_t>(steps);
    return steps_ >= 0;
  }
  [[nodiscard]] bool isIn(const Class& characters, std::size_t at) const {
    return at < text_.size() && characters[static_cast<unsigned char>(text_[at])];
  }
  /// The character there; beyond the ends it is '\0'.
  [[nodiscard]] std::size_t here(std::size_t at) const {
    return at < text_.size() ? static_cast<unsigned char>(text_[at]) : 0;
  }
  [[nodiscard]] std::size_t before(std::size_t at) const { return at > 0 ? here(at - 1) : 0; }

  bool runGreedy(std::size_t item, std::size_t at) {
    const Item& each = items_[item];
    std::size_t count = 0;
    while (isIn(each.characters, at + count)) {
      ++count;
    }
    const std::size_t least = each.kind == Kind::GreedyOne ? 1 : 0;
    if (!spend(count)) {
      return false;
    }
    for (++count; count-- > least;) {
      if (run(item + 1, at + count)) {
        return true;
      }
      if (!spend(1)) {
        return false;
      }
    }
    return false;
  }

  bool runLazy(std::size_t item, std::size_t at) {
    while (!run(item + 1, at)) {
      if (!spend(1) || !isIn(items_[item].characters, at)) {
        return false;
      }
      ++at;
    }
    return true;
  }

  /// A capture that turned out wrong is put back as it was.
  bool runCapture(std::size_t item, std::size_t at) {
    const Item& each = items_[item];
    Capture& capture = match_.captures[each.capture];
    const Capture kept = capture;
    if (each.kind == Kind::Close) {
      capture.length = at - capture.begin;
    } else {
      capture = {at, 0, each.kind == Kind::Position};
    }
    if (run(item + 1, at)) {
      return true;
    }
    capture = kept;
    return false;
  }

  bool skipBalanced(const Item& each, std::size_t& at) {
    if (here(at) != each.first || at >= text_.size()) {
      return false;
    }
    std::size_t depth = 1;
    for (std::size_t i = at + 1; i < text_.size(); ++i) {
      const auto c = static_cast<unsigned char>(text_[i]);
      if (c == each.last) {
        if (--depth == 0) {
          const bool mayGoOn = spend(i - at);
          at = i + 1;
          return mayGoOn;
        }
      } else if (c == each.first) {
        ++depth;
      }
    }
    (void)spend(text_.size() - at);
    return false;
  }

  bool skipReference(const Capture& capture, std::size_t& at) {
    if (capture.isPosition) {
      return false;
    }
    const std::string_view wanted = text_.substr(capture.begin, capture.length);
    if (!spend(wanted.size()) || text_.substr(at, wanted.size()) != wanted) {
      return false;
    }
    at += wanted.size();
    return true;
  }

  const std::vector<Item>& items_;
  std::string_view text_;
  std::int64_t& steps_;
  Match& match_;
};

Result<LuaPattern> LuaPattern::compile(std::string_view pattern, bool mayBeAnchored) {
  LuaPattern compiled;
  compiled.anchored_ = mayBeAnchored && pattern.starts_with('^');
  pattern.remove_prefix(compiled.anchored_ ? 1 : 0);
  return Parser(pattern, compiled).parse().map([&] { return std::move(compiled); });
}

Result<LuaPattern> LuaPattern::compile(std::string_view pattern) {
  return compile(pattern, true);
}

Result<LuaPattern> LuaPattern::compileUnanchored(std::string_view pattern) {
  return compile(pattern, false);
}

LuaPattern::Outcome LuaPattern::matchAt(std::string_view text, std::size_t place, std::int64_t& steps,
                                        Match& match) const {
  match.begin = place;
  match.count = captures_;
  if (Matcher(items_, text, steps, match).run(0, place)) {
    return Outcome::Matched;
  }
  return steps < 0 ? Outcome::OutOfSteps : Outcome::None;
}

LuaPattern::Outcome LuaPattern::search(std::string_view text, std::size_t place, std::int64_t& steps,
                                       Match& match) const {
  for (; place <= text.size(); ++place) {
    const Outcome outcome = matchAt(text, place, steps, match);
    if (outcome != Outcome::None || anchored_) {
      return outcome;
    }
  }
  return Outcome::None;
}

}  // namespace meridian::scripting

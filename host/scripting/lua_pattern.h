#pragma once

#include <array>
#include <bitset>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "host/api/error.h"

namespace meridian::scripting {

/// A pattern of Lua's string library (Lua 5.4 reference manual, 6.4.1), whose matching ends after so many steps: Lua's
/// own matcher backtracks in C, where no hook counts, and needs n^k steps for k repetitions over n characters.
class LuaPattern {
 public:
  static constexpr std::size_t mostCaptures = 32;

  struct Capture {
    std::size_t begin = 0;
    std::size_t length = 0;   ///< of a position capture: 0
    bool isPosition = false;  ///< "()": the place itself
  };
  struct Match {
    std::size_t begin = 0;
    std::size_t end = 0;
    std::array<Capture, mostCaptures> captures{};
    std::size_t count = 0;
  };
  enum class Outcome { Matched, None, OutOfSteps };

  /// Errors: what the manual calls malformed; more than 32 captures; more than 200 repetitions and captures together,
  /// for so deep goes the matcher.
  [[nodiscard]] static Result<LuaPattern> compile(std::string_view pattern);

  /// Whether it begins with '^' (which gmatch takes literally: compile its pattern by compileUnanchored).
  [[nodiscard]] bool isAnchored() const { return anchored_; }
  [[nodiscard]] static Result<LuaPattern> compileUnanchored(std::string_view pattern);

  /// At exactly that place. Takes what it needs from `steps`, and gives up when they are less than none.
  [[nodiscard]] Outcome matchAt(std::string_view text, std::size_t place, std::int64_t& steps, Match& match) const;
  /// At the first place from `place` on where it matches; only at `place` when anchored.
  [[nodiscard]] Outcome search(std::string_view text, std::size_t place, std::int64_t& steps, Match& match) const;

 private:
  using Class = std::bitset<256>;
  enum class Kind {
    One,        ///< a character of the class
    Optional,   ///< one or none, rather one
    Greedy,     ///< any number, rather many
    GreedyOne,  ///< at least one, rather many
    Lazy,       ///< any number, rather few
    Balanced,   ///< %bxy
    Frontier,   ///< %f[set]
    Reference,  ///< %1 ... %9
    Open,       ///< (
    Position,   ///< ()
    Close,      ///< )
    EndOfText   ///< $
  };
  struct Item {
    Kind kind = Kind::One;
    Class characters{};
    unsigned char first = 0;  ///< of Balanced
    unsigned char last = 0;
    std::size_t capture = 0;  ///< of Reference, Open, Position and Close
  };
  class Parser;
  class Matcher;

  static Result<LuaPattern> compile(std::string_view pattern, bool mayBeAnchored);

  std::vector<Item> items_;
  std::size_t captures_ = 0;
  bool anchored_ = false;
};

}  // namespace meridian::scripting

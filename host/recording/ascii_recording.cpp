#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "host/recording/formats.h"

namespace meridian::recording {

namespace {

constexpr std::string_view blanks = " \t\r";

/// Lines of a text, with their numbers; line ends and carriage returns taken off.
class Lines {
 public:
  explicit Lines(std::string_view text) : rest_(text) {}
  [[nodiscard]] std::optional<std::string_view> next() {
    if (rest_.empty()) {
      return std::nullopt;
    }
    const std::size_t end = rest_.find('\n');
    std::string_view line = rest_.substr(0, end);
    rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
    while (line.ends_with('\r')) {
      line.remove_suffix(1);
    }
    ++number_;
    return line;
  }
  [[nodiscard]] std::size_t number() const { return number_; }

 private:
  std::string_view rest_;
  std::size_t number_ = 1;  ///< the header was line 1
};

/// Words of a line; remembers the first thing that was wrong.
class Words {
 public:
  explicit Words(std::string_view line) : rest_(line) {}

  std::string_view word() {
    rest_.remove_prefix(std::min(rest_.find_first_not_of(blanks), rest_.size()));
    const std::size_t end = std::min(rest_.find_first_of(blanks), rest_.size());
    const std::string_view found = rest_.substr(0, end);
    rest_.remove_prefix(end);
    return found;
  }

  double number(std::string_view name) {
    const std::string_view found = word();
    double value = 0.0;
    const auto [end, error] = std::from_chars(found.data(), found.data() + found.size(), value);
    if (error != std::errc() || end != found.data() + found.size() || !std::isfinite(value)) {
      expect("a finite number (" + std::string(name) + ")", found);
    }
    return value;
  }

  /// One of two letters: whether it is the first.
  bool either(std::string_view first, std::string_view second) {
    const std::string_view found = word();
    if (found != first && found != second) {
      expect("'" + std::string(first) + "' or '" + std::string(second) + "'", found);
    }
    return found == first;
  }

  [[nodiscard]] std::string_view rest() {
    rest_.remove_prefix(std::min(rest_.find_first_not_of(blanks), rest_.size()));
    return rest_;
  }

  void expect(const std::string& what, std::string_view found) {
    if (trouble_.empty()) {
      constexpr std::size_t shown = 60;
      trouble_ =
          "expected " + what +
          (found.empty() ? ", found the end of the line" : ", found '" + std::string(found.substr(0, shown)) + "'");
    }
  }
  [[nodiscard]] const std::string& trouble() const { return trouble_; }

 private:
  std::string_view rest_;
  std::string trouble_;
};

class AsciiReader {
 public:
  AsciiReader(std::string_view body, int version, std::string_view where)
      : lines_(body), version_(version), where_(where) {}

  Result<SessionRecording> read() {
    while (const auto line = lines_.next()) {
      Words words(*line);
      const std::string_view kind = words.word();
      if (kind.empty() || kind.starts_with('#')) {
        continue;
      }
      const std::size_t number = lines_.number();
      if (kind == "camera") {
        readCamera(words);
      } else if (kind == "script") {
        readScript(words);
      } else if (kind == "time") {
        readTime(words);
      } else {
        words.expect("'camera', 'script' or 'time'", kind);
      }
      if (!words.trouble().empty()) {
        return failure(words.trouble(), std::string(where_) + ":" + std::to_string(number),
                       "correct the line, or take it out");
      }
    }
    return std::move(recording_);
  }

 private:
  double timestamp(Words& words) {
    if (version_ < 2) {
      static_cast<void>(words.number("the application's time"));
    }
    const double stamp = words.number("the time stamp");
    if (stamp < last_) {
      words.expect(fmt::format("a time stamp of at least {}, the line before's", last_), fmt::format("{}", stamp));
    }
    last_ = std::max(last_, stamp);
    return stamp;
  }

  void readCamera(Words& words) {
    CameraEntry entry;
    entry.line = lines_.number();
    entry.timestamp = timestamp(words);
    entry.simulationTime = Time(words.number("the simulation time"));
    entry.position.x = words.number("position x");
    entry.position.y = words.number("position y");
    entry.position.z = words.number("position z");
    if (version_ >= 3) {
      entry.rotation.w = words.number("rotation w");
    }
    entry.rotation.x = words.number("rotation x");
    entry.rotation.y = words.number("rotation y");
    entry.rotation.z = words.number("rotation z");
    if (version_ < 3) {
      entry.rotation.w = words.number("rotation w");
    }
    entry.scale = words.number("the scale");
    entry.followsRotation = words.either("F", "-");
    entry.node = words.word();
    if (entry.node.empty()) {
      words.expect("the identifier of a node", {});
    }
    if (!words.rest().empty()) {
      words.expect("the end of the line", words.rest());
    }
    if (words.trouble().empty()) {
      if (const auto valid = checkCamera(entry); !valid) {
        words.expect("a camera that can be used", valid.error().what);
        return;
      }
      recording_.entries.emplace_back(std::move(entry));
    }
  }

  void readScript(Words& words) {
    ScriptEntry entry;
    entry.line = lines_.number();
    entry.timestamp = timestamp(words);
    entry.simulationTime = Time(words.number("the simulation time"));
    const double count = words.number("the number of lines");
    if (words.trouble().empty() && (count < 1.0 || count != std::floor(count))) {
      words.expect("a number of lines of at least 1", fmt::format("{}", count));
    }
    if (!words.trouble().empty()) {
      return;
    }
    entry.text = words.rest();
    for (std::size_t read = 1; static_cast<double>(read) < count; ++read) {
      const auto line = lines_.next();
      if (!line) {
        words.expect(fmt::format("a script of {} lines", count), fmt::format("the end of the file after {}", read));
        return;
      }
      entry.text += '\n';
      entry.text += line->substr(std::min(line->find_first_not_of(blanks), line->size()));
    }
    recording_.entries.emplace_back(std::move(entry));
  }

  void readTime(Words& words) {
    const double stamp = timestamp(words);
    const double simulation = words.number("the simulation time");
    const double delta = words.number("the delta time");
    const bool paused = words.either("P", "R");
    const bool jump = words.either("J", "-");
    if (words.trouble().empty()) {
      ScriptEntry entry = timeScript(stamp, simulation, delta, paused, jump);
      entry.line = lines_.number();
      recording_.entries.emplace_back(std::move(entry));
    }
  }

  Lines lines_;
  int version_;
  std::string_view where_;
  double last_ = 0.0;
  SessionRecording recording_;
};

std::string format(const CameraEntry& entry) {
  const glm::dvec3& p = entry.position;
  const glm::dquat& q = entry.rotation;
  // OpenSpace keeps rotations as floats, but nothing keeps a reader from taking doubles.
  return fmt::format("camera {} {} {} {} {} {} {} {} {} {} {} {}\n", entry.timestamp, entry.simulationTime.tdbSeconds(),
                     p.x, p.y, p.z, q.w, q.x, q.y, q.z, entry.scale, entry.followsRotation ? 'F' : '-', entry.node);
}

std::string format(const ScriptEntry& entry) {
  std::string text = entry.text;
  std::erase(text, '\r');
  while (text.ends_with('\n')) {
    text.pop_back();
  }
  // Joining lines by ';' would end up inside a comment or a long string.
  const bool joinable = text.find("--") == std::string::npos && text.find("[[") == std::string::npos &&
                        text.find("[=") == std::string::npos && text.find("\\\n") == std::string::npos;
  std::ptrdiff_t lines = 1;
  if (joinable) {
    std::replace(text.begin(), text.end(), '\n', ' ');
  } else {
    lines += std::count(text.begin(), text.end(), '\n');
  }
  return fmt::format("script {} {} {} {}\n", entry.timestamp, entry.simulationTime.tdbSeconds(), lines, text);
}

}  // namespace

Result<SessionRecording> parseAsciiBody(std::string_view body, int version, std::string_view where) {
  return AsciiReader(body, version, where).read();
}

std::string formatEntry(const SessionRecording::Entry& entry) {
  return std::visit([](const auto& each) { return format(each); }, entry);
}

}  // namespace meridian::recording

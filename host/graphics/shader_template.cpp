#include "host/graphics/shader_template.h"

#include <algorithm>
#include <charconv>
#include <fstream>
#include <iterator>
#include <optional>
#include <system_error>

#include <fmt/format.h>

namespace meridian::graphics {

namespace {

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) {
    return {};
  }
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

/// Cuts the first line off `text`.
std::string_view takeLine(std::string_view& text) {
  const auto end = text.find('\n');
  const std::string_view line = text.substr(0, end);
  text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  return line;
}

/// One shader being put together.
class Expansion {
 public:
  Expansion(const std::filesystem::path& folder, const Substitutions& substitutions)
      : folder_(folder), substitutions_(substitutions) {}

  Result<std::string> read(std::string_view name, const std::string& where) const;
  Result<void> append(std::string_view text, std::string name);
  [[nodiscard]] ShaderSource& source() { return source_; }

 private:
  Result<void> appendLine(std::string_view line, std::size_t file, std::size_t number);
  Result<void> appendInclude(std::string_view directive, std::size_t file, std::size_t number);
  [[nodiscard]] Result<std::string> substituted(std::string_view line, const std::string& where) const;
  /// The only `#{name}` of a line that holds nothing else.
  [[nodiscard]] static std::optional<std::string_view> loneName(std::string_view line);
  /// Appends the lines of `text`: from that place on when `counting`, else all from it.
  void emit(std::string_view text, std::size_t file, std::size_t number, bool counting);
  [[nodiscard]] std::string place(std::size_t file, std::size_t number) const {
    return fmt::format("{}:{}", source_.files[file], number);
  }

  const std::filesystem::path& folder_;
  const Substitutions& substitutions_;
  ShaderSource source_;
};

Result<std::string> Expansion::read(std::string_view name, const std::string& where) const {
  const std::filesystem::path relative = std::filesystem::path(name).lexically_normal();
  if (relative.empty() || relative.is_absolute() || *relative.begin() == "..") {
    return failure(fmt::format("\"{}\" is not below the shader folder", name), where,
                   "name the file from the shader folder: room/file.glsl");
  }
  const std::filesystem::path path = folder_ / relative;
  std::error_code error;
  std::ifstream stream;
  if (std::filesystem::is_regular_file(path, error)) {
    stream.open(path, std::ios::binary);
  }
  if (!stream.is_open()) {
    return failure(fmt::format("there is no shader file {}", path.string()), where);
  }
  return std::string(std::istreambuf_iterator<char>(stream), {});
}

std::optional<std::string_view> Expansion::loneName(std::string_view line) {
  const std::string_view words = trimmed(line);
  if (words.starts_with("#{") && words.find('}') == words.size() - 1) {
    return words.substr(2, words.size() - 3);
  }
  return std::nullopt;
}

Result<std::string> Expansion::substituted(std::string_view line, const std::string& where) const {
  std::string text;
  for (;;) {
    const auto start = line.find("#{");
    text += line.substr(0, start);
    if (start == std::string_view::npos) {
      return text;
    }
    const auto end = line.find('}', start);
    if (end == std::string_view::npos) {
      return failure("a #{ is not closed on its line", where, "write #{name}");
    }
    const std::string_view name = line.substr(start + 2, end - start - 2);
    const auto found = substitutions_.find(name);
    if (found == substitutions_.end()) {
      return failure(fmt::format("nothing is given for #{{{}}}", name), where);
    }
    text += found->second;
    line.remove_prefix(end + 1);
  }
}

void Expansion::emit(std::string_view text, std::size_t file, std::size_t number, bool counting) {
  do {
    source_.text += takeLine(text);
    source_.text += '\n';
    source_.origins.push_back({static_cast<std::uint32_t>(file), static_cast<std::uint32_t>(number)});
    number += counting ? 1 : 0;
  } while (!text.empty());
}

Result<void> Expansion::appendInclude(std::string_view directive, std::size_t file, std::size_t number) {
  const std::string_view rest = trimmed(directive.substr(std::string_view("#include").size()));
  if (rest.size() < 3 || rest.front() != '"' || rest.find('"', 1) != rest.size() - 1) {
    return failure("an include needs a file name in quotes", place(file, number), "write #include \"room/file.glsl\"");
  }
  std::string name(rest.substr(1, rest.size() - 2));
  if (std::ranges::find(source_.files, name) != source_.files.end()) {
    return {};
  }
  auto text = read(name, place(file, number));
  if (!text) {
    return tl::make_unexpected(std::move(text.error()));
  }
  return append(*text, std::move(name));
}

Result<void> Expansion::appendLine(std::string_view line, std::size_t file, std::size_t number) {
  const std::string where = place(file, number);
  auto text = substituted(line, where);
  if (!text) {
    return tl::make_unexpected(std::move(text.error()));
  }
  const auto lone = loneName(line);
  if (lone && text->find('\n') != std::string::npos) {
    source_.files.push_back(fmt::format("#{{{}}} in {}", *lone, source_.files[file]));
    emit(*text, source_.files.size() - 1, 1, true);
    return {};
  }
  if (!lone && trimmed(*text).starts_with("#include")) {
    return appendInclude(trimmed(*text), file, number);
  }
  emit(*text, file, number, false);
  return {};
}

Result<void> Expansion::append(std::string_view text, std::string name) {
  const std::size_t file = source_.files.size();
  source_.files.push_back(std::move(name));
  for (std::size_t number = 1; !text.empty(); ++number) {
    std::string_view line = takeLine(text);
    if (line.ends_with('\r')) {
      line.remove_suffix(1);
    }
    if (auto done = appendLine(line, file, number); !done) {
      return done;
    }
  }
  return {};
}

/// Where a line of a compiler's log points.
struct LogPlace {
  std::size_t source = 0;
  std::size_t line = 0;
  std::string_view rest;  ///< after the place
};

bool takeNumber(std::string_view& text, std::size_t& number) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc{}) {
    return false;
  }
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  return true;
}

bool takeCharacter(std::string_view& text, char character) {
  if (!text.starts_with(character)) {
    return false;
  }
  text.remove_prefix(1);
  return true;
}

/// Mesa writes "0:12(5): error: ...", NVIDIA "0(12) : error ...", others "ERROR: 0:12: ...".
std::optional<LogPlace> logPlace(std::string_view line) {
  for (const std::string_view prefix : {"ERROR: ", "WARNING: "}) {
    if (line.starts_with(prefix)) {
      line.remove_prefix(prefix.size());
    }
  }
  LogPlace place;
  if (!takeNumber(line, place.source)) {
    return std::nullopt;
  }
  if (takeCharacter(line, ':')) {
    if (!takeNumber(line, place.line)) {
      return std::nullopt;
    }
    std::size_t column = 0;
    if (takeCharacter(line, '(') && (!takeNumber(line, column) || !takeCharacter(line, ')'))) {
      return std::nullopt;
    }
  } else if (!takeCharacter(line, '(') || !takeNumber(line, place.line) || !takeCharacter(line, ')')) {
    return std::nullopt;
  }
  place.rest = line;
  return place;
}

}  // namespace

std::string ShaderSource::place(std::size_t line) const {
  if (line >= 1 && line <= origins.size()) {
    const Origin& origin = origins[line - 1];
    return fmt::format("{}:{}", files[origin.file], origin.line);
  }
  return fmt::format("{}:{}", files.empty() ? "shader" : files.front(), line);
}

std::string ShaderSource::readableLog(std::string_view log) const {
  std::string readable;
  while (!log.empty()) {
    const std::string_view line = takeLine(log);
    const auto found = logPlace(line);
    readable += found ? fmt::format("{}{}\n", place(found->line), found->rest) : fmt::format("{}\n", line);
  }
  return readable;
}

std::string ShaderSource::firstPlace(std::string_view log) const {
  while (!log.empty()) {
    if (const auto found = logPlace(takeLine(log))) {
      return place(found->line);
    }
  }
  return files.empty() ? std::string() : files.front();
}

Result<ShaderSource> ShaderTemplates::load(std::string_view name, const Substitutions& substitutions) const {
  auto text = Expansion(folder_, substitutions).read(name, std::string(name));
  if (!text) {
    return tl::make_unexpected(std::move(text.error()));
  }
  return expand(*text, name, substitutions);
}

Result<ShaderSource> ShaderTemplates::expand(std::string_view text, std::string_view name,
                                             const Substitutions& substitutions) const {
  if (!text.starts_with("#version")) {
    return failure("a shader begins with #version", fmt::format("{}:1", name), "make #version 450 core its first line");
  }
  Expansion expansion(folder_, substitutions);
  if (auto done = expansion.append(text, std::string(name)); !done) {
    return tl::make_unexpected(std::move(done.error()));
  }
  return std::move(expansion.source());
}

}  // namespace meridian::graphics

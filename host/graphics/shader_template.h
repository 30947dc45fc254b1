#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "host/api/error.h"

namespace meridian::graphics {

/// GLSL ready for the compiler, and where each of its lines came from.
///
/// The origin is kept here rather than in `#line` directives, because Mesa's compiler reports many errors with source
/// number 0, whatever the directive said.
struct ShaderSource {
  struct Origin {
    std::uint32_t file;  ///< in `files`
    std::uint32_t line;  ///< from 1
  };

  std::string text;
  std::vector<std::string> files;  ///< "surface/chunk.vert", "#{layers} in surface/chunk.frag"
  std::vector<Origin> origins{};   ///< of each line of the text; lines beyond it are the first file's

  /// A compiler's log with "0:12(5)" and "0(12)" and "ERROR: 0:12:" turned into "surface/chunk.vert:12".
  [[nodiscard]] std::string readableLog(std::string_view log) const;
  /// "surface/chunk.vert:12" of the first message in a compiler's log; the first file when it names no line.
  [[nodiscard]] std::string firstPlace(std::string_view log) const;

 private:
  [[nodiscard]] std::string place(std::size_t line) const;
};

/// What `#{name}` stands for.
using Substitutions = std::map<std::string, std::string, std::less<>>;

/// Reads the templates below one folder (Paths::shaders).
///
/// - `#{name}` is replaced by the substitution of that name, anywhere in a line, also in an include's name. Text put
///   in is not looked through again. On a line of its own it may be many lines, which then count as a file of their own
///   in messages.
/// - `#include "room/file.glsl"`, on a line of its own, is replaced by that file, named from the folder; each file at
///   most once in a shader, so that a file may include what it needs.
/// - The first line of a shader must be its `#version`.
///
/// Safe to use from several threads; keeps nothing between calls.
class ShaderTemplates {
 public:
  explicit ShaderTemplates(std::filesystem::path folder) : folder_(std::move(folder)) {}

  /// Errors, each with template file and line: no such file, a name that leaves the folder, an unknown substitution.
  [[nodiscard]] Result<ShaderSource> load(std::string_view name, const Substitutions& substitutions = {}) const;
  /// The same for a template that is no file; `name` is what messages call it.
  [[nodiscard]] Result<ShaderSource> expand(std::string_view text, std::string_view name,
                                            const Substitutions& substitutions = {}) const;

  [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }

 private:
  std::filesystem::path folder_;
};

}  // namespace meridian::graphics

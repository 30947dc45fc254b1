#include "host/assets/path_tokens.h"

#include <algorithm>
#include <array>
#include <utility>

#include <fmt/format.h>

namespace meridian::assets {

namespace fs = std::filesystem;

namespace {

constexpr std::array<std::string_view, 3> writableTokens{"SYNC", "CACHE", "TEMPORARY"};

std::string_view bare(std::string_view name) {
  if (name.starts_with("${") && name.ends_with("}")) {
    name = name.substr(2, name.size() - 3);
  }
  return name;
}

/// With symbolic links resolved as far as the path exists; empty if it cannot be resolved (a loop of links).
fs::path resolved(const fs::path& path) {
  std::error_code error;
  fs::path out = fs::weakly_canonical(path, error);
  return error ? fs::path() : out.lexically_normal();
}

}  // namespace

bool isBelow(const fs::path& path, const fs::path& folder) {
  auto [inFolder, inPath] = std::mismatch(folder.begin(), folder.end(), path.begin(), path.end());
  // A folder written with a slash at its end has an empty last part.
  return inFolder == folder.end() || (inFolder->empty() && std::next(inFolder) == folder.end());
}

PathTokens::PathTokens(const Paths& paths) {
  set("ASSETS", paths.assets);
  set("SYNC", paths.sync);
  set("CACHE", paths.cache);
  set("TEMPORARY", paths.temporary);
  set("DATA", paths.data);
  set("SYNC_DYNAMIC", paths.sync / "dynamically_downloaded");
  for (const auto& [token, folder] : {std::pair{"SCRIPTS", "scripts"},
                                      {"PROFILES", "profiles"},
                                      {"FONTS", "fonts"},
                                      {"TASKS", "tasks"},
                                      {"WEB", "web"},
                                      {"CONFIG", "config"},
                                      {"DOCUMENTATION", "documentation"},
                                      {"MODULES", "modules"},
                                      {"GLOBEBROWSING", "globebrowsing"},
                                      {"USER", "user"},
                                      {"USER_ASSETS", "user/assets"},
                                      {"USER_CONFIG", "user/config"},
                                      {"USER_PROFILES", "user/profiles"},
                                      {"USER_SCRIPTS", "user/scripts"},
                                      {"USER_SHOWCOMPOSER", "user/showcomposer"},
                                      {"USER_SHOWCOMPOSER_UPLOADS", "user/showcomposer/uploads"},
                                      {"USER_SHOWCOMPOSER_PROJECTS", "user/showcomposer/projects"},
                                      {"USER_WEBPANELS", "user/webpanels"},
                                      {"SCREENSHOTS", "user/screenshots"}}) {
    set(token, paths.data / folder);
  }
  set("RECORDINGS", paths.sync / "recordings");  // scripts write them
  set("SHADERS", paths.shaders);
  set("LOGS", paths.temporary / "logs");
  // May lie elsewhere: a link to what was prepared in a cache that cannot be written.
  allowReading(paths.cache / "data");
}

void PathTokens::set(std::string_view name, const fs::path& folder) {
  folders_.insert_or_assign(std::string(bare(name)), folder.lexically_normal());
}

const fs::path* PathTokens::find(std::string_view name) const {
  const auto found = folders_.find(bare(name));
  return found == folders_.end() ? nullptr : &found->second;
}

Result<fs::path> PathTokens::expand(std::string_view text) const {
  if (!text.starts_with("${")) {
    return fs::path(text).lexically_normal();
  }
  const std::size_t end = text.find('}');
  if (end == std::string_view::npos) {
    return failure(fmt::format("the path token in \"{}\" is not closed", text));
  }
  const fs::path* folder = find(text.substr(0, end + 1));
  if (folder == nullptr) {
    return failure(fmt::format("unknown path token {}", text.substr(0, end + 1)));
  }
  text.remove_prefix(end + 1);
  while (text.starts_with('/')) {
    text.remove_prefix(1);
  }
  return (*folder / fs::path(text)).lexically_normal();
}

void PathTokens::allowReading(const fs::path& folder) {
  const fs::path added = resolved(folder);
  if (!added.empty() && std::find(readable_.begin(), readable_.end(), added) == readable_.end()) {
    readable_.push_back(added);
  }
}

Result<fs::path> PathTokens::readable(const fs::path& path) const {
  const fs::path real = resolved(path);
  const auto holds = [&](const fs::path& folder) { return !folder.empty() && isBelow(real, folder); };
  const bool allowed = !real.empty() && (std::any_of(readable_.begin(), readable_.end(), holds) ||
                                         std::any_of(folders_.begin(), folders_.end(),
                                                     [&](const auto& each) { return holds(resolved(each.second)); }));
  if (!allowed) {
    return failure("scripts may not read there", path.string(),
                   "keep it below an asset's folder or a path token such as ${ASSETS}");
  }
  return real;
}

Result<fs::path> PathTokens::writable(const fs::path& path) const {
  const fs::path real = resolved(path);
  const bool allowed = !real.empty() && std::any_of(writableTokens.begin(), writableTokens.end(), [&](auto name) {
    const fs::path* folder = find(name);
    const fs::path place = folder != nullptr ? resolved(*folder) : fs::path();
    return !place.empty() && isBelow(real, place) && real != place;
  });
  if (!allowed) {
    return failure("scripts may not write there", path.string(), "write below ${SYNC}, ${CACHE} or ${TEMPORARY}");
  }
  return real;
}

}  // namespace meridian::assets

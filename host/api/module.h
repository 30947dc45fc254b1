#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "host/api/error.h"
#include "host/api/panel.h"
#include "host/api/property_owner.h"
#include "host/api/renderable.h"
#include "host/api/script_library.h"
#include "host/api/statistics.h"

namespace meridian {

/// Where things are on this machine. All absolute.
struct Paths {
  std::filesystem::path data;  ///< assets, flights, small rasters: data/ of the source or of the install tree
  std::filesystem::path shaders;
  std::filesystem::path assets;     ///< ${ASSETS}
  std::filesystem::path cache;      ///< ${CACHE}
  std::filesystem::path sync;       ///< ${SYNC}
  std::filesystem::path temporary;  ///< ${TEMPORARY}
};

/// What a module may ask of the host. Outlives every module.
class Host {
 public:
  virtual ~Host() = default;
  virtual void registerRenderable(std::string type, RenderableFactory factory) = 0;
  virtual void registerScriptLibrary(ScriptLibrary library) = 0;
  virtual void registerPanel(std::unique_ptr<Panel> panel) = 0;
  [[nodiscard]] virtual const Paths& paths() const = 0;
  [[nodiscard]] virtual Statistics& statistics() = 0;
  /// The renderable of the scene-graph node of that identifier; null without such a node or renderable.
  [[nodiscard]] virtual Renderable* renderable(std::string_view node) = 0;
  /// Identifiers of all nodes, in the order of adding.
  [[nodiscard]] virtual std::vector<std::string> nodes() const = 0;

  /// The folder that a path token stands for, by its name with or without "${" and "}"; nothing for an unknown one.
  [[nodiscard]] virtual std::optional<std::filesystem::path> pathToken(std::string_view name) const = 0;

  // For script functions, while one runs.
  /// Where the script stands that calls: "FILE:LINE" for messages, and the folder that relative paths begin at.
  struct ScriptPlace {
    std::string where;
    std::string folder;
    bool isAsset = false;  ///< it is an asset's code
  };
  [[nodiscard]] virtual ScriptPlace scriptPlace() const = 0;
  /// The whole path, tokens replaced. Errors: unknown tokens; where scripts may not read.
  [[nodiscard]] virtual Result<std::filesystem::path> readablePath(std::string_view path) const = 0;
  /// Likewise where scripts may write.
  [[nodiscard]] virtual Result<std::filesystem::path> writablePath(std::string_view path) const = 0;
  /// What a Lua file of data returns, or else the globals that it sets; run in a sandbox of its own.
  [[nodiscard]] virtual Result<Value> readLuaData(const std::filesystem::path& file) const = 0;
  /// As openspace.addSceneGraphNode.
  virtual Result<void> addSceneGraphNode(const Value& table) = 0;
  /// To be told of whatever a script registers under a name, other than nodes: see NoteRegistration.
  virtual void noteRegistration(std::string name, std::function<void()> takeBack) = 0;
};

/// A part of the program that can be left out at build time. Named in CMake; the host finds it in a generated list.
class Module : public PropertyOwner {
 public:
  using PropertyOwner::PropertyOwner;
  virtual Result<void> initialize(Host& host) = 0;
};

}  // namespace meridian

#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include <glm/vec3.hpp>

#include "host/api/error.h"
#include "host/api/property_owner.h"
#include "host/api/renderable.h"
#include "host/api/schema.h"
#include "host/api/time.h"
#include "host/api/value.h"
#include "host/scene/scene_node.h"
#include "host/scene/transform.h"

namespace meridian::scene {

/// The scene graph, and the owner of the properties `Scene.*`. World space is the frame of its root: metres, origin at
/// the solar-system barycentre, axes SPICE's GALACTIC. Render thread only.
class Scene final : public PropertyOwner {
 public:
  /// With the node "Root" alone, evaluated at J2000.
  Scene();
  ~Scene() override;

  /// Of a type named in assets. Registering a type twice asserts.
  void registerRenderable(std::string type, RenderableFactory factory);

  /// What `openspace.addSceneGraphNode` takes: see the schema. `where` is the asset's file and line, `folder` the
  /// asset's folder. The new node is evaluated at the scene's time. Errors: a table that the schema refuses, an
  /// identifier that is taken, a parent that is not there, a renderable of a registered type that cannot be made,
  /// RenderableGlobe without its module. A renderable of any other type gives a node without one, and a warning for
  /// the first of the type.
  [[nodiscard]] Result<SceneNode*> addNode(const Value& table, std::string_view where, std::string_view folder);

  /// With everything below it. Whoever asked by onRemove is told first, children before parents.
  /// Errors: no such node; the root.
  [[nodiscard]] Result<void> removeNode(std::string_view identifier);

  /// Hangs a node, with all below it, on another parent: its transform is in that one's frame from then on.
  /// Errors: no such node; the root; a parent that is the node itself or below it.
  [[nodiscard]] Result<void> setParent(std::string_view identifier, std::string_view parent);

  /// Called before a node goes, for as long as the scene lives or until the key is given to `forget`.
  [[nodiscard]] int onRemove(std::function<void(SceneNode&)> callback);
  void forget(int key);

  [[nodiscard]] SceneNode& root() { return *nodes_.front(); }
  [[nodiscard]] const SceneNode& root() const { return *nodes_.front(); }
  /// Null without such a node.
  [[nodiscard]] SceneNode* node(std::string_view identifier) const;
  /// Parents before children, else in the order of adding; the root first.
  [[nodiscard]] const std::vector<std::unique_ptr<SceneNode>>& nodes() const { return nodes_; }

  /// Evaluates every node's transforms at that time.
  void evaluate(const Time& time);
  [[nodiscard]] const Time& time() const { return time_; }

  /// The frame of `from` in the frame of `to`, through their nearest common ancestor: coordinates far from both never
  /// enter, so neighbours far out in the solar system are exact to each other.
  [[nodiscard]] static Transform relativeTransform(const SceneNode& from, const SceneNode& to);
  /// Only as good as a double at that distance from the barycentre: 0.03 mm at 1 AU.
  [[nodiscard]] Transform worldFromNode(const SceneNode& node) const { return relativeTransform(node, root()); }

  /// Tells transforms where the eye is: what gives it in a node's own frame and units, for as long as the scene lives.
  void setEye(std::function<glm::dvec3(const SceneNode&)> eye) { eye_ = std::move(eye); }
  /// Nothing before setEye.
  [[nodiscard]] std::optional<glm::dvec3> eyeIn(const SceneNode& node) const {
    return eye_ ? std::optional(eye_(node)) : std::nullopt;
  }

  /// Logs a warning unless there was one of that subject before.
  void warnOnce(const std::string& subject, const std::string& message) const;

  /// Unit, in the node's own frame, towards the light: the node that its renderable names, else `Sun`, if there is one;
  /// else the ephemeris' Sun, for a node placed (itself or through an ancestor) by a SpiceTranslation whose position is
  /// known; else away from the node's world position reversed, that is towards the origin; +x where even that says
  /// nothing.
  [[nodiscard]] glm::dvec3 lightDirection(const SceneNode& node) const;

  /// The keys of a node's table, and of its `GUI` and `Transform`.
  [[nodiscard]] static const Schema& nodeSchema();
  [[nodiscard]] static const Schema& guiSchema();
  [[nodiscard]] static const Schema& transformSchema();

 private:
  [[nodiscard]] Result<std::unique_ptr<Renderable>> makeRenderable(const Value& table, std::string_view identifier,
                                                                   std::string_view where,
                                                                   std::string_view folder) const;

  std::map<std::string, RenderableFactory, std::less<>> factories_;
  std::vector<std::unique_ptr<SceneNode>> nodes_;
  std::map<std::string, SceneNode*, std::less<>> byIdentifier_;
  std::map<int, std::function<void(SceneNode&)>> removalCallbacks_;
  int nextKey_ = 0;
  Time time_;
  std::function<glm::dvec3(const SceneNode&)> eye_;
  mutable std::set<std::string> warned_;
};

}  // namespace meridian::scene

#include "host/scene/scene_scripts.h"

#include <string>
#include <utility>

namespace meridian::scene {

namespace {

using Arguments = std::span<const Value>;

Result<std::string> textAt(Arguments arguments, std::size_t i) {
  if (arguments[i].string() == nullptr) {
    return failure("argument " + std::to_string(i + 1) + " must be the identifier of a node");
  }
  return *arguments[i].string();
}

Result<SceneNode*> nodeAt(const Scene& scene, Arguments arguments) {
  return textAt(arguments, 0).and_then([&](const std::string& identifier) -> Result<SceneNode*> {
    if (SceneNode* node = scene.node(identifier)) {
      return node;
    }
    return failure("there is no node '" + identifier + "'", {}, "check the identifier");
  });
}

ScriptResult nodesOfType(const Scene& scene, Arguments arguments) {
  return textAt(arguments, 0).map([&](const std::string& type) {
    Table list;
    for (const auto& node : scene.nodes()) {
      if (node->renderable() != nullptr && node->renderable()->type() == type) {
        list.list.emplace_back(node->identifier());
      }
    }
    return std::vector<Value>{std::move(list)};
  });
}

ScriptResult setParent(Scene& scene, Arguments arguments) {
  const auto node = textAt(arguments, 0);
  const auto parent = textAt(arguments, 1);
  if (!node || !parent) {
    return tl::make_unexpected(!node ? node.error() : parent.error());
  }
  const auto done = scene.setParent(*node, *parent);
  return done ? ScriptResult(std::vector<Value>()) : tl::make_unexpected(done.error());
}

}  // namespace

ScriptLibrary sceneLibrary(Scene& scene) {
  const auto ofNode = [&scene](Value (*read)(const Scene&, const SceneNode&)) {
    return [&scene, read](Arguments a) -> ScriptResult {
      return nodeAt(scene, a).map([&](const SceneNode* node) { return std::vector<Value>{read(scene, *node)}; });
    };
  };
  const auto sphere = ofNode([](const Scene&, const SceneNode& node) { return Value(node.boundingSphere()); });
  return {"",
          {{"sceneGraphNodes", "", "The identifiers of all nodes.", 0, 0,
            [&scene](Arguments) -> ScriptResult {
              Table list;
              for (const auto& node : scene.nodes()) {
                list.list.emplace_back(node->identifier());
              }
              return std::vector<Value>{std::move(list)};
            }},
           {"nodeByRenderableType", "type", "The identifiers of nodes with a renderable of that type.", 1, 1,
            [&scene](Arguments a) { return nodesOfType(scene, a); }},
           {"setParent", "node, parent", "Hangs a node on another parent.", 2, 2,
            [&scene](Arguments a) { return setParent(scene, a); }},
           {"boundingSphere", "node", "Metres.", 1, 1, sphere},
           {"interactionSphere", "node", "The same: we have no other sphere.", 1, 1, sphere},
           {"worldPosition", "node", "Metres from the solar-system barycentre.", 1, 1,
            ofNode([](const Scene& all, const SceneNode& node) { return Value(all.worldFromNode(node).translation); })},
           {"worldRotation", "node", "A matrix of 9 numbers by columns.", 1, 1,
            ofNode([](const Scene& all, const SceneNode& node) {
              const glm::dmat3 matrix = all.worldFromNode(node).rotation;
              Table list;
              for (int i = 0; i < 9; ++i) {
                list.list.emplace_back(matrix[i / 3][i % 3]);
              }
              return Value(std::move(list));
            })}}};
}

}  // namespace meridian::scene

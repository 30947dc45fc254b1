#pragma once

#include <memory>
#include <string>

#include "host/api/property.h"
#include "host/api/property_owner.h"
#include "host/api/renderable.h"
#include "host/api/time.h"
#include "host/scene/node_transforms.h"
#include "host/scene/transform.h"

namespace meridian::scene {

/// A place in the scene: a frame in its parent's frame, and perhaps something to draw there. Made by Scene::addNode.
class SceneNode final : public PropertyOwner {
 public:
  /// What Scene puts together from the asset's table.
  struct Parts {
    std::string identifier;
    SceneNode* parent = nullptr;  ///< null for the root only
    std::unique_ptr<Translation> translation{};
    std::unique_ptr<Rotation> rotation{};
    std::unique_ptr<Scale> scale{};
    std::unique_ptr<Renderable> renderable{};
    std::string guiName{};
    std::string guiPath{};
    std::string guiDescription{};
    bool guiHidden = false;
    double boundingSphere = 0.0;  ///< 0: take the renderable's
  };
  explicit SceneNode(Parts parts);

  [[nodiscard]] SceneNode* parentNode() const { return parts_.parent; }
  /// For Scene::setParent, which keeps the order of nodes.
  void setParentNode(SceneNode& parent) {
    parts_.parent = &parent;
    depth_ = parent.depth() + 1;
  }
  [[nodiscard]] const Translation* translation() const { return parts_.translation.get(); }
  [[nodiscard]] int depth() const { return depth_; }  ///< of the root: 0
  [[nodiscard]] Renderable* renderable() const { return parts_.renderable.get(); }
  /// Null unless the renderable is something to stand on.
  [[nodiscard]] Ground* ground() const { return parts_.renderable ? parts_.renderable->ground() : nullptr; }
  /// Metres in the node's own frame: the asset's, else the renderable's, else 0.
  [[nodiscard]] double boundingSphere() const;

  [[nodiscard]] const std::string& guiName() const { return name(); }
  [[nodiscard]] const std::string& guiPath() const { return parts_.guiPath; }
  [[nodiscard]] bool isGuiHidden() const { return parts_.guiHidden; }

  /// Evaluates the transforms at that time.
  void evaluate(const Time& time);
  /// Of the time last evaluated: this node's frame in its parent's.
  [[nodiscard]] const Transform& parentFromNode() const { return parentFromNode_; }

 private:
  Parts parts_;
  int depth_ = 0;
  Transform parentFromNode_;
};

}  // namespace meridian::scene

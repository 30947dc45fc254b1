#include "host/scene/scene_node.h"

namespace meridian::scene {

SceneNode::SceneNode(Parts parts)
    : PropertyOwner(parts.identifier, parts.guiName, parts.guiDescription), parts_(std::move(parts)) {
  depth_ = parts_.parent != nullptr ? parts_.parent->depth() + 1 : 0;
  const std::initializer_list<PropertyOwner*> owners = {parts_.renderable.get(), parts_.translation.get(),
                                                        parts_.rotation.get(), parts_.scale.get()};
  for (PropertyOwner* owner : owners) {
    if (owner != nullptr) {
      addChild(*owner);
    }
  }
}

double SceneNode::boundingSphere() const {
  if (parts_.boundingSphere > 0.0 || !parts_.renderable) {
    return parts_.boundingSphere;
  }
  return parts_.renderable->boundingSphere();
}

void SceneNode::evaluate(const Time& time) {
  if (parts_.translation) {
    parentFromNode_.translation = parts_.translation->position(time);
  }
  if (parts_.rotation) {
    parentFromNode_.rotation = parts_.rotation->matrix(time);
  }
  if (parts_.scale) {
    parentFromNode_.scale = parts_.scale->factor(time);
  }
}

}  // namespace meridian::scene

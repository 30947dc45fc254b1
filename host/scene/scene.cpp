#include "host/scene/scene.h"

#include <algorithm>
#include <cassert>

#include "host/api/log.h"
#include "host/scene/transform_types.h"

namespace meridian::scene {

namespace {

using Type = Schema::Type;

std::string textOr(const Value* table, std::string_view key, std::string_view otherwise) {
  const Value* value = table != nullptr ? table->find(key) : nullptr;
  const std::string* text = value != nullptr ? value->string() : nullptr;
  return text != nullptr ? *text : std::string(otherwise);
}

std::vector<std::string> tagsOf(const Value& table) {
  const Value* tag = table.find("Tag");
  if (tag == nullptr) {
    return {};
  }
  if (const std::string* one = tag->string()) {
    return {*one};
  }
  std::vector<std::string> tags;
  for (const Value& each : tag->table()->list) {
    tags.push_back(*each.string());
  }
  return tags;
}

/// One of `Transform`'s three tables, if it is there.
template <class Kind, class Make>
Result<void> makePart(TransformRequest request, const Value* transform, std::string_view key, Make make,
                      std::unique_ptr<Kind>& part) {
  const Value* table = transform != nullptr ? transform->find(key) : nullptr;
  if (table == nullptr) {
    return {};
  }
  request.table = *table;
  request.path = "Transform." + std::string(key);
  auto made = make(request);
  if (!made) {
    return tl::make_unexpected(made.error());
  }
  part = std::move(*made);
  return {};
}

bool isAtOrBelow(const SceneNode& node, const SceneNode& top) {
  const SceneNode* each = &node;
  while (each != nullptr && each != &top) {
    each = each->parentNode();
  }
  return each == &top;
}

Result<void> checkGui(const Value* gui, std::string_view where) {
  if (gui == nullptr) {
    return {};
  }
  if (auto valid = Scene::guiSchema().validate(*gui, where, "GUI"); !valid) {
    return valid;
  }
  const std::string path = textOr(gui, "Path", "/");
  if (!path.starts_with('/')) {
    return failure("expected a path that starts with '/', found '" + path + "'", std::string(where) + ": GUI.Path",
                   "write it as \"/Solar System/Planets\"");
  }
  return {};
}

}  // namespace

Scene::Scene() : PropertyOwner("Scene") {
  SceneNode::Parts parts;
  parts.identifier = "Root";
  nodes_.push_back(std::make_unique<SceneNode>(std::move(parts)));
  byIdentifier_.emplace("Root", nodes_.front().get());
  addChild(*nodes_.front());
}

Scene::~Scene() {
  while (!nodes_.empty()) {
    nodes_.pop_back();  // children before parents
  }
}

void Scene::registerRenderable(std::string type, RenderableFactory factory) {
  [[maybe_unused]] const bool added = factories_.emplace(std::move(type), std::move(factory)).second;
  assert(added);
}

const Schema& Scene::nodeSchema() {
  static const Schema schema({{"Identifier", Type::Identifier, "Unique in the scene", true},
                              {"Parent", Type::Identifier, "Identifier of a node that exists; Root without"},
                              {"Renderable", Type::Table, "What is drawn there"},
                              {"Transform", Type::Table, "Translation, Rotation and Scale in the parent's frame"},
                              {"BoundingSphere", Type::Number, "Metres", false, 0.0},
                              {"Tag", Type::StringOrStrings, "Words to find the node by"},
                              {"GUI", Type::Table, "How the user interface shows it"}});
  return schema;
}

const Schema& Scene::guiSchema() {
  static const Schema schema({{"Name", Type::String, "For people; the identifier without"},
                              {"Path", Type::String, "Folders from '/', such as /Solar System/Planets"},
                              {"Description", Type::String, "For people"},
                              {"Hidden", Type::Boolean, "Whether lists leave it out"}});
  return schema;
}

const Schema& Scene::transformSchema() {
  static const Schema schema({{"Translation", Type::Table, "Where the node stands"},
                              {"Rotation", Type::Table, "How its axes lie"},
                              {"Scale", Type::Table, "How large its unit is"}});
  return schema;
}

Result<std::unique_ptr<Renderable>> Scene::makeRenderable(const Value& table, std::string_view identifier,
                                                          std::string_view where, std::string_view folder) const {
  static const Schema schema({{"Type", Type::String, "What to draw, such as RenderableGlobe", true}});
  if (auto valid = schema.validate(table, where, "Renderable"); !valid) {
    return tl::make_unexpected(valid.error());
  }
  const std::string& type = *table.find("Type")->string();
  if (const auto factory = factories_.find(type); factory != factories_.end()) {
    return factory->second({table, std::string(where), std::string(folder), std::string(identifier)});
  }
  if (type == "RenderableGlobe") {
    return failure("globes need the module globebrowsing, which this program was built without",
                   std::string(where) + ": Renderable.Type", "build with MERIDIAN_MODULE_GLOBEBROWSING=ON");
  }
  warnOnce("renderable " + type, std::string(where) + ": '" + std::string(identifier) +
                                     "' has a renderable of the type '" + type +
                                     "', which is none of ours; nodes with it are there, but show nothing");
  return nullptr;
}

Result<SceneNode*> Scene::addNode(const Value& table, std::string_view where, std::string_view folder) {
  if (auto valid = nodeSchema().validate(table, where); !valid) {
    return tl::make_unexpected(valid.error());
  }
  SceneNode::Parts parts;
  parts.identifier = *table.find("Identifier")->string();
  if (node(parts.identifier) != nullptr) {
    return failure("there is a node '" + parts.identifier + "' already", std::string(where) + ": Identifier",
                   "choose another identifier, or remove the other node first");
  }
  const std::string parent = textOr(&table, "Parent", "Root");
  parts.parent = node(parent);
  if (parts.parent == nullptr) {
    return failure("there is no node '" + parent + "' to be the parent of '" + parts.identifier + "'",
                   std::string(where) + ": Parent", "require the asset that adds the parent first");
  }
  const Value* gui = table.find("GUI");
  if (auto valid = checkGui(gui, where); !valid) {
    return tl::make_unexpected(valid.error());
  }
  parts.guiName = textOr(gui, "Name", "");
  parts.guiPath = textOr(gui, "Path", "/");
  parts.guiDescription = textOr(gui, "Description", "");
  const Value* hidden = gui != nullptr ? gui->find("Hidden") : nullptr;
  parts.guiHidden = hidden != nullptr && *hidden->boolean();
  if (const Value* sphere = table.find("BoundingSphere")) {
    parts.boundingSphere = *sphere->number();
  }
  const Value* transform = table.find("Transform");
  if (transform != nullptr) {
    if (auto valid = transformSchema().validate(*transform, where, "Transform"); !valid) {
      return tl::make_unexpected(valid.error());
    }
  }
  const TransformRequest request{{}, std::string(where), {}, std::string(folder), parts.identifier, this};
  for (auto made : {makePart(request, transform, "Translation", makeTranslation, parts.translation),
                    makePart(request, transform, "Rotation", makeRotation, parts.rotation),
                    makePart(request, transform, "Scale", makeScale, parts.scale)}) {
    if (!made) {
      return tl::make_unexpected(made.error());
    }
  }
  if (const Value* renderable = table.find("Renderable")) {
    auto made = makeRenderable(*renderable, parts.identifier, where, folder);
    if (!made) {
      return tl::make_unexpected(made.error());
    }
    parts.renderable = std::move(*made);
  }
  auto added = std::make_unique<SceneNode>(std::move(parts));
  for (std::string& tag : tagsOf(table)) {
    added->addTag(std::move(tag));
  }
  added->evaluate(time_);
  addChild(*added);
  byIdentifier_.emplace(added->identifier(), added.get());
  nodes_.push_back(std::move(added));
  return nodes_.back().get();
}

Result<void> Scene::removeNode(std::string_view identifier) {
  SceneNode* top = node(identifier);
  if (top == nullptr) {
    return failure("there is no node '" + std::string(identifier) + "'", {}, "check the identifier");
  }
  if (top == &root()) {
    return failure("the root of the scene cannot be removed", {}, "remove the nodes below it");
  }
  // Later nodes are never parents of earlier ones.
  for (std::size_t i = nodes_.size(); i-- > 0;) {
    if (!isAtOrBelow(*nodes_[i], *top)) {
      continue;
    }
    for (const auto& [key, callback] : removalCallbacks_) {
      callback(*nodes_[i]);
    }
    byIdentifier_.erase(nodes_[i]->identifier());
    nodes_.erase(nodes_.begin() + static_cast<std::ptrdiff_t>(i));
  }
  return {};
}

Result<void> Scene::setParent(std::string_view identifier, std::string_view parentIdentifier) {
  SceneNode* moved = node(identifier);
  SceneNode* parent = node(parentIdentifier);
  if (moved == nullptr || parent == nullptr) {
    return failure("there is no node '" + std::string(moved == nullptr ? identifier : parentIdentifier) + "'", {},
                   "check the identifier");
  }
  if (moved == &root() || isAtOrBelow(*parent, *moved)) {
    return failure("'" + std::string(identifier) + "' cannot hang on '" + std::string(parentIdentifier) + "'", {},
                   "name a parent that is not below it; the root has none");
  }
  moved->setParentNode(*parent);
  // Parents stay before children.
  const auto branch = std::stable_partition(nodes_.begin(), nodes_.end(),
                                            [&](const auto& each) { return !isAtOrBelow(*each, *moved); });
  std::for_each(branch, nodes_.end(), [&](const auto& each) { each->setParentNode(*each->parentNode()); });
  return {};
}

void Scene::warnOnce(const std::string& subject, const std::string& message) const {
  if (warned_.insert(subject).second) {
    log::warning("{}", message);
  }
}

void warnOnce(const TransformRequest& request, const std::string& subject, const std::string& message) {
  if (request.scene != nullptr) {
    request.scene->warnOnce(subject, request.where + ": " + message);
  } else {
    log::warning("{}: {}", request.where, message);
  }
}

int Scene::onRemove(std::function<void(SceneNode&)> callback) {
  removalCallbacks_.emplace(nextKey_, std::move(callback));
  return nextKey_++;
}

void Scene::forget(int key) {
  removalCallbacks_.erase(key);
}

SceneNode* Scene::node(std::string_view identifier) const {
  const auto found = byIdentifier_.find(identifier);
  return found != byIdentifier_.end() ? found->second : nullptr;
}

void Scene::evaluate(const Time& time) {
  time_ = time;
  for (const std::unique_ptr<SceneNode>& each : nodes_) {
    each->evaluate(time);
  }
}

Transform Scene::relativeTransform(const SceneNode& from, const SceneNode& to) {
  Transform ancestorFromSource;
  Transform ancestorFromDestination;
  const SceneNode* source = &from;
  const SceneNode* destination = &to;
  while (source != destination) {
    if (source->depth() >= destination->depth()) {
      ancestorFromSource = source->parentFromNode() * ancestorFromSource;
      source = source->parentNode();
    } else {
      ancestorFromDestination = destination->parentFromNode() * ancestorFromDestination;
      destination = destination->parentNode();
    }
  }
  // The difference is taken before turning: both translations share the ancestor's axes.
  const glm::dmat3 back = glm::transpose(ancestorFromDestination.rotation);
  const double shrink = 1.0 / ancestorFromDestination.scale;
  return {back * ((ancestorFromSource.translation - ancestorFromDestination.translation) * shrink),
          back * ancestorFromSource.rotation, ancestorFromSource.scale * shrink};
}

}  // namespace meridian::scene

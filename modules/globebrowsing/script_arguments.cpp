#include "globebrowsing/script_arguments.h"

#include <cmath>
#include <utility>

#include <fmt/format.h>

namespace meridian::globebrowsing {

namespace {

void noteLayer(Host& host, const std::string& node, const Layer& layer) {
  const auto takeBack = [&host, node, group = layer.group(), identifier = layer.identifier(),
                         where = layer.request().where] {
    const Result<RenderableGlobe*> found = globe(host, node);
    const Layer* const present = found ? (*found)->layers().group(group).find(identifier) : nullptr;
    // Another one may have its name by now.
    if (present != nullptr && present->request().where == where) {
      static_cast<void>((*found)->layers().deleteLayer(name(group), identifier));
    }
  };
  host.noteRegistration(fmt::format("layer {} {} {}", node, name(layer.group()), layer.identifier()), takeBack);
}

}  // namespace

Result<std::string> text(const Value& value, std::string_view argument) {
  if (const std::string* found = value.string()) {
    return *found;
  }
  return failure(fmt::format("{} must be a string, found {}", argument, kindName(value.kind())));
}

Result<std::string> identifierOf(const Value& value, std::string_view argument) {
  const Value* named = value.isTable() ? value.find("Identifier") : &value;
  return text(named != nullptr ? *named : Value(), argument);
}

Result<double> number(const Value& value, std::string_view argument) {
  const auto found = value.number();
  if (!found || !std::isfinite(*found)) {
    return failure(fmt::format("{} must be a finite number, found {}", argument, kindName(value.kind())));
  }
  return *found;
}

Result<RenderableGlobe*> globe(Host& host, const Value& node) {
  return text(node, "globe").and_then([&](const std::string& identifier) -> Result<RenderableGlobe*> {
    if (auto* found = dynamic_cast<RenderableGlobe*>(host.renderable(identifier))) {
      return found;
    }
    return failure(fmt::format("there is no globe \"{}\"", identifier), {},
                   "openspace.globebrowsing.globes() lists those there are");
  });
}

ScriptResult none(const Result<void>& done) {
  return done ? ScriptResult(std::vector<Value>{}) : tl::make_unexpected(done.error());
}

Result<void> addLayerFromScript(Host& host, const Value& node, const std::string& group, const Value& table) {
  if (!table.isTable()) {
    return failure(fmt::format("the layer must be a table, found {}", kindName(table.kind())));
  }
  return globe(host, node)
      .and_then([&](RenderableGlobe* found) {
        Host::ScriptPlace place = host.scriptPlace();
        return found->addLayer(group, {table, std::move(place.where), "addLayer", std::move(place.folder)},
                               !place.isAsset);
      })
      .map([&](const Layer* added) {
        if (added != nullptr) {
          noteLayer(host, *node.string(), *added);
        }
      });
}

}  // namespace meridian::globebrowsing

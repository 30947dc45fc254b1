#include "globebrowsing/map_server_panel.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "globebrowsing/layers_file.h"
#include "globebrowsing/source/capabilities_parts.h"
#include "globebrowsing/source/service_text.h"

namespace meridian::globebrowsing {

namespace {

/// Services list thousands of times.
constexpr std::size_t mostCharacters = 120;

std::string shortened(const std::string& text) {
  return text.size() <= mostCharacters ? text : text.substr(0, mostCharacters) + " ...";
}

/// A label of its own for the n-th of things that may have the same name, as services' layers and styles may.
std::string labelOf(const std::string& name, std::size_t n) {
  return fmt::format("{}##{}", name, n);
}

/// The identifier, or with a number where the group has it already.
std::string freeIdentifier(const LayerGroup& group, const std::string& wanted) {
  std::string identifier = wanted;
  for (int n = 2; group.find(identifier) != nullptr; ++n) {
    identifier = fmt::format("{}_{}", wanted, n);
  }
  return identifier;
}

}  // namespace

MapServerPanel::MapServerPanel(Host& host, MapServers& servers)
    : host_(host),
      servers_(servers),
      group_({"Group", "Group", "Of the globe's layers"}, layerGroupNames(),
             static_cast<int>(LayerGroupId::ColorLayers)) {}

RenderableGlobe* MapServerPanel::globe() const {
  return globe_ ? dynamic_cast<RenderableGlobe*>(host_.renderable(globe_->word())) : nullptr;
}

void MapServerPanel::updateGlobes() {
  std::vector<std::string> globes;
  for (const std::string& node : host_.nodes()) {
    if (dynamic_cast<RenderableGlobe*>(host_.renderable(node)) != nullptr) {
      globes.push_back(node);
    }
  }
  if (globes == (globe_ ? globe_->options() : std::vector<std::string>())) {
    return;
  }
  const std::string former = globe_ ? globe_->word() : std::string();
  globe_.reset();
  if (!globes.empty()) {
    const auto place = std::find(globes.begin(), globes.end(), former);
    const auto chosen = place == globes.end() ? 0 : static_cast<int>(place - globes.begin());
    globe_ = std::make_unique<OptionProperty>(
        Property::Description{"Globe", "Globe", "Where layers and servers are added"}, std::move(globes), chosen);
  }
}

void MapServerPanel::build(PanelBuilder& builder) {
  updateGlobes();
  if (!globe_) {
    builder.text("There is no globe to add layers to");
    return;
  }
  builder.property(*globe_);
  builder.property(group_);
  builder.property(filter_);
  if (!failed_.empty()) {
    builder.warning(failed_);
  } else if (!done_.empty()) {
    builder.text(done_);
  }
  for (const MapServer& server : servers_.all()) {
    buildServer(builder, server);
  }
  if (builder.beginSection("New server")) {
    buildNewServer(builder);
    builder.endSection();
  }
  if (builder.beginSection("Added layers")) {
    buildAdded(builder);
    builder.endSection();
  }
}

void MapServerPanel::buildNewServer(PanelBuilder& builder) {
  builder.property(url_);
  builder.property(name_);
  if (builder.button("Load") && !url_.get().empty()) {
    servers_.add({name_.get().empty() ? url_.get() : name_.get(), globe_->word(), repairedUrl(url_.get())});
    done_.clear();
    failed_.clear();
  }
}

void MapServerPanel::buildServer(PanelBuilder& builder, const MapServer& server) {
  if (!builder.beginSection(server.name + "##server")) {
    return;
  }
  builder.text(shortened(server.url));
  if (servers_.isLoading(server.name)) {
    builder.text("loading ...");
  } else if (const MapServers::Offer& offer = servers_.offered(server.name); !offer) {
    builder.warning(offer.error().message());
  } else {
    buildOffer(builder, server, *offer);
  }
  const bool loadsAgain = builder.button("Load again");
  if (builder.button("Forget")) {
    servers_.remove(server.name);
  } else if (loadsAgain) {
    servers_.add(server);
  }
  builder.endSection();
}

void MapServerPanel::buildOffer(PanelBuilder& builder, const MapServer& server, const ServerOffer& serverOffer) {
  if (!serverOffer.message.empty()) {
    builder.warning(serverOffer.message);
  }
  const std::vector<OfferedLayer>& offer = serverOffer.layers;
  std::size_t matches = 0;
  for (std::size_t i = 0; i < offer.size(); ++i) {
    const OfferedLayer& layer = offer[i];
    if (!containsIgnoringCase(layer.name, filter_.get())) {
      continue;
    }
    if (++matches <= mostListed && builder.beginSection(labelOf(layer.name, i))) {
      buildLayer(builder, server, layer);
      builder.endSection();
    }
  }
  builder.text(matches <= mostListed
                   ? fmt::format("{} of {} layers", matches, offer.size())
                   : fmt::format("{} of {} layers; the first {} are listed", matches, offer.size(), mostListed));
}

void MapServerPanel::buildLayer(PanelBuilder& builder, const MapServer& server, const OfferedLayer& layer) {
  if (layer.extent) {
    const Extent degrees = toDegrees(*layer.extent);
    builder.text(fmt::format("west {:.4g}, south {:.4g}, east {:.4g}, north {:.4g}", degrees.west, degrees.south,
                             degrees.east, degrees.north));
  }
  if (!layer.times.empty()) {
    builder.text("times " + shortened(layer.times));
  }
  if (!layer.attribution.empty()) {
    builder.text(shortened(layer.attribution));
  }
  if (!layer.obstacle.empty()) {
    builder.warning("cannot be shown: " + layer.obstacle);
  }
  const bool isOnly = layer.styles.size() == 1;
  for (std::size_t i = 0; i < layer.styles.size(); ++i) {
    if (builder.button(labelOf(isOnly ? "Add" : "Add, style " + layer.styles[i].name, i))) {
      add(server, layer, layer.styles[i]);
    }
  }
}

void MapServerPanel::add(const MapServer& server, const OfferedLayer& layer, const OfferedLayer::Style& style) {
  done_.clear();
  RenderableGlobe* const found = globe();
  if (found == nullptr) {
    return;
  }
  Table table = *style.table.table();
  const std::string identifier = freeIdentifier(found->layers().group(group()), *table.fields["Identifier"].string());
  table.fields["Identifier"] = identifier;
  const Result<Layer*> added = found->layers().addLayer(name(group()), {table, server.name, identifier, {}});
  if (!added) {
    failed_ = added.error().message();
    return;
  }
  (*added)->setUsers();
  failed_.clear();
  done_ = fmt::format("{} is now {}.{} of {}", layer.name, name(group()), identifier, globe_->word());
}

void MapServerPanel::buildAdded(PanelBuilder& builder) {
  RenderableGlobe* const found = globe();
  const std::vector<Layer*> layers = found != nullptr ? usersLayers(*found) : std::vector<Layer*>();
  for (const Layer* layer : layers) {
    builder.text(fmt::format("{}.{}: {}", name(layer->group()), layer->identifier(), layer->status.get()));
    if (!layer->lastError.get().empty()) {
      builder.warning(layer->lastError.get());
    }
  }
  if (layers.empty()) {
    builder.text("none");
    return;
  }
  builder.property(file_);
  if (builder.button("Write asset")) {
    write();
  }
}

void MapServerPanel::write() {
  const Result<std::filesystem::path> written = writeLayersFile(host_, globe_->word(), file_.get());
  done_ = written ? "written: " + written->string() : std::string();
  failed_ = written ? std::string() : written.error().message();
}

}  // namespace meridian::globebrowsing

#include "globebrowsing/server_documents.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "globebrowsing/source/capabilities.h"
#include "globebrowsing/source/document_file.h"
#include "globebrowsing/source/service_asset.h"
#include "globebrowsing/source/service_text.h"

namespace meridian::globebrowsing {

namespace {

/// What an asset can say of the layer: a table for each style.
Result<std::vector<OfferedLayer::Style>> stylesOf(const Capabilities& capabilities, const CapabilitiesLayer& layer,
                                                  const std::string& globe) {
  std::vector<OfferedLayer::Style> styles;
  const std::size_t count = std::max<std::size_t>(layer.styles.size(), 1);
  for (std::size_t i = 0; i < count; ++i) {
    LayerChoices choices;
    choices.style = i == 0 ? std::string() : layer.styles[i].identifier;
    Result<LayerAsset> asset = assetOf(capabilities, layer, choices, {globe});
    if (!asset) {
      return tl::make_unexpected(std::move(asset.error()));
    }
    std::string name = layer.styles.empty()            ? "default"
                       : layer.styles[i].title.empty() ? layer.styles[i].identifier
                                                       : layer.styles[i].title;
    styles.push_back({std::move(name), std::move(asset->table)});
  }
  return styles;
}

OfferedLayer offeredLayer(const Capabilities& capabilities, const CapabilitiesLayer& layer, const std::string& globe) {
  OfferedLayer offered;
  offered.name = layer.title.empty() ? layer.identifier : layer.title;
  offered.obstacle = layer.obstacle;
  offered.extent = layer.extent;
  offered.times = layer.timeDimension() != nullptr ? layer.timeDimension()->values : std::string();
  offered.attribution = creditText(layer.attribution.empty() ? capabilities.attribution : layer.attribution);
  if (!offered.obstacle.empty()) {
    return offered;
  }
  Result<std::vector<OfferedLayer::Style>> styles = stylesOf(capabilities, layer, globe);
  if (!styles) {
    offered.obstacle = styles.error().what;
    return offered;
  }
  offered.styles = std::move(*styles);
  offered.url = *offered.styles.front().table.find("FilePath")->string();
  return offered;
}

}  // namespace

Result<std::vector<ServerDocuments::Entry>> ServerDocuments::read(const Fetched& document, const std::string& url,
                                                                  const std::string& globe) {
  if (document.body == nullptr) {
    return failure("there are no capabilities at that address", url, "check the address");
  }
  return parseCapabilities(*document.body, url).map([&](const Capabilities& capabilities) {
    std::vector<Entry> entries;
    for (const CapabilitiesLayer& layer : capabilities.layers) {
      if (!layer.document.empty()) {
        entries.push_back({{}, layer.document, layer.title});
      } else if (!layer.identifier.empty()) {  // no heading
        entries.push_back({offeredLayer(capabilities, layer, globe)});
      }
    }
    return entries;
  });
}

ServerDocuments::ServerDocuments(const MapServer& server) : documents_{{server.url}}, known_{server.url} {}

std::vector<ServerDocuments::Wanted> ServerDocuments::put(std::size_t number, Result<std::vector<Entry>> entries) {
  --open_;
  documents_[number].isPut = true;
  if (!entries) {
    documents_[number].entries = std::move(entries);
    return {};
  }
  std::vector<Wanted> wanted;
  const int depth = documents_[number].depth + 1;
  std::erase_if(*entries, [&](const Entry& entry) {
    if (entry.document.empty()) {
      return false;
    }
    std::size_t* reason = nullptr;
    if (!known_.insert(entry.document).second) {
      return true;  // lists may name each other
    }
    if (!isWebAddress(entry.document)) {
      reason = &unreachable_;
    } else if (depth > deepestList) {
      reason = &tooDeep_;
    } else if (documents_.size() > mostDocuments) {
      reason = &tooMany_;
    }
    if (reason != nullptr) {
      ++*reason;
      return true;
    }
    wanted.push_back({documents_.size(), entry.document});
    documents_[number].listed.push_back(documents_.size());
    documents_.push_back({entry.document, entry.title, depth});
    return false;
  });
  documents_[number].entries = std::move(entries);
  open_ += wanted.size();
  return wanted;
}

void ServerDocuments::gather(std::size_t number, std::vector<OfferedLayer>& layers) {
  Document& document = documents_[number];
  if (!document.isPut || !document.entries) {
    return;
  }
  std::size_t listed = 0;
  for (Entry& entry : *document.entries) {
    if (!entry.document.empty()) {
      gather(document.listed[listed++], layers);
      continue;
    }
    // Many an ArcGIS service calls its map "Layers".
    const bool isSaid = containsIgnoringCase(entry.layer.name, document.title);
    entry.layer.name.insert(0, isSaid ? std::string() : document.title + ": ");
    layers.push_back(std::move(entry.layer));
  }
}

std::string ServerDocuments::missing(const std::string& late) const {
  std::size_t tooLate = 0;
  std::size_t failed = 0;
  std::string example;
  for (const Document& document : documents_) {
    tooLate += document.isPut ? 0 : 1;
    if (document.isPut && !document.entries) {
      ++failed;
      example = example.empty() ? document.entries.error().message() : example;
    }
  }
  std::string reasons;
  const auto add = [&](std::size_t count, const std::string& why) {
    reasons += count == 0 ? std::string() : fmt::format("{}{} {}", reasons.empty() ? "" : "; ", count, why);
  };
  add(tooMany_, fmt::format("beyond the {} that are loaded at most", mostDocuments));
  add(tooDeep_, fmt::format("in lists within more than {} lists", deepestList));
  add(unreachable_, "at addresses of no server");
  add(tooLate, late);
  add(failed, "that could not be loaded, such as " + example);
  const std::size_t leftOut = tooMany_ + tooDeep_ + unreachable_ + tooLate + failed;
  return leftOut == 0 ? std::string()
                      : fmt::format("{} of {} documents were left out: {}", leftOut,
                                    documents_.size() - 1 + tooMany_ + tooDeep_ + unreachable_, reasons);
}

MapServers::Offer ServerDocuments::offer(const std::string& late) {
  const Document& own = documents_.front();
  if (!own.isPut) {
    return failure("the capabilities " + late, own.url, "check the server, or try again");
  }
  if (!own.entries) {
    return tl::make_unexpected(own.entries.error());
  }
  ServerOffer offer;
  offer.message = missing(late);
  gather(0, offer.layers);
  return offer;
}

}  // namespace meridian::globebrowsing

#include "globebrowsing/map_server_scripts.h"

#include <string>
#include <utility>

#include <fmt/format.h>

#include "globebrowsing/script_arguments.h"
#include "host/api/log.h"

namespace meridian::globebrowsing {

namespace {

using Arguments = std::span<const Value>;

ScriptResult loadCapabilities(MapServers& servers, Arguments arguments) {
  const auto name = text(arguments[0], "name");
  const auto globe = text(arguments[1], "globe");
  const auto url = text(arguments[2], "url");
  for (const auto* each : {&name, &globe, &url}) {
    if (!*each) {
      return tl::make_unexpected(each->error());
    }
  }
  servers.add({*name, *globe, *url});
  return none({});
}

ScriptResult capabilities(const MapServers& servers, Arguments arguments) {
  const auto name = text(arguments[0], "name");
  if (!name) {
    return tl::make_unexpected(name.error());
  }
  const MapServers::Offer& offer = servers.offered(*name);
  Table list;
  if (!offer) {
    log::warning("capabilitiesWMS: {}: {}", *name, offer.error().message());
  } else {
    std::size_t hidden = 0;
    const OfferedLayer* example = nullptr;
    for (const OfferedLayer& layer : offer->layers) {
      if (!layer.url.empty()) {
        list.list.emplace_back(Table{{}, {{"Name", layer.name}, {"URL", layer.url}}});
      } else if (++hidden == 1) {
        example = &layer;
      }
    }
    if (example != nullptr) {
      log::warning("capabilitiesWMS: {}: {} of {} layers cannot be shown, such as '{}': {}", *name, hidden,
                   offer->layers.size(), example->name, example->obstacle);
    }
  }
  return std::vector<Value>{std::move(list)};
}

ScriptResult urlInfo(const MapServers& servers, Arguments arguments) {
  return text(arguments[0], "globe").map([&](const std::string& globe) {
    Table list;
    for (const MapServer& server : servers.of(globe)) {
      list.list.emplace_back(Table{{}, {{"name", server.name}, {"url", server.url}}});
    }
    return std::vector<Value>{std::move(list)};
  });
}

Result<void> addServers(MapServers& servers, const std::string& globe, const Value& list, const std::string& where) {
  if (!list.isTable()) {
    return failure("expected a list of servers", fmt::format("{}: {}", where, globe));
  }
  for (std::size_t i = 0; i < list.table()->list.size(); ++i) {
    const Value& each = list.table()->list[i];
    const Value* name = each.find("Name");
    const Value* url = each.find("URL");
    if (name == nullptr || url == nullptr || name->string() == nullptr || url->string() == nullptr) {
      return failure("a server needs a Name and a URL, both strings", fmt::format("{}: {}[{}]", where, globe, i + 1));
    }
    servers.add({*name->string(), globe, *url->string()});
  }
  return {};
}

ScriptResult loadFromFile(Host& host, MapServers& servers, Arguments arguments) {
  const auto file =
      text(arguments[0], "file").and_then([&](const std::string& path) { return host.readablePath(path); });
  const Result<Value> table = file.and_then([&](const auto& path) { return host.readLuaData(path); });
  if (!table) {
    return tl::make_unexpected(table.error());
  }
  if (!table->isTable()) {
    return failure("the file returns no table", file->string());
  }
  for (const auto& [globe, list] : table->table()->fields) {
    if (auto done = addServers(servers, globe, list, file->string()); !done) {
      return none(done);
    }
  }
  return none({});
}

}  // namespace

std::vector<ScriptFunction> mapServerFunctions(Host& host, MapServers& servers) {
  return {{"loadWMSCapabilities", "name, globe, url", "Names a map server, whose layers can then be asked for", 3, 3,
           [&servers](Arguments a) { return loadCapabilities(servers, a); }},
          {"removeWMSServer", "name", "Forgets a map server", 1, 1,
           [&servers](Arguments a) -> ScriptResult {
             const auto name = text(a[0], "name");
             if (name && !servers.remove(*name)) {
               log::warning("removeWMSServer: there is no map server \"{}\"", *name);
             }
             return name ? none({}) : tl::make_unexpected(name.error());
           }},
          {"capabilitiesWMS", "name", "The layers that a map server offers: { Name, URL } each", 1, 1,
           [&servers](Arguments a) { return capabilities(servers, a); },
           [&servers](Arguments a) { return a[0].string() != nullptr && servers.stillLoads(*a[0].string()); }},
          {"urlInfo", "globe", "The map servers of a globe: { name, url } each", 1, 1,
           [&servers](Arguments a) { return urlInfo(servers, a); }},
          {"loadWMSServersFromFile", "file", "Names the map servers that a Lua file lists by globe", 1, 1,
           [&host, &servers](Arguments a) { return loadFromFile(host, servers, a); }}};
}

}  // namespace meridian::globebrowsing

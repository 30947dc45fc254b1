#include "globebrowsing/geo_json_scripts.h"

#include <memory>
#include <set>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "globebrowsing/script_arguments.h"
#include "host/api/log.h"
#include "host/api/schema.h"

namespace meridian::globebrowsing {

namespace {

using Arguments = std::span<const Value>;

struct GeoJsonFiles {
  std::set<std::pair<std::string, std::string>> known;  ///< globe and identifier
  bool told = false;

  void tell() {
    if (!std::exchange(told, true)) {
      log::warning("GeoJSON files are not drawn");
    }
  }
};

ScriptResult add(Host& host, const std::shared_ptr<GeoJsonFiles>& files, Arguments arguments) {
  using Type = Schema::Type;
  static const Schema schema({{"Identifier", Type::Identifier, "unique on the globe", true},
                              {"File", Type::String, "the path of a GeoJSON file", true}});
  const auto found = globe(host, arguments[0]);
  if (!found) {
    return tl::make_unexpected(found.error());
  }
  if (auto valid = schema.validate(arguments[1], "", "addGeoJson"); !valid) {
    return none(valid);
  }
  const std::pair file(*arguments[0].string(), *arguments[1].find("Identifier")->string());
  if (!files->known.insert(file).second) {
    return failure(fmt::format("{} has a GeoJSON \"{}\" already", file.first, file.second), {},
                   "choose another Identifier");
  }
  host.noteRegistration(fmt::format("GeoJSON {} {}", file.first, file.second),
                        [files, file] { files->known.erase(file); });
  files->tell();
  return none({});
}

ScriptResult remove(Host& host, GeoJsonFiles& files, Arguments arguments) {
  const auto found = globe(host, arguments[0]);
  const auto identifier = identifierOf(arguments[1], "identifier");
  if (!found || !identifier) {
    return tl::make_unexpected(found ? identifier.error() : found.error());
  }
  if (files.known.erase({*arguments[0].string(), *identifier}) == 0) {
    return failure(fmt::format("{} has no GeoJSON \"{}\"", *arguments[0].string(), *identifier));
  }
  return none({});
}

}  // namespace

std::vector<ScriptFunction> geoJsonFunctions(Host& host) {
  const auto files = std::make_shared<GeoJsonFiles>();
  return {{"addGeoJson", "globe, table", "Keeps a GeoJSON file for a globe; it is not drawn", 2, 2,
           [&host, files](Arguments a) { return add(host, files, a); }},
          {"deleteGeoJson", "globe, identifier or table", "Forgets a GeoJSON file", 2, 2,
           [&host, files](Arguments a) { return remove(host, *files, a); }},
          {"addGeoJsonFromFile", "file, name?", "Accepted; the file is not drawn", 1, 2,
           [files](Arguments a) -> ScriptResult {
             files->tell();
             return text(a[0], "file").map([](const std::string&) { return std::vector<Value>{}; });
           }}};
}

}  // namespace meridian::globebrowsing

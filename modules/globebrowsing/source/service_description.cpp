#include "globebrowsing/source/service_description.h"

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "globebrowsing/source/capabilities_parts.h"
#include "globebrowsing/source/gdal_wms.h"
#include "globebrowsing/source/map_crs.h"
#include "globebrowsing/source/service_text.h"
#include "globebrowsing/source/tile_pyramid.h"
#include "globebrowsing/source/url_template.h"
#include "globebrowsing/source/vrt_wrapper.h"
#include "globebrowsing/source/xml_document.h"

namespace meridian::globebrowsing {

namespace {

constexpr std::size_t largestDescription = std::size_t{4} << 20;
constexpr int deepestNesting = 4;  ///< VRTs that wrap VRTs

bool isDocument(std::string_view text) {
  const std::string_view begin = trimmed(text.starts_with("\xEF\xBB\xBF") ? text.substr(3) : text);
  return begin.starts_with('<');
}

/// The name of the first element in the beginning of a document, without its prefix; empty where that is no XML.
std::string_view rootName(std::string_view head) {
  while (true) {
    head = trimmed(head);
    if (!head.starts_with('<')) {
      return {};
    }
    std::string_view end = ">";
    if (head.starts_with("<!--")) {
      end = "-->";
    } else if (head.starts_with("<!") && head.find('[') < head.find('>')) {
      end = "]>";
    } else if (!head.starts_with("<?") && !head.starts_with("<!")) {
      const std::string_view name = head.substr(1, head.find_first_of(" \t\r\n/>") - 1);
      return name.substr(name.find(':') + 1);
    }
    const std::size_t at = head.find(end);
    if (at == std::string_view::npos) {
      return {};
    }
    head.remove_prefix(at + end.size());
  }
}

/// The name of the root element of a file of any size; empty where it is no XML.
std::string rootNameIn(const std::string& path) {
  std::error_code code;
  if (!std::filesystem::is_regular_file(path, code)) {
    return {};
  }
  std::ifstream file(path, std::ios::binary);
  std::string head(16384, '\0');
  file.read(head.data(), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<std::size_t>(file.gcount()));
  if (head.starts_with("\xFF\xFE") || head.starts_with("\xFE\xFF")) {  // UTF-16; the names are ASCII
    head.erase(0, 2);
    std::erase(head, '\0');
  }
  return std::string(rootName(head.starts_with("\xEF\xBB\xBF") ? std::string_view(head).substr(3) : head));
}

/// The text of a small file that begins as XML does; nothing for any other.
std::optional<std::string> documentIn(const std::string& path) {
  std::error_code code;
  if (!std::filesystem::is_regular_file(path, code) || std::filesystem::file_size(path, code) > largestDescription) {
    return std::nullopt;
  }
  std::ifstream file(path, std::ios::binary);
  std::string head(256, '\0');
  file.read(head.data(), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<std::size_t>(file.gcount()));
  if (!isDocument(head)) {
    return std::nullopt;
  }
  file.clear();
  file.seekg(0);
  return std::string(std::istreambuf_iterator<char>(file), {});
}

struct Source {
  std::string filePath;
  std::string where;
  int nesting = 0;
  TileSettings settings{};
};

Result<ServiceDescription> describe(const Source& source);

/// Whether a VRT shows all of the document that it wraps where it is, and as it is, so that the capabilities which that
/// names may count in its place. What they will say of the place is not known yet; a <GDAL_WMS> has a window besides.
bool showsAllAsItIs(const VrtWrapper& wrapper, const std::string& path) {
  if (wrapper.noData || wrapper.makesAlpha || wrapper.scale || wrapper.offset || wrapper.isPart) {
    return false;
  }
  const std::optional<std::string> document = isDocument(path) ? path : documentIn(path);
  const auto window = document ? readGdalWms(*document, path) : Result<GdalDescription>();
  if (!window || !window->service) {
    return true;
  }
  const std::optional<TileService> shown = wrapped(wrapper, *window->service);
  return shown && shown->east == window->service->east && shown->south == window->service->south;
}

Result<ServiceDescription> describeVrt(const std::string& content, const Source& source, const std::string& folder) {
  auto read = readVrtWrapper(content, source.where);
  if (!read) {
    return tl::make_unexpected(std::move(read.error()));
  }
  ServiceDescription result;
  result.reason = std::move(read->reason);
  if (!read->wrapper) {
    return result;
  }
  const VrtWrapper& wrapper = *read->wrapper;
  const std::string& inner = wrapper.source;
  const bool isFile = !isDocument(inner) && inner.find(':') == std::string::npos;
  const std::string path =
      isFile && wrapper.isRelative ? (std::filesystem::path(folder) / inner).lexically_normal().string() : inner;
  auto described = describe({path, isFile ? path : source.where, source.nesting + 1, source.settings});
  if (described && described->reference && !showsAllAsItIs(wrapper, path)) {
    result.reason = "the VRT says of a layer of capabilities what its values mean or where it is";
    return result;
  }
  if (!described || !described->service) {
    return described;
  }
  result.service = wrapped(wrapper, std::move(*described->service));
  if (result.service) {
    result.notes = std::move(described->notes);
  } else {
    result.reason = "the VRT shows its service elsewhere than it is";
  }
  return result;
}

Result<ServiceDescription> describeWmtsDocument(const XmlDocument& document) {
  CapabilitiesReference reference;
  reference.kind = CapabilitiesKind::Wmts;
  const pugi::xml_node root = document.root();
  reference.url = repairedUrl(text(root, "GetCapabilitiesUrl"));
  if (reference.url.empty()) {
    return failure("the description has no GetCapabilitiesUrl", document.placeOf(root));
  }
  for (const pugi::xml_node& entry : root.children()) {
    choose(reference, localName(entry), text(entry));
  }
  ServiceDescription result;
  result.reference = std::move(reference);
  return result;
}

/// The server's word counts for all that the document says besides: it is there for programs that read no capabilities.
CapabilitiesReference referenceOfMaps(const pugi::xml_node& root) {
  const pugi::xml_node service = child(root, "Service");
  // GDAL puts them into its addresses as they stand, so that they are written as addresses have them.
  const auto name = [&](std::string_view element) { return percentDecoded(text(service, element)); };
  CapabilitiesReference reference;
  reference.kind = CapabilitiesKind::Wms;
  reference.url = repairedUrl(text(root, "GetCapabilitiesUrl"));
  reference.layer = name("Layers");
  reference.choices.style = name("Styles");
  reference.choices.format = name("ImageFormat");
  reference.choices.crs = name("CRS").empty() ? name("SRS") : name("CRS");
  reference.choices.isTransparent = boolean(text(service, "Transparent")).value_or(false);
  const std::string server = text(service, "ServerUrl");
  const std::size_t query = std::min(server.find('?'), server.size());
  for (const std::string& part : split(server.substr(std::min(query + 1, server.size())), "&")) {
    const std::size_t equals = std::min(part.find('='), part.size());
    const std::string parameter = percentDecoded(part.substr(0, equals));
    const std::string value = percentDecoded(part.substr(std::min(equals + 1, part.size())));
    if (parameter.empty() || isGetMapParameter(parameter)) {
      continue;
    }
    if (equalIgnoringCase(parameter, "time")) {
      reference.choices.time = value;
    } else {
      reference.choices.parameters.emplace_back(parameter, value);
    }
  }
  return reference;
}

/// A TiledWMS is known by its patterns, which the server tells. Nothing where the document brings the server's answer
/// along, changes other places of the patterns than the time, or has something to be sent along: that is GDAL's.
std::optional<CapabilitiesReference> referenceOfPatterns(const pugi::xml_node& root) {
  const pugi::xml_node service = child(root, "Service");
  if (!equalIgnoringCase(attribute(service, "name"), "TiledWMS") || child(service, "Configuration") ||
      text(service, "ServerUrl").empty()) {
    return std::nullopt;
  }
  for (const char* sent : {"UserPwd", "Referer", "Accept", "UserAgent"}) {
    if (!text(root, sent).empty()) {
      return std::nullopt;
    }
  }
  CapabilitiesReference reference;
  reference.kind = CapabilitiesKind::TiledWms;
  reference.url = withParameters(repairedUrl(text(service, "ServerUrl")), {{"request", "GetTileService"}});
  reference.layer = text(service, "TiledGroupName");
  for (const pugi::xml_node& change : children(service, "Change")) {
    if (!equalIgnoringCase(attribute(change, "key"), "${time}")) {
      return std::nullopt;
    }
    reference.choices.time = text(change);
  }
  return reference;
}

Result<ServiceDescription> describeDocument(const std::string& content, const Source& source,
                                            const std::string& folder) {
  auto document = XmlDocument::parse(content, source.where);
  if (!document) {
    return tl::make_unexpected(std::move(document.error()));
  }
  const pugi::xml_node root = document->root();
  ServiceDescription result;
  if (isNamed(root, "GDAL_WMS") && !text(root, "GetCapabilitiesUrl").empty()) {
    result.reference = referenceOfMaps(root);
    return result;
  }
  if (isNamed(root, "GDAL_WMS")) {
    result.reference = referenceOfPatterns(root);
    if (result.reference) {
      return result;
    }
    auto read = readGdalWms(content, source.where);
    if (!read) {
      return tl::make_unexpected(std::move(read.error()));
    }
    result.service = std::move(read->service);
    result.reason = std::move(read->reason);
    result.notes = std::move(read->notes);
    return result;
  }
  if (isNamed(root, "GDAL_WMTS")) {
    return describeWmtsDocument(*document);
  }
  if (isNamed(root, "VRTDataset") && source.nesting < deepestNesting) {
    return describeVrt(content, source, folder);
  }
  result.reason = "a <" + std::string(localName(root)) + "> is no description of a service";
  return result;
}

/// A GetMap request tells the layer, the CRS and the extent, and that is all it takes.
Result<ServiceDescription> describeGetMap(const std::string& url, const std::string& where) {
  const auto parameter = [&](std::string_view name) { return percentDecoded(parameterOf(url, name).value_or("")); };
  ServiceDescription result;
  const std::string layers = parameter("layers");
  if (layers.empty()) {
    result.reason = "the address names no LAYERS";
    return result;
  }
  const std::string version = parameter("version").empty() ? "1.1.1" : parameter("version");
  Capabilities capabilities;
  capabilities.version = version;
  capabilities.url = where;
  capabilities.mapAddress = url;
  CapabilitiesLayer layer;
  layer.identifier = layers;
  layer.title = layer.identifier;
  std::string crs = parameter("crs").empty() ? parameter("srs") : parameter("crs");
  crs = crs.empty() ? "EPSG:4326" : crs;
  layer.crs = CrsNames({crs});
  if (const std::string format = parameter("format"); !format.empty()) {
    layer.formats = {format};
  }
  const std::vector<std::string> box = split(parameter("bbox"), ",");
  const auto known = MapCrs::of(crs, where);
  if (!known) {
    return tl::make_unexpected(known.error());
  }
  if (box.size() == 4) {
    const bool isTurned = isWmsThree(version) && known->isNorthingFirst();
    const auto side = [&](std::size_t i) { return number(box[i]).value_or(0.0); };
    const Extent extent{side(0), side(1), side(2), side(3)};
    layer.boundingBoxes = {{crs, extent}};
    layer.extent = extentOfBox(*known, isTurned ? axesExchanged(extent) : extent);
  }
  LayerChoices choices;
  choices.isTransparent = boolean(parameter("transparent")).value_or(false);
  if (const std::string style = parameter("styles"); !style.empty()) {
    layer.styles = {{style}};
    choices.style = style;
  }
  auto service = meridian::globebrowsing::serviceOf(capabilities, layer, choices);
  if (!service) {
    return tl::make_unexpected(std::move(service.error()));
  }
  result.service = std::move(*service);
  return result;
}

Result<ServiceDescription> describe(const Source& source) {
  const std::string& text = source.filePath;
  if (isDocument(text)) {
    return describeDocument(text, source, {});
  }
  ServiceDescription result;
  if ((result.reference = readReference(text))) {
    return result;
  }
  if (lowerCase(text.substr(0, 4)) == "wms:" && containsIgnoringCase(text, "layers=")) {
    return describeGetMap(repairedUrl(std::string_view(text).substr(4)), source.where);
  }
  if (isUrlTemplate(text)) {
    auto service = meridian::globebrowsing::serviceOf(templateOf(text, source.where, source.settings));
    if (!service) {
      return tl::make_unexpected(std::move(service.error()));
    }
    result.service = std::move(*service);
    return result;
  }
  if (isCapabilitiesRoot(rootNameIn(text))) {
    result.reference = CapabilitiesReference{text};
    return result;
  }
  if (const std::optional<std::string> content = documentIn(text)) {
    return describeDocument(*content, {text, text, source.nesting, source.settings},
                            std::filesystem::path(text).parent_path().string());
  }
  result.reason = "it is no description of a map service";
  return result;
}

}  // namespace

Result<ServiceDescription> describeService(const std::string& filePath, const std::string& where,
                                           const TileSettings& settings) {
  return describe({filePath, where, 0, settings});
}

bool mayHaveTimes(const std::string& filePath) {
  std::optional<CapabilitiesReference> reference;
  if (!isDocument(filePath)) {
    reference = readReference(filePath);
  } else if (containsIgnoringCase(filePath, "GetCapabilitiesUrl")) {
    Result<ServiceDescription> described = describeService(filePath, {});
    reference = described ? std::move(described->reference) : std::nullopt;
  }
  const bool isOfTimes =
      reference && (reference->kind == CapabilitiesKind::Wms || reference->kind == CapabilitiesKind::Wmts);
  return isOfTimes && reference->choices.time.empty();
}

}  // namespace meridian::globebrowsing

#include "globebrowsing/source/gdal_network.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <memory>
#include <mutex>
#include <set>
#include <string_view>

#include <cpl_conv.h>
#include <cpl_http.h>
#include <cpl_string.h>
#include <cpl_vsi.h>
#include <fmt/format.h>

#include "globebrowsing/source/service_text.h"
#include "globebrowsing/source/xml_document.h"
#include "host/api/log.h"

namespace meridian::globebrowsing {

namespace {

constexpr vsi_l_offset largestDescription = XmlDocument::Limits{}.bytes;
constexpr int deepestNesting = 8;  ///< VRTs that show VRTs
constexpr std::array<std::string_view, 5> descriptionEndings{".vrt", ".xml", ".wms", ".mrf", ".wmts"};

std::atomic<bool> offline{false};

/// One option after the other, but those that the user has set.
class Configuration {
 public:
  /// An empty value: as if it had never been set.
  void set(const char* name, const std::string& value) {
    if (!ours_.contains(name)) {
      if (CPLGetConfigOption(name, nullptr) != nullptr) {
        return;
      }
      ours_.insert(name);
    }
    CPLSetConfigOption(name, value.empty() ? nullptr : value.c_str());
  }

  /// That no file is looked for on a server: none has this name. Here the user's own value has to wait.
  void setOffline(bool isOffline) {
    constexpr const char* name = "CPL_VSIL_CURL_ALLOWED_FILENAME";
    if (isOffline && !users_) {
      users_ = CPLGetConfigOption(name, "");
      CPLSetConfigOption(name, "none");
    } else if (!isOffline && users_) {
      CPLSetConfigOption(name, users_->empty() ? nullptr : users_->c_str());
      users_.reset();
    }
  }

 private:
  std::set<std::string> ours_;
  std::optional<std::string> users_;  ///< while we are offline
};

/// What GDAL asks through its function for whole documents is answered here while it is offline.
CPLHTTPResult* refuseOffline(const char* /*url*/, CSLConstList options, GDALProgressFunc, void*, CPLHTTPFetchWriteFunc,
                             void*, void*) {
  if (!offline || CSLFetchNameValue(options, "CLOSE_PERSISTENT") != nullptr) {
    return nullptr;
  }
  auto* result = static_cast<CPLHTTPResult*>(CPLCalloc(1, sizeof(CPLHTTPResult)));
  result->nStatus = 1;
  result->pszErrBuf = CPLStrdup("no server is asked in the cache mode cache-only");
  CPLError(CE_Failure, CPLE_AppDefined, "%s", result->pszErrBuf);
  return result;
}

std::string secondsOf(std::chrono::milliseconds time) {
  return fmt::format("{}", std::chrono::duration<double>(time).count());
}

/// Servers that GDAL's drivers know by a name of theirs, and file systems that are servers.
bool isServersName(std::string_view text) {
  constexpr std::array<std::string_view, 12> prefixes{"http://",   "https://", "ftp://", "ogcapi:", "eedai:", "eeda:",
                                                      "plmosaic:", "daas:",    "ngw:",   "wcs:",    "pg:",    "iip:"};
  constexpr std::array<std::string_view, 8> systems{"/vsicurl", "/vsis3",  "/vsigs",    "/vsiaz",
                                                    "/vsiadls", "/vsioss", "/vsiswift", "/vsiwebhdfs"};
  const std::string lower = lowerCase(text);
  return std::any_of(prefixes.begin(), prefixes.end(), [&](auto prefix) { return lower.starts_with(prefix); }) ||
         std::any_of(systems.begin(), systems.end(),
                     [&](auto name) { return lower.find(name) != std::string::npos; }) ||
         lower.find("http://") != std::string::npos || lower.find("https://") != std::string::npos;
}

std::string_view withoutMark(std::string_view text) {
  text = text.starts_with("\xEF\xBB\xBF") ? text.substr(3) : text;
  return text.substr(std::min(text.find_first_not_of(" \t\r\n"), text.size()));
}

struct CloseFile {
  void operator()(VSILFILE* file) const { VSIFCloseL(file); }
};

struct Document {
  std::string text{};  ///< empty: it is none
  bool isTooLarge = false;
};

/// A file that begins as XML does, also in an archive.
Document documentAt(const std::string& path) {
  const std::unique_ptr<VSILFILE, CloseFile> file(VSIFOpenL(path.c_str(), "rb"));
  std::string text(256, '\0');
  if (file == nullptr) {
    return {};
  }
  text.resize(VSIFReadL(text.data(), 1, text.size(), file.get()));
  if (!withoutMark(text).starts_with('<') || VSIFSeekL(file.get(), 0, SEEK_END) != 0) {
    return {};
  }
  if (VSIFTellL(file.get()) > largestDescription) {
    return {{}, true};
  }
  text.resize(static_cast<std::size_t>(VSIFTellL(file.get())));
  VSIFSeekL(file.get(), 0, SEEK_SET);
  text.resize(VSIFReadL(text.data(), 1, text.size(), file.get()));
  return {std::move(text)};
}

/// By its name. A mosaic has thousands of rasters, which are not opened before they are shown.
bool mayBeDescription(const std::string& path) {
  const std::string lower = lowerCase(path);
  return std::any_of(descriptionEndings.begin(), descriptionEndings.end(),
                     [&](std::string_view ending) { return lower.ends_with(ending); });
}

/// Goes through descriptions and what they name.
class Search {
 public:
  void look(const std::string& path, int nesting) {
    const std::string_view begin = withoutMark(path);
    if (begin.starts_with('<')) {
      lookInto(path, {}, nesting);
    } else if (isServersName(begin)) {
      note(std::string(begin));
    } else if ((nesting == 0 || mayBeDescription(path)) && seen_.insert(path).second) {
      const Document document = documentAt(path);
      if (document.isTooLarge) {
        reach_.unchecked = path;
      } else if (!document.text.empty()) {
        lookInto(document.text, path, nesting);
      }
    }
  }
  [[nodiscard]] GdalReach take() { return std::move(reach_); }

 private:
  void note(std::string server) {
    if (!reach_.server) {
      reach_.server = std::move(server);
    }
  }

  void lookInto(const std::string& document, const std::string& file, int nesting) {
    constexpr std::array<std::string_view, 6> ofServices{"GDAL_WMS", "GDAL_WMTS",      "WCS_GDAL",
                                                         "MRF_META", "TileMapService", "Capabilities"};
    const auto xml = XmlDocument::parse(std::string_view(document), file);
    if (!xml || nesting > deepestNesting) {
      return;
    }
    if (isNamed(xml->root(), "VRTDataset")) {
      lookIntoVrt(xml->root(), file, nesting);
    } else if (std::any_of(ofServices.begin(), ofServices.end(),
                           [&](std::string_view name) { return isNamed(xml->root(), name); })) {
      lookIntoService(xml->root());
    }
  }

  void lookIntoVrt(const pugi::xml_node& node, const std::string& file, int nesting) {
    for (const pugi::xml_node& inner : node.children()) {
      if (isNamed(inner, "SourceFilename") || isNamed(inner, "SourceDataset")) {
        const std::string name = text(inner);
        const bool isRelative = boolean(attribute(inner, "relativeToVRT")).value_or(false);
        const std::string folder = CPLGetPath(file.c_str());
        look(isRelative ? CPLProjectRelativeFilename(folder.c_str(), name.c_str()) : name, nesting + 1);
      } else {
        lookIntoVrt(inner, file, nesting);
      }
    }
  }

  void lookIntoService(const pugi::xml_node& node) {
    if (isNamed(node, "UnsafeSSL")) {
      reach_.isUnverified = reach_.isUnverified || boolean(text(node)).value_or(false);
    }
    if (const std::string own = text(node); isServersName(own)) {
      note(own);
    }
    for (const pugi::xml_attribute& attribute : node.attributes()) {
      const std::string_view name = attribute.name();
      if (!name.starts_with("xmlns") && !name.ends_with("schemaLocation") && isServersName(attribute.value())) {
        note(attribute.value());
      }
    }
    for (const pugi::xml_node& inner : node.children()) {
      lookIntoService(inner);
    }
  }

  GdalReach reach_;
  std::set<std::string> seen_;  ///< files
};

}  // namespace

void setGdalNetwork(const NetworkOptions& options) {
  static std::mutex mutex;
  static Configuration configuration;
  const std::lock_guard lock(mutex);
  const TransferLimits& limits = options.limits;
  configuration.set("GDAL_HTTP_USERAGENT", userAgentOf(options));
  configuration.set("GDAL_HTTP_CONNECTTIMEOUT", secondsOf(limits.connectTime));
  configuration.set("GDAL_HTTP_TIMEOUT", secondsOf(limits.totalTime));
  configuration.set("GDAL_HTTP_LOW_SPEED_TIME", fmt::format("{}", limits.stallTime.count()));
  configuration.set("GDAL_HTTP_LOW_SPEED_LIMIT", fmt::format("{}", limits.minimumSpeed));
  configuration.set("GDAL_CURL_CA_BUNDLE", options.certificateFile.string());
  if (static bool isTold = false; !isTold && CPLTestBool(CPLGetConfigOption("GDAL_HTTP_UNSAFESSL", "NO"))) {
    isTold = true;
    log::warning(
        "GDAL_HTTP_UNSAFESSL is not heeded: certificates are always verified; name your own in MERIDIAN_CA_FILE");
  }
  CPLSetConfigOption("GDAL_HTTP_UNSAFESSL", "NO");
  offline = options.cache.mode == CacheMode::CacheOnly;
  configuration.setOffline(offline);
  static std::once_flag once;
  std::call_once(once, [] { CPLHTTPSetFetchCallback(refuseOffline, nullptr); });
}

bool isGdalOffline() {
  return offline;
}

GdalReach gdalReach(const std::string& path) {
  Search search;
  search.look(path, 0);
  return search.take();
}

std::string withVerifiedCertificates(const std::string& path) {
  const bool isInline = withoutMark(path).starts_with('<');
  std::string text = isInline ? path : mayBeDescription(path) ? documentAt(path).text : std::string();
  const std::size_t begin = text.find("<UnsafeSSL>");
  constexpr std::string_view end = "</UnsafeSSL>";
  const std::size_t last = begin == std::string::npos ? begin : text.find(end, begin);
  if (last == std::string::npos || text.find("<GDAL_WMS") > begin) {
    return path;
  }
  return text.erase(begin, last + end.size() - begin);
}

Result<void> checkReach(const GdalReach& reach, const std::string& where) {
  constexpr const char* goOnline =
      "go online: unset MERIDIAN_OFFLINE, or set the property NetworkCacheMode to read-write";
  if (reach.isUnverified) {
    return failure("the description wants certificates not to be verified (UnsafeSSL)", where,
                   "remove that, and name the authority's certificates in MERIDIAN_CA_FILE");
  }
  if (reach.server && offline) {
    return failure("GDAL would ask a server (" + reach.server->substr(0, 200) +
                       "), and no server is asked in the cache mode cache-only",
                   where, goOnline);
  }
  if (reach.unchecked && offline) {
    return failure(fmt::format("'{}' has more than {} MiB and is not looked through for servers, so that it is not "
                               "known whether GDAL would ask one; none is asked in the cache mode cache-only",
                               reach.unchecked->substr(0, 200), largestDescription >> 20U),
                   where, goOnline);
  }
  return {};
}

}  // namespace meridian::globebrowsing

#include "globebrowsing/providers/temporal_document.h"

#include <algorithm>
#include <array>
#include <sstream>
#include <utility>

#include <fmt/format.h>
#include <pugixml.hpp>

#include "globebrowsing/providers/time_picture.h"

namespace meridian::globebrowsing {

namespace {

constexpr const char* rootName = "OpenSpaceTemporalGDALDataset";

/// OpenSpaceTimeIdFormat, and the picture that it stands for.
constexpr std::array<std::pair<std::string_view, std::string_view>, 5> pictures{
    {{"YYYY-MM-DD", "YYYY-MM-DD"},
     {"YYYY-MM-DDThh:mm:ssZ", "YYYY-MM-DDTHR:MN:SCZ"},
     {"YYYY-MM-DDThh_mm_ssZ", "YYYY-MM-DDTHR_MN_SCZ"},
     {"YYYYMMDD_hhmmss", "YYYYMMDD_HRMNSC"},
     {"YYYYMMDD_hhmm", "YYYYMMDD_HRMN"}}};

std::string textOf(const pugi::xml_node& root, const char* name, const char* otherwise) {
  const pugi::xml_node node = root.child(name);
  return node ? node.text().as_string(otherwise) : otherwise;
}

}  // namespace

bool isTemporalDocument(std::string_view filePath) {
  const std::size_t first = filePath.find_first_not_of(" \t\r\n");
  return first != std::string_view::npos && filePath[first] == '<' &&
         filePath.find(std::string("<") + rootName) != std::string_view::npos;
}

Result<PrototypedSeries::Description> readTemporalDocument(std::string_view text, const std::string& where) {
  pugi::xml_document document;
  const pugi::xml_parse_result parsed =
      document.load_buffer(text.data(), text.size(), pugi::parse_default | pugi::parse_trim_pcdata);
  if (!parsed) {
    return failure(fmt::format("the description is no XML: {} at character {}", parsed.description(), parsed.offset),
                   where, "mend it there");
  }
  const pugi::xml_node root = document.child(rootName);
  if (!root) {
    return failure(fmt::format("the description has no <{}>", rootName), where,
                   "write one, or use Mode, Prototyped and Folder");
  }
  const std::string format = textOf(root, "OpenSpaceTimeIdFormat", "YYYY-MM-DDThh:mm:ssZ");
  const auto picture =
      std::find_if(pictures.begin(), pictures.end(), [&](const auto& one) { return one.first == format; });
  if (picture == pictures.end()) {
    std::string known;
    for (const auto& [name, meaning] : pictures) {
      known.append(known.empty() ? "" : ", ").append(name);
    }
    return failure(fmt::format("unknown OpenSpaceTimeIdFormat \"{}\"", format), where, "use one of: " + known);
  }
  std::string prototype = textOf(root, "FilePath", "");
  if (const pugi::xml_node service = root.child("GDAL_WMS")) {
    std::ostringstream written;
    service.print(written, "", pugi::format_raw);
    prototype = written.str();
  }
  if (prototype.empty()) {
    return failure("the description has neither <GDAL_WMS> nor <FilePath>", where, "say where the data are");
  }
  return PrototypedSeries::Description{
      textOf(root, "OpenSpaceTimeStart", "2000-01-01"), textOf(root, "OpenSpaceTimeEnd", "Today"),
      textOf(root, "OpenSpaceTimeResolution", "2d"), std::string(picture->second), std::move(prototype)};
}

}  // namespace meridian::globebrowsing

#include <map>
#include <regex>
#include <set>

#include <cpl_minixml.h>
#include <cpl_string.h>

#include "globebrowsing/source/capabilities.h"
#include "globebrowsing/source/service_text.h"
#include "service_fixture.h"

namespace meridian::globebrowsing {
namespace {

using namespace test;

/// GDAL's own list of a document's layers: the identifiers in the names of its subdatasets.
std::set<std::string> layersByGdal(const std::string& path, const std::string& pattern) {
  const GDALDatasetUniquePtr dataset = openWithGdal(path);
  std::set<std::string> names;
  char** list = dataset ? dataset->GetMetadata("SUBDATASETS") : nullptr;
  for (int i = 0; list != nullptr && list[i] != nullptr; ++i) {
    std::smatch match;
    const std::string entry = list[i];
    if (std::regex_search(entry, match, std::regex(pattern))) {
      names.insert(match[1]);
    }
  }
  return names;
}

TEST(RealCapabilitiesByGdal, HaveTheSameWmtsLayers) {
  for (const char* file : {"wmts_copernicus_marine_time_PT1H.xml", "wmts_eox_maps.xml", "wmts_pdok_nl.xml",
                           "wmts_nasa_gibs_epsg4326_2017.xml"}) {
    SCOPED_TRACE(file);
    const std::string path = sharedData("capabilities/" + std::string(file));
    MERIDIAN_NEEDS(path);
    std::set<std::string> ours;
    for (const CapabilitiesLayer& layer : realCapabilities(file).layers) {
      ours.insert(layer.identifier);
    }
    std::set<std::string> theirs = layersByGdal(path, "_NAME=WMTS:.*layer=\"?([^,\"]*)");
    for (const std::string& name : theirs) {
      EXPECT_TRUE(ours.contains(name)) << name;
    }
    EXPECT_GE(theirs.size() + 1, ours.size());
  }
}

/// GDAL's WMTS driver lays its own raster over a set; pixels and the grid's corner must be where ours are.
TEST(RealCapabilitiesByGdal, HaveTheSamePixels) {
  struct Case {
    const char* file;
    const char* layer;
    const char* set;
  };
  for (const Case& test :
       {Case{"wmts_eox_maps.xml", "bluemarble", "WGS84"},
        {"wmts_eox_maps.xml", "bluemarble_3857", "g"},
        {"wmts_pdok_nl.xml", "brtachtergrondkaart", "EPSG:28992"},
        {"wmts_pdok_nl.xml", "brtachtergrondkaart", "EPSG:3857"},
        {"wmts_ign_one_layer.xml", "ORTHOIMAGERY.ORTHOPHOTOS", "PM"},
        {"wmts_esri_arcgisonline_demographics.xml", "Demographics_USA_Population_Density", "GoogleMapsCompatible"},
        {"wmts_nasa_gibs_epsg4326_2017.xml", "MODIS_Terra_CorrectedReflectance_TrueColor", "250m"}}) {
    SCOPED_TRACE(std::string(test.file) + " " + test.layer + " " + test.set);
    const std::string path = sharedData("capabilities/" + std::string(test.file));
    MERIDIAN_NEEDS(path);
    const Capabilities capabilities = realCapabilities(test.file);
    if (capabilities.find(test.layer) == nullptr) {
      ADD_FAILURE() << "no such layer";
      continue;
    }
    LayerChoices choices;
    choices.matrixSet = test.set;
    const TileService service = serviceOfLayer(capabilities, test.layer, choices);
    const GDALDatasetUniquePtr dataset =
        openWithGdal("WMTS:" + path + ",layer=" + test.layer + ",tilematrixset=\"" + test.set + "\"");
    ASSERT_TRUE(dataset);
    std::array<double, 6> transform{};
    ASSERT_EQ(dataset->GetGeoTransform(transform.data()), CE_None);
    ASSERT_FALSE(service.matrices.empty());
    const TileMatrix& finest = service.matrices.front();
    // GDAL may begin at a coarser matrix.
    const double levels = std::log2(transform[1] / finest.pixelWidth);
    EXPECT_NEAR(levels, std::round(levels), 1e-8);
    // A whole number of pixels lies between the two origins.
    const double columns = (transform[0] - finest.left) / transform[1];
    EXPECT_NEAR(columns, std::round(columns), 1e-3);
  }
}

// ---- The ledger: what a document, read by GDAL's XML parser, allows.

const char* textAt(const CPLXMLNode* node, const char* path) {
  return CPLGetXMLValue(node, path, "");
}

std::vector<const CPLXMLNode*> all(const CPLXMLNode* node, const std::string& name) {
  std::vector<const CPLXMLNode*> found;
  for (const CPLXMLNode* entry = node == nullptr ? nullptr : node->psChild; entry != nullptr; entry = entry->psNext) {
    if (entry->eType == CXT_Element && name == entry->pszValue) {
      found.push_back(entry);
    }
  }
  return found;
}

struct AllowedMatrix {
  long long firstRow = 0;
  long long lastRow = 0;
  long long firstColumn = 0;
  long long lastColumn = 0;
};

/// Of a layer of a WMTS: by set and matrix, what may be asked for.
std::map<std::pair<std::string, std::string>, AllowedMatrix> allowedTiles(const CPLXMLNode* contents,
                                                                          const CPLXMLNode* layer) {
  std::map<std::pair<std::string, std::string>, AllowedMatrix> allowed;
  for (const CPLXMLNode* link : all(layer, "TileMatrixSetLink")) {
    const std::string set = textAt(link, "TileMatrixSet");
    const CPLXMLNode* limits = CPLGetXMLNode(const_cast<CPLXMLNode*>(link), "TileMatrixSetLimits");
    for (const CPLXMLNode* candidate : all(contents, "TileMatrixSet")) {
      if (set != textAt(candidate, "Identifier")) {
        continue;
      }
      for (const CPLXMLNode* matrix : all(candidate, "TileMatrix")) {
        AllowedMatrix tiles{0, std::lround(std::stod(textAt(matrix, "MatrixHeight"))) - 1, 0,
                            std::lround(std::stod(textAt(matrix, "MatrixWidth"))) - 1};
        bool isLimited = limits == nullptr;
        for (const CPLXMLNode* limit : all(limits, "TileMatrixLimits")) {
          const std::string name = textAt(limit, "TileMatrix");
          if (name == textAt(matrix, "Identifier") || name == set + ":" + textAt(matrix, "Identifier")) {
            tiles = {std::stoll(textAt(limit, "MinTileRow")), std::stoll(textAt(limit, "MaxTileRow")),
                     std::stoll(textAt(limit, "MinTileCol")), std::stoll(textAt(limit, "MaxTileCol"))};
            isLimited = true;
          }
        }
        if (isLimited) {
          allowed[{set, textAt(matrix, "Identifier")}] = tiles;
        }
      }
    }
  }
  return allowed;
}

/// The parts of an address by a template's names.
std::map<std::string, std::string> match(const std::string& address, const std::string& pattern) {
  std::vector<std::string> names;
  std::string expression;
  for (std::size_t at = 0; at < pattern.size(); ++at) {
    if (pattern[at] == '{') {
      const std::size_t close = pattern.find('}', at);
      names.push_back(pattern.substr(at + 1, close - at - 1));
      expression += "([^/?&]*)";
      at = close;
    } else {
      expression +=
          (std::isalnum(static_cast<unsigned char>(pattern[at])) != 0 ? "" : "\\") + std::string(1, pattern[at]);
    }
  }
  std::smatch found;
  std::map<std::string, std::string> parts;
  if (std::regex_match(address, found, std::regex(expression))) {
    for (std::size_t i = 0; i < names.size(); ++i) {
      parts[names[i]] = found[i + 1];
    }
  }
  return parts;
}

std::map<std::string, std::string> tileOf(const std::string& address, const CPLXMLNode* layer) {
  for (const CPLXMLNode* resource : all(layer, "ResourceURL")) {
    auto parts = match(address, textAt(resource, "template"));
    if (!parts.empty()) {
      return parts;
    }
  }
  const auto value = [&](const char* name) {
    char* plain = CPLUnescapeString(parameterOf(address, name).value_or("missing").c_str(), nullptr, CPLES_URL);
    const std::string result = plain;
    CPLFree(plain);
    return result;
  };
  EXPECT_EQ(value("layer"), textAt(layer, "Identifier"));
  return {{"TileMatrixSet", value("tilematrixset")},
          {"TileMatrix", value("tilematrix")},
          {"TileRow", value("tilerow")},
          {"TileCol", value("tilecol")},
          {"Style", value("style")}};
}

TEST(Ledger, NoTileIsAskedForThatTheWmtsForbids) {
  std::size_t requests = 0;
  for (const char* file :
       {"wmts_copernicus_marine_time_PT1H.xml", "wmts_eox_maps.xml", "wmts_esri_arcgisonline_demographics.xml",
        "wmts_ign_one_layer.xml", "wmts_miramon_time_months.xml", "wmts_nasa_gibs_epsg4326_2017.xml",
        "wmts_nasa_trek_mars_themis.xml", "wmts_ogc_sample.xml", "wmts_pdok_nl.xml"}) {
    const std::string path = sharedData("capabilities/" + std::string(file));
    MERIDIAN_NEEDS(path);
    const Capabilities capabilities = realCapabilities(file);
    CPLXMLTreeCloser tree(CPLParseXMLFile(path.c_str()));
    CPLStripXMLNamespace(tree.get(), nullptr, TRUE);
    const CPLXMLNode* contents = CPLGetXMLNode(tree.get(), "=Capabilities.Contents");
    const std::vector<const CPLXMLNode*> nodes = all(contents, "Layer");
    for (std::size_t i = 0; i<nodes.size(); i += nodes.size()> 100 ? 10 : 1) {
      const CPLXMLNode* node = nodes[i];
      const CapabilitiesLayer* layer = capabilities.find(textAt(node, "Identifier"));
      ASSERT_NE(layer, nullptr);
      const auto allowed = allowedTiles(contents, node);
      for (const MatrixSetLink& link : layer->matrixSets) {
        LayerChoices choices;
        choices.matrixSet = capabilities.matrixSets[link.set].identifier;
        const auto service = serviceOf(capabilities, *layer, choices);
        if (!service) {
          continue;
        }
        for (const TileAddress& address : cornersOf(*service)) {
          const std::string url = service->url(address);
          EXPECT_EQ(url.find_first_of("{} "), std::string::npos) << url;
          auto parts = tileOf(url, node);
          if (parts.count("TileMatrixSet") == 0) {  // a template may name its set outright
            parts["TileMatrixSet"] = choices.matrixSet;
          }
          const auto found = allowed.find({parts["TileMatrixSet"], parts["TileMatrix"]});
          ASSERT_NE(found, allowed.end()) << url << " of " << layer->identifier;
          const long long row = std::stoll(parts["TileRow"]);
          const long long column = std::stoll(parts["TileCol"]);
          EXPECT_TRUE(row >= found->second.firstRow && row <= found->second.lastRow &&
                      column >= found->second.firstColumn && column <= found->second.lastColumn)
              << url;
          ++requests;
        }
      }
    }
  }
  EXPECT_GT(requests, 2000U);
}

// ---- What services write.

TEST(Wmts, StylesFormatsAndDimensionsFillTheAddress) {
  const Capabilities capabilities = realCapabilities("wmts_nasa_gibs_epsg4326_2017.xml");
  if (capabilities.layers.empty()) {
    GTEST_SKIP() << "NOT TESTED: no shared data; set MERIDIAN_SHARED_DATA";
  }
  LayerChoices choices;
  choices.time = "2016-02-03";
  const TileService service = serviceOfLayer(capabilities, "MODIS_Terra_CorrectedReflectance_TrueColor", choices);
  EXPECT_EQ(service.url({0, 3, 5}),
            "https://gibs.earthdata.nasa.gov/wmts/epsg4326/best/MODIS_Terra_CorrectedReflectance_TrueColor/default/"
            "2016-02-03/250m/8/5/3.jpeg");
  EXPECT_NEAR(service.matrices.back().pixelWidth, 0.5625, 1e-12);
  EXPECT_EQ(service.matrices.back().lastColumn, 1);
}

TEST(Wmts, RelativeAddressesAreSeenFromTheDocument) {
  for (const char* address :
       {"../tiles/{TileMatrix}/{TileRow}/{TileCol}.png", "/a/x/../b/../tiles/./{TileMatrix}/{TileRow}/{TileCol}.png",
        "tiles/../../tiles/{TileMatrix}/{TileRow}/{TileCol}.png"}) {
    const auto capabilities = parse(
        "<Capabilities><Contents><Layer><Identifier>a</Identifier><TileMatrixSetLink><TileMatrixSet>s</TileMatrixSet>"
        "</TileMatrixSetLink><ResourceURL resourceType=\"tile\" format=\"image/png\" template=\"" +
            std::string(address) +
            "\"/></Layer><TileMatrixSet><Identifier>s</Identifier><SupportedCRS>EPSG:4326</SupportedCRS><TileMatrix>"
            "<Identifier>0</Identifier><ScaleDenominator>279541132.0143589</ScaleDenominator><TopLeftCorner>90 -180"
            "</TopLeftCorner><TileWidth>256</TileWidth><TileHeight>256</TileHeight><MatrixWidth>2</MatrixWidth>"
            "<MatrixHeight>1</MatrixHeight></TileMatrix></TileMatrixSet></Contents></Capabilities>",
        "http://h/a/1.0.0/WMTSCapabilities.xml");
    ASSERT_TRUE(capabilities) << capabilities.error().message();
    EXPECT_EQ(serviceOfLayer(*capabilities, "a").url({0, 1, 0}), "http://h/a/tiles/0/0/1.png") << address;
  }
}

TEST(Wmts, GibsSetsAreThoseOfAllProjections) {
  const Capabilities sets = realCapabilities("gibs_tilematrixsets_all_projections.xml");
  if (sets.matrixSets.empty()) {
    GTEST_SKIP() << "NOT TESTED: no shared data; set MERIDIAN_SHARED_DATA";
  }
  std::map<std::string, int> count;
  for (const MatrixSet& set : sets.matrixSets) {
    EXPECT_EQ(set.problem, "") << set.identifier;
    ++count[canonicalCrsName(set.crs)];
    if (canonicalCrsName(set.crs) == "EPSG:3031" || canonicalCrsName(set.crs) == "EPSG:3413") {
      EXPECT_LT(set.matrices.front().left, -4e6) << set.identifier;
      EXPECT_GT(set.matrices.front().top, 4e6) << set.identifier;
    }
  }
  EXPECT_GT(count["EPSG:3031"], 0);
  EXPECT_GT(count["EPSG:3413"], 0);
  EXPECT_GT(count["EPSG:3857"], 0);
}

TEST(Wmts, MarsIsOneTurnWhateverTheDegreeWas) {
  const Capabilities capabilities = realCapabilities("wmts_nasa_trek_mars_themis.xml");
  if (capabilities.layers.empty()) {
    GTEST_SKIP() << "NOT TESTED: no shared data; set MERIDIAN_SHARED_DATA";
  }
  const TileService service = serviceOfLayer(capabilities, capabilities.layers[0].identifier);
  EXPECT_EQ(service.crs, "");
  EXPECT_DOUBLE_EQ(service.matrices.back().pixelWidth, 180.0 / 256);
  EXPECT_DOUBLE_EQ(service.matrices.back().top, 90.0);
}

}  // namespace
}  // namespace meridian::globebrowsing

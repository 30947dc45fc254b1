#include "globebrowsing/source/capabilities.h"

#include <map>
#include <random>
#include <regex>
#include <set>

#include <cpl_minixml.h>
#include <cpl_string.h>

#include "globebrowsing/source/service_text.h"
#include "globebrowsing/source/time_dimension.h"
#include "service_fixture.h"

namespace meridian::globebrowsing {
namespace {

using namespace test;

TileService serviceOfLayer(const Capabilities& capabilities, const std::string& layer,
                           const LayerChoices& choices = {}) {
  const CapabilitiesLayer* found = capabilities.find(layer);
  EXPECT_NE(found, nullptr) << layer;
  if (found == nullptr) {
    return {};
  }
  auto service = serviceOf(capabilities, *found, choices);
  EXPECT_TRUE(service) << (service ? "" : service.error().message());
  return service ? std::move(*service) : TileService{};
}

struct Document {
  const char* file;
  CapabilitiesKind kind;
  const char* version;
  std::size_t layers;  ///< elements Layer (TMS, ArcGIS: one), counted by Python's ElementTree
  std::size_t usable;  ///< with a name, and not otherwise impossible
};

class RealCapabilities : public testing::TestWithParam<Document> {};

TEST_P(RealCapabilities, HasItsLayers) {
  const Document& expected = GetParam();
  MERIDIAN_NEEDS(sharedData("capabilities/" + std::string(expected.file)));
  const Capabilities capabilities = realCapabilities(expected.file, "http://h/x/" + std::string(expected.file));
  EXPECT_EQ(capabilities.kind, expected.kind);
  EXPECT_EQ(capabilities.version, expected.version);
  EXPECT_EQ(capabilities.layers.size(), expected.layers);
  std::size_t usable = 0;
  for (const CapabilitiesLayer& layer : capabilities.layers) {
    if (!layer.obstacle.empty()) {
      EXPECT_FALSE(serviceOf(capabilities, layer));
      continue;
    }
    ++usable;
    EXPECT_FALSE(layer.title.empty());
    const auto service = serviceOf(capabilities, layer);
    ASSERT_TRUE(service) << service.error().message();
    EXPECT_FALSE(service->matrices.empty());
    EXPECT_LT(service->west, service->east);
    EXPECT_LT(service->south, service->north);
    for (std::size_t i = 1; i < service->matrices.size(); ++i) {
      EXPECT_GT(service->matrices[i].pixelHeight, service->matrices[i - 1].pixelHeight);
    }
  }
  EXPECT_EQ(usable, expected.usable);
}

using enum CapabilitiesKind;
INSTANTIATE_TEST_SUITE_P(SharedData, RealCapabilities,
                         testing::Values(Document{"wms111_brgm_utf16.xml", Wms, "1.1.1", 5, 5},
                                         Document{"wms111_iem_nexrad_PT5M.xml", Wms, "1.1.1", 3, 3},
                                         Document{"wms111_jpl_onearth_2010.xml", Wms, "1.1.1", 16, 15},
                                         Document{"wms111_noaa_nowcoast_forecasts.xml", Wms, "1.1.1", 278, 277},
                                         Document{"wms111_ogc_sample.xml", Wms, "1.1.1", 10, 8},
                                         Document{"wms111_terraserver.xml", Wms, "1.1.1", 4, 3},
                                         Document{"wms130_digitalearthau_timelists.xml", Wms, "1.3.0", 9, 5},
                                         Document{"wms130_esri_small.xml", Wms, "1.3.0", 2, 1},
                                         Document{"wms130_gibs_onearth.xml", Wms, "1.3.0", 19, 19},
                                         Document{"wms130_nasa_nccs_thredds_timelist.xml", Wms, "1.3.0", 9, 7},
                                         Document{"wms130_ogc_sample.xml", Wms, "1.3.0", 10, 8},
                                         Document{"wms130_usgs_nationalatlas_arcgis.xml", Wms, "1.3.0", 20, 20},
                                         Document{"time_bad_datetime.xml", Wms, "1.1.1", 2, 1},
                                         Document{"time_comma_sep_datetimes_inherited.xml", Wms, "1.3.0", 3, 1},
                                         Document{"time_period_date_notime.xml", Wms, "1.1.1", 2, 1},
                                         Document{"time_period_datetimes.xml", Wms, "1.1.1", 2, 1},
                                         Document{"time_period_datetimes_crossing_leap_second.xml", Wms, "1.1.1", 2, 1},
                                         Document{"time_period_datetimes_multiple_units.xml", Wms, "1.1.1", 2, 1},
                                         Document{"wmts_copernicus_marine_time_PT1H.xml", Wmts, "1.0.0", 5, 5},
                                         Document{"wmts_eox_maps.xml", Wmts, "1.0.0", 39, 39},
                                         Document{"wmts_esri_arcgisonline_demographics.xml", Wmts, "1.0.0", 1, 1},
                                         Document{"wmts_ign_one_layer.xml", Wmts, "1.0.0", 1, 1},
                                         Document{"wmts_miramon_time_months.xml", Wmts, "1.0.0", 1, 1},
                                         // One layer names a matrix set that is not there.
                                         Document{"wmts_nasa_gibs_epsg4326_2017.xml", Wmts, "1.0.0", 520, 519},
                                         Document{"wmts_nasa_trek_mars_themis.xml", Wmts, "1.0.0", 1, 1},
                                         Document{"wmts_ogc_sample.xml", Wmts, "1.0.0", 1, 1},
                                         Document{"wmts_pdok_nl.xml", Wmts, "1.0.0", 44, 44},
                                         Document{"gibs_tilematrixsets_all_projections.xml", Wmts, "1.0.0", 0, 0},
                                         Document{"tms_ne2_webmercator_tilemapresource.xml", Tms, "1.0.0", 1, 1},
                                         Document{"tms_ign_geopf_tilemap.xml", Tms, "1.0.0", 1, 0},  // vector tiles
                                         Document{"arcgis_mapserver_fused_cache.json", ArcGis, "10.81", 1, 1},
                                         Document{"arcgis_imageserver_tile.json", ArcGis, "10.91", 1, 1}),
                         [](const auto& tested) {
                           std::string name = tested.param.file;
                           return name.substr(0, name.find('.'));
                         });

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

std::vector<TileAddress> cornersOf(const TileService& service) {
  std::vector<TileAddress> addresses;
  for (std::size_t i = 0; i < service.matrices.size(); ++i) {
    const TileMatrix& matrix = service.matrices[i];
    addresses.push_back({i, matrix.firstColumn, matrix.firstRow});
    addresses.push_back({i, matrix.lastColumn, matrix.lastRow});
  }
  return addresses;
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

TEST(Ledger, NoMapIsAskedForThatTheWmsForbids) {
  MERIDIAN_NEEDS(sharedData("capabilities"));
  for (const auto& entry : std::filesystem::directory_iterator(sharedData("capabilities"))) {
    const std::string file = entry.path().filename().string();
    if (!file.starts_with("wms1")) {
      continue;
    }
    SCOPED_TRACE(file);
    const Capabilities capabilities = realCapabilities(file);
    for (const CapabilitiesLayer& layer : capabilities.layers) {
      for (const std::string& crs : layer.crs) {
        LayerChoices choices;
        choices.crs = crs;
        const auto service =
            layer.obstacle.empty() ? serviceOf(capabilities, layer, choices) : tl::make_unexpected(Error{});
        if (!service) {
          continue;
        }
        for (const TileAddress& address : cornersOf(*service)) {
          const std::string url = service->url(address);
          const auto value = [&](const char* name) {
            return replaceAll(parameterOf(url, name).value_or("missing"), "%20", " ");
          };
          EXPECT_EQ(url.find_first_of("{} "), std::string::npos) << url;
          EXPECT_EQ(value("version"), capabilities.version);
          EXPECT_EQ(value("request"), "GetMap");
          EXPECT_EQ(value("layers"), percentEncoded(layer.identifier));
          EXPECT_EQ(value(capabilities.version == "1.3.0" ? "crs" : "srs"), percentEncoded(crs, ":"));
          EXPECT_NE(std::find(layer.formats.begin(), layer.formats.end(), replaceAll(value("format"), "%3B", ";")),
                    layer.formats.end())
              << url;
          if (capabilities.maximumWidth > 0) {
            EXPECT_LE(std::stoi(value("width")), capabilities.maximumWidth);
          }
          const std::vector<std::string> box = split(value("bbox"), ",");
          ASSERT_EQ(box.size(), 4U);
          EXPECT_LT(*number(box[0]), *number(box[2])) << url;
          EXPECT_LT(*number(box[1]), *number(box[3])) << url;
          // The tile and the extent have points in common.
          const TileMatrix& matrix = service->matrices[address.matrix];
          const double west = matrix.left + static_cast<double>(address.column) * matrix.tileWidth * matrix.pixelWidth;
          EXPECT_LT(west, service->east);
          EXPECT_GT(west + matrix.tileWidth * matrix.pixelWidth, service->west);
        }
      }
    }
  }
}

// ---- What services write.

std::string wms(const std::string& version, const std::string& layers, const std::string& service = {}) {
  const std::string root = version == "1.3.0" ? "WMS_Capabilities" : "WMT_MS_Capabilities";
  return "<" + root + " version=\"" + version + "\"><Service><Title>T</Title>" + service +
         "</Service><Capability><Request><GetMap><Format>image/jpeg</Format><Format>image/png</Format><DCPType><HTTP>"
         "<Get><OnlineResource xlink:href=\"http://h/w?map=a&amp;\"/></Get></HTTP></DCPType></GetMap></Request>" +
         layers + "</Capability></" + root + ">";
}

const std::string worldBox =
    "<EX_GeographicBoundingBox><westBoundLongitude>-180</westBoundLongitude><eastBoundLongitude>180"
    "</eastBoundLongitude><southBoundLatitude>-90</southBoundLatitude><northBoundLatitude>90</northBoundLatitude>"
    "</EX_GeographicBoundingBox>";

TEST(Wms, AxesGoByVersionAndCrs) {
  struct Case {
    const char* version;
    const char* crs;
    const char* box;
  };
  const std::string oldBox = "<LatLonBoundingBox minx=\"-180\" miny=\"-90\" maxx=\"180\" maxy=\"90\"/>";
  for (const Case& test : {Case{"1.1.1", "EPSG:4326", "BBOX=0,-90,180,90"},
                           {"1.3.0", "EPSG:4326", "BBOX=-90,0,90,180"},
                           {"1.3.0", "CRS:84", "BBOX=0,-90,180,90"},
                           {"1.3.0", "EPSG:4258", "BBOX=-90,0,90,180"},
                           {"1.3.0", "urn:ogc:def:crs:EPSG::4326", "BBOX=-90,0,90,180"}}) {
    const std::string tag = std::string(test.version) == "1.3.0" ? "CRS" : "SRS";
    const auto capabilities = parse(wms(test.version, "<Layer><Name>a</Name><Title>A</Title><" + tag + ">" + test.crs +
                                                          "</" + tag + ">" + worldBox + oldBox + "</Layer>"));
    ASSERT_TRUE(capabilities) << capabilities.error().message();
    const TileService service = serviceOfLayer(*capabilities, "a");
    const std::string url = service.url({service.matrices.size() - 1, 1, 0});
    EXPECT_NE(url.find(test.box), std::string::npos) << url;
    EXPECT_EQ(url.substr(0, 17), "http://h/w?map=a&");
    EXPECT_EQ(service.crs, "");
  }
}

TEST(Wms, PolarMapsAreLaidOutInTheirOwnBox) {
  // EPSG:3031's axes are easting and northing; EPSG:2180's (Poland) northing first.
  const auto capabilities = parse(
      wms("1.3.0",
          "<Layer><Name>a</Name><CRS>EPSG:3031</CRS><BoundingBox CRS=\"EPSG:3031\" minx=\"-4194304\" miny=\"-4194304\" "
          "maxx=\"4194304\" maxy=\"4194304\"/></Layer><Layer><Name>b</Name><CRS>EPSG:2180</CRS><BoundingBox "
          "CRS=\"EPSG:2180\" minx=\"100000\" miny=\"200000\" maxx=\"800000\" maxy=\"860000\"/></Layer>"));
  ASSERT_TRUE(capabilities);
  const TileService polar = serviceOfLayer(*capabilities, "a");
  EXPECT_EQ(polar.crs, "EPSG:3031");
  EXPECT_NE(polar.url({polar.matrices.size() - 1, 0, 0}).find("BBOX=-4194304,-4194304,4194304,4194304"),
            std::string::npos);
  const TileService poland = serviceOfLayer(*capabilities, "b");
  EXPECT_DOUBLE_EQ(poland.west, 200000);
  EXPECT_DOUBLE_EQ(poland.north, 800000);
  EXPECT_NE(poland.url({poland.matrices.size() - 1, 0, 0}).find("BBOX=100000,200000,"), std::string::npos);
}

TEST(Wms, LayersInherit) {
  const auto capabilities = parse(wms(
      "1.1.1",
      "<Layer><Title>Root</Title><SRS>EPSG:4326 EPSG:3857</SRS><LatLonBoundingBox minx=\"-10\" miny=\"40\" maxx=\"10\" "
      "maxy=\"50\"/><Attribution><Title>Me</Title></Attribution><Style><Name>s</Name></Style>"
      "<Dimension name=\"time\" units=\"ISO8601\"/><Extent name=\"time\" default=\"2001\" "
      "nearestValue=\"1\">2000/2002/P1Y"
      "</Extent><Layer><Name>a</Name><Title>A</Title><SRS>EPSG:3031</SRS><Style><Name>t</Name></Style>"
      "<Extent name=\"time\">2005</Extent><Layer opaque=\"1\"><Name>b</Name></Layer></Layer></Layer>"));
  ASSERT_TRUE(capabilities);
  ASSERT_EQ(capabilities->layers.size(), 3U);
  const CapabilitiesLayer& b = *capabilities->find("b");
  EXPECT_EQ(b.crs, (std::vector<std::string>{"EPSG:4326", "EPSG:3857", "EPSG:3031"}));
  EXPECT_EQ(b.path, (std::vector<std::string>{"Root", "A"}));
  EXPECT_EQ(b.styles.size(), 2U);
  EXPECT_EQ(b.attribution, "Me");
  EXPECT_EQ(b.title, "b");
  ASSERT_NE(b.timeDimension(), nullptr);
  EXPECT_EQ(b.timeDimension()->values, "2005");
  EXPECT_EQ(b.timeDimension()->units, "ISO8601");
  ASSERT_TRUE(b.extent);
  EXPECT_NEAR(b.extent->west, -10 * degree, 1e-12);
  const TileService service = serviceOfLayer(*capabilities, "b");
  EXPECT_EQ(service.attribution, "Me");
  const std::string url = service.url({0, service.matrices[0].firstColumn, service.matrices[0].firstRow});
  EXPECT_NE(url.find("FORMAT=image/jpeg"), std::string::npos) << url;  // opaque
  EXPECT_NE(url.find("TIME=2005"), std::string::npos) << url;          // it names no default
  EXPECT_FALSE(capabilities->layers[0].obstacle.empty());
}

TEST(Wms, ChoicesAreKeptToWhatThereIs) {
  const auto capabilities = parse(wms(
      "1.3.0",
      "<Layer><Name>a &amp; b</Name><CRS>CRS:84</CRS>" + worldBox +
          "<Style><Name>dark</Name></Style><Dimension name=\"time\" units=\"ISO8601\" default=\"2002-01-01\">"
          "2001-01-01,2002-01-01</Dimension><Dimension name=\"elevation\" units=\"m\" default=\"0\">0,100</Dimension>"
          "<Dimension name=\"band\" units=\"\" default=\"1\">1,2</Dimension></Layer>",
      "<MaxWidth>400</MaxWidth><MaxHeight>300</MaxHeight>"));
  ASSERT_TRUE(capabilities);
  const CapabilitiesLayer& layer = *capabilities->find("a & b");
  LayerChoices choices;
  choices.style = "dark";
  choices.format = "image/PNG";
  choices.time = "2001-01-01";
  choices.dimensions = {{"elevation", "100"}, {"Band", "2"}};
  choices.parameters = {{"token", "x y"}};
  choices.isTransparent = false;
  const TileService service = serviceOfLayer(*capabilities, "a & b", choices);
  const std::string url = service.url({0, service.matrices[0].firstColumn, service.matrices[0].firstRow});
  for (const char* part : {"LAYERS=a%20%26%20b&", "STYLES=dark&", "FORMAT=image/png&", "TIME=2001-01-01",
                           "ELEVATION=100", "DIM_band=2", "token=x%20y", "TRANSPARENT=FALSE", "WIDTH=300&HEIGHT=300"}) {
    EXPECT_NE(url.find(part), std::string::npos) << part << " in " << url;
  }
  for (const auto& spoil : std::initializer_list<std::function<void(LayerChoices&)>>{
           [](LayerChoices& c) { c.style = "light"; }, [](LayerChoices& c) { c.format = "image/x"; },
           [](LayerChoices& c) { c.crs = "EPSG:2056"; }, [](LayerChoices& c) { c.dimensions["elevation"] = "7"; }}) {
    LayerChoices bad;
    spoil(bad);
    EXPECT_FALSE(serviceOf(*capabilities, layer, bad));
  }
}

TEST(Wms, FixedSizesAreAskedForOnce) {
  const auto capabilities = parse(
      wms("1.3.0", "<Layer fixedWidth=\"600\" fixedHeight=\"300\" noSubsets=\"1\"><Name>a</Name><CRS>CRS:84</CRS>" +
                       worldBox + "</Layer><Layer noSubsets=\"1\"><Name>b</Name><CRS>CRS:84</CRS>" + worldBox +
                       "</Layer>"));
  const TileService fixed = serviceOfLayer(*capabilities, "a");
  ASSERT_EQ(fixed.matrices.size(), 1U);
  EXPECT_NE(fixed.url({0, 0, 0}).find("BBOX=-180,-90,180,90&WIDTH=600&HEIGHT=300"), std::string::npos);
  const TileService whole = serviceOfLayer(*capabilities, "b");
  ASSERT_EQ(whole.matrices.size(), 1U);
  EXPECT_EQ(whole.matrices[0].tileWidth, 2 * whole.matrices[0].tileHeight);
}

TEST(Wms, ReadsWhatIsOddAndMissing) {
  // Prefixes, a BOM, CDATA, case, attributes without prefix, version 1.0.0's formats, exchanged and crossing extents.
  const auto odd = parse(
      "\xEF\xBB\xBF<?xml version=\"1.0\"?><wms:WMS_CAPABILITIES version=\"1.3.0\"><wms:Service/><wms:Capability>"
      "<wms:Request><wms:GetMap><wms:DCPType><wms:HTTP><wms:Get><wms:OnlineResource href=\"/w\"/></wms:Get></wms:HTTP>"
      "</wms:DCPType></wms:GetMap></wms:Request><wms:Layer queryable=\"TRUE\" opaque=\"False\"><wms:Name>"
      "<![CDATA[a]]></wms:Name><wms:LatLonBoundingBox minx=\"170\" miny=\"-20\" maxx=\"-170\" maxy=\"20\"/></wms:Layer>"
      "</wms:Capability></wms:WMS_CAPABILITIES>");
  ASSERT_TRUE(odd) << odd.error().message();
  EXPECT_NEAR(odd->layers[0].extent->east, 190 * degree, 1e-12);
  const TileService service = serviceOfLayer(*odd, "a");
  EXPECT_EQ(service.url({0, service.matrices[0].firstColumn, service.matrices[0].firstRow}).substr(0, 21),
            "http://example.org/w?");
  const auto old = parse(
      "<WMT_MS_Capabilities version=\"1.0.0\"><Capability><Request><Map><Format><PNG/><JPEG/></Format><DCPType><HTTP>"
      "<Get onlineResource=\"http://h/old\"/></HTTP></DCPType></Map></Request><Layer><Name>a</Name><SRS>EPSG:4326</SRS>"
      "</Layer></Capability></WMT_MS_Capabilities>");
  ASSERT_TRUE(old);
  EXPECT_EQ(old->layers[0].formats, (std::vector<std::string>{"PNG", "JPEG"}));
  EXPECT_NE(serviceOfLayer(*old, "a").url({0, 0, 0}).find("http://h/old?"), std::string::npos);
}

TEST(Capabilities, WhatIsNoneIsToldClearly) {
  const auto says = [](std::string_view text) {
    const auto read = parse(text);
    EXPECT_FALSE(read) << text;
    return read ? "" : read.error().message();
  };
  EXPECT_NE(says("<ServiceExceptionReport><ServiceException>Layer unknown</ServiceException></ServiceExceptionReport>")
                .find("Layer unknown"),
            std::string::npos);
  EXPECT_NE(says("<html><head><title>Log in</title></head></html>").find("Log in"), std::string::npos);
  EXPECT_NE(says("{\"error\":{\"code\":498,\"message\":\"Invalid token\"}}").find("Invalid token"), std::string::npos);
  EXPECT_NE(says("<kml/>").find("kml"), std::string::npos);
  EXPECT_NE(says("{\"a\":1}").find("ArcGIS"), std::string::npos);
  EXPECT_NE(says("{").find("JSON"), std::string::npos);
  EXPECT_NE(says("<WMS_Capabilities/>").find("no layers"), std::string::npos);
  EXPECT_NE(says("<Capabilities><Contents/></Capabilities>").find("no layers"), std::string::npos);
  EXPECT_FALSE(says("").empty());
}

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

TEST(Tms, RowsCountFromTheSouth) {
  const Capabilities capabilities =
      realCapabilities("tms_ne2_webmercator_tilemapresource.xml", "http://h/t/tilemapresource.xml");
  if (capabilities.layers.empty()) {
    GTEST_SKIP() << "NOT TESTED: no shared data; set MERIDIAN_SHARED_DATA";
  }
  const TileService service = serviceOfLayer(capabilities, capabilities.layers[0].identifier);
  EXPECT_EQ(service.crs, "EPSG:3857");
  ASSERT_EQ(service.matrices.size(), 8U);
  EXPECT_EQ(service.url({7, 0, 0}), "http://h/t/0/0/0.png");
  EXPECT_EQ(service.url({6, 1, 0}), "http://h/t/1/1/1.png");
  EXPECT_NEAR(service.matrices[6].top, webMercatorHalfWidth, 1.0);
}

std::string tileMap(const std::string& srs, const std::string& box, const std::string& sets) {
  return "<TileMap version=\"1.0.0\"><Title>t</Title><SRS>" + srs + "</SRS>" + box +
         "<TileFormat width=\"256\" height=\"256\" mime-type=\"image/png\" extension=\"png\"/>" + sets + "</TileMap>";
}

TEST(Tms, GeodeticProfilesOfBothKinds) {
  const std::string box =
      "<BoundingBox minx=\"-180\" miny=\"-90\" maxx=\"180\" maxy=\"90\"/><Origin x=\"-180\" y=\"-90\"/>";
  const auto compatible = parse(tileMap("EPSG:4326", box,
                                        "<TileSets profile=\"global-geodetic\"><TileSet href=\"0\" "
                                        "units-per-pixel=\"0.703125\" order=\"0\"/><TileSet href=\"1\" "
                                        "units-per-pixel=\"0.3515625\" order=\"1\"/></TileSets>"),
                                "http://h/tilemapresource.xml");
  ASSERT_TRUE(compatible);
  const TileService two = serviceOfLayer(*compatible, "t");
  EXPECT_EQ(two.matrices[1].lastColumn, 1);
  EXPECT_EQ(two.matrices[1].lastRow, 0);
  EXPECT_EQ(two.url({0, 3, 0}), "http://h/1/3/1.png");
  // One tile of 360 degrees: half of it lies beyond the pole.
  const auto single = parse(tileMap("EPSG:4326", box,
                                    "<TileSets profile=\"geodetic\"><TileSet href=\"0\" units-per-pixel=\"1.40625\" "
                                    "order=\"0\"/></TileSets>"));
  const TileService one = serviceOfLayer(*single, "t");
  EXPECT_EQ(one.matrices[0].lastColumn, 0);
  EXPECT_DOUBLE_EQ(one.matrices[0].top, 270.0);
  EXPECT_DOUBLE_EQ(one.north, 90.0);
  EXPECT_EQ(one.url({0, 0, 0}), "http://example.org/0/0/0.png");
}

TEST(Tms, ListsNameOtherDocuments) {
  const auto list = parse(
      "<TileMapService version=\"1.0.0\"><Title>s</Title><TileMaps><TileMap title=\"a\" srs=\"EPSG:4326\" "
      "href=\"http://h/a\"/><TileMap title=\"b\" href=\"b/\"/></TileMaps></TileMapService>",
      "http://h/tms/1.0.0");
  ASSERT_TRUE(list);
  ASSERT_EQ(list->layers.size(), 2U);
  EXPECT_EQ(list->layers[1].document, "http://h/tms/b/");
  EXPECT_FALSE(serviceOf(*list, list->layers[0]));
}

TEST(ArcGisServices, DynamicMapsAreAskedForByWindow) {
  const auto capabilities = parse(
      R"({"currentVersion":10.8,"mapName":"M","capabilities":"Map,Query","maxImageWidth":4096,"maxImageHeight":4096,
          "fullExtent":{"xmin":-10,"ymin":40,"xmax":10,"ymax":50,"spatialReference":{"wkid":4326}},
          "timeInfo":{"timeExtent":[0,86400000],"defaultTimeInterval":6,"defaultTimeIntervalUnits":"esriTimeUnitsHours"},
          "layers":[{"id":0,"name":"zero"},{"id":3,"name":"three"}],"copyrightText":"C"})",
      "http://h/arcgis/rest/services/M/MapServer?f=json");
  ASSERT_TRUE(capabilities) << capabilities.error().message();
  ASSERT_EQ(capabilities->layers.size(), 3U);
  EXPECT_EQ(capabilities->layers[0].timeDimension()->values, "1970-01-01T00:00:00Z/1970-01-02T00:00:00Z/PT6H");
  LayerChoices choices;
  choices.time = "1970-01-01T06:00:00Z";
  const TileService service = serviceOfLayer(*capabilities, "3", choices);
  const std::string url = service.url({service.matrices.size() - 1, 0, 0});
  for (const char* part : {"http://h/arcgis/rest/services/M/MapServer/export?", "bbox=-180,-90,0,90", "size=512,512",
                           "bboxSR=4326", "layers=show:3", "time=21600000", "f=image"}) {
    EXPECT_NE(url.find(part), std::string::npos) << part << " in " << url;
  }
  EXPECT_EQ(service.attribution, "C");
  const auto list =
      parse(R"({"folders":["F"],"services":[{"name":"F/A","type":"MapServer"},{"name":"B","type":"GPServer"}]})",
            "http://h/arcgis/rest/services?f=json");
  ASSERT_TRUE(list);
  ASSERT_EQ(list->layers.size(), 2U);
  EXPECT_EQ(list->layers[1].document, "http://h/arcgis/rest/services/F/A/MapServer?f=json");
}

TEST(TiledWms, PatternsAreLevels) {
  // As JPL's OnEarth wrote them (GDAL's driver page has this group).
  const auto capabilities = parse(
      "<WMS_Tile_Service version=\"0.1.0\"><Service><Title>OnEarth</Title></Service><TiledPatterns>"
      "<OnlineResource xlink:href=\"http://onearth/wms.cgi?\"/><TiledGroup><Name>Global SRTM</Name><Title>SRTM</Title>"
      "<LatLonBoundingBox minx=\"-180\" miny=\"-60\" maxx=\"180\" maxy=\"84\"/><TilePattern><![CDATA[\n"
      "request=GetMap&layers=srtm&srs=EPSG:4326&width=512&height=512&bbox=-180,88,-178,90&format=image/png&styles=\n"
      "request=GetMap&layers=srtm&srs=EPSG:4326&width=512&height=512&bbox=-180,88,-178,90&format=image/png\n"
      "]]></TilePattern><TilePattern><![CDATA[request=GetMap&layers=srtm&srs=EPSG:4326&width=512&height=512&"
      "bbox=-180,86,-176,90&format=image/png&styles=]]></TilePattern></TiledGroup></TiledPatterns></WMS_Tile_Service>");
  ASSERT_TRUE(capabilities) << capabilities.error().message();
  const TileService service = serviceOfLayer(*capabilities, "Global SRTM");
  ASSERT_EQ(service.matrices.size(), 2U);
  EXPECT_EQ(service.matrices[0].firstRow, 3);
  EXPECT_EQ(service.matrices[0].lastColumn, 179);
  const std::string url = service.url({1, 1, 2});
  EXPECT_EQ(url.substr(0, 23), "http://onearth/wms.cgi?");
  EXPECT_NE(url.find("bbox=-176,78,-172,82"), std::string::npos) << url;
}

TEST(Capabilities, DamagedDocumentsNeverCrash) {
  std::mt19937 random(11);
  for (const char* file :
       {"wms130_gibs_onearth.xml", "wms111_brgm_utf16.xml", "wmts_pdok_nl.xml", "wmts_nasa_trek_mars_themis.xml",
        "tms_ne2_webmercator_tilemapresource.xml", "arcgis_mapserver_fused_cache.json"}) {
    const std::string path = sharedData("capabilities/" + std::string(file));
    MERIDIAN_NEEDS(path);
    const Bytes bytes = bytesOf(path);
    for (int round = 0; round < 60; ++round) {
      Bytes damaged = bytes;
      if (round % 3 == 0) {
        damaged.resize(random() % damaged.size());
      }
      for (int flip = 0; flip < round && !damaged.empty(); ++flip) {
        damaged[random() % damaged.size()] = static_cast<std::uint8_t>("<>&0-9e/\"'{}[]a \0"[random() % 17]);
      }
      const auto read = parseCapabilities(damaged, "http://h/x");
      for (std::size_t i = 0; read && i < std::min<std::size_t>(read->layers.size(), 5); ++i) {
        const auto service = serviceOf(*read, read->layers[i]);
        if (service) {
          for (const TileAddress& address : cornersOf(*service)) {
            (void)service->url(address);
          }
        }
      }
    }
  }
}

}  // namespace
}  // namespace meridian::globebrowsing

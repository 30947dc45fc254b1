#include "globebrowsing/source/capabilities.h"

#include <random>

#include "service_fixture.h"

namespace meridian::globebrowsing {
namespace {

using namespace test;

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

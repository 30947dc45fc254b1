// Layers of services that have times: what is shown when, and that nothing else is asked for.
#include <ogrsf_frmts.h>

#include "globebrowsing/source/service_text.h"
#include "map_servers_stage.h"
#include "support/nginx_server.h"
#include "support/timed_pyramid.h"

namespace meridian::globebrowsing {
namespace {

using testing::AnyOf;
using testing::HasSubstr;

using Colour = std::array<int, 3>;

Colour middleOf(const Result<ColourPixels>& pixels) {
  if (!pixels || pixels->rgba.empty()) {
    return {};
  }
  std::array<int, 3> sum{};
  constexpr int side = 8;
  for (int i = 0; i < side * side; ++i) {
    const int row = pixels->size / 2 + i / side;
    const std::uint8_t* p = &pixels->rgba[4 * (static_cast<std::size_t>(row) * static_cast<std::size_t>(pixels->size) +
                                               static_cast<std::size_t>(pixels->size / 2 + i % side))];
    for (std::size_t band = 0; band < 3; ++band) {
      sum[band] += p[band];
    }
  }
  return {sum[0] / (side * side), sum[1] / (side * side), sum[2] / (side * side)};
}

void expectColour(const Colour& found, const Colour& expected, const std::string& when) {
  for (std::size_t band = 0; band < 3; ++band) {
    EXPECT_NEAR(found[band], expected[band], 6) << when << ", band " << band;
  }
}

/// MapServer with a raster for each of three months, found by an index of their times.
class WmsTimesTest : public MapServersStage {
 protected:
  struct Month {
    std::string time;
    Colour colour;
  };
  const std::vector<Month> months{
      {"2004-01-01", {220, 40, 40}}, {"2004-02-01", {40, 220, 40}}, {"2004-04-01", {40, 40, 220}}};

  void SetUp() override {
    MapServersStage::SetUp();
    if (IsSkipped()) {
      return;
    }
    writeIndex();
    writeMapFile("  LAYER\n    NAME 'ice'\n    TYPE RASTER\n    STATUS ON\n    TILEINDEX '" +
                 (folder / "index.shp").string() +
                 "'\n    TILEITEM 'location'\n    PROJECTION 'init=epsg:4326' END\n    EXTENT -180 -90 180 90\n"
                 "    METADATA 'wms_title' 'Ice' 'wms_extent' '-180 -90 180 90' 'wms_timeitem' 'time' 'wms_timeextent' "
                 "'2004-01-01/2004-02-01/P1M,2004-04-01' 'wms_timedefault' '2004-02-01' END\n  END\n");
    start();
  }

 private:
  void writeIndex() const {
    GDALDatasetUniquePtr index(GetGDALDriverManager()
                                   ->GetDriverByName("ESRI Shapefile")
                                   ->Create((folder / "index.shp").c_str(), 0, 0, 0, GDT_Unknown, nullptr));
    OGRLayer* layer = index->CreateLayer("index", nullptr, wkbPolygon, nullptr);
    for (const char* name : {"location", "time"}) {
      OGRFieldDefn field(name, OFTString);
      field.SetWidth(200);
      ASSERT_EQ(layer->CreateField(&field), OGRERR_NONE);
    }
    for (const Month& month : months) {
      const std::string file = (folder / (month.time + ".tif")).string();
      writeUniform(file, month.colour);
      OGRFeature feature(layer->GetLayerDefn());
      feature.SetField("location", file.c_str());
      feature.SetField("time", month.time.c_str());
      OGRGeometry* outline = nullptr;
      OGRGeometryFactory::createFromWkt("POLYGON((-180 -90,180 -90,180 90,-180 90,-180 -90))", nullptr, &outline);
      feature.SetGeometryDirectly(outline);
      ASSERT_EQ(layer->CreateFeature(&feature), OGRERR_NONE);
    }
  }
  static void writeUniform(const std::string& file, const Colour& colour) {
    GDALDatasetUniquePtr raster(
        GetGDALDriverManager()->GetDriverByName("GTiff")->Create(file.c_str(), 256, 128, 3, GDT_Byte, nullptr));
    std::array<double, 6> transform{-180.0, 360.0 / 256, 0.0, 90.0, 0.0, -180.0 / 128};
    raster->SetGeoTransform(transform.data());
    for (int band = 0; band < 3; ++band) {
      ASSERT_EQ(raster->GetRasterBand(band + 1)->Fill(colour[static_cast<std::size_t>(band)]), CE_None);
    }
  }
};

TEST_F(WmsTimesTest, ALayerOfEitherVersionFollowsTime) {
  for (const char* version : {"1.1.1", "1.3.0"}) {
    SCOPED_TRACE(version);
    ServiceStage stage;
    const std::string url = base() + "/mapserv?SERVICE=WMS&REQUEST=GetCapabilities&VERSION=" + version;
    const std::string written = filePathOf(stage, url, "ice");
    EXPECT_THAT(written, HasSubstr("<GetCapabilitiesUrl>"));
    for (const std::string& filePath : {written, "WMS:" + url + ",layer=ice"}) {
      const auto layer = stage.opened(stage.make({{"FilePath", filePath}}));
      ASSERT_NE(layer->steps(), nullptr);
      for (const auto& [time, month] : std::vector<std::pair<const char*, std::size_t>>{{"2003-01-01", 1},
                                                                                        {"2004-01-01", 0},
                                                                                        {"2004-01-31T23:59:59", 0},
                                                                                        {"2004-02-01", 1},
                                                                                        {"2004-03-15", 1},
                                                                                        {"2004-04-10", 2},
                                                                                        {"2026-01-01", 1}}) {
        const auto step = stage.open(*layer, *Time::fromUtc(time));
        expectColour(middleOf(stage.tile(step, {1, 1, 0, 0})), months[month].colour, time);
      }
    }
  }
  int maps = 0;
  for (const std::string& request : requests()) {
    if (request.find("GetMap") != std::string::npos) {
      ++maps;
      EXPECT_THAT(parameterOf(request, "time").value_or("none"), AnyOf("2004-01-01", "2004-02-01", "2004-04-01"));
    }
  }
  EXPECT_GT(maps, 0);
}

/// Plain files behind nginx.
class WmtsTimesTest : public testing::Test {
 protected:
  void SetUp() override {
    if (!NginxServer::isInstalled()) {
      GTEST_SKIP() << "nginx is not installed; install nginx-light";
    }
    server = std::make_unique<NginxServer>();
    pyramid.write(server->root(), server->http1());
  }
  void expectDays(ServiceStage& stage, const TileProvider& layer, const std::vector<std::pair<double, int>>& days) {
    for (const auto& [time, day] : days) {
      const auto step = stage.open(layer, TimedPyramid::timeOf(time));
      expectColour(middleOf(stage.tile(step, {0, 1, 0, 1})), TimedPyramid::colourOf(day), std::to_string(time));
    }
  }
  [[nodiscard]] int requestsFor(const std::string& part) const {
    const std::string log = server->accessLog();
    int count = 0;
    for (std::size_t at = log.find(part); at != std::string::npos; at = log.find(part, at + 1)) {
      ++count;
    }
    return count;
  }

  const TimedPyramid pyramid{.days = 12, .levels = 2};
  std::unique_ptr<NginxServer> server;
};

TEST_F(WmtsTimesTest, ALayerFollowsTimeAndItsCapabilitiesAreReadOnce) {
  ServiceStage stage;
  const auto layer = stage.opened(stage.make({{"FilePath", TimedPyramid::filePath(server->http1())}}));
  ASSERT_NE(layer->steps(), nullptr);
  expectDays(stage, *layer, {{0.0, 0}, {0.99, 0}, {1.0, 1}, {7.5, 7}, {11.5, 11}, {3.0, 3}, {-400.0, 11}, {400.0, 11}});
  EXPECT_EQ(requestsFor("/wmts.xml"), 1);
  EXPECT_GT(requestsFor(" 200 /days/2004-01-08/"), 0);
  EXPECT_EQ(requestsFor(" 404 "), 0) << server->accessLog();
  const TileStep step = layer->steps()->at(TimedPyramid::timeOf(3.5));
  EXPECT_NEAR(step.begin - TimedPyramid::timeOf(3), 0.0, 1e-3);
  EXPECT_NEAR(step.end - TimedPyramid::timeOf(4), 0.0, 1e-3);
}

TEST_F(WmtsTimesTest, AFixedTimeIsTakenByTheSameRule) {
  ServiceStage stage;
  const auto layer = stage.opened(stage.make({{"FilePath", TimedPyramid::filePath(server->http1())},
                                              {"UseFixedTime", true},
                                              {"FixedTime", "2004-01-05T12:00:00"}}));
  expectDays(stage, *layer, {{0.0, 4}, {9.0, 4}});
}

TEST_F(WmtsTimesTest, StepsOfAPrototypeShareTheCapabilities) {
  ServiceStage stage;
  const Value time = tableOf({{"Start", "2004-01-01"}, {"End", "2004-01-12"}});
  const auto layer = stage.opened(
      stage.make({{"Type", "TemporalTileProvider"},
                  {"Mode", "Prototyped"},
                  {"Prototyped",
                   tableOf({{"Time", time},
                            {"TemporalResolution", "1d"},
                            {"TimeFormat", "YYYY-MM-DD"},
                            {"Prototype", TimedPyramid::filePath(server->http1()) + ",time=${OpenSpaceTimeId}"}})}}));
  expectDays(stage, *layer, {{0.5, 0}, {5.0, 5}, {11.0, 11}});
  EXPECT_EQ(requestsFor("/wmts.xml"), 1);
}

TEST_F(WmtsTimesTest, ATypeOrATimeKeepsItAsItIs) {
  ServiceStage stage;
  const std::string filePath = TimedPyramid::filePath(server->http1());
  const auto plain = stage.open({{"FilePath", filePath}, {"Type", "DefaultTileProvider"}});
  EXPECT_EQ(plain->steps(), nullptr);
  expectColour(middleOf(stage.tile(plain, {0, 1, 0, 1})), TimedPyramid::colourOf(11), "its default");
  const auto chosen = stage.open(filePath + ",time=2004-01-03");
  EXPECT_EQ(chosen->steps(), nullptr);
  expectColour(middleOf(stage.tile(chosen, {0, 1, 0, 1})), TimedPyramid::colourOf(2), "the time chosen");
}

}  // namespace
}  // namespace meridian::globebrowsing

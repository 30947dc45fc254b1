// Layers whose tiles a server has, on the screen; and what map servers offer.
#include <fstream>

#include <gmock/gmock.h>

#include "globe_fixture.h"
#include "globebrowsing/globe_services.h"
#include "globebrowsing/source/gdal_network.h"
#include "support/nginx_server.h"
#include "support/server_process.h"
#include "support/timed_pyramid.h"
#include "support/world_raster.h"

namespace meridian::globebrowsing {
namespace {

using testing::HasSubstr;

class MapServiceTest : public GlobeTest {
 protected:
  void SetUp() override {
    GlobeTest::SetUp();
    if (graphics_) {
      WorldRaster::write(folder_ / "world.tif");
    }
  }
  [[nodiscard]] std::vector<std::uint8_t> picture() const {
    std::vector<std::uint8_t> rgba(std::size_t{4} * width * height);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, target_->framebuffer());
    glReadPixels(0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
    return rgba;
  }
  std::vector<std::uint8_t> pictureOf(const std::string& filePath) {
    addGlobe({{"ColorLayers", listOf({fileLayer("World", filePath)})}});
    EXPECT_TRUE(settle());
    std::vector<std::uint8_t> rgba = picture();
    removeGlobes();
    return rgba;
  }
  static int difference(const std::vector<std::uint8_t>& a, const std::vector<std::uint8_t>& b) {
    int greatest = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
      greatest = std::max(greatest, std::abs(int{a[i]} - int{b[i]}));
    }
    return greatest;
  }
};

TEST_F(MapServiceTest, AServicesPictureIsThatOfTheFile) {
  if (!NginxServer::isInstalled()) {
    GTEST_SKIP() << "nginx is not installed; install nginx-light";
  }
  NginxServer server;
  WorldRaster::cut(folder_ / "world.tif", server.root());
  const std::vector<std::uint8_t> expected = pictureOf((folder_ / "world.tif").string());
  EXPECT_LE(difference(pictureOf(WorldRaster::document(server.http1())), expected), 3);
  EXPECT_THAT(server.accessLog(), HasSubstr(" 200 /1/"));
}

TEST_F(MapServiceTest, AddressesOfTilesAndArcGisCachesShowTheSame) {
  if (!NginxServer::isInstalled()) {
    GTEST_SKIP() << "nginx is not installed; install nginx-light";
  }
  NginxServer server;
  const auto path = [](std::initializer_list<int> parts) {
    std::filesystem::path joined;
    for (const int part : parts) {
      joined /= std::to_string(part);
    }
    return joined;
  };
  const std::filesystem::path arcGis = server.root() / "arcgis/rest/services/World/MapServer";
  WorldRaster::cutMercator([&](int level, int column, int row) {
    return server.root() / "xyz" / path({level, column}) / (std::to_string(row) + ".png");
  });
  WorldRaster::cutMercator([&](int level, int column, int row) {
    return arcGis / "tile" / path({level, row, column});
  });
  std::ofstream(arcGis / "index.html") << R"({"currentVersion": 10.91, "mapName": "World", "singleFusedMapCache": true,
      "spatialReference": {"wkid": 102100, "latestWkid": 3857}, "copyrightText": "The makers", "tileInfo": {"rows": 256,
      "cols": 256, "dpi": 96, "format": "PNG", "origin": {"x": -20037508.342787, "y": 20037508.342787},
      "spatialReference": {"wkid": 102100, "latestWkid": 3857},
      "lods": [{"level": 0, "resolution": 156543.03392800014, "scale": 591657527.591555},
      {"level": 1, "resolution": 78271.51696399994, "scale": 295828763.795777},
      {"level": 2, "resolution": 39135.75848200009, "scale": 147914381.897889}]},
      "fullExtent": {"xmin": -20037508.342787, "ymin": -20037508.342787, "xmax": 20037508.342787,
      "ymax": 20037508.342787, "spatialReference": {"wkid": 102100, "latestWkid": 3857}}})";
  const std::vector<std::uint8_t> expected = pictureOf((folder_ / "world.tif").string());
  EXPECT_LE(difference(pictureOf(server.http1() + "/xyz/{z}/{x}/{y}.png"), expected), 3);
  EXPECT_THAT(server.accessLog(), HasSubstr(" 200 /xyz/2/"));
  EXPECT_LE(difference(pictureOf(server.http1() + "/arcgis/rest/services/World/MapServer?f=json"), expected), 3);
  EXPECT_THAT(server.accessLog(), HasSubstr(" 200 /arcgis/rest/services/World/MapServer/tile/2/"));
  EXPECT_THAT(server.accessLog(), testing::Not(HasSubstr(" 404 /arcgis"))) << "it has no more than it says";
}

TEST_F(MapServiceTest, APropertyLimitsTheImagesOfTiles) {
  WorldRaster::cut(folder_ / "world.tif", folder_ / "tiles");
  const int port = freePort();
  const ServerProcess server(ServerProcess::fileServer((folder_ / "tiles").string(), port), port);
  setModuleProperty("NetworkImageSide", 64.0);
  auto& globe =
      addGlobe({{"ColorLayers",
                 listOf({fileLayer("World", WorldRaster::document("http://127.0.0.1:" + std::to_string(port)))})}});
  const StringProperty& lastError = globe.layers().group(LayerGroupId::ColorLayers).find("World")->lastError;
  ASSERT_TRUE(framesUntil([&lastError] { return !lastError.get().empty(); }));
  EXPECT_THAT(lastError.get(), HasSubstr("MERIDIAN_IMAGE_SIDE"));
  setModuleProperty("NetworkImageSide", 512.0);
  ASSERT_TRUE(framesUntil([&lastError] { return lastError.get().empty(); }));
  ASSERT_TRUE(settle());
  EXPECT_EQ(lastError.get(), "");
  EXPECT_NEAR(centre()[0], WorldRaster::value(0, 0.2, 0.1), 4);
}

TEST_F(MapServiceTest, WhatFailedOfflineIsThereOnline) {
  setModuleProperty("NetworkCacheMode", "cache-only");
  const int port = freePort();
  const std::string address = "http://127.0.0.1:" + std::to_string(port);
  WorldRaster::cut(folder_ / "world.tif", folder_ / "served");
  const TimedPyramid pyramid{.days = 2, .levels = 2};
  pyramid.write(folder_ / "served", address);
  const ServerProcess server(ServerProcess::fileServer((folder_ / "served").string(), port), port);
  time_ = TimedPyramid::timeOf(0);
  auto& globe = addGlobe({{"ColorLayers", listOf({fileLayer("Days", TimedPyramid::filePath(address)),
                                                  fileLayer("World", WorldRaster::document(address))})}});
  const LayerGroup& group = globe.layers().group(LayerGroupId::ColorLayers);
  const Layer& days = *group.find("Days");
  const Layer& world = *group.find("World");
  ASSERT_TRUE(framesUntil([&] { return days.status.get() == "failed" && !world.lastError.get().empty(); }));
  EXPECT_THAT(days.lastError.get(), HasSubstr("cache-only"));
  EXPECT_THAT(world.lastError.get(), HasSubstr("go online"));
  ASSERT_TRUE(settle());
  const std::shared_ptr<TileProvider> failed = world.provider();
  setModuleProperty("NetworkCacheMode", "read-only");
  ASSERT_TRUE(framesUntil([&] { return days.status.get() == "ready" && world.status.get() == "ready"; }))
      << days.lastError.get();
  ASSERT_TRUE(settle());
  EXPECT_EQ(days.lastError.get(), "");
  EXPECT_EQ(world.lastError.get(), "");
  for (int band = 0; band < 3; ++band) {
    EXPECT_NEAR(centre()[static_cast<std::size_t>(band)], WorldRaster::value(band, 0.2, 0.1), 4) << band;
  }
  const std::shared_ptr<TileProvider> shown = world.provider();
  EXPECT_NE(shown, failed);
  setModuleProperty("NetworkCacheMode", "cache-only");
  setModuleProperty("NetworkCacheMode", "read-write");
  frame();
  EXPECT_EQ(world.provider(), shown) << "what works goes on";
}

TEST_F(MapServiceTest, LayersOfCapabilitiesOpenOffline) {
  paths_.cache = folder_ / "cache";
  const auto beginAnew = [&] {
    removeGlobes();
    module_.reset();
    host_ = std::make_unique<FakeHost>(paths_, statistics_);
    module_ = makeModule();
    ASSERT_TRUE(module_->initialize(*host_));
  };
  const int port = freePort();
  const std::string address = "http://127.0.0.1:" + std::to_string(port);
  const TimedPyramid pyramid{.days = 3, .levels = 2};
  pyramid.write(folder_ / "served", address);
  time_ = TimedPyramid::timeOf(1.5);
  const auto shown = [&] {
    RenderableGlobe& globe = addGlobe({{"ColorLayers", listOf({fileLayer("Days", TimedPyramid::filePath(address))})}});
    EXPECT_TRUE(settle());
    EXPECT_EQ(globe.layers().group(LayerGroupId::ColorLayers).find("Days")->lastError.get(), "");
    return picture();
  };
  beginAnew();
  std::vector<std::uint8_t> online;
  {
    const ServerProcess server(ServerProcess::fileServer((folder_ / "served").string(), port), port);
    online = shown();
    EXPECT_NEAR(centre()[0], TimedPyramid::colourOf(1)[0], TimedPyramid::grain + 2);
  }
  beginAnew();
  setModuleProperty("NetworkCacheMode", "cache-only");
  EXPECT_EQ(difference(shown(), online), 0);
  // Without the cache there is nothing to open.
  paths_.cache = folder_ / "empty";
  beginAnew();
  setModuleProperty("NetworkCacheMode", "cache-only");
  RenderableGlobe& globe = addGlobe({{"ColorLayers", listOf({fileLayer("Days", TimedPyramid::filePath(address))})}});
  const Layer& days = *globe.layers().group(LayerGroupId::ColorLayers).find("Days");
  EXPECT_TRUE(framesUntil([&] { return days.status.get() == "failed"; }));
}

TEST_F(MapServiceTest, TheViewWaitsForAServerThatIsDown) {
  WorldRaster::cut(folder_ / "world.tif", folder_ / "tiles");
  const int port = freePort();
  auto& globe =
      addGlobe({{"ColorLayers",
                 listOf({fileLayer("World", WorldRaster::document("http://127.0.0.1:" + std::to_string(port)))})}});
  const StringProperty& lastError = globe.layers().group(LayerGroupId::ColorLayers).find("World")->lastError;
  ASSERT_TRUE(framesUntil([&lastError] { return !lastError.get().empty(); }));
  EXPECT_NE(unsettled(), "");
  EXPECT_THAT(lastError.get(), HasSubstr(std::to_string(port)));
  EXPECT_EQ(globe.layers().group(LayerGroupId::ColorLayers).find("World")->status.get(), "ready");
  const ServerProcess server(ServerProcess::fileServer((folder_ / "tiles").string(), port), port);
  EXPECT_TRUE(settle());
  EXPECT_TRUE(framesUntil([&lastError] { return lastError.get().empty(); })) << lastError.get();
  const Pixel seen = centre();
  for (int band = 0; band < 3; ++band) {
    EXPECT_NEAR(seen[static_cast<std::size_t>(band)], WorldRaster::value(band, 0.2, 0.1), 4) << band;
  }
}

TEST_F(MapServiceTest, LayersOfCapabilitiesWaitForAServerThatIsDown) {
  setModuleProperty("NetworkCacheMode", "off");
  const int port = freePort();
  const std::string address = "http://127.0.0.1:" + std::to_string(port);
  const TimedPyramid pyramid{.days = 2, .levels = 2};
  std::filesystem::create_directories(folder_ / "days");
  pyramid.write((folder_ / "days").string(), address);
  time_ = TimedPyramid::timeOf(1);
  const std::string path = TimedPyramid::filePath(address);
  auto& globe =
      addGlobe({{"ColorLayers",
                 listOf({fileLayer("Days", path), fileLayer("Pinned", path, {{"Type", "DefaultTileProvider"}})})}});
  for (const char* name : {"Days", "Pinned"}) {
    const Layer& layer = *globe.layers().group(LayerGroupId::ColorLayers).find(name);
    ASSERT_TRUE(framesUntil([&] { return !layer.lastError.get().empty(); })) << name;
    EXPECT_THAT(layer.lastError.get(), HasSubstr(std::to_string(port)));
    EXPECT_EQ(layer.status.get(), "opening");
  }
  const ServerProcess server(ServerProcess::fileServer((folder_ / "days").string(), port), port);
  for (const char* name : {"Days", "Pinned"}) {
    const Layer& layer = *globe.layers().group(LayerGroupId::ColorLayers).find(name);
    ASSERT_TRUE(framesUntil([&] { return layer.status.get() == "ready" && layer.lastError.get().empty(); }))
        << name << ": " << layer.status.get() << ", " << layer.lastError.get();
  }
  EXPECT_TRUE(settle());
}

/// Of the module's services, without graphics.
class CapabilitiesLoaderTest : public testing::Test {
 protected:
  CapabilitiesLoaderTest() {
    std::string name = (std::filesystem::temp_directory_path() / "meridian-capabilities-XXXXXX").string();
    folder_ = ::mkdtemp(name.data());
    std::ofstream(folder_ / "tilemapresource.xml") << R"(<TileMap version="1.0.0"><Title>The world</Title>
              <Attribution><Title>The makers</Title></Attribution><SRS>EPSG:4326</SRS>
              <BoundingBox minx="-180" miny="-90" maxx="180" maxy="90"/><Origin x="-180" y="-90"/>
              <TileFormat width="256" height="256" mime-type="image/png" extension="png"/>
              <TileSets profile="global-geodetic"><TileSet href="0" units-per-pixel="0.703125" order="0"/>
              <TileSet href="1" units-per-pixel="0.3515625" order="1"/></TileSets></TileMap>)";
    servers_.setLoader([this](const MapServer& server, CapabilitiesLoader::Done done) {
      asked_->capabilities().load(server, std::move(done));
    });
  }
  ~CapabilitiesLoaderTest() override {
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
  }
  MapServers::Offer offered(const std::string& url) {
    servers_.add({"Server", "Earth", url});
    for (MapServers::Offer offer = servers_.offered("Server");; offer = servers_.offered("Server")) {
      if (offer || offer.error().what.find("not arrived yet") == std::string::npos) {
        return offer;
      }
      asked_->capabilities().deliver();
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }

  std::filesystem::path folder_;
  PropertyOwner owner_{"GlobeBrowsing", "Globe browsing", ""};
  Statistics statistics_;
  MapServers servers_;
  GlobeServices services_{owner_, statistics_, std::filesystem::path()};
  GlobeServices* asked_ = &services_;
};

TEST_F(CapabilitiesLoaderTest, AServerOffersWhatAnAssetCanName) {
  const int port = freePort();
  const ServerProcess server(ServerProcess::fileServer(folder_.string(), port), port);
  const std::string address = "http://127.0.0.1:" + std::to_string(port);
  const MapServers::Offer offer = offered(address + "/tilemapresource.xml");
  ASSERT_TRUE(offer) << offer.error().message();
  ASSERT_EQ(offer->layers.size(), 1U);
  EXPECT_EQ(offer->layers.front().name, "The world");
  EXPECT_THAT(offer->layers.front().url, HasSubstr("<GDAL_WMS>"));
  EXPECT_THAT(offer->layers.front().url, HasSubstr(address));
  EXPECT_EQ(offer->layers.front().attribution, "The makers");
  ASSERT_TRUE(offer->layers.front().extent);
  EXPECT_NEAR(offer->layers.front().extent->west, -std::numbers::pi, 1e-9);
  ASSERT_EQ(offer->layers.front().styles.size(), 1U);
  const Value& table = offer->layers.front().styles.front().table;
  EXPECT_EQ(*table.find("FilePath"), Value(offer->layers.front().url));
  EXPECT_EQ(*table.find("Attribution"), Value("The makers"));
}

TEST_F(CapabilitiesLoaderTest, WhatWasListedIsListedOffline) {
  const int port = freePort();
  const std::string url = "http://127.0.0.1:" + std::to_string(port) + "/tilemapresource.xml";
  const auto list = [&](const char* mode) {
    PropertyOwner owner("GlobeBrowsing", "Globe browsing", "");
    GlobeServices services(owner, statistics_, folder_ / "cache");
    EXPECT_TRUE(owner.property("NetworkCacheMode")->set(Value(mode)));
    asked_ = &services;
    MapServers::Offer offer = offered(url);
    asked_ = &services_;
    return offer;
  };
  EXPECT_FALSE(list("cache-only"));
  {
    const ServerProcess server(ServerProcess::fileServer(folder_.string(), port), port);
    ASSERT_TRUE(list("read-write"));
  }
  const MapServers::Offer offline = list("cache-only");
  ASSERT_TRUE(offline) << offline.error().message();
  ASSERT_EQ(offline->layers.size(), 1U);
  EXPECT_EQ(offline->layers.front().name, "The world");
}

TEST_F(CapabilitiesLoaderTest, CapabilitiesMayLieInAFile) {
  const MapServers::Offer offer = offered((folder_ / "tilemapresource.xml").string());
  ASSERT_TRUE(offer) << offer.error().message();
  ASSERT_EQ(offer->layers.size(), 1U);
  EXPECT_THAT(offer->layers.front().obstacle, HasSubstr("the document's own address")) << "its tiles lie nowhere";
  EXPECT_FALSE(services_.fetcher()->hasStarted());
}

TEST_F(CapabilitiesLoaderTest, SaysWhyThereAreNone) {
  std::ofstream(folder_ / "page.html") << "<html><body>moved</body></html>";
  EXPECT_FALSE(offered((folder_ / "page.html").string()));
  EXPECT_FALSE(offered((folder_ / "missing.xml").string()));
  const MapServers::Offer offer = offered("http://127.0.0.1:" + std::to_string(freePort()) + "/capabilities.xml");
  ASSERT_FALSE(offer);
  EXPECT_THAT(offer.error().message(), HasSubstr("127.0.0.1"));
}

TEST_F(CapabilitiesLoaderTest, TheCacheOfTheNetworkIsSetByProperties) {
  EXPECT_TRUE(owner_.property("NetworkCacheMode")->set(Value("cache-only")));
  EXPECT_EQ(services_.fetcher()->options().cache.mode, CacheMode::CacheOnly);
  EXPECT_TRUE(isGdalOffline());
  const MapServers::Offer offer = offered("http://127.0.0.1:" + std::to_string(freePort()) + "/capabilities.xml");
  ASSERT_FALSE(offer);
  EXPECT_THAT(offer.error().message(), testing::Not(HasSubstr("connect")));
  EXPECT_TRUE(owner_.property("NetworkCacheMode")->set(Value("read-write")));
  EXPECT_FALSE(isGdalOffline());
}

}  // namespace
}  // namespace meridian::globebrowsing

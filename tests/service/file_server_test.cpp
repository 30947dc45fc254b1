// Tiles that lie on a server as files, and servers that are down.
#include "service_stage.h"
#include "support/nginx_server.h"

namespace meridian::globebrowsing {
namespace {

using testing::HasSubstr;
using State = TileAnswer::State;

class FileServerTest : public ServiceTest {
 protected:
  void SetUp() override {
    if (!NginxServer::isInstalled()) {
      GTEST_SKIP() << "nginx is not installed; install nginx-light";
    }
    server = std::make_unique<NginxServer>();
    WorldRaster::cut(raster(), server->root());
  }
  [[nodiscard]] std::string document() const { return WorldRaster::document(server->http1()); }

  std::unique_ptr<NginxServer> server;
};

TEST_F(FileServerTest, TilesOfADocumentAreThoseOfTheFile) {
  ServiceStage stage;
  const auto layer = stage.open(document());
  EXPECT_FALSE(stage.fetcher->hasStarted()) << "nothing has been asked for yet";
  expectRaster(stage, layer, 2);
}

TEST_F(FileServerTest, ADocumentMayLieInAFileBesideTheAsset) {
  ServiceStage stage;
  std::ofstream(folder / "world.wms") << document();
  expectRaster(stage, stage.open({{"FilePath", "world.wms"}}, folder.string()), 2, {{0, 1, 0, 1}});
}

TEST_F(FileServerTest, NothingIsAskedForBeyondTheServiceNorTwice) {
  ServiceStage stage;
  const auto layer = stage.open(document());
  for (int level = 0; level < 4; ++level) {
    for (int root = 0; root < 2; ++root) {
      const auto side = std::uint32_t{1} << level;
      for (std::uint32_t y = 0; y < side; ++y) {
        TileIndex index{static_cast<std::uint8_t>(root), static_cast<std::uint8_t>(level), 0, y};
        ASSERT_TRUE(stage.tile(layer, index));
      }
    }
  }
  std::istringstream log(server->accessLog());
  std::multiset<std::string> paths;
  for (std::string protocol, status, path, connection; log >> protocol >> status >> path >> connection;) {
    EXPECT_EQ(status, "200") << path;
    paths.insert(path);
  }
  EXPECT_GE(paths.size(), 8U);
  EXPECT_LE(paths.size(), 10U);
  for (const std::string& path : paths) {
    EXPECT_EQ(paths.count(path), 1U) << path;
  }
}

TEST_F(FileServerTest, ProvidersThatAreMadeOfOthersHandTheirTilesOn) {
  ServiceStage stage;
  const Value service = tableOf({{"FilePath", document()}});
  const Value file = tableOf({{"FilePath", raster()}});
  Table levels;
  levels.list = {tableOf({{"MaxLevel", 2}, {"TileProvider", service}}),
                 tableOf({{"MaxLevel", 20}, {"TileProvider", file}})};
  expectRaster(stage, stage.open({{"Type", "TileProviderByLevel"}, {"LevelTileProviders", levels}}), 2);
  Table cells;
  cells.list = {tableOf({{"Index", tableOf({{"X", 1}, {"Y", 1}, {"Level", 2}})}, {"TileProvider", service}})};
  expectRaster(
      stage, stage.open({{"Type", "TileProviderByIndex"}, {"DefaultTileProvider", file}, {"TileProviders", cells}}), 2);
  EXPECT_THAT(server->accessLog(), HasSubstr("200 /1/"));
  const auto byDate = stage.open({{"Type", "TileProviderByDate"}, {"Providers", tableOf({{"2004-01-01", service}})}});
  expectRaster(stage, byDate, 2, {{1, 1, 1, 0}});
}

TEST_F(FileServerTest, HeightsOfAServiceHeedTheAsset) {
  ServiceStage stage;
  const Fields more{{"HeightScale", 10.0}, {"HeightOffset", 500.0}, {"HeightDatum", 200.0}};
  Fields service = more;
  service["FilePath"] = document();
  Fields file = more;
  file["FilePath"] = raster();
  const auto layer = stage.open(service);
  const auto task = layer->heightTask(*stage.tiling, {0, 1, 0, 1}, heightLayout);
  ASSERT_NE(task, nullptr);
  while (!task->prepare(1.0, [] {})) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  const auto found = task->make({});
  const auto expected = stage.open(file)->heights(*stage.tiling, {0, 1, 0, 1}, heightLayout, {});
  ASSERT_TRUE(found && expected);
  EXPECT_NEAR(found->minimum, expected->minimum, 20.0);
  EXPECT_NEAR(found->maximum, expected->maximum, 20.0);
}

class ServerDownTest : public ServiceTest {
 protected:
  ServerDownTest() { WorldRaster::cut(raster(), folder / "tiles"); }
  [[nodiscard]] std::string document() const {
    return WorldRaster::document("http://127.0.0.1:" + std::to_string(port));
  }
  [[nodiscard]] std::unique_ptr<ServerProcess> start() const {
    return std::make_unique<ServerProcess>(ServerProcess::fileServer((folder / "tiles").string(), port), port);
  }

  int port = freePort();
};

TEST_F(ServerDownTest, TilesWaitForAServerThatComesUpLater) {
  ServiceStage stage;
  const auto layer = stage.open(document());
  const std::uint32_t stream = stage.streamer->newStream();
  for (int i = 0; i < 300; ++i) {
    ASSERT_EQ(stage.frame(layer, stream, {0, 1, 0, 1}).state, State::Pending);
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  const auto server = start();
  TileAnswer answer = stage.frame(layer, stream, {0, 1, 0, 1});
  while (answer.state == State::Pending) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
    answer = stage.frame(layer, stream, {0, 1, 0, 1});
  }
  ASSERT_EQ(answer.state, State::Ready) << answer.error->message();
  expectRaster(stage, layer, 2, {{0, 1, 0, 1}});
}

TEST_F(ServerDownTest, WhatIsOnDiskIsDrawnWithoutTheServer) {
  {
    ServiceStage stage(folder / "cache");
    const auto server = start();
    expectRaster(stage, stage.open(document()), 2);
  }
  ServiceStage stage(folder / "cache");
  expectRaster(stage, stage.open(document()), 2);
}

TEST_F(ServerDownTest, CapabilitiesAreWaitedForAndThenReadOrNot) {
  ServiceStage stage;
  const auto layer = stage.make({{"FilePath", "WMTS:http://127.0.0.1:" + std::to_string(port) + "/a.xml,layer=a"}});
  TileProvider::openOn(stage.workers, layer);
  EXPECT_EQ(layer->state(), TileProvider::State::Opening);
  while (!layer->lastFailure()) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  EXPECT_THAT(layer->lastFailure()->message(), HasSubstr("127.0.0.1"));
  EXPECT_EQ(layer->state(), TileProvider::State::Opening);
  const auto server = start();  // which has no such file
  while (layer->state() == TileProvider::State::Opening) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  ASSERT_EQ(layer->state(), TileProvider::State::Failed);
  EXPECT_THAT(layer->error()->message(), HasSubstr("a.xml"));
  EXPECT_FALSE(layer->lastFailure());
}

TEST_F(ServerDownTest, NothingIsAnsweredOnceTheNetworkHasEnded) {
  ServiceStage stage;
  EXPECT_FALSE(stage.fetcher->hasStarted());
  const FetchRequest request{.url = "http://127.0.0.1:" + std::to_string(port) + "/0/0/0.png"};
  const auto unexpected = [](const Result<Fetched>&) { ADD_FAILURE() << "answered"; };
  const auto before = stage.fetcher->fetch(request, unexpected);
  EXPECT_TRUE(stage.fetcher->hasStarted());
  stage.fetcher->close();
  const auto server = start();
  const auto after = stage.fetcher->fetch(request, unexpected);
  EXPECT_NE(after, nullptr);
  EXPECT_FALSE(stage.fetcher->hasStarted());
}

TEST_F(ServerDownTest, ALayerThatIsRemovedWhileItOpensIsForgotten) {
  ServiceStage stage;
  auto layer = stage.make({{"FilePath", "WMTS:http://127.0.0.1:" + std::to_string(port) + "/a.xml,layer=a"}});
  const std::weak_ptr<TileProvider> watched = layer;
  TileProvider::openOn(stage.workers, layer);
  layer.reset();
  stage.workers.drain();
  EXPECT_TRUE(watched.expired());
}

}  // namespace
}  // namespace meridian::globebrowsing

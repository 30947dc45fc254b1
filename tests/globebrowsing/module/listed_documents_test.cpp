// Lists of services: the documents that they name are loaded, so many of them, and what is missing is told.
#include <filesystem>
#include <fstream>
#include <thread>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "../source/fake_fetcher.h"
#include "globebrowsing/capabilities_loader.h"
#include "globebrowsing/server_documents.h"

namespace meridian::globebrowsing {
namespace {

using test::FakeFetcher;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

const std::string host = "http://h";

std::string tileMap(const std::string& title) {
  return "<TileMap version='1.0.0'><Title>" + title +
         "</Title><SRS>EPSG:4326</SRS><BoundingBox minx='-180' miny='-90' maxx='180' maxy='90'/><Origin x='-180' "
         "y='-90'/><TileFormat width='256' height='256' mime-type='image/png' extension='png'/><TileSets>"
         "<TileSet href='0' units-per-pixel='0.703125' order='0'/></TileSets></TileMap>";
}

std::string tileMaps(const std::vector<std::string>& names) {
  std::string entries;
  for (const std::string& name : names) {
    entries += "<TileMap title='" + name + "' href='" + host + "/" + name + "/'/>";
  }
  return "<TileMapService version='1.0.0'><Title>s</Title><TileMaps>" + entries + "</TileMaps></TileMapService>";
}

class ListedDocuments : public testing::Test {
 protected:
  ~ListedDocuments() override { workers_.stop(); }

  void give(const std::string& path, const std::string& text) { texts_[host + path] = text; }
  /// The loader's answer for the server at that path.
  MapServers::Offer offered(const std::string& path, std::chrono::seconds wait = std::chrono::hours(1)) {
    return offeredAt(host + path, wait);
  }
  MapServers::Offer offeredAt(const std::string& url, std::chrono::seconds wait = std::chrono::hours(1)) {
    CapabilitiesLoader loader(workers_, fetcher_, wait);
    std::optional<MapServers::Offer> answer;
    loader.load({"S", "Earth", url}, [&](MapServers::Offer offer) { answer = std::move(offer); });
    while (!answer) {
      loader.deliver();
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return *answer;
  }
  static std::vector<std::string> namesOf(const MapServers::Offer& offer) {
    std::vector<std::string> names;
    for (const OfferedLayer& layer : offer->layers) {
      EXPECT_EQ(layer.obstacle, "") << layer.name;
      names.push_back(layer.name);
    }
    return names;
  }

  std::map<std::string, std::string> texts_;
  WorkerPool workers_{2};
  std::shared_ptr<FakeFetcher> fetcher_ =
      std::make_shared<FakeFetcher>([this](const std::string& url) -> Result<Fetched> {
        const auto found = texts_.find(url);
        if (found == texts_.end()) {
          return failure("the server answers 404", url);
        }
        Fetched fetched;
        fetched.body = std::make_shared<const std::vector<std::uint8_t>>(found->second.begin(), found->second.end());
        return fetched;
      });
};

TEST_F(ListedDocuments, ATileMapServersMapsAreItsLayers) {
  give("/", "<Services><TileMapService title='s' version='1.0.0' href='http://h/1.0.0/'/></Services>");
  give("/1.0.0/", tileMaps({"a", "b", "c"}));
  for (const char* name : {"a", "b", "c"}) {
    give("/" + std::string(name) + "/", tileMap(name));
  }
  const MapServers::Offer offer = offered("/");
  ASSERT_TRUE(offer) << offer.error().message();
  EXPECT_THAT(namesOf(offer), ElementsAre("a", "b", "c")) << "in the order of the list, whichever came first";
  EXPECT_EQ(offer->message, "");
  EXPECT_THAT(offer->layers.back().url, AllOf(HasSubstr("TMS:http://h/c/"), Not(HasSubstr("layer="))))
      << "one level: which number is which cannot be seen";
  EXPECT_EQ(fetcher_->accepted().size(), 5U);
}

TEST_F(ListedDocuments, AnArcGisServersFoldersAreFollowed) {
  const std::string services = "/arcgis/rest/services";
  give(services + "?f=json", R"({"folders":["F"],"services":[{"name":"Top","type":"MapServer"}]})");
  give(services + "/F?f=json", R"({"folders":["G"],"services":[{"name":"F/In","type":"ImageServer"}]})");
  const std::string place =
      R"("fullExtent":{"xmin":-10,"ymin":40,"xmax":10,"ymax":50,"spatialReference":{"wkid":4326}})";
  give(services + "/Top/MapServer?f=json", R"({"mapName":"Layers","capabilities":"Map",)" + place + "}");
  give(services + "/F/In/ImageServer?f=json", R"({"name":"F/In","pixelType":"U8",)" + place + "}");
  give(services + "/G?f=json", R"({"folders":[],"services":[{"name":"G/Deep","type":"MapServer"}]})");
  const MapServers::Offer offer = offered(services + "?f=json");
  ASSERT_TRUE(offer) << offer.error().message();
  EXPECT_THAT(namesOf(offer), ElementsAre("F/In", "Top: Layers"));
  EXPECT_EQ(offer->layers.front().url, "ArcGIS:" + host + services + "/F/In/ImageServer?f=json");
  EXPECT_EQ(offer->message, "1 of 5 documents were left out: 1 in lists within more than 2 lists");
}

TEST_F(ListedDocuments, NoMoreThanSoMany) {
  std::vector<std::string> names;
  for (int i = 0; i < 300; ++i) {
    names.push_back(fmt::format("map{}", i));
    give("/" + names.back() + "/", tileMap(names.back()));
  }
  give("/", tileMaps(names));
  const MapServers::Offer offer = offered("/");
  ASSERT_TRUE(offer) << offer.error().message();
  EXPECT_EQ(offer->layers.size(), ServerDocuments::mostDocuments);
  EXPECT_EQ(fetcher_->asked().size(), ServerDocuments::mostDocuments + 1);
  EXPECT_THAT(offer->message, HasSubstr("44 of 300 documents were left out: 44 beyond the 256"));
}

TEST_F(ListedDocuments, WhatCannotBeLoadedIsTold) {
  give("/", tileMaps({"a", "gone", "page"}));
  give("/a/", tileMap("a"));
  give("/page/", "<html><body>moved</body></html>");
  const MapServers::Offer offer = offered("/");
  ASSERT_TRUE(offer) << offer.error().message();
  EXPECT_THAT(namesOf(offer), ElementsAre("a"));
  EXPECT_THAT(offer->message,
              AllOf(HasSubstr("2 of 3 documents were left out: 2 that could not be loaded"), HasSubstr("h/gone/")));
  EXPECT_EQ(fetcher_->accepted().count(host + "/page/"), 0U) << "it is not kept";
  EXPECT_FALSE(offered("/none"));
}

TEST_F(ListedDocuments, ListsThatNameEachOtherEnd) {
  give("/", "<Services><TileMapService href='http://h/'/><TileMapService href='http://h/b/'/></Services>");
  give("/b/", "<Services><TileMapService href='http://h/'/><TileMapService href='http://h/b/'/></Services>");
  const MapServers::Offer offer = offered("/");
  ASSERT_TRUE(offer) << offer.error().message();
  EXPECT_TRUE(offer->layers.empty());
  EXPECT_EQ(fetcher_->asked(), (FakeFetcher::Ledger{{host + "/", 1}, {host + "/b/", 1}}));
}

TEST_F(ListedDocuments, WhenTimeIsUpWhatIsThereIsOffered) {
  fetcher_->stall(true);
  const MapServers::Offer none = offered("/", std::chrono::seconds(0));
  ASSERT_FALSE(none);
  EXPECT_THAT(none.error().message(), HasSubstr("did not arrive"));
  ServerDocuments documents({"S", "Earth", host + "/"});
  std::vector<ServerDocuments::Entry> entries{{{}, host + "/1/", "one"}, {{}, host + "/2/", "two"}};
  ASSERT_EQ(documents.put(0, entries).size(), 2U);
  EXPECT_TRUE(documents.put(1, std::vector<ServerDocuments::Entry>{{OfferedLayer{"first", "TMS:x"}}}).empty());
  EXPECT_FALSE(documents.isComplete());
  const MapServers::Offer some = documents.offer("did not arrive within 15 seconds");
  ASSERT_TRUE(some);
  EXPECT_THAT(namesOf(some), ElementsAre("one: first"));
  EXPECT_EQ(some->message, "1 of 2 documents were left out: 1 did not arrive within 15 seconds");
}

TEST_F(ListedDocuments, AListInAFileNamesOnlyServers) {
  const std::string path = testing::TempDir() + "meridian_list.xml";
  std::ofstream(path) << "<TileMapService version='1.0.0'><TileMaps><TileMap title='a' href='http://h/a/'/>"
                         "<TileMap title='b' href='b/'/></TileMaps></TileMapService>";
  give("/a/", tileMap("a"));
  const MapServers::Offer offer = offeredAt(path);
  ASSERT_TRUE(offer) << offer.error().message();
  EXPECT_THAT(namesOf(offer), ElementsAre("a"));
  EXPECT_EQ(offer->message, "1 of 2 documents were left out: 1 at addresses of no server");
  std::filesystem::remove(path);
}

}  // namespace
}  // namespace meridian::globebrowsing

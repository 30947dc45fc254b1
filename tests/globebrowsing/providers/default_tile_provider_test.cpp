#include "globebrowsing/providers/default_tile_provider.h"

#include <fstream>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "globebrowsing/streaming/worker_pool.h"
#include "provider_fixture.h"

namespace meridian::globebrowsing {
namespace {

using testing::HasSubstr;
using State = TileProvider::State;

TEST(DataPath, TellsFilesDocumentsAndConnectionsApart) {
  struct Case {
    const char* filePath;
    DataPath::Kind kind;
    const char* text;
  };
  for (const Case& c : {Case{"earth.tif", DataPath::Kind::File, "/assets/earth/earth.tif"},
                        Case{"../moon/moon.vrt", DataPath::Kind::File, "/assets/moon/moon.vrt"},
                        Case{"/else/where.tif", DataPath::Kind::File, "/else/where.tif"},
                        Case{"  \n<VRTDataset/>", DataPath::Kind::Document, "  \n<VRTDataset/>"},
                        Case{"WMS:http://a/b", DataPath::Kind::Connection, "WMS:http://a/b"},
                        Case{"NETCDF:\"a.nc\":z", DataPath::Kind::Connection, "NETCDF:\"a.nc\":z"},
                        Case{"/vsizip/a.zip/b.tif", DataPath::Kind::Connection, "/vsizip/a.zip/b.tif"}}) {
    const DataPath path = dataPath(c.filePath, "/assets/earth");
    EXPECT_EQ(path.kind, c.kind) << c.filePath;
    EXPECT_EQ(path.text, c.text);
  }
}

TEST(DefaultTileProvider, SaysWhatIsWrongWithItsFile) {
  const TemporaryFolder folder("provider");
  std::filesystem::create_directory(folder.path() + "/folder.tif");
  std::ofstream(folder.path() + "/text.tif") << "this is no raster";
  struct Case {
    const char* file;
    bool usable;
    const char* what;
  };
  for (const Case& c : {Case{"missing.tif", false, "does not exist"}, Case{"folder.tif", false, "is a directory"},
                        Case{"text.tif", true, ""}}) {
    const auto provider = makeProvider(requestFor({{"FilePath", c.file}}, folder.path()));
    ASSERT_TRUE(provider);
    EXPECT_EQ((*provider)->check().has_value(), c.usable) << c.file;
    EXPECT_EQ((*provider)->state(), State::NotOpened);
    EXPECT_FALSE((*provider)->error());
    const Result<void> opened = (*provider)->open();
    ASSERT_FALSE(opened) << c.file;
    EXPECT_THAT(opened.error().message(), HasSubstr(c.what));
    EXPECT_THAT(opened.error().message(), HasSubstr("mars.asset:4"));
    EXPECT_EQ((*provider)->state(), State::Failed);
    EXPECT_EQ((*provider)->error()->what, opened.error().what);
    EXPECT_FALSE((*provider)->open()) << "the first outcome stays";
    EXPECT_FALSE((*provider)->colours(earthTiling(), {}, {}));
    EXPECT_FALSE((*provider)->overlaps(earthTiling(), {}));
  }
}

class RealRasters : public testing::Test {
 protected:
  static std::shared_ptr<TileProvider> provider(Fields fields) {
    const std::string file = *fields.at("FilePath").string();
    if (!std::filesystem::exists(file)) {
      return nullptr;
    }
    auto made = makeProvider(requestFor(std::move(fields)));
    EXPECT_TRUE(made) << made.error().message();
    return *made;
  }
};

TEST_F(RealRasters, Etopo5GivesTheHeightsOfTheEarth) {
  const auto etopo = provider({{"FilePath", "/usr/share/ferret-vis/data/etopo5.cdf"}});
  if (etopo == nullptr) {
    GTEST_SKIP() << "NOT TESTED: install ferret-datasets for etopo5.cdf";
  }
  const GeodeticTiling tiling = earthTiling();
  EXPECT_FALSE(etopo->heights(tiling, {}, heightLayout, {})) << "not open yet";
  WorkerPool workers(1);
  TileProvider::openOn(workers, etopo);
  EXPECT_NE(etopo->state(), State::NotOpened);
  TileProvider::openOn(workers, etopo);
  workers.drain();
  ASSERT_EQ(etopo->state(), State::Ready) << etopo->error()->message();
  EXPECT_TRUE(etopo->overlaps(tiling, {}));
  EXPECT_TRUE(etopo->hasFinerHeights(tiling, {}));
  EXPECT_FALSE(etopo->hasFinerHeights(tiling, {0, 12, 0, 2000}));

  const double degrees = std::numbers::pi / 180.0;
  // Tibet's plateau and the abyss of the western Pacific, on tiles of about 5 arc minutes per node.
  for (const auto& [latitude, longitude, least, greatest] :
       {std::tuple{33.0, 88.0, 4000.0, 6500.0}, std::tuple{15.0, 150.0, -7000.0, -3000.0}}) {
    const TilePlace place = tiling.locate(latitude * degrees, longitude * degrees, 4);
    const Result<HeightPixels> heights = etopo->heights(tiling, place.index, heightLayout, {});
    ASSERT_TRUE(heights) << heights.error().message();
    ASSERT_EQ(heights->size, heightLayout.size());
    const auto at = [&](double uv) { return static_cast<std::size_t>(std::lround(uv * 128.0) + 1); };
    const float metres = heights->metres[at(place.uv.y) * static_cast<std::size_t>(heights->size) + at(place.uv.x)];
    EXPECT_GT(metres, least);
    EXPECT_LT(metres, greatest);
  }
}

TEST_F(RealRasters, ACancelledTileIsAnErrorAndNotAPicture) {
  const auto etopo = provider({{"FilePath", "/usr/share/ferret-vis/data/etopo5.cdf"}});
  if (etopo == nullptr) {
    GTEST_SKIP() << "NOT TESTED: install ferret-datasets for etopo5.cdf";
  }
  ASSERT_TRUE(etopo->open());
  std::stop_source stop;
  stop.request_stop();
  EXPECT_FALSE(etopo->heights(earthTiling(), {}, heightLayout, stop.get_token()));
}

TEST_F(RealRasters, HeightKeysReachTheRaster) {
  const std::string file = "/usr/share/ferret-vis/data/etopo60.cdf";
  const auto plain = provider({{"FilePath", file}});
  const auto lifted = provider({{"FilePath", file}, {"HeightScale", 2.0}, {"HeightDatum", 100.0}});
  if (plain == nullptr) {
    GTEST_SKIP() << "NOT TESTED: install ferret-datasets for etopo60.cdf";
  }
  ASSERT_TRUE(plain->open());
  ASSERT_TRUE(lifted->open());
  const auto a = plain->heights(earthTiling(), {1, 1, 0, 0}, heightLayout, {});
  const auto b = lifted->heights(earthTiling(), {1, 1, 0, 0}, heightLayout, {});
  ASSERT_TRUE(a && b);
  for (std::size_t i = 0; i < a->metres.size(); i += 101) {
    EXPECT_NEAR(b->metres[i], 2.0F * a->metres[i] - 100.0F, 0.01F);
  }
}

}  // namespace
}  // namespace meridian::globebrowsing

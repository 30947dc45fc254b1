#include "globebrowsing/providers/temporal_tile_provider.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "globebrowsing/providers/colormap.h"
#include "globebrowsing/providers/inner_providers.h"
#include "host/api/property_owner.h"
#include "provider_fixture.h"
#include "support/shared_data.h"

namespace meridian::globebrowsing {
namespace {

using testing::HasSubstr;

constexpr Colour red{255, 0, 0, 255};
constexpr Colour green{0, 255, 0, 255};
constexpr Colour blue{0, 0, 255, 255};

Fields prototyped(Fields more = {}) {
  Fields fields{{"Time", tableOf({{"Start", "2004-02-01"}, {"End", "2004-04-01"}})},
                {"TemporalResolution", "1M"},
                {"TimeFormat", "YYYY-MM"},
                {"Prototype", "world.${OpenSpaceTimeId}.ppm"}};
  for (auto& [key, value] : more) {
    fields[key] = value;
  }
  return {{"Type", "TemporalTileProvider"}, {"Mode", "Prototyped"}, {"Prototyped", tableOf(std::move(fields))}};
}

Fields inFolder(const std::string& folder, const std::string& format = "world.%Y-%m") {
  return {
      {"Type", "TemporalTileLayer"}, {"Mode", "Folder"}, {"Folder", tableOf({{"Folder", folder}, {"Format", format}})}};
}

/// February is red, March green, April blue.
class TemporalTileProviderTest : public testing::Test {
 protected:
  TemporalTileProviderTest() {
    writeImage(folder_.path() + "/world.2004-02.ppm", {255, 0, 0});
    writeImage(folder_.path() + "/world.2004-03.ppm", {0, 255, 0});
    writeImage(folder_.path() + "/world.2004-04.ppm", {0, 0, 255});
  }
  std::shared_ptr<TileProvider> open(Fields fields) {
    auto provider = makeProvider(requestFor(std::move(fields), folder_.path()));
    EXPECT_TRUE(provider) << provider.error().message();
    const Result<void> checked = (*provider)->check();
    EXPECT_TRUE(checked) << checked.error().message();
    const Result<void> opened = (*provider)->open();
    EXPECT_TRUE(opened) << opened.error().message();
    return *provider;
  }
  static void expectMonths(const TileProvider& provider) {
    EXPECT_EQ(middleAt(provider, "1990-01-01"), red) << "before the first";
    EXPECT_EQ(middleAt(provider, "2004-02-01"), red);
    EXPECT_EQ(middleAt(provider, "2004-02-29T23:59:59.999"), red);
    EXPECT_EQ(middleAt(provider, "2004-03-01"), green);
    EXPECT_EQ(middleAt(provider, "2004-03-31T23:59:59"), green);
    EXPECT_EQ(middleAt(provider, "2004-04-01T00:00:00"), blue);
    EXPECT_EQ(middleAt(provider, "2026-01-01"), blue) << "after the last";
    const TileSteps& steps = *provider.steps();
    const TileStep march = steps.at(timeOf("2004-03-10"));
    EXPECT_EQ(march.begin.utc(), "2004-03-01T00:00:00.000");
    EXPECT_EQ(march.end.utc(), "2004-04-01T00:00:00.000");
    EXPECT_EQ(march.id, steps.at(timeOf("2004-03-01")).id);
    EXPECT_NE(march.id, steps.at(march.end).id);
    EXPECT_NE(march.id, steps.at(march.begin + -0.001).id);
    EXPECT_EQ(steps.at(timeOf("2003-01-01")).begin.tdbSeconds(), -INFINITY);
    EXPECT_EQ(steps.at(timeOf("2005-01-01")).end.tdbSeconds(), INFINITY);
  }

  TemporaryFolder folder_{"temporal"};
};

TEST_F(TemporalTileProviderTest, GoesThroughAPrototypesTimes) {
  expectMonths(*open(prototyped()));
}

TEST_F(TemporalTileProviderTest, GoesThroughAFoldersFiles) {
  std::ofstream(folder_.path() + "/readme.txt") << "no data";
  std::ofstream(folder_.path() + "/world.2004-13.ppm") << "no month";
  std::filesystem::create_directory(folder_.path() + "/world.2004-05");
  expectMonths(*open(inFolder(folder_.path())));
  expectMonths(*open(inFolder(".")));
}

TEST_F(TemporalTileProviderTest, ReadsTheOlderXml) {
  const std::string xml = R"(<OpenSpaceTemporalGDALDataset>
      <OpenSpaceTimeStart>2004-02-01</OpenSpaceTimeStart>
      <OpenSpaceTimeEnd>2004-04-01</OpenSpaceTimeEnd>
      <OpenSpaceTimeResolution>1M</OpenSpaceTimeResolution>
      <OpenSpaceTimeIdFormat>YYYY-MM-DD</OpenSpaceTimeIdFormat>
      <FilePath>day.${OpenSpaceTimeId}.ppm</FilePath>
    </OpenSpaceTemporalGDALDataset>)";
  for (const char* month : {"2", "3", "4"}) {
    const std::string base = folder_.path();
    std::filesystem::rename(base + "/world.2004-0" + month + ".ppm", base + "/day.2004-0" + month + "-01.ppm");
  }
  expectMonths(*open({{"Type", "TemporalTileLayer"}, {"FilePath", xml}}));
  expectMonths(*open({{"FilePath", xml}}));
  EXPECT_EQ(*layerTypeOf(requestFor({{"FilePath", xml}})), LayerType::TemporalTileProvider);
  std::ofstream(folder_.path() + "/months.xml") << xml;
  expectMonths(*open({{"Type", "TemporalTileLayer"}, {"FilePath", "months.xml"}}));
}

TEST_F(TemporalTileProviderTest, KeepsToAFixedTime) {
  for (Fields fields : {prototyped(), inFolder(".")}) {
    fields.insert({{"UseFixedTime", true}, {"FixedTime", "2004-03-01"}});
    const auto provider = open(std::move(fields));
    EXPECT_EQ(middleAt(*provider, "2004-02-01"), green);
    PropertyOwner& properties = *provider->properties();
    EXPECT_EQ(properties.identifier(), "TileProvider");
    ASSERT_TRUE(properties.property("FixedTime")->set("2004-04-01"));
    EXPECT_EQ(middleAt(*provider, "2004-02-01"), blue);
    ASSERT_TRUE(properties.property("FixedTime")->set("some day"));
    EXPECT_EQ(middleAt(*provider, "2004-02-01"), red) << "the scene's time";
    ASSERT_TRUE(properties.property("FixedTime")->set("2004-04-01"));
    ASSERT_TRUE(properties.property("UseFixedTime")->set(false));
    EXPECT_EQ(middleAt(*provider, "2004-03-05"), green);
  }
  const auto folder = open([] {
    Fields fields = inFolder(".");
    fields.insert({{"UseFixedTime", true}, {"FixedTime", "2010-01-01"}});
    return fields;
  }());
  EXPECT_EQ(middleAt(*folder, "2004-02-01"), blue) << "past the last file";
}

/// An image of one row, 24-bit BMP.
void writeRow(const std::string& path, const std::vector<std::array<int, 3>>& colours) {
  const std::size_t row = (3 * colours.size() + 3) / 4 * 4;
  std::string bytes(54 + row, '\0');
  const auto put = [&](std::size_t at, std::size_t number) {
    for (std::size_t i = 0; i < 4; ++i) {
      bytes[at + i] = static_cast<char>(number >> (8 * i) & 255U);
    }
  };
  bytes[0] = 'B';
  bytes[1] = 'M';
  put(2, bytes.size());
  put(10, 54);
  put(14, 40);
  put(18, colours.size());
  put(22, 1);
  bytes[26] = 1;
  bytes[28] = 24;
  for (std::size_t i = 0; i < colours.size(); ++i) {
    for (std::size_t band = 0; band < 3; ++band) {
      bytes[54 + 3 * i + band] = static_cast<char>(colours[i][2 - band]);
    }
  }
  std::ofstream(path, std::ios::binary) << bytes;
}

TEST_F(TemporalTileProviderTest, InterpolatesWhereAskedTo) {
  EXPECT_FALSE(open(prototyped())->steps()->interpolates());
  for (Fields fields : {prototyped(), inFolder(".")}) {
    fields["Interpolation"] = true;
    fields["FixedTime"] = "2004-03-01";
    const auto provider = open(std::move(fields));
    const TileSteps& steps = *provider->steps();
    EXPECT_TRUE(steps.interpolates());
    EXPECT_EQ(steps.at(timeOf("2004-02-10")).instant.utc(), "2004-02-01T00:00:00.000") << "of the first, too";
    EXPECT_EQ(steps.at(timeOf("2004-03-10")).instant.utc(), "2004-03-01T00:00:00.000");
    PropertyOwner& properties = *provider->properties();
    ASSERT_TRUE(properties.property("UseFixedTime")->set(true));
    EXPECT_FALSE(steps.interpolates()) << "a fixed time is one step";
    ASSERT_TRUE(properties.property("UseFixedTime")->set(false));
    ASSERT_TRUE(properties.property("Interpolation")->set(false));
    EXPECT_FALSE(steps.interpolates());
  }
}

TEST_F(TemporalTileProviderTest, ColoursTheFirstBandByAColormap) {
  writeRow(folder_.path() + "/map.bmp", {{0, 0, 255}, {0, 255, 0}, {255, 0, 0}});
  writeImage(folder_.path() + "/world.2004-03.ppm", {51, 200, 100});
  Fields fields = inFolder(".");
  fields["Colormap"] = "map.bmp";
  const auto provider = open(fields);
  EXPECT_EQ(middleAt(*provider, "2004-02-10"), (Colour{255, 0, 0, 255})) << "255 is the last colour";
  EXPECT_EQ(middleAt(*provider, "2004-03-10"), (Colour{0, 102, 153, 255}))
      << "51 / 255 is 0.4 of the way to the middle";
  EXPECT_EQ(middleAt(*provider, "2004-04-10"), (Colour{0, 0, 255, 255})) << "0 is the first";
  fields["Colormap"] = "";
  EXPECT_EQ(middleAt(*open(fields), "2004-03-10"), (Colour{51, 200, 100, 255}));
}

TEST_F(TemporalTileProviderTest, KeepsTheAlphaOfWhatAColormapColours) {
  writeRow(folder_.path() + "/map.bmp", {{9, 8, 7}});
  const auto colormap = Colormap::read(folder_.path() + "/map.bmp", "here");
  ASSERT_TRUE(colormap) << colormap.error().message();
  ColourPixels pixels{1, {200, 1, 2, 77}, true, false};
  (*colormap)->apply(pixels);
  EXPECT_EQ(pixels.rgba, (std::vector<std::uint8_t>{9, 8, 7, 77}));
  ColourPixels nothing;
  (*colormap)->apply(nothing);
  EXPECT_TRUE(nothing.rgba.empty());
}

TEST_F(TemporalTileProviderTest, SaysWhatIsWrongWithItsColormap) {
  std::ofstream(folder_.path() + "/text.png") << "no image";
  std::ofstream(folder_.path() + "/empty.png");
  struct Case {
    const char* colormap;
    bool usable;
    const char* what;
  };
  for (const Case& c : {Case{"gone.png", false, "gone.png does not exist"}, Case{".", false, "does not exist"},
                        Case{"text.png", true, "text.png"}, Case{"empty.png", true, "empty.png"}}) {
    Fields fields = inFolder(".");
    fields["Colormap"] = c.colormap;
    const auto made = makeProvider(requestFor(fields, folder_.path()));
    ASSERT_TRUE(made);
    EXPECT_EQ((*made)->check().has_value(), c.usable) << c.colormap;
    const Result<void> opened = (*made)->open();
    ASSERT_FALSE(opened) << c.colormap;
    EXPECT_THAT(opened.error().message(), HasSubstr(c.what));
    EXPECT_THAT(opened.error().message(), HasSubstr("mars.asset:4: Layers.ColorLayers[1].Colormap"));
  }
}

TEST_F(TemporalTileProviderTest, AStepWithoutItsFileFailsAlone) {
  std::filesystem::remove(folder_.path() + "/world.2004-03.ppm");
  const auto provider = open(prototyped());
  const auto march = provider->steps()->make(timeOf("2004-03-10"));
  ASSERT_TRUE(march);
  const Result<void> opened = (*march)->open();
  ASSERT_FALSE(opened);
  EXPECT_THAT(opened.error().message(), HasSubstr("world.2004-03.ppm"));
  EXPECT_THAT(opened.error().message(), HasSubstr("mars.asset:4"));
  EXPECT_EQ(middleAt(*provider, "2004-04-10"), blue);
}

TEST_F(TemporalTileProviderTest, WritesEveryTimeAndLeavesWhatIsGdals) {
  Fields fields = prototyped({{"TimeFormat", "YYYY-DOYTHR:MN:SCZ"},
                              {"Prototype", "<GDAL_WMS><T>${OpenSpaceTimeId}/${z}/${OpenSpaceTimeId}</T></GDAL_WMS>"}});
  const auto series = PrototypedSeries::make(requestFor(std::move(fields)));
  ASSERT_TRUE(series) << series.error().message();
  EXPECT_EQ(*(*series)->filePath((*series)->at(timeOf("2004-03-10").utcInstant()).instant),
            "<GDAL_WMS><T>2004-061T00:00:00Z/${z}/2004-061T00:00:00Z</T></GDAL_WMS>");
}

TEST_F(TemporalTileProviderTest, TodayIsTheLastStepBeforeNow) {
  Fields fields = prototyped({{"Time", tableOf({{"Start", "2000-01-01"}, {"End", "Today"}})},
                              {"TemporalResolution", "1d"},
                              {"TimeFormat", "YYYY-MM-DDTHR:MN:SC"}});
  const auto series = PrototypedSeries::make(requestFor(std::move(fields)));
  ASSERT_TRUE(series) << series.error().message();
  const std::string last = *(*series)->filePath((*series)->at(timeOf("2999-01-01").utcInstant()).instant);
  EXPECT_THAT(last, HasSubstr("T00:00:00"));
  const Time::UtcInstant shown = (*series)->at(timeOf("2999-01-01").utcInstant()).instant;
  EXPECT_GT(shown, Time::now().utcInstant() - std::chrono::hours(48));
  EXPECT_LE(shown, Time::now().utcInstant());
}

TEST_F(TemporalTileProviderTest, SaysWhatIsWrongWithItsTable) {
  const auto time = [](const char* start, const char* end) { return tableOf({{"Start", start}, {"End", end}}); };
  Fields nothing{{"Type", "TemporalTileProvider"}, {"Mode", "Folder"}};
  Fields mode = prototyped();
  mode["Mode"] = "Spooled";
  Fields fixed = prototyped();
  fixed["FixedTime"] = "some day";
  Fields inherited = prototyped();
  inherited["TilePixelSize"] = 3;
  Fields xml{{"Type", "TemporalTileLayer"}, {"FilePath", "<OpenSpaceTemporalGDALDataset><a></b>"}};
  Fields empty{{"Type", "TemporalTileLayer"}, {"FilePath", "<OpenSpaceTemporalGDALDataset/>"}};
  Fields other{{"Type", "TemporalTileLayer"}, {"FilePath", "<GDAL_WMS/>"}};
  const std::vector<std::pair<Fields, const char*>> table{
      {nothing, "Mode"},
      {mode, "Mode"},
      {fixed, "FixedTime"},
      {inherited, "TilePixelSize"},
      {xml, "FilePath"},
      {empty, "FilePath"},
      {other, "FilePath"},
      {prototyped({{"Time", time("2004-02-30", "2005-01-01")}}), "Prototyped.Time.Start"},
      {prototyped({{"Time", time("2004-02-01", "whenever")}}), "Prototyped.Time.End"},
      {prototyped({{"Time", time("2004-02-01", "2003-01-01")}}), "Prototyped.Time"},
      {prototyped({{"Time", time("2004-02-01T01:00:00", "2005-01-01")}}), "Prototyped.Time"},
      {prototyped({{"Time", 3}}), "Prototyped.Time"},
      {prototyped({{"Time", tableOf({})}}), "Prototyped.Time.Start"},
      {prototyped({{"TemporalResolution", "0d"}}), "Prototyped.TemporalResolution"},
      {prototyped({{"TimeFormat", "YYYY ::TDB"}}), "Prototyped.TimeFormat"},
      {prototyped({{"Prototype", "world.tif"}}), "Prototyped.Prototype"},
  };
  for (const auto& [fields, key] : table) {
    const auto made = makeProvider(requestFor(fields, folder_.path()));
    ASSERT_FALSE(made) << key;
    EXPECT_EQ(made.error().where, std::string("mars.asset:4: Layers.ColorLayers[1].") + key);
    EXPECT_FALSE(made.error().what.empty());
  }
}

TEST_F(TemporalTileProviderTest, SaysWhatIsWrongWithItsData) {
  std::ofstream(folder_.path() + "/large.xml") << std::string((1 << 20) + 10, ' ');
  std::ofstream(folder_.path() + "/empty.xml");
  std::filesystem::create_directory(folder_.path() + "/nothing");
  struct Case {
    Fields fields;
    bool usable;
    const char* what;
  };
  for (const Case& c :
       {Case{inFolder("gone"), false, "does not exist"}, Case{inFolder("large.xml"), false, "is not a folder"},
        Case{inFolder("nothing"), true, "none of the 0 files"},
        Case{inFolder(".", "moon.%Y"), true, "none of the 5 files"},
        Case{inFolder(".", "world.%Q"), false, "Folder.Format: the format \"world.%Q\" has an unknown conversion %Q"},
        Case{inFolder(".", ""), false, "the format is empty"},
        Case{{{"Type", "TemporalTileLayer"}, {"FilePath", "gone.xml"}}, false, "does not exist"},
        Case{{{"Type", "TemporalTileLayer"}, {"FilePath", "large.xml"}}, true, "longer than"},
        Case{{{"Type", "TemporalTileLayer"}, {"FilePath", "empty.xml"}}, true, "no XML"},
        Case{prototyped({{"Prototype", "gone/${OpenSpaceTimeId}.tif"}}), false, "does not exist"}}) {
    const auto made = makeProvider(requestFor(c.fields, folder_.path()));
    ASSERT_TRUE(made) << made.error().message();
    EXPECT_EQ((*made)->check().has_value(), c.usable) << c.what;
    const Result<void> opened = (*made)->open();
    ASSERT_FALSE(opened) << c.what;
    EXPECT_THAT(opened.error().message(), HasSubstr(c.what));
    EXPECT_THAT(opened.error().message(), HasSubstr("mars.asset:4"));
  }
}

TEST_F(TemporalTileProviderTest, ShowsTheMonthsOfBlueMarble) {
  const std::string months = ::meridian::test::sharedData("imagery/earth/temporal_bmng");
  if (!std::filesystem::exists(months)) {
    GTEST_SKIP() << "NOT TESTED: there is no " << months;
  }
  Fields prototype = prototyped({{"Prototype", months + "/world.${OpenSpaceTimeId}.tif"}});
  std::vector<Colour> seen;
  for (Fields fields : {std::move(prototype), inFolder(months)}) {
    const auto provider = open(std::move(fields));
    // Siberia in the snow's months.
    const TileIndex siberia = earthTiling().locate(1.0, 1.6, 5).index;
    for (const char* month : {"2004-02-10", "2004-03-10", "2004-04-10"}) {
      seen.push_back(middleAt(*provider, month, siberia));
    }
  }
  ASSERT_EQ(seen.size(), 6U);
  EXPECT_NE(seen[0], seen[2]) << "the snow goes";
  EXPECT_TRUE(std::equal(seen.begin(), seen.begin() + 3, seen.begin() + 3)) << "both ways to the same files";
}

}  // namespace
}  // namespace meridian::globebrowsing

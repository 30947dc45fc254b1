#include "globebrowsing/providers/service_series.h"

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "globebrowsing/source/service_text.h"
#include "provider_fixture.h"
#include "support/shared_data.h"

namespace meridian::globebrowsing {
namespace {

using testing::HasSubstr;

TimeSeries::Instant instantAt(const char* text) {
  return timeOf(text).utcInstant();
}

/// A WMS of one layer with a time dimension that stands in this text.
class ServiceSeriesTest : public testing::Test {
 protected:
  std::string capabilities(const std::string& dimension) {
    const std::string path = folder_.path() + "/wms" + std::to_string(++files_) + ".xml";
    std::ofstream(path) << "<WMS_Capabilities version='1.3.0'><Capability><Request><GetMap><Format>image/png</Format>"
                           "<DCPType><HTTP><Get><OnlineResource href='http://127.0.0.1/wms'/></Get></HTTP></DCPType>"
                           "</GetMap></Request><Layer><Name>ice</Name><Title>Ice</Title><CRS>CRS:84</CRS>"
                        << dimension << "</Layer></Capability></WMS_Capabilities>";
    return path;
  }
  std::unique_ptr<ServiceSeries> series(const std::string& dimension) {
    const std::string path = capabilities(dimension);
    auto made = ServiceSeries::make({path, "ice"}, std::make_shared<CapabilitiesDocument>(path, nullptr));
    EXPECT_TRUE(made) << made.error().message();
    return std::unique_ptr<ServiceSeries>(dynamic_cast<ServiceSeries*>(made->release()));
  }
  static std::string shownAt(const ServiceSeries& series, const char* time) {
    return series.valueOf(series.at(instantAt(time)).instant);
  }
  /// Everywhere within an entry's time it is shown, and just outside another is.
  static void expectConsistent(const ServiceSeries& series, TimeSeries::Instant now) {
    using std::chrono::milliseconds;
    const TimeSeries::Entry entry = series.at(now);
    if (entry.begin) {
      EXPECT_LE(*entry.begin, now);
      EXPECT_EQ(series.at(*entry.begin).instant, entry.instant);
      EXPECT_NE(series.at(*entry.begin - milliseconds(1)).begin, entry.begin);
    }
    if (entry.end) {
      EXPECT_GT(*entry.end, now);
      EXPECT_EQ(series.at(*entry.end - milliseconds(1)).instant, entry.instant);
      EXPECT_NE(series.at(*entry.end).end, entry.end);
    }
  }

  TemporaryFolder folder_{"series"};
  int files_ = 0;
};

TEST_F(ServiceSeriesTest, TakesTheLatestValueThatIsNotLater) {
  const auto years = series("<Dimension name='time' units='ISO8601'>2001,2004-03,2010-06-30</Dimension>");
  EXPECT_EQ(shownAt(*years, "1990-01-01"), "2001") << "without a default: the first";
  EXPECT_EQ(shownAt(*years, "2004-02-29"), "2001");
  EXPECT_EQ(shownAt(*years, "2004-03-01"), "2004-03");
  EXPECT_EQ(shownAt(*years, "2026-03-01"), "2010-06-30");
  const TimeSeries::Entry middle = years->at(instantAt("2005-01-01"));
  EXPECT_EQ(middle.begin, instantAt("2004-03-01"));
  EXPECT_EQ(middle.end, instantAt("2010-06-30"));
  EXPECT_FALSE(years->at(instantAt("1990-01-01")).begin);
  EXPECT_FALSE(years->at(instantAt("2026-01-01")).end);
}

TEST_F(ServiceSeriesTest, TakesTheNearestWhereTheServerDoes) {
  const auto nearest =
      series("<Dimension name='time' nearestValue='1' default='2001-01-01'>2001-01-01/2001-01-11/P2D</Dimension>");
  EXPECT_EQ(shownAt(*nearest, "1990-01-01"), "2001-01-01");
  EXPECT_EQ(shownAt(*nearest, "2001-01-02T00:00:00"), "2001-01-01") << "the earlier of two";
  EXPECT_EQ(shownAt(*nearest, "2001-01-02T00:00:00.001"), "2001-01-03");
  EXPECT_EQ(shownAt(*nearest, "2026-01-02"), "2001-01-11");
  for (const char* time : {"1990-01-01", "2001-01-02T00:00:00.001", "2001-01-02", "2001-01-03", "2026-01-01"}) {
    expectConsistent(*nearest, instantAt(time));
  }
}

TEST_F(ServiceSeriesTest, ShowsTheDefaultOutsideOfWhatThereIs) {
  const auto days =
      series("<Dimension name='time' default='2001-01-05' nearestValue='0'>2001-01-01/2001-01-10/P1D</Dimension>");
  EXPECT_EQ(shownAt(*days, "2000-12-31T23:59:59"), "2001-01-05");
  EXPECT_EQ(shownAt(*days, "2001-01-01"), "2001-01-01");
  EXPECT_EQ(shownAt(*days, "2001-01-10T23:59:59"), "2001-01-10") << "its day";
  EXPECT_EQ(shownAt(*days, "2001-01-11"), "2001-01-05");
  for (const char* time : {"1990-01-01", "2001-01-01", "2001-01-05", "2001-01-10T12:00:00", "2026-01-01"}) {
    expectConsistent(*days, instantAt(time));
  }
  // A default that is none of the values is the server's affair: it is not named.
  EXPECT_EQ(shownAt(*series("<Dimension name='time' default='1999'>2001/2003/P1Y</Dimension>"), "2026-01-01"), "");
  EXPECT_EQ(shownAt(*series("<Dimension name='time' default='1999'>2001/2003/P1Y</Dimension>"), "2002-05-01"), "2002");
}

TEST_F(ServiceSeriesTest, GoesThroughSeveralIntervalsAndUnevenPeriods) {
  const auto months = series(
      "<Dimension name='time'>1948-01-31/1948-04-30/P1M,2015-01-01T06:00Z/2015-01-03/PT6H,"
      "2020-01-01T00:00:00Z/2020-01-01T00:00:01Z/PT0.25S</Dimension>");
  EXPECT_EQ(shownAt(*months, "1948-03-30"), "1948-02-29");
  EXPECT_EQ(shownAt(*months, "2000-01-01"), "1948-04-30");
  EXPECT_EQ(shownAt(*months, "2015-01-02T13:00:00"), "2015-01-02T12:00:00Z");
  EXPECT_EQ(shownAt(*months, "2020-01-01T00:00:00.800"), "2020-01-01T00:00:00.75Z");
  for (const char* time : {"1948-02-29", "1948-04-30", "2015-01-02T13:00:00", "2020-01-01T00:00:00.300"}) {
    expectConsistent(*months, instantAt(time));
  }
}

TEST_F(ServiceSeriesTest, CurrentIsTheLatestUpToNow) {
  const auto running =
      series("<Dimension name='time' current='1' default='current'>2020-01-01/2199-01-01/P1Y</Dimension>");
  const std::string year = Time::now().utc().substr(0, 4);
  EXPECT_EQ(shownAt(*running, "2010-01-01"), year + "-01-01");
  EXPECT_EQ(shownAt(*series("<Dimension name='time'>2020-01-01/present/P1Y</Dimension>"), "2300-01-01"),
            year + "-01-01");
}

TEST_F(ServiceSeriesTest, WithoutTimesItIsOneStep) {
  for (const char* dimension :
       {"", "<Dimension name='time'/>", "<Dimension name='time' default='current'/>",
        "<Dimension name='time'>rubbish</Dimension>", "<Dimension name='elevation'>0</Dimension>"}) {
    const auto none = series(dimension);
    const TimeSeries::Entry entry = none->at(instantAt("2004-01-01"));
    EXPECT_FALSE(entry.begin || entry.end) << dimension;
    EXPECT_EQ(none->at(instantAt("1904-01-01")).instant, entry.instant);
    EXPECT_EQ(none->valueOf(entry.instant), "");
  }
  const std::string path = capabilities("<Dimension name='time'>2001,2002</Dimension>");
  CapabilitiesReference reference{path, "ice"};
  reference.choices.time = "2001";
  const auto chosen = ServiceSeries::make(reference, std::make_shared<CapabilitiesDocument>(path, nullptr));
  ASSERT_TRUE(chosen);
  EXPECT_FALSE((*chosen)->at(instantAt("2004-01-01")).begin);
}

TEST_F(ServiceSeriesTest, SaysWhatIsWrong) {
  const std::string path = capabilities("");
  const auto missing = ServiceSeries::make({path, "snow"}, std::make_shared<CapabilitiesDocument>(path, nullptr));
  ASSERT_FALSE(missing);
  EXPECT_THAT(missing.error().message(), HasSubstr("snow"));
  const std::string none = folder_.path() + "/none.xml";
  EXPECT_FALSE(ServiceSeries::make({none, "ice"}, std::make_shared<CapabilitiesDocument>(none, nullptr)));
}

TEST_F(ServiceSeriesTest, ALayerWithoutATypeThatNamesCapabilitiesFollowsTime) {
  const auto typeOf = [](Fields fields) { return *layerTypeOf(requestFor(std::move(fields))); };
  const std::string document =
      "<GDAL_WMS><Service name='WMS'><ServerUrl>http://a/wms?</ServerUrl><Layers>ice</Layers></Service>"
      "<GetCapabilitiesUrl>http://a/wms?REQUEST=GetCapabilities</GetCapabilitiesUrl></GDAL_WMS>";
  for (const std::string& path :
       {std::string("WMTS:http://a/wmts.xml,layer=ice"),
        std::string("WMS:http://a/wms?REQUEST=GetCapabilities,layer=ice,crs=EPSG:4326"), document}) {
    EXPECT_EQ(typeOf({{"FilePath", path}}), LayerType::TemporalTileProvider) << path;
    EXPECT_EQ(typeOf({{"FilePath", path}, {"Type", "DefaultTileProvider"}}), LayerType::DefaultTileProvider) << path;
  }
  for (const char* path : {"WMTS:http://a/wmts.xml,layer=ice,time=2001", "WMS:http://a/wms?LAYERS=ice&SRS=EPSG:4326",
                           "ice.tif", "http://a/{z}/{x}/{y}.png"}) {
    EXPECT_EQ(typeOf({{"FilePath", path}}), LayerType::DefaultTileProvider) << path;
  }
}

/// What a dimension allows, by the C library's calendar.
class Allowed {
 public:
  explicit Allowed(const LayerDimension& dimension) {
    for (const std::string& part : split(dimension.values, ",")) {
      const std::vector<std::string> pieces = split(part, "/");
      if (pieces.size() == 1) {
        values_.insert(part);
      } else {
        intervals_.push_back(pieces);
      }
    }
    if (!dimension.defaultValue.empty()) {
      values_.insert(dimension.defaultValue);
    }
  }
  [[nodiscard]] bool has(const std::string& value) const {
    return values_.contains(value) || std::any_of(intervals_.begin(), intervals_.end(),
                                                  [&](const auto& interval) { return isIn(interval, value); });
  }

 private:
  static std::tm fields(const std::string& text) {
    std::tm tm{};
    tm.tm_mon = 1;
    tm.tm_mday = 1;
    std::sscanf(text.c_str(), "%d-%d-%dT%d:%d:%d", &tm.tm_year, &tm.tm_mon, &tm.tm_mday, &tm.tm_hour, &tm.tm_min,
                &tm.tm_sec);
    tm.tm_year -= 1900;
    --tm.tm_mon;
    return tm;
  }
  static bool isIn(const std::vector<std::string>& interval, const std::string& value) {
    std::tm start = fields(interval[0]);
    std::tm end = fields(interval[1]);
    std::tm at = fields(value);
    const int months = 12 * (at.tm_year - start.tm_year) + at.tm_mon - start.tm_mon;
    const bool isSameDay = at.tm_mday == start.tm_mday && at.tm_hour == start.tm_hour;
    const std::time_t since = timegm(&at) - timegm(&start);
    if (since < 0 || timegm(&at) > timegm(&end)) {
      return false;
    }
    int count = 0;
    char unit = 0;
    const std::string period = interval.size() > 2 ? interval[2] : "P1D";
    if (period.starts_with("PT")) {
      std::time_t seconds = 0;
      int used = 0;
      for (const char* rest = period.c_str() + 2; std::sscanf(rest, "%d%c%n", &count, &unit, &used) == 2;
           rest += used) {
        seconds += count * (unit == 'H' ? 3600 : unit == 'M' ? 60 : 1);
      }
      return since % seconds == 0;
    }
    if (std::sscanf(period.c_str(), "P%d%c", &count, &unit) != 2 || count == 0) {
      return true;
    }
    return unit == 'D'   ? since % (count * 86400) == 0
           : unit == 'W' ? since % (count * 604800) == 0
           : unit == 'M' ? isSameDay && months % count == 0
                         : isSameDay && months % (12 * count) == 0;
  }

  std::set<std::string> values_;
  std::vector<std::vector<std::string>> intervals_;
};

TEST(SharedCapabilities, EveryTimeThatIsAskedForIsAllowed) {
  const std::string data = ::meridian::test::sharedData("capabilities");
  if (!std::filesystem::exists(data)) {
    GTEST_SKIP() << "NOT TESTED: there is no " << data;
  }
  int layers = 0;
  std::set<std::string> documents;
  for (const auto& file : std::filesystem::directory_iterator(data)) {
    const std::string path = file.path().string();
    const auto document = std::make_shared<CapabilitiesDocument>(path, nullptr);
    const auto capabilities = document->capabilities();
    if (!capabilities) {
      continue;
    }
    for (const CapabilitiesLayer& layer : (*capabilities)->layers) {
      const LayerDimension* dimension = layer.timeDimension();
      if (dimension == nullptr || dimension->values.empty() || !layer.obstacle.empty() || layer.identifier.empty()) {
        continue;
      }
      SCOPED_TRACE(path + ": " + layer.identifier);
      CapabilitiesReference reference{path, layer.identifier};
      const auto made = ServiceSeries::make(reference, document);
      if (!made) {
        continue;  // no CRS or extent of its is known; said in other tests
      }
      const auto& series = dynamic_cast<const ServiceSeries&>(**made);
      if (series.times().isEmpty()) {
        continue;
      }
      ++layers;
      documents.insert(path);
      const Allowed allowed(*dimension);
      for (const char* time : {"1900-01-01", "1948-02-15", "1990-07-04T05:06:07", "2004-08-01", "2005-12-31T23:59:59",
                               "2013-03-31T12:00:00", "2016-02-29", "2017-06-15T12:34:56.789", "2026-11-25"}) {
        const TimeSeries::Entry entry = series.at(instantAt(time));
        const std::string value = series.valueOf(entry.instant);
        EXPECT_TRUE(value.empty() || allowed.has(value)) << value << " of " << dimension->values.substr(0, 200);
        if (value.empty()) {
          EXPECT_FALSE(dimension->defaultValue.empty());
        }
        EXPECT_TRUE(!entry.begin || *entry.begin <= instantAt(time)) << time;
        EXPECT_TRUE(!entry.end || *entry.end > instantAt(time)) << time;
        if (entry.end) {
          EXPECT_EQ(series.at(*entry.end - std::chrono::milliseconds(1)).instant, entry.instant) << time;
        }
        if (entry.begin) {
          EXPECT_EQ(series.at(*entry.begin).instant, entry.instant) << time;
        }
      }
    }
  }
  EXPECT_GE(layers, 300);
  EXPECT_GE(documents.size(), 10U);
}

}  // namespace
}  // namespace meridian::globebrowsing

#include "globebrowsing/providers/time_file_name.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <ctime>
#include <iomanip>
#include <locale>
#include <random>
#include <sstream>
#include <string>

#include <gtest/gtest.h>

namespace meridian::globebrowsing {
namespace {

std::string read(const char* format, const char* name) {
  const Result<TimeFileName> reader = TimeFileName::create(format);
  if (!reader) {
    return "bad format";
  }
  const std::optional<Time::UtcInstant> instant = reader->read(name);
  return instant ? Time::fromUtcInstant(*instant).utc().substr(0, 19) : "no";
}

TEST(TimeFileName, ReadsWhatAssetsUse) {
  struct Case {
    const char* format;
    const char* name;
    const char* time;
  };
  for (const Case& c : {
           Case{"world.%Y-%m", "world.2004-02.tif", "2004-02-01T00:00:00"},
           Case{"%Y%m%d", "20040301.png", "2004-03-01T00:00:00"},
           Case{"%Y%m%d", "20040331", "2004-03-31T00:00:00"},
           Case{"a_%Y%m%d_%H%M%S.png", "a_20040331_235958.png", "2004-03-31T23:59:58"},
           Case{"a_%Y_%j", "a_2004_001.png", "2004-01-01T00:00:00"},
           Case{"%Y%j", "2004366", "2004-12-31T00:00:00"},
           Case{"firemap.%Y%j-%Y%j", "firemap.2000049-2000058.4096x2048.png", "2000-02-27T00:00:00"},
           Case{"%y%m%d", "690101", "1969-01-01T00:00:00"},
           Case{"%y%m%d", "681231", "2068-12-31T00:00:00"},
           Case{"%Y_%m_%d", "2004_3_1x", "2004-03-01T00:00:00"},
           // Weeks by Python: 2008-03-09 is the Sunday of week 10; 2023-01-01 that of week 1; 2022 begins in week 0.
           Case{"%Y%U", "200810.png", "2008-03-09T00:00:00"},
           Case{"%Y%U", "202301.png", "2023-01-01T00:00:00"},
           Case{"%Y%U", "202200.png", "2022-01-01T00:00:00"},
           Case{"%Y%U", "202201.png", "2022-01-02T00:00:00"},
           Case{"%d %b %Y", "01 Mar 2004", "2004-03-01T00:00:00"},
           Case{"%B_%Y", "september_2004.jpg", "2004-09-01T00:00:00"},
           Case{"x%%%Y", "x%2004", "2004-01-01T00:00:00"},
           Case{"%F", "2004-03-31T.tif", "2004-03-31T00:00:00"},
           Case{"%FT%T", "2004-03-31T01:02:03", "2004-03-31T01:02:03"},
           // A Sunday of week 0 may be one of December.
           Case{"%Y%U%w", "2008103.png", "2008-03-12T00:00:00"},
           Case{"%Y%W%u", "2008107.png", "2008-03-16T00:00:00"},
           Case{"%Y%U%w", "2022000.png", "2021-12-26T00:00:00"},
           Case{"%Y%W", "200810.png", "2008-03-10T00:00:00"},
           Case{"%Y%W", "202200.png", "2022-01-01T00:00:00"},
           Case{"%G-W%V-%u", "2020-w53-5", "2021-01-01T00:00:00"},
           Case{"%G-W%V", "2021-W01", "2021-01-04T00:00:00"},
           Case{"%g%V", "2101", "2021-01-04T00:00:00"},
           // Month and day say more than a day of the year, and that more than a month.
           Case{"%Y%m%d.%j", "20040301.365", "2004-03-01T00:00:00"},
           Case{"%Y-%m.%j", "2004-01.061", "2004-03-01T00:00:00"},
           Case{"%Y-%m week %U", "2004-03 week 01", "2004-03-01T00:00:00"},
           // What is left out is as std::get_time leaves it.
           Case{"a_%m.png", "a_03.png", "1900-03-01T00:00:00"},
           Case{"%m-%d", "12-31.png", "1900-12-31T00:00:00"},
           Case{"%H%M.png", "2159.png", "1900-01-01T21:59:00"},
           Case{"world.tif", "World.TIF", "1900-01-01T00:00:00"},
           Case{"%C", "20", "2000-01-01T00:00:00"},
           Case{"%C%y", "1904", "1904-01-01T00:00:00"},
           Case{"%C %Y", "19 2004", "2004-01-01T00:00:00"},
           Case{"%Y %I%p", "2004 12AM", "2004-01-01T00:00:00"},
           Case{"%Y %p%I", "2004 pm03", "2004-01-01T15:00:00"},
           Case{"%Y %l%P", "2004  3pm", "2004-01-01T15:00:00"},
           Case{"%Y %k", "2004  3", "2004-01-01T03:00:00"},
           Case{"%H%p", "03PM", "1900-01-01T03:00:00"},
           Case{"%A %d %B %Y", "MONDAY 01 March 2004", "2004-03-01T00:00:00"},
           Case{"%c", "Mon Mar  1 10:11:12 2004", "2004-03-01T10:11:12"},
           Case{"%Y%m%dT%H%M%S%Z.png", "20040301T101112UTC.png", "2004-03-01T10:11:12"},
           Case{"%Y%m%dT%H%M%S%z.png", "20040301T101112Z.png", "2004-03-01T10:11:12"},
           Case{"%Y%m%dT%H%M%S%z.png", "20040301T101112+05:45.png", "2004-03-01T10:11:12"},
           Case{"%s.png", "1078135872.png", "2004-03-01T10:11:12"},
           Case{"%EY-%Om", "2004-03", "2004-03-01T00:00:00"},
           Case{"%y%m%d", "040301", "2004-03-01T00:00:00"},
           // A published slip: minute and hour for month and day.
           Case{"sibt1850_seaice_extent_%Y%M%H_sos.png", "sibt1850_seaice_extent_19790931_sos.png", "no"},
           Case{"sibt1850_seaice_extent_%Y%M%H_sos.png", "sibt1850_seaice_extent_19790915_sos.png",
                "1979-09-15T00:00:00"},
       }) {
    EXPECT_EQ(read(c.format, c.name), c.time) << c.format << ' ' << c.name;
  }
}

TEST(TimeFileName, LeavesOutWhatIsNoTime) {
  for (const auto& [format, name] : {std::pair("%Y%m%d", "2004"),
                                     std::pair("%Y%m%d", "20041301"),
                                     std::pair("%Y%m%d", "20040230"),
                                     std::pair("%Y%m%d", "x20040201"),
                                     std::pair("a%Y", "b2004"),
                                     std::pair("%Y%m%d", "2004-2-1"),
                                     std::pair("%Y%j", "2003366"),
                                     std::pair("%Y%j", "2004000"),
                                     std::pair("%Y%m%d%H", "2004010124"),
                                     std::pair("%Y", ""),
                                     std::pair("%Y%z", "2004+2"),
                                     std::pair("%p", "xm"),
                                     std::pair("%Y-%A", "2004-Mo"),
                                     std::pair("%u", "0"),
                                     std::pair("%V", "00"),
                                     std::pair("%Z", "utc"),
                                     std::pair("%j", "366"),
                                     std::pair("%d %b %Y", "01 Mrz 2004"),
                                     std::pair("%Y.tif", "2004"),
                                     std::pair("%Y%m%d", "+2004301")}) {
    EXPECT_EQ(read(format, name), "no") << format << ' ' << name;
  }
}

TEST(TimeFileName, RefusesFormatsThatCannotGiveATime) {
  for (const char* format : {"", "%Q%Y", "%Y%", "%Y%E", "%Y%Eq", "%+"}) {
    const Result<TimeFileName> made = TimeFileName::create(format);
    ASSERT_FALSE(made) << format;
    EXPECT_FALSE(made.error().remedy.empty());
  }
}

/// What std::get_time reads from the whole of the name, in the terms of read(). A name that ends too soon is none.
std::string standardRead(const std::string& format, const std::string& name) {
  std::tm fields{};
  std::istringstream stream(name + '|');
  stream.imbue(std::locale::classic());
  stream >> std::get_time(&fields, (format + '|').c_str());
  if (stream.fail()) {
    return "no";
  }
  const std::chrono::year_month_day day = std::chrono::year(fields.tm_year + 1900) /
                                          static_cast<unsigned>(fields.tm_mon + 1) /
                                          static_cast<unsigned>(std::max(fields.tm_mday, 1));
  if (!day.ok()) {
    return "no";
  }
  // It leaves leap seconds in.
  const auto instant = std::chrono::sys_days(day) + std::chrono::hours(fields.tm_hour) +
                       std::chrono::minutes(fields.tm_min) + std::chrono::seconds(std::min(fields.tm_sec, 59));
  return Time::fromUtcInstant(instant).utc().substr(0, 19);
}

std::string written(const char* format, const std::tm& time) {
  std::array<char, 200> text{};
  return {text.data(), std::strftime(text.data(), text.size(), format, &time)};
}

/// Formats whose names std::get_time of this library reads without a slip of its own. Among those: %y takes the two
/// digits after it for the rest of a year, and %c, %Z and %z do not read what strftime writes.
constexpr std::array<const char*, 36> standardFormats{
    "%Y",
    "%Y-%m",
    "%Y%m%d",
    "world.%Y-%m.tif",
    "a_%Y%m%d_%H%M%S.png",
    "a_%m.png",
    "%m-%d",
    "%d",
    "%e.%m.%Y",
    "%H%M",
    "%H:%M:%S %d %b %Y",
    "%B %Y",
    "%h-%Y",
    "%y.%m.%d",
    "%C%y",
    "%C.%m",
    "%Y_%j",
    "%Y%j",
    "firemap.%Y%j-%Y%j",
    "%Y%m%d.%j",
    "%Y-%U-%w",
    "%Y-%W-%w",
    "%A %Y-%U",
    "%a, %d %b %Y",
    "%Y%m%d %I%p",
    "%p%I %Y",
    "%I.%M %p, %D",
    "%r",
    "%R",
    "%T %x",
    "%X",
    "%EY-%Om-%Od",
    "%Y%n%m%t%d",
    "100%% %Y",
    "WORLD %Y",
    "static",
};

bool isOfWeek(const std::string& format) {
  return format.find("%U") != std::string::npos || format.find("%W") != std::string::npos;
}

TEST(TimeFileName, ReadsWhatTheStandardLibraryReads) {
  std::mt19937 random(4);
  int read = 0;
  int refused = 0;
  for (const char* format : standardFormats) {
    for (int i = 0; i < 400; ++i) {
      const std::time_t seconds = std::uniform_int_distribution<std::time_t>(-2'000'000'000, 4'000'000'000)(random);
      std::tm time{};
      ASSERT_NE(gmtime_r(&seconds, &time), nullptr);
      std::string name = written(format, time);
      // Weeks that reach into another year are beyond what the library computes.
      const bool isInside = time.tm_yday > 7 && time.tm_yday < 350;
      if (isOfWeek(format) && !isInside) {
        continue;
      }
      // Every second one with a slip in it.
      if (i % 2 == 1 && !isOfWeek(format)) {
        constexpr std::string_view letters = "0123456789 _-.aApPmM";
        name[random() % name.size()] = letters[random() % letters.size()];
      }
      const std::string expected = standardRead(format, name);
      const Result<TimeFileName> reader = TimeFileName::create(std::string(format) + '|');
      ASSERT_TRUE(reader) << format;
      const std::optional<Time::UtcInstant> instant = reader->read(name + '|');
      EXPECT_EQ(instant ? Time::fromUtcInstant(*instant).utc().substr(0, 19) : "no", expected)
          << '"' << format << "\" \"" << name << '"';
      ++(expected == "no" ? refused : read);
    }
  }
  EXPECT_GT(read, 7000);
  EXPECT_GT(refused, 1000);
}

TEST(TimeFileName, KnowsEveryConversionOfTheStandardLibrary) {
  for (const char letter : std::string_view("aAbBcCdDeFgGhHIjklmMnpPrRsStTuUVwWxXyYzZ%")) {
    for (const std::string& format :
         {std::string{'%', letter}, std::string{'%', 'E', letter}, std::string{'%', 'O', letter}}) {
      EXPECT_TRUE(TimeFileName::create(format)) << format;
    }
  }
}

}  // namespace
}  // namespace meridian::globebrowsing

#include "globebrowsing/providers/time_file_name.h"

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
           // A published slip: minute and hour for month and day.
           Case{"sibt1850_seaice_extent_%Y%M%H_sos.png", "sibt1850_seaice_extent_19790931_sos.png", "no"},
           Case{"sibt1850_seaice_extent_%Y%M%H_sos.png", "sibt1850_seaice_extent_19790915_sos.png",
                "1979-09-15T00:00:00"},
       }) {
    EXPECT_EQ(read(c.format, c.name), c.time) << c.format << ' ' << c.name;
  }
}

TEST(TimeFileName, LeavesOutWhatIsNoTime) {
  for (const auto& [format, name] :
       {std::pair("%Y%m%d", "2004"), std::pair("%Y%m%d", "20041301"), std::pair("%Y%m%d", "20040230"),
        std::pair("%Y%m%d", "x20040201"), std::pair("a%Y", "b2004"), std::pair("%Y%m%d", "2004-2-1"),
        std::pair("%Y%j", "2003366"), std::pair("%Y%j", "2004000"), std::pair("%Y%m%d%H", "2004010124"),
        std::pair("%Y", ""), std::pair("%d %b %Y", "01 Mrz 2004"), std::pair("%Y.tif", "2004"),
        std::pair("%Y%m%d", "+2004301")}) {
    EXPECT_EQ(read(format, name), "no") << format << ' ' << name;
  }
}

TEST(TimeFileName, RefusesFormatsThatCannotGiveATime) {
  for (const char* format : {"", "world.tif", "%m-%d", "%Q%Y", "%Y%", "%E%Y"}) {
    const Result<TimeFileName> made = TimeFileName::create(format);
    ASSERT_FALSE(made) << format;
    EXPECT_FALSE(made.error().remedy.empty());
  }
}

}  // namespace
}  // namespace meridian::globebrowsing

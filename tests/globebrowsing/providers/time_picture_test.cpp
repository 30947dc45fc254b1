#include "globebrowsing/providers/time_picture.h"

#include <gtest/gtest.h>

namespace meridian::globebrowsing {
namespace {

TEST(TimePicture, WritesAsSpiceDoes) {
  struct Case {
    const char* picture;
    const char* instant;
    const char* text;
  };
  for (const Case& c : {
           Case{"YYYY-MM-DD", "2004-03-01", "2004-03-01"},
           Case{"YYYYMMDD", "2004-03-01", "20040301"},
           Case{"YYYY-MM-DDTHR:MN:SCZ", "2004-03-01T07:08:09", "2004-03-01T07:08:09Z"},
           Case{"YYYYMMDD_HRMNSC", "2004-03-01T07:08:09", "20040301_070809"},
           Case{"YYYYMMDD_HRMN", "2004-03-01T23:59:59", "20040301_2359"},
           Case{"YYYY/DOY", "2004-12-31", "2004/366"},
           Case{"YRDOY", "2000-01-01", "00001"},
           Case{"DD MON YYYY", "2004-03-01", "01 MAR 2004"},
           Case{"DD Mon YYYY", "2004-03-01", "01 Mar 2004"},
           Case{"dd-mon", "2004-03-01", "dd-mar"},
           // Longer than its picture: nothing is cut off.
           Case{"MONTH", "2004-09-01", "SEPTEMBER"},
           Case{"Weekday, Month", "1969-07-20", "Sunday, July"},
           Case{"WKD wkd Wkd", "1969-07-20", "SUN sun Sun"},
           Case{"AP:MN AMPM", "1969-07-20T20:17:40", "08:17 P.M."},
           Case{"AP ampm", "1969-07-20T00:17:40", "12 a.m."},
           Case{"HR:MN:SC.##", "2004-03-01T07:08:09.987", "07:08:09.98"},
           Case{"SC.#####", "2004-03-01T07:08:09.987", "09.98700"},
           Case{"YYYY ::UTC", "2004-03-01", "2004 "},
           Case{"JULIAND", "2000-01-01T12:00:00", "2451545"},
           Case{"MMMNSC", "2004-03-01T00:08:09", "030809"},
           Case{"YYYY", "0450-03-01", "0450"},
           Case{"mosaic_.tif", "2004-03-01", "mosaic_.tif"},
           Case{"", "2004-03-01", ""},
       }) {
    const Result<std::string> text = writeTime(c.picture, Time::fromUtc(c.instant)->utcInstant());
    ASSERT_TRUE(text) << c.picture;
    EXPECT_EQ(*text, c.text) << c.picture;
  }
}

TEST(TimePicture, RefusesOtherScalesAndZones) {
  for (const char* picture : {"YYYY ::TDB", "HR ::UTC-7", "HR::", "YYYY::UTC+5:30"}) {
    const Result<std::string> text = writeTime(picture, {});
    ASSERT_FALSE(text) << picture;
    EXPECT_FALSE(text.error().remedy.empty());
  }
}

}  // namespace
}  // namespace meridian::globebrowsing

#include "globebrowsing/providers/date_text.h"

#include <gtest/gtest.h>

namespace meridian::globebrowsing {
namespace {

TEST(DateText, ReadsDatesAsAssetsWriteThem) {
  for (const auto& [text, utc] :
       {std::pair("2004-03-01", "2004-03-01T00:00:00.000"),
        std::pair("2004-03-01T01:02:03Z", "2004-03-01T01:02:03.000"), std::pair("2004", "2004-01-01T00:00:00.000"),
        std::pair("2004-03", "2004-03-01T00:00:00.000"), std::pair("2004-061", "2004-03-01T00:00:00.000"),
        std::pair("2004-061T12:30", "2004-03-01T12:30:00.000"), std::pair("2000 Jan 1", "2000-01-01T00:00:00.000"),
        std::pair("2004 MAR 01 23:59:58", "2004-03-01T23:59:58.000"),
        std::pair(" 2004-03-01\n", "2004-03-01T00:00:00.000")}) {
    const auto read = readDate(text);
    ASSERT_TRUE(read) << text;
    EXPECT_EQ(Time::fromUtcInstant(*read).utc(), utc) << text;
  }
}

TEST(DateText, RefusesTheRest) {
  for (const char* text : {"", " ", "Today", "2004-13", "2004-02-30", "2004-366T99:00", "2003-366", "20040301",
                           "2004 Foo 1", "2004 Mar", "2004-03-01x", "2004x", "2004 Mar 1 25:00"}) {
    EXPECT_FALSE(readDate(text)) << text;
  }
}

}  // namespace
}  // namespace meridian::globebrowsing

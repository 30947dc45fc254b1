#include "globebrowsing/network/cache_policy.h"

#include <gmock/gmock.h>

namespace meridian::globebrowsing {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

// Sun, 06 Nov 1994 08:49:37 GMT, the example of RFC 9110, section 5.6.7.
constexpr UnixTime date = 784111777;
constexpr UnixTime day = 86400;

AnswerFacts answered(const std::string& fields, UnixTime responseTime = date) {
  return {HeaderFields::fromText(fields), responseTime, responseTime};
}

TEST(CachePolicy, ReadsDatesInAllThreeForms) {
  EXPECT_EQ(parseHttpDate("Sun, 06 Nov 1994 08:49:37 GMT"), date);
  EXPECT_EQ(parseHttpDate("Sunday, 06-Nov-94 08:49:37 GMT"), date);
  EXPECT_EQ(parseHttpDate("Sun Nov  6 08:49:37 1994"), date);
  for (const char* text : {"", "0", "-1", "tomorrow", "784111777", "Sun, 99 Nov 1994 08:49:37 GMT"}) {
    EXPECT_EQ(parseHttpDate(text), std::nullopt) << text;
  }
}

TEST(CachePolicy, KnowsWhatMayBeKept) {
  struct Case {
    int status;
    const char* fields;
    bool isStorable;
  };
  for (const Case& test : {
           Case{200, "", true},
           Case{200, "Cache-Control: private, max-age=5", true},
           Case{200, "Cache-Control: no-cache", true},
           Case{200, "Cache-Control: no-store", false},
           Case{200, "cache-control: public\nCACHE-CONTROL: max-age=1, No-Store", false},
           Case{200, "Cache-Control: ext=\"no-store, x\", max-age=1", true},
           Case{200, "Vary: Accept-Encoding, Origin", true},
           Case{200, "Vary: *", false},
           Case{203, "", false},
           Case{206, "", false},
           Case{404, "Cache-Control: max-age=60", false},
           Case{500, "", false},
       }) {
    EXPECT_EQ(isStorable(test.status, HeaderFields::fromText(test.fields)), test.isStorable)
        << test.status << ' ' << test.fields;
  }
}

TEST(CachePolicy, KnowsHowLongAnAnswerIsFresh) {
  const std::string dated = "Date: Sun, 06 Nov 1994 08:49:37 GMT\n";
  struct Case {
    std::string fields;
    std::int64_t lifetime;
  };
  for (const Case& test : {
           Case{"Cache-Control: max-age=60", 60},
           Case{"Cache-Control: max-age=\"60\"", 60},
           Case{"Cache-Control: max-age=0", 0},
           Case{"Cache-Control: max-age=60, max-age=5", 60},  // 4.2.1: the first
           Case{"Cache-Control: max-age=nonsense", 0},        // 4.2.1: stale
           Case{"Cache-Control: max-age=-5", 0},
           Case{"Cache-Control: max-age=99999999999999999999", 2147483648},                // 1.2.2
           Case{"Cache-Control: s-maxage=60", day},                                        // for shared caches
           Case{"Cache-Control: max-age=60\nExpires: Sun, 06 Nov 1994 09:49:37 GMT", 60},  // 5.3: max-age wins
           Case{dated + "Expires: Sun, 06 Nov 1994 09:49:37 GMT", 3600},
           Case{dated + "Expires: Sun, 06 Nov 1994 07:49:37 GMT", 0},
           Case{dated + "Expires: 0", 0},                                           // 5.3: in the past
           Case{"Expires: Sun, 06 Nov 1994 09:49:37 GMT", 3600},                    // no Date: when it came
           Case{dated + "Last-Modified: Sat, 05 Nov 1994 08:49:37 GMT", day / 10},  // 4.2.2
           Case{dated + "Last-Modified: Thu, 06 Nov 1980 08:49:37 GMT", 7 * day},
           Case{dated + "Last-Modified: Mon, 07 Nov 1994 08:49:37 GMT", 0},
           Case{"", day},
       }) {
    EXPECT_EQ(freshnessLifetime(answered(test.fields), {}), test.lifetime) << test.fields;
  }
}

TEST(CachePolicy, ReckonsAge) {
  struct Case {
    const char* fields;
    UnixTime requestTime, responseTime, now;
    std::int64_t age;
  };
  const char* const dated = "Date: Sun, 06 Nov 1994 08:49:37 GMT";
  for (const Case& test : {
           Case{"", date, date, date + 7, 7}, Case{dated, date, date, date + 7, 7},
           Case{dated, date + 10, date + 10, date + 10, 10},  // apparent_age
           Case{"Age: 30", date - 2, date, date + 5, 37},     // age_value + response_delay + resident_time
           Case{"Age: nonsense", date, date, date, 0},
           Case{"Age: 30", date, date, date - 1000, 30},       // the clock was put back
           Case{dated, date - 100, date - 50, date - 50, 50},  // a server whose clock is ahead
       }) {
    const AnswerFacts facts{HeaderFields::fromText(test.fields), test.requestTime, test.responseTime};
    EXPECT_EQ(currentAge(facts, test.now), test.age) << test.fields << ' ' << test.now - date;
  }
}

TEST(CachePolicy, KnowsWhatIsFreshAndWhatMayStandIn) {
  struct Case {
    const char* fields;
    std::int64_t after;
    bool isFresh, mayServeStale;
  };
  for (const Case& test : {
           Case{"Cache-Control: max-age=60", 59, true, true},
           Case{"Cache-Control: max-age=60", 60, false, true},
           Case{"Cache-Control: max-age=60", 60 + 31 * day, false, false},
           Case{"Cache-Control: no-cache, max-age=60", 1, false, false},
           Case{"Cache-Control: max-age=60, must-revalidate", 59, true, false},
           Case{"Cache-Control: max-age=60, must-revalidate", 61, false, false},
           Case{"Cache-Control: max-age=60, stale-if-error=100", 160, false, true},
           Case{"Cache-Control: max-age=60, stale-if-error=100", 161, false, false},
           Case{"Cache-Control: max-age=60, stale-if-error=0", 61, false, false},
           Case{"", day - 1, true, true},
           Case{"", day, false, true},
       }) {
    const AnswerFacts facts = answered(test.fields);
    EXPECT_EQ(isFresh(facts, {}, date + test.after), test.isFresh) << test.fields << ' ' << test.after;
    EXPECT_EQ(mayServeStale(facts, {}, date + test.after), test.mayServeStale) << test.fields << ' ' << test.after;
  }
}

TEST(CachePolicy, AsksWhetherItIsStillGood) {
  EXPECT_THAT(conditionalHeaders(answered("ETag: W/\"a\"\nLast-Modified: Sun, 06 Nov 1994 08:49:37 GMT")),
              ElementsAre("If-None-Match: W/\"a\"", "If-Modified-Since: Sun, 06 Nov 1994 08:49:37 GMT"));
  EXPECT_THAT(conditionalHeaders(answered("Last-Modified: lately")), IsEmpty());
  EXPECT_THAT(conditionalHeaders(answered("")), IsEmpty());
}

TEST(CachePolicy, A304RenewsWhatIsKnown) {
  const AnswerFacts kept = answered(
      "ETag: \"1\"\nContent-Type: image/png\nCache-Control: max-age=60\nAge: 50\nDate: Sun, 06 Nov 1994 08:49:37 GMT");
  AnswerFacts of304 = answered("Cache-Control: max-age=120\nContent-Type: text/html\nX-Other: 1", date + 100);
  const AnswerFacts now = refreshed(kept, of304);
  EXPECT_EQ(now.fields.find("ETag"), "\"1\"");
  EXPECT_EQ(now.fields.find("Content-Type"), "image/png");
  EXPECT_EQ(now.fields.list("Cache-Control"), "max-age=120");
  EXPECT_EQ(now.fields.find("X-Other"), std::nullopt);
  EXPECT_TRUE(isFresh(now, {}, date + 100 + 119));
  EXPECT_FALSE(isFresh(now, {}, date + 100 + 120));
}

}  // namespace
}  // namespace meridian::globebrowsing

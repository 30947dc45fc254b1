#include "host/api/value.h"

#include <cmath>

#include <gtest/gtest.h>

namespace meridian {
namespace {

TEST(Value, KnowsItsKindAndConvertsNothing) {
  EXPECT_EQ(kindName(Value().kind()), "nil");
  EXPECT_EQ(kindName(Value(true).kind()), "boolean");
  EXPECT_EQ(kindName(Value(3).kind()), "number");
  EXPECT_EQ(kindName(Value("3").kind()), "string");
  EXPECT_EQ(kindName(Value(Table{}).kind()), "table");
  EXPECT_FALSE(Value("3").number());
  EXPECT_FALSE(Value(1).boolean());
  EXPECT_EQ(Value(3).string(), nullptr);
}

TEST(Value, ReadsListsOfNumbers) {
  const Value vector(glm::dvec3(1.0, 2.0, 3.0));
  EXPECT_EQ(vector.numbers(3), (std::vector<double>{1.0, 2.0, 3.0}));
  EXPECT_TRUE(vector.numbers());
  EXPECT_FALSE(vector.numbers(2));
  EXPECT_FALSE(Value(Table{{1, "2"}, {}}).numbers());
  EXPECT_FALSE(Value(1).numbers());
}

TEST(Value, WritesItselfAsLua) {
  EXPECT_EQ(Value().toLua(), "nil");
  EXPECT_EQ(Value(false).toLua(), "false");
  EXPECT_EQ(Value(0.1).toLua(), "0.1");
  EXPECT_EQ(Value(HUGE_VAL).toLua(), "math.huge");
  EXPECT_EQ(Value("a\"b\\c\nd").toLua(), "\"a\\\"b\\\\c\\nd\"");
  EXPECT_EQ(Value(Table{{1, Table{}}, {{"b c", true}, {"a", "x"}}}).toLua(), "{ 1, { }, a = \"x\", [\"b c\"] = true }");
}

TEST(Value, ComparesTablesByContents) {
  EXPECT_EQ(Value(Table{{1}, {{"a", 2}}}), Value(Table{{1}, {{"a", 2}}}));
  EXPECT_FALSE(Value(Table{{1}, {}}) == Value(Table{{2}, {}}));
  EXPECT_FALSE(Value(1) == Value("1"));
}

TEST(Value, FindsFields) {
  const Value value = Table{{}, {{"Name", "Earth"}}};
  ASSERT_NE(value.find("Name"), nullptr);
  EXPECT_EQ(*value.find("Name"), Value("Earth"));
  EXPECT_EQ(value.find("Nothing"), nullptr);
  EXPECT_EQ(Value(3).find("Name"), nullptr);
}

}  // namespace
}  // namespace meridian

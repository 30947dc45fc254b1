#include "host/api/schema.h"

#include <gtest/gtest.h>

namespace meridian {
namespace {

const Schema layer({{"Identifier", Schema::Type::Identifier, "the layer's name in scripts", true},
                    {"Opacity", Schema::Type::Number, "how opaque it is", false, 0.0, 1.0},
                    {"BlendMode", Schema::Type::String, "how it blends", false, {}, {}, {"Normal", "Multiply"}}});

Value table(std::map<std::string, Value, std::less<>> fields) {
  return Table{{}, std::move(fields)};
}

TEST(Schema, AcceptsWhatItDescribesAndIgnoresTheRest) {
  EXPECT_TRUE(layer.validate(table({{"Identifier", "a"}, {"Opacity", 1.0}, {"Padding", "?"}}), "x.asset:1"));
}

TEST(Schema, NamesThePlaceAndTheKeyOfAMissingField) {
  const Result<void> result = layer.validate(table({}), "x.asset:7", "Layers.ColorLayers[1]");
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().where, "x.asset:7: Layers.ColorLayers[1].Identifier");
}

TEST(Schema, RefusesWrongTypesRangesAndChoices) {
  EXPECT_FALSE(layer.validate(table({{"Identifier", "two words"}}), ""));
  EXPECT_FALSE(layer.validate(table({{"Identifier", "a"}, {"Opacity", 1.5}}), ""));
  EXPECT_FALSE(layer.validate(table({{"Identifier", "a"}, {"Opacity", std::numeric_limits<double>::quiet_NaN()}}), ""));
  EXPECT_FALSE(layer.validate(table({{"Identifier", "a"}, {"BlendMode", "Dodge"}}), ""));
  EXPECT_FALSE(layer.validate(3.0, ""));
}

TEST(UnknownKeys, AreNamedWithWhatTheyResemble) {
  const Schema one({{"FilePath", Schema::Type::String, ""}, {"ZIndex", Schema::Type::Integer, ""}});
  const Schema other({{"Identifier", Schema::Type::String, ""}});
  const Value table =
      Table{{}, {{"filepath", 1}, {"Identifer", 2}, {"ZIndex", 3}, {"Old", 4}, {"Nonsense", 5}, {"X", 6}}};
  static constexpr std::string_view ignored[] = {"Old"};
  const std::vector<UnknownKey> unknown = unknownKeys(table, {&one, &other}, ignored);
  std::string text;
  for (const UnknownKey& each : unknown) {
    text += each.key + "=" + each.meant + ' ';
  }
  EXPECT_EQ(text, "Identifer=Identifier Nonsense= X= filepath=FilePath ");
}

}  // namespace
}  // namespace meridian

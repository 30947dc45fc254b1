#include "globebrowsing/layers/layer_fields.h"

#include <cstring>
#include <regex>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "globebrowsing/layers/layer_glsl.h"
#include "layer_fixture.h"

namespace meridian::globebrowsing {
namespace {

struct Member {
  std::string type, name;
};

std::vector<Member> parseStruct(const std::string& text) {
  std::vector<Member> members;
  const std::regex line(R"(\s+(int|float|vec[234]) (\w+);)");
  for (std::sregex_iterator match(text.begin(), text.end(), line), end; match != end; ++match) {
    members.push_back({(*match)[1], (*match)[2]});
  }
  return members;
}

/// Offsets by counting words of 4 bytes, as the rules of std140 are usually explained.
std::vector<std::size_t> offsetsByWords(const std::vector<Member>& members) {
  std::vector<std::size_t> offsets;
  std::size_t word = 0;
  for (const Member& member : members) {
    const std::size_t words = member.type.substr(0, 3) == "vec" ? static_cast<std::size_t>(member.type[3] - '0') : 1;
    const std::size_t boundary = words == 3 ? 4 : words;
    while (word % boundary != 0) {
      ++word;
    }
    offsets.push_back(word * 4);
    word += words;
  }
  return offsets;
}

TEST(LayerFields, TheStructParsesBackToTheTableAndItsOffsets) {
  const LayerFields& fields = layerFields();
  const std::string text = glslStruct(fields, "Layer");
  EXPECT_THAT(text, testing::StartsWith("struct Layer {"));
  const std::vector<Member> members = parseStruct(text);
  ASSERT_EQ(members.size(), fields.fields().size());
  const std::vector<std::size_t> offsets = offsetsByWords(members);
  for (std::size_t i = 0; i < members.size(); ++i) {
    EXPECT_EQ(members[i].name, fields.fields()[i].name);
    EXPECT_EQ(members[i].type, glslName(fields.fields()[i].type));
    EXPECT_EQ(offsets[i], fields.fields()[i].offset) << members[i].name;
  }
  EXPECT_EQ(fields.stride() % 16, 0U);
  EXPECT_GE(fields.stride(), offsets.back() + 4);
}

TEST(LayerFields, LaysOutWhatOpenGLsRulesSay) {
  const auto nothing = [](const Layer&, std::byte*) {};
  const LayerFields fields({{"a", GlslType::Float, nothing},
                            {"b", GlslType::Vec3, nothing},
                            {"c", GlslType::Float, nothing},
                            {"d", GlslType::Vec2, nothing},
                            {"e", GlslType::Vec4, nothing},
                            {"f", GlslType::Int, nothing}});
  std::vector<std::size_t> offsets;
  for (const LayerField& field : fields.fields()) {
    offsets.push_back(field.offset);
  }
  EXPECT_THAT(offsets, testing::ElementsAre(0, 16, 28, 32, 48, 64));
  EXPECT_EQ(fields.stride(), 80U);
}

TEST(LayerFields, WriteReadsTheLayersProperties) {
  LayerManager manager;
  Layer& layer = **manager.addLayer("Overlays", requestFor(solidLayer("a", {{"BlendMode", "Color"}})));
  layer.opacity.put(0.5);
  layer.fade.put(0.5);
  layer.colour.put({0.25, 0.5, 0.75});
  layer.gamma.put(2.0);
  layer.chromaKeyTolerance.put(0.125);
  std::vector<std::byte> bytes(layerFields().stride());
  layerFields().write(layer, bytes);
  const auto floatAt = [&](std::string_view name, std::size_t component = 0) {
    for (const LayerField& field : layerFields().fields()) {
      if (field.name == name) {
        float value = 0.0F;
        std::memcpy(&value, bytes.data() + field.offset + 4 * component, 4);
        return value;
      }
    }
    ADD_FAILURE() << "no field " << name;
    return 0.0F;
  };
  EXPECT_EQ(floatAt("opacity"), 0.25F);
  EXPECT_EQ(floatAt("colour", 2), 0.75F);
  EXPECT_EQ(floatAt("gamma"), 2.0F);
  EXPECT_EQ(floatAt("multiplier"), 1.0F);
  EXPECT_EQ(floatAt("chromaKeyTolerance"), 0.125F);
  const float mode = floatAt("blendMode");
  std::int32_t word = 0;
  std::memcpy(&word, &mode, 4);
  EXPECT_EQ(word, static_cast<std::int32_t>(BlendMode::Color));
}

TEST(LayerGlsl, ConstantsAreTheEnumsNumbers) {
  const std::string text = glslLayerConstants();
  for (const char* line :
       {"const int blendModeNormal = 0;", "const int blendModeMultiply = 1;", "const int blendModeMultiplyMix = 2;",
        "const int blendModeAdd = 3;", "const int blendModeSubtract = 4;", "const int blendModeColor = 5;",
        "const int adjustmentNone = 0;", "const int adjustmentChromaKey = 1;", "const int samplingTile = 0;",
        "const int samplingSolidColor = 1;", "const int samplingColorRelief = 2;", "const int samplingHillshade = 3;",
        "const int samplingSlope = 4;", "const int samplingIsolines = 5;"}) {
    EXPECT_THAT(text, testing::HasSubstr(line));
  }
}

TEST(LayerGlsl, TheBlockIsAnArrayOfTheStruct) {
  EXPECT_EQ(glslLayerBlock({"Layer", "ColourLayers", "layers", 3, 16}),
            "layout(std140, binding = 3) uniform ColourLayers {\n  Layer layers[16];\n};\n");
}

}  // namespace
}  // namespace meridian::globebrowsing

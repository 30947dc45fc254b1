#include "host/graphics/shader_template.h"

#include <array>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

namespace meridian::graphics {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// Where messages say that each line is.
std::vector<std::string> places(const ShaderSource& source) {
  std::vector<std::string> found;
  for (std::size_t line = 1; line <= source.origins.size(); ++line) {
    found.push_back(source.firstPlace("0:" + std::to_string(line) + "(1): error"));
  }
  return found;
}

class ShaderTemplate : public ::testing::Test {
 protected:
  ShaderTemplate() { std::filesystem::create_directories(folder_ / "room"); }
  ~ShaderTemplate() override { std::filesystem::remove_all(folder_); }

  void write(const char* name, const char* text) const { std::ofstream(folder_ / name) << text; }

  std::filesystem::path folder_ =
      std::filesystem::temp_directory_path() / ("meridian-templates-" + std::to_string(getpid()));
  ShaderTemplates templates_{folder_};
};

TEST_F(ShaderTemplate, IncludesEachFileOnceAndKnowsWhereLinesCameFrom) {
  write("room/top.frag",
        "#version 450 core\n"
        "#include \"room/a.glsl\"\n"
        "  #include \"room/b.glsl\"\n"
        "void main() {}\n");
  write("room/a.glsl", "int a;\n");
  write("room/b.glsl", "#include \"room/a.glsl\"\nint b;");
  const auto source = templates_.load("room/top.frag");
  ASSERT_TRUE(source.has_value()) << source.error().message();
  EXPECT_EQ(source->text,
            "#version 450 core\n"
            "int a;\n"
            "int b;\n"
            "void main() {}\n");
  EXPECT_THAT(places(*source), ElementsAre("room/top.frag:1", "room/a.glsl:1", "room/b.glsl:2", "room/top.frag:4"));
  EXPECT_THAT(source->files, ElementsAre("room/top.frag", "room/a.glsl", "room/b.glsl"));
}

TEST_F(ShaderTemplate, EndsThoughFilesIncludeEachOther) {
  write("room/a.glsl", "#include \"room/b.glsl\"\nint a;\n");
  write("room/b.glsl", "#include \"room/a.glsl\"\nint b;\n");
  const auto source = templates_.expand("#version 450 core\n#include \"room/a.glsl\"\n", "top");
  ASSERT_TRUE(source.has_value()) << source.error().message();
  EXPECT_THAT(source->files, ElementsAre("top", "room/a.glsl", "room/b.glsl"));
}

TEST_F(ShaderTemplate, PutsTextInPlaceOfNames) {
  write("room/fast.glsl", "int fast;\n");
  const auto source = templates_.expand(
      "#version 450 core\n"
      "float x = #{value} * #{value};\n"
      "#{functions}\n"
      "int y = #{two lines};\n"
      "#include \"room/#{kind}.glsl\"\n"
      "int last;\n",
      "top", {{"value", "2.0"}, {"functions", "int f();\nint #{g}();"}, {"two lines", "1\n+ 2"}, {"kind", "fast"}});
  ASSERT_TRUE(source.has_value()) << source.error().message();
  EXPECT_EQ(source->text,
            "#version 450 core\n"
            "float x = 2.0 * 2.0;\n"
            "int f();\nint #{g}();\n"
            "int y = 1\n+ 2;\n"
            "int fast;\n"
            "int last;\n");
  EXPECT_THAT(places(*source), ElementsAre("top:1", "top:2", "#{functions} in top:1", "#{functions} in top:2", "top:4",
                                           "top:4", "room/fast.glsl:1", "top:6"));
}

TEST_F(ShaderTemplate, NamesFileAndLineOfWhatIsWrong) {
  write("room/wrong.glsl", "int a;\nint #{missing};\n");
  struct Case {
    const char* text;
    const char* where;
    const char* what;
  };
  const std::array<Case, 8> cases{
      {{"#version 450 core\n\n#include \"room/absent.glsl\"\n", "top:3", "no shader file"},
       {"#version 450 core\n#include \"../secret\"\n", "top:2", "not below the shader folder"},
       {"#version 450 core\n#include \"/etc/passwd\"\n", "top:2", "not below the shader folder"},
       {"#version 450 core\n#include \"room\"\n", "top:2", "no shader file"},
       {"#version 450 core\n#include room/a.glsl\n", "top:2", "in quotes"},
       {"#version 450 core\n#include \"room/wrong.glsl\"\n", "room/wrong.glsl:2", "nothing is given for #{missing}"},
       {"#version 450 core\nint a = #{open;\n", "top:2", "not closed"},
       {"int a;\n#version 450 core\n", "top:1", "begins with #version"}}};
  for (const Case& entry : cases) {
    const auto source = templates_.expand(entry.text, "top");
    ASSERT_FALSE(source.has_value()) << entry.text;
    EXPECT_EQ(source.error().where, entry.where);
    EXPECT_THAT(source.error().what, HasSubstr(entry.what));
  }
  const auto absent = templates_.load("room/absent.frag");
  ASSERT_FALSE(absent.has_value());
  EXPECT_EQ(absent.error().where, "room/absent.frag");
}

TEST(ShaderLog, IsReadableWhoeverWroteIt) {
  const ShaderSource source{"", {"surface/chunk.frag", "gpu/layers.glsl"}, {{0, 1}, {1, 1}, {1, 2}, {0, 3}}};
  EXPECT_EQ(source.readableLog("0:3(5): error: no such thing\n0:4(1): warning: odd"),
            "gpu/layers.glsl:2: error: no such thing\nsurface/chunk.frag:3: warning: odd\n");
  EXPECT_EQ(source.readableLog("0(3) : error C1008: undefined"), "gpu/layers.glsl:2 : error C1008: undefined\n");
  EXPECT_EQ(source.readableLog("ERROR: 0:4: 'x' : undeclared"), "surface/chunk.frag:3: 'x' : undeclared\n");
  EXPECT_EQ(source.readableLog("out of luck\n0:9(1): error: end"), "out of luck\nsurface/chunk.frag:9: error: end\n");
  EXPECT_EQ(source.firstPlace("Compilation failed\n0:2(5): error"), "gpu/layers.glsl:1");
  EXPECT_EQ(source.firstPlace("12"), "surface/chunk.frag");
}

}  // namespace
}  // namespace meridian::graphics

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

class ShaderTemplate : public ::testing::Test {
 protected:
  ShaderTemplate() { std::filesystem::create_directories(folder_ / "room"); }
  ~ShaderTemplate() override { std::filesystem::remove_all(folder_); }

  void write(const char* name, const char* text) const { std::ofstream(folder_ / name) << text; }

  std::filesystem::path folder_ =
      std::filesystem::temp_directory_path() / ("meridian-templates-" + std::to_string(getpid()));
  ShaderTemplates templates_{folder_};
};

TEST_F(ShaderTemplate, IncludesEachFileOnceAndNumbersTheLines) {
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
            "#line 1 1\nint a;\n#line 3 0\n"
            "#line 1 2\n\nint b;\n#line 4 0\n"
            "void main() {}\n");
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
      "#include \"room/#{kind}.glsl\"\n",
      "top", {{"value", "2.0"}, {"functions", "int f();\nint #{g}();"}, {"two lines", "1\n+ 2"}, {"kind", "fast"}});
  ASSERT_TRUE(source.has_value()) << source.error().message();
  EXPECT_EQ(source->text,
            "#version 450 core\n"
            "float x = 2.0 * 2.0;\n"
            "#line 1 1\nint f();\nint #{g}();\n#line 4 0\n"
            "int y = 1\n+ 2;\n#line 5 0\n"
            "#line 1 2\nint fast;\n#line 6 0\n");
  EXPECT_THAT(source->files, ElementsAre("top", "#{functions} in top", "room/fast.glsl"));
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
  const ShaderSource source{"", {"surface/chunk.frag", "gpu/layers.glsl"}};
  EXPECT_EQ(source.readableLog("1:12(5): error: no such thing\n0:3(1): warning: odd"),
            "gpu/layers.glsl:12: error: no such thing\nsurface/chunk.frag:3: warning: odd\n");
  EXPECT_EQ(source.readableLog("0(7) : error C1008: undefined"), "surface/chunk.frag:7 : error C1008: undefined\n");
  EXPECT_EQ(source.readableLog("ERROR: 1:4: 'x' : undeclared"), "gpu/layers.glsl:4: 'x' : undeclared\n");
  EXPECT_EQ(source.readableLog("out of luck\n9:1(1): error: nowhere"), "out of luck\n9:1(1): error: nowhere\n");
  EXPECT_EQ(source.firstPlace("Compilation failed\n1:12(5): error"), "gpu/layers.glsl:12");
  EXPECT_EQ(source.firstPlace("12"), "surface/chunk.frag");
}

}  // namespace
}  // namespace meridian::graphics

#include <cstddef>
#include <string>
#include <vector>

#include "globebrowsing/gpu/chunk_blocks.h"
#include "globebrowsing/layers/layer_fields.h"
#include "globebrowsing/layers/layer_glsl.h"
#include "gpu_fixture.h"

namespace meridian::globebrowsing {
namespace {

/// What the driver says about blocks, against what C++ writes into them.
class BlockLayoutTest : public GpuTest {
 protected:
  void compile(const std::string& declarations, const std::string& use) {
    const auto fragment = graphics_->templates().expand(
        "#version 450 core\n" + declarations + "layout(location = 0) out vec4 colour;\nvoid main() { colour = vec4(" +
            use + "); }\n",
        "test.frag");
    ASSERT_TRUE(fragment) << fragment.error().message();
    const auto vertex = graphics_->templates().load("gpu/fill.vert");
    ASSERT_TRUE(vertex) << vertex.error().message();
    const auto program = graphics::compileProgram({"layout test", *vertex, *fragment, {}});
    ASSERT_TRUE(program) << program.error().message();
    program_ = *program;
  }
  void TearDown() override {
    if (program_ != 0) {
      glDeleteProgram(program_);
    }
  }

  [[nodiscard]] int property(const std::string& uniform, GLenum what) const {
    const GLuint index = glGetProgramResourceIndex(program_, GL_UNIFORM, uniform.c_str());
    EXPECT_NE(index, GL_INVALID_INDEX) << uniform;
    GLint value = -1;
    glGetProgramResourceiv(program_, GL_UNIFORM, index, 1, &what, 1, nullptr, &value);
    return value;
  }
  [[nodiscard]] int offset(const std::string& uniform) const { return property(uniform, GL_OFFSET); }
  [[nodiscard]] int blockSize(const std::string& block) const {
    const GLuint index = glGetProgramResourceIndex(program_, GL_UNIFORM_BLOCK, block.c_str());
    EXPECT_NE(index, GL_INVALID_INDEX) << block;
    const GLenum what = GL_BUFFER_DATA_SIZE;
    GLint value = -1;
    glGetProgramResourceiv(program_, GL_UNIFORM_BLOCK, index, 1, &what, 1, nullptr, &value);
    return value;
  }

  GLuint program_ = 0;
};

TEST_F(BlockLayoutTest, ChunkBlocksLieWhereTheDriverReadsThem) {
  compile("#include \"surface/blocks.glsl\"\n", "view.opacity + chunks[63].lift");
  ASSERT_FALSE(HasFatalFailure());
  EXPECT_EQ(offset("ViewBlock.clipFromRelative"), offsetof(ViewBlock, clipFromRelative));
  EXPECT_EQ(offset("ViewBlock.lightDirection"), offsetof(ViewBlock, lightDirection));
  EXPECT_EQ(offset("ViewBlock.ambient"), offsetof(ViewBlock, ambient));
  EXPECT_EQ(offset("ViewBlock.opacity"), offsetof(ViewBlock, opacity));
  EXPECT_LE(blockSize("ViewBlock"), static_cast<int>(sizeof(ViewBlock)));

  EXPECT_EQ(offset("chunks[0].corners[0]"), offsetof(ChunkParameters, corners));
  EXPECT_EQ(property("chunks[0].corners[0]", GL_ARRAY_STRIDE), static_cast<int>(sizeof(glm::vec4)));
  EXPECT_EQ(offset("chunks[0].base"), offsetof(ChunkParameters, composites));
  EXPECT_EQ(offset("chunks[0].night"), offsetof(ChunkParameters, composites) + sizeof(glm::vec4));
  EXPECT_EQ(offset("chunks[0].overlay"), offsetof(ChunkParameters, composites) + 2 * sizeof(glm::vec4));
  EXPECT_EQ(offset("chunks[0].normals"), offsetof(ChunkParameters, normals));
  EXPECT_EQ(offset("chunks[0].layers"), offsetof(ChunkParameters, layers));
  EXPECT_EQ(offset("chunks[0].skirt"), offsetof(ChunkParameters, skirt));
  EXPECT_EQ(offset("chunks[0].level"), offsetof(ChunkParameters, level));
  EXPECT_EQ(offset("chunks[0].lift"), offsetof(ChunkParameters, lift));
  EXPECT_EQ(offset("chunks[0].otherLayer"), offsetof(ChunkParameters, otherLayer));
  EXPECT_EQ(offset("chunks[0].otherWeight"), offsetof(ChunkParameters, otherWeight));
  EXPECT_EQ(offset("ViewBlock.waterReflectance"), offsetof(ViewBlock, waterReflectance));
  EXPECT_EQ(offset("chunks[63].level"), 63 * sizeof(ChunkParameters) + offsetof(ChunkParameters, level));
  EXPECT_LE(blockSize("ChunkBlock"), static_cast<int>(sizeof(ChunkBlock)));
}

TEST_F(BlockLayoutTest, LayerFieldsLieWhereTheDriverReadsThem) {
  compile(glslStruct(layerFields(), "Layer") + glslLayerBlock({"Layer", "LayerBlock", "layers", 2, 3}),
          "layers[2].opacity");
  ASSERT_FALSE(HasFatalFailure());
  for (const std::size_t layer : {std::size_t{0}, std::size_t{2}}) {
    for (const LayerField& field : layerFields().fields()) {
      const std::string name = "layers[" + std::to_string(layer) + "]." + field.name;
      EXPECT_EQ(offset(name), static_cast<int>(layer * layerFields().stride() + field.offset)) << name;
    }
  }
  EXPECT_EQ(blockSize("LayerBlock"), static_cast<int>(3 * layerFields().stride()));
}

}  // namespace
}  // namespace meridian::globebrowsing

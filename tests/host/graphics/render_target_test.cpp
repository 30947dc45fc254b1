#include "host/graphics/render_target.h"

#include "graphics_fixture.h"
#include "host/graphics/program.h"

namespace meridian::graphics {
namespace {

using Target = GraphicsTest;

/// A triangle that covers the upper left half of the picture.
struct Triangle {
  Triangle()
      : program(*compileProgram(
            {"triangle",
             shader(R"(const vec2 corners[3] = vec2[3](vec2(-1, 1), vec2(-1, -1), vec2(1, 1));
void main() { gl_Position = vec4(corners[gl_VertexID], 0.5, 1.0); })",
                    "triangle.vert"),
             shader("layout(location = 0) out vec4 c;\nvoid main() { c = vec4(1.0); }", "triangle.frag"),
             {}})),
        vertices(VertexArray::create()) {}
  ~Triangle() { glDeleteProgram(program); }
  Triangle(const Triangle&) = delete;
  Triangle& operator=(const Triangle&) = delete;

  void draw(const RenderTarget& target) const {
    target.bind();
    target.clear(glm::vec4(0.0F, 0.0F, 0.0F, 1.0F));
    glUseProgram(program);
    glBindVertexArray(vertices.id());
    glDrawArrays(GL_TRIANGLES, 0, 3);
  }

  GLuint program;
  VertexArray vertices;
};

std::uint8_t red(const std::vector<std::uint8_t>& pixels, int width, int x, int y) {
  return pixels[static_cast<std::size_t>(4 * (y * width + x))];
}

TEST_F(Target, GivesRowsFromTopToBottom) {
  auto target = RenderTarget::create({{64, 32}, 1});
  ASSERT_TRUE(target.has_value()) << target.error().message();
  EXPECT_EQ(target->samples(), 1);
  const Triangle triangle;
  triangle.draw(*target);
  const auto pixels = target->readPixels();
  EXPECT_EQ(red(pixels, 64, 1, 1), 255) << "upper left";
  EXPECT_EQ(red(pixels, 64, 62, 30), 0) << "lower right";
  EXPECT_EQ(red(pixels, 64, 2, 28), 255) << "lower left";
}

TEST_F(Target, SmoothsEdgesWithSamples) {
  const Triangle triangle;
  const auto greys = [&triangle](int samples) {
    auto target = RenderTarget::create({{64, 64}, samples});
    EXPECT_TRUE(target.has_value());
    triangle.draw(*target);
    const auto pixels = target->readPixels();
    int found = 0;
    for (std::size_t pixel = 0; pixel < pixels.size(); pixel += 4) {
      found += pixels[pixel] > 0 && pixels[pixel] < 255 ? 1 : 0;
    }
    return std::pair(found, target->samples());
  };
  EXPECT_EQ(greys(1), std::pair(0, 1));
  for (const int asked : {2, 4, 1000}) {
    const auto [found, given] = greys(asked);
    EXPECT_GT(found, 32) << asked << " samples";
    EXPECT_GE(given, std::min(asked, 4));
  }
}

TEST_F(Target, IsCopiedIntoAnotherFramebuffer) {
  const Triangle triangle;
  for (const int samples : {1, 4}) {
    auto from = RenderTarget::create({{32, 32}, samples});
    ASSERT_TRUE(from.has_value());
    for (const glm::ivec2 size : {glm::ivec2(32, 32), glm::ivec2(128, 64)}) {
      auto to = RenderTarget::create({size, 1});
      ASSERT_TRUE(to.has_value());
      triangle.draw(*from);
      from->blit(to->framebuffer(), size);
      const auto pixels = to->readPixels();
      EXPECT_EQ(red(pixels, size.x, size.x / 4, size.y / 4), 255) << samples << " samples";
      EXPECT_EQ(red(pixels, size.x, 3 * size.x / 4, 7 * size.y / 8), 0) << samples << " samples";
    }
    from->blit(0, glm::ivec2(0));
  }
  EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));
}

TEST_F(Target, IsReshapedOnlyWhenItsShapeChanges) {
  auto target = RenderTarget::create({{8, 8}, 1});
  ASSERT_TRUE(target.has_value());
  const GLuint before = target->framebuffer();
  ASSERT_TRUE(target->reshape({{8, 8}, 1}).has_value());
  EXPECT_EQ(target->framebuffer(), before);
  ASSERT_TRUE(target->reshape({{16, 4}, 4}).has_value());
  EXPECT_EQ(target->readPixels().size(), 16U * 4U * 4U);
  ASSERT_TRUE(target->reshape({{0, -3}, 1}).has_value());
  EXPECT_EQ(target->size(), glm::ivec2(1));
  const auto tooLarge = target->reshape({{1 << 20, 8}, 1});
  ASSERT_FALSE(tooLarge.has_value());
  EXPECT_EQ(target->size(), glm::ivec2(1)) << "an error leaves it as it was";
}

}  // namespace
}  // namespace meridian::graphics

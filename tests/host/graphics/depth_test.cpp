#include <array>
#include <cmath>
#include <numbers>

#include <glm/gtc/type_ptr.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec4.hpp>

#include "graphics_fixture.h"
#include "host/graphics/program.h"
#include "host/graphics/projection.h"
#include "host/graphics/render_target.h"

namespace meridian::graphics {
namespace {

constexpr double fieldOfView = 0.5 * std::numbers::pi;

TEST(Projection, AgreesWithHandValues) {
  const glm::dmat4 matrix = reversedInfinitePerspective(fieldOfView, 2.0, 0.25);
  const glm::dvec4 atNear = matrix * glm::dvec4(0.0, 0.0, -0.25, 1.0);
  EXPECT_DOUBLE_EQ(atNear.z / atNear.w, 1.0);
  const glm::dvec4 far = matrix * glm::dvec4(0.0, 0.0, -1e13, 1.0);
  EXPECT_DOUBLE_EQ(far.z / far.w, 0.25 / 1e13);
  // At 90 degrees the picture's upper edge rises as far as it is away; it is twice as wide as high.
  const glm::dvec4 corner = matrix * glm::dvec4(6.0, 3.0, -3.0, 1.0);
  EXPECT_DOUBLE_EQ(corner.x / corner.w, 1.0);
  EXPECT_DOUBLE_EQ(corner.y / corner.w, 1.0);
}

TEST(Projection, CountsPixelsPerRadianAtTheMiddle) {
  EXPECT_DOUBLE_EQ(pixelsPerRadian(fieldOfView, 720.0), 360.0);
  // A small angle at the middle of the picture, projected.
  const glm::dmat4 matrix = reversedInfinitePerspective(0.8, 1.5, 1.0);
  const double angle = 1e-6;
  const glm::dvec4 clip = matrix * glm::dvec4(0.0, std::sin(angle), -std::cos(angle), 1.0);
  EXPECT_NEAR(0.5 * 600.0 * clip.y / clip.w / angle, pixelsPerRadian(0.8, 600.0), 1e-6);
}

/// Draws quads that cover the picture at distances from the camera.
class Depth : public GraphicsTest {
 protected:
  static constexpr int side = 16;

  void SetUp() override {
    GraphicsTest::SetUp();
    if (!context_) {
      return;
    }
    auto program = compileProgram({"quad",
                                   shader(R"(layout(location = 0) uniform mat4 clipFromCamera;
layout(location = 1) uniform float distanceAhead;
void main() {
  vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 4.0 - 2.0;
  gl_Position = clipFromCamera * vec4(corner * distanceAhead, -distanceAhead, 1.0);
})",
                                          "quad.vert"),
                                   shader(R"(layout(location = 2) uniform vec4 colour;
layout(location = 0) out vec4 result;
void main() { result = colour; })",
                                          "quad.frag"),
                                   {}});
    ASSERT_TRUE(program.has_value()) << program.error().message();
    program_ = *program;
    vertices_ = VertexArray::create();
    auto target = RenderTarget::create({glm::ivec2(side), 1});
    ASSERT_TRUE(target.has_value()) << target.error().message();
    target_ = std::make_unique<RenderTarget>(std::move(*target));
  }

  void TearDown() override {
    if (context_) {
      glDeleteProgram(program_);
      vertices_.reset();
      target_.reset();
    }
  }

  void begin(double near) {
    target_->bind();
    target_->clear(glm::vec4(0.0F, 0.0F, 0.0F, 1.0F));
    glUseProgram(program_);
    glBindVertexArray(vertices_.id());
    const glm::mat4 matrix(reversedInfinitePerspective(fieldOfView, 1.0, near));
    glUniformMatrix4fv(0, 1, GL_FALSE, glm::value_ptr(matrix));
  }

  static void quad(double distance, const glm::vec4& colour) {
    glUniform1f(1, static_cast<float>(distance));
    glUniform4fv(2, 1, glm::value_ptr(colour));
    glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
  }

  /// How many pixels are mostly of that channel.
  [[nodiscard]] int count(std::size_t channel) const {
    const std::vector<std::uint8_t> pixels = target_->readPixels();
    int found = 0;
    for (std::size_t pixel = 0; pixel < pixels.size(); pixel += 4) {
      found += pixels[pixel + channel] > 200 ? 1 : 0;
    }
    return found;
  }

  GLuint program_ = 0;
  VertexArray vertices_;
  std::unique_ptr<RenderTarget> target_;
};

const glm::vec4 red(1.0F, 0.0F, 0.0F, 1.0F);
const glm::vec4 green(0.0F, 1.0F, 0.0F, 1.0F);

TEST_F(Depth, ResolvesOneMetreAtTenThousandKilometres) {
  begin(0.1);
  quad(1e7, red);
  quad(1e7 + 1.0, green);
  EXPECT_EQ(count(0), side * side) << "the nearer one, drawn first";
  begin(0.1);
  quad(1e7 + 1.0, green);
  quad(1e7, red);
  EXPECT_EQ(count(0), side * side) << "the nearer one, drawn last";
}

TEST_F(Depth, HoldsACentimetreAndTheEdgeOfTheSolarSystemInOnePass) {
  const double near = 0.005;
  constexpr std::array<double, 8> distances{1e13, 1.5e11, 4e8, 1e7, 1e4, 100.0, 1.0, 0.01};
  for (std::size_t nearer = 1; nearer < distances.size(); ++nearer) {
    begin(near);
    quad(distances[nearer], red);
    quad(distances[nearer - 1], green);
    EXPECT_EQ(count(0), side * side) << distances[nearer] << " m is before " << distances[nearer - 1] << " m";
  }
  begin(near);
  quad(1e13, green);
  EXPECT_EQ(count(1), side * side) << "1e13 m is before the background";
}

}  // namespace
}  // namespace meridian::graphics

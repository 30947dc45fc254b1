#include "globebrowsing/gpu/uniform_ring.h"

#include <set>

#include <glm/vec4.hpp>

#include "gpu_fixture.h"

namespace meridian::globebrowsing {
namespace {

using UniformRingTest = GpuTest;

TEST_F(UniformRingTest, BlocksOfThreeFramesLieApartAndAligned) {
  UniformRing ring(1024, 64);
  std::set<GLintptr> offsets;
  for (int frame = 0; frame < 3; ++frame) {
    ring.beginFrame();
    ring.reserve(4 * ring.aligned(100));
    for (int n = 0; n < 4; ++n) {
      const UniformRing::Block block = ring.take(100);
      EXPECT_EQ(block.offset % 64, 0);
      EXPECT_EQ(block.size, 128);
      EXPECT_TRUE(offsets.insert(block.offset).second) << "a block of an earlier frame is given again";
    }
    ring.endFrame();
  }
}

TEST_F(UniformRingTest, WrapsAfterThreeFrames) {
  UniformRing ring(256, 16);
  ring.beginFrame();
  const GLintptr first = ring.take(16).offset;
  ring.endFrame();
  for (int frame = 0; frame < 2; ++frame) {
    ring.beginFrame();
    EXPECT_NE(ring.take(16).offset, first);
    ring.endFrame();
  }
  ring.beginFrame();
  EXPECT_EQ(ring.take(16).offset, first);
}

TEST_F(UniformRingTest, GrowsWithinAFrameAndIsReadByTheDriverAsWritten) {
  UniformRing ring(64, static_cast<std::size_t>(graphics_->limits().uniformBlockAlignment));
  for (int frame = 0; frame < 5; ++frame) {
    ring.beginFrame();
    for (int n = 0; n < 100; ++n) {
      ring.reserve(ring.aligned(sizeof(glm::vec4)));
      const glm::vec4 value(static_cast<float>(frame), static_cast<float>(n), 2.0F, 3.0F);
      ring.writeAndBind(1, value);
      GLint buffer = 0;
      GLint64 offset = 0;
      glGetIntegeri_v(GL_UNIFORM_BUFFER_BINDING, 1, &buffer);
      glGetInteger64i_v(GL_UNIFORM_BUFFER_START, 1, &offset);
      glm::vec4 read(0.0F);
      glGetNamedBufferSubData(static_cast<GLuint>(buffer), offset, sizeof(read), &read);
      ASSERT_EQ(read, value);
    }
    ring.endFrame();
  }
  EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));
}

}  // namespace
}  // namespace meridian::globebrowsing

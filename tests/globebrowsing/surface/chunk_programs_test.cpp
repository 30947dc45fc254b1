#include "globebrowsing/surface/chunk_programs.h"

#include "../gpu/gpu_fixture.h"

namespace meridian::globebrowsing {
namespace {

class ChunkProgramsTest : public GpuTest {};

TEST_F(ChunkProgramsTest, NothingIsDrawnWithAProgramFinishedSinceItWasAskedFor) {
  ChunkPrograms programs(*graphics_);
  ASSERT_TRUE(programs.set({}));
  graphics_->programs().waitAll();
  EXPECT_EQ(programs.program({}), 0U);
  EXPECT_FALSE(programs.ready()) << "a picture without the globe would count as complete";
  ASSERT_TRUE(programs.set({}));
  EXPECT_NE(programs.program({}), 0U);
  EXPECT_TRUE(programs.ready());
}

TEST_F(ChunkProgramsTest, TheLastProgramsDrawUntilTheNextAreThere) {
  ChunkPrograms programs(*graphics_);
  ASSERT_TRUE(programs.set({}));
  graphics_->programs().waitAll();
  ASSERT_TRUE(programs.set({}));
  const GLuint plain = programs.program({});
  ChunkProgramKey edges;
  edges.edges = true;
  ASSERT_TRUE(programs.set(edges));
  graphics_->programs().waitAll();
  EXPECT_EQ(programs.program({}), plain);
  EXPECT_FALSE(programs.key().edges);
  EXPECT_FALSE(programs.ready());
  ASSERT_TRUE(programs.set(edges));
  EXPECT_NE(programs.program({}), plain);
  EXPECT_TRUE(programs.key().edges);
  EXPECT_TRUE(programs.ready());
}

}  // namespace
}  // namespace meridian::globebrowsing

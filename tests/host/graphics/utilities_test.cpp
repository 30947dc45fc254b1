#include <cstdlib>
#include <filesystem>
#include <string>
#include <thread>

#include <unistd.h>

#include "graphics_fixture.h"
#include "host/api/module.h"
#include "host/api/statistics.h"
#include "host/graphics/frame_fence.h"
#include "host/graphics/gl_objects.h"
#include "host/graphics/gpu_timer.h"
#include "host/graphics/graphics.h"
#include "host/graphics/limits.h"
#include "host/graphics/render_target.h"
#include "host/graphics/upload_budget.h"

namespace meridian::graphics {
namespace {

using OpenGl = GraphicsTest;

TEST_F(OpenGl, IsOfTheVersionAskedFor) {
  EXPECT_GE(epoxy_gl_version(), 45);
  GLint profile = 0;
  glGetIntegerv(GL_CONTEXT_PROFILE_MASK, &profile);
  EXPECT_EQ(profile, GL_CONTEXT_CORE_PROFILE_BIT);
  EXPECT_FALSE(context_->platform().empty());
}

TEST_F(OpenGl, HasTheLimitsThatTheSpecificationPromises) {
  const Limits limits = readLimits();
  EXPECT_FALSE(limits.renderer.empty());
  EXPECT_GE(limits.textureSize, 16384);
  EXPECT_GE(limits.textureLayers, 2048);
  EXPECT_GE(limits.fragmentTextureUnits, 16);
  EXPECT_GE(limits.vertexTextureUnits, 16);
  EXPECT_GE(limits.combinedTextureUnits, 96);
  EXPECT_GE(limits.samples, 4);
  EXPECT_GE(limits.uniformBlockBytes, 16384);
  EXPECT_GE(limits.anisotropy, 1.0F);
}

TEST_F(OpenGl, SharesBuffersWithASecondContextOnAnotherThread) {
  const unsigned value = 42;
  const Buffer buffer(sizeof(value), &value, 0);
  glFinish();
  auto second = context_->createShared();
  ASSERT_TRUE(second.has_value()) << second.error().message();
  unsigned read = 0;
  std::thread([&] {
    ASSERT_TRUE((*second)->makeCurrent().has_value());
    glGetNamedBufferSubData(buffer.id(), 0, sizeof(read), &read);
    (*second)->release();
  }).join();
  EXPECT_EQ(read, value);
  EXPECT_TRUE(deviationsFromDefaultState().empty()) << "the first context is still current";
}

TEST_F(OpenGl, SaysWhatDiffersFromTheDefaultState) {
  EXPECT_EQ(deviationsFromDefaultState(), "");
  glEnable(GL_BLEND);
  glDepthFunc(GL_LESS);
  glColorMask(GL_TRUE, GL_FALSE, GL_TRUE, GL_TRUE);
  const std::string words = deviationsFromDefaultState();
  EXPECT_NE(words.find("blending is on"), std::string::npos) << words;
  EXPECT_NE(words.find("depth function"), std::string::npos) << words;
  EXPECT_NE(words.find("colour channel"), std::string::npos) << words;
  applyDefaultState();
  EXPECT_EQ(deviationsFromDefaultState(), "");
}

TEST_F(OpenGl, DeletesWhatItOwnsOnce) {
  GLuint id = 0;
  {
    Texture first = Texture::array2D(GL_RGBA8, 8, 8, 3);
    id = first.id();
    const Texture second = std::move(first);
    EXPECT_EQ(first.id(), 0U);  // NOLINT(bugprone-use-after-move): that is what is tested
    EXPECT_EQ(second.id(), id);
    EXPECT_EQ(glIsTexture(id), GL_TRUE);
  }
  EXPECT_EQ(glIsTexture(id), GL_FALSE);
}

TEST_F(OpenGl, SaysWhyAFramebufferCannotBeDrawnTo) {
  const Framebuffer framebuffer = Framebuffer::create();
  const auto empty = framebuffer.check("nothing");
  ASSERT_FALSE(empty.has_value());
  EXPECT_NE(empty.error().what.find("nothing is incomplete: it has no attachment"), std::string::npos)
      << empty.error().what;
  framebuffer.attachLayer(GL_COLOR_ATTACHMENT0, Texture::array2D(GL_RGBA8, 8, 8, 2), 1);
}

TEST_F(OpenGl, TimesFramesWithoutWaiting) {
  auto target = RenderTarget::create({{256, 256}, 1});
  ASSERT_TRUE(target.has_value());
  GpuTimer timer;
  FrameFence fence;
  int taken = 0;
  // More frames than the ring holds, before the first result is asked for.
  for (int frame = 0; frame < 20; ++frame) {
    timer.begin();
    target->bind();
    target->clear(glm::vec4(0.5F));
    timer.end();
    fence.mark();
  }
  EXPECT_TRUE(fence.wait());
  glFinish();
  while (const auto milliseconds = timer.take()) {
    EXPECT_GE(*milliseconds, 0.0);
    ++taken;
  }
  EXPECT_GE(taken, 1);
  EXPECT_LE(taken, 8);
}

TEST_F(OpenGl, IsHandedOutByGraphics) {
  Paths paths;
  paths.shaders = "/nowhere";
  Statistics statistics;
  auto graphics = Graphics::create(*context_, paths, statistics);
  ASSERT_TRUE(graphics.has_value()) << graphics.error().message();
  (*graphics)->beginFrame(1000.0);
  EXPECT_TRUE((*graphics)->uploads().left());
  {
    const UploadBudget::Span span((*graphics)->uploads());
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  (*graphics)->endFrame();
  EXPECT_GE(statistics.frame.upload, 2.0);
  EXPECT_EQ(&(*graphics)->paths(), &paths);
  EXPECT_EQ((*graphics)->templates().folder(), paths.shaders);
}

TEST(UploadBudget, IsSpentBySpansOnly) {
  UploadBudget budget;
  budget.begin(0.0);
  EXPECT_FALSE(budget.left());
  budget.begin(1.0);
  std::this_thread::sleep_for(std::chrono::milliseconds(3));
  EXPECT_TRUE(budget.left()) << "nothing was uploaded";
  {
    const UploadBudget::Span outer(budget);
    const UploadBudget::Span inner(budget);
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
    EXPECT_FALSE(budget.left()) << "an open span counts";
  }
  EXPECT_FALSE(budget.left());
  budget.begin(1.0);
  EXPECT_TRUE(budget.left());
  EXPECT_EQ(budget.spent(), 0.0);
}

class ShaderCacheFolder : public ::testing::Test {
 protected:
  void SetUp() override {
    if (const char* value = std::getenv(variable)) {
      before_ = value;
    }
    unsetenv(variable);
  }
  void TearDown() override {
    before_.empty() ? unsetenv(variable) : setenv(variable, before_.c_str(), 1);
    std::filesystem::remove_all(folder_);
  }

  static constexpr const char* variable = "MESA_SHADER_CACHE_DIR";
  std::filesystem::path folder_ =
      std::filesystem::path(MERIDIAN_TEST_FOLDER) / ("cache_folder_" + std::to_string(getpid()));
  std::string before_;
};

TEST_F(ShaderCacheFolder, IsMadeAndToldToTheDriver) {
  const auto used = useShaderCacheFolder(folder_);
  ASSERT_TRUE(used.has_value()) << used.error().message();
  EXPECT_TRUE(std::filesystem::is_directory(*used));
  EXPECT_EQ(used->parent_path(), folder_);
  EXPECT_EQ(std::getenv(variable), used->string());
}

TEST_F(ShaderCacheFolder, IsTheUsersWhenTheyNameOne) {
  setenv(variable, "/somewhere/else", 1);
  const auto used = useShaderCacheFolder(folder_);
  ASSERT_TRUE(used.has_value());
  EXPECT_EQ(*used, "/somewhere/else");
  EXPECT_FALSE(std::filesystem::exists(folder_));
}

TEST_F(ShaderCacheFolder, IsAnErrorWhereNoneCanBe) {
  const auto used = useShaderCacheFolder("/proc/meridian");
  ASSERT_FALSE(used.has_value());
  EXPECT_EQ(used.error().where, "/proc/meridian/shaders");
  EXPECT_EQ(std::getenv(variable), nullptr);
}

// CTest runs this one on a display of its own (window.context).
TEST(WindowContext, OpensOnADisplay) {
  if (std::getenv("DISPLAY") == nullptr) {
    GTEST_SKIP() << "no display";
  }
  const auto window = WindowContext::create({.visible = false});
  ASSERT_TRUE(window) << window.error().message();
  ASSERT_TRUE((*window)->makeCurrent().has_value());
  EXPECT_GE(epoxy_gl_version(), 45);
  EXPECT_TRUE((*window)->createShared().has_value());
  EXPECT_EQ((*window)->framebufferSize(), glm::ivec2(1280, 720));
}

TEST(WindowContext, NamesTheReasonWithoutADisplay) {
  ::setenv("DISPLAY", ":987", 1);
  ::unsetenv("WAYLAND_DISPLAY");
  const auto window = WindowContext::create();
  ASSERT_FALSE(window.has_value());
  EXPECT_NE(window.error().what.find("no window can be opened"), std::string::npos) << window.error().what;
  EXPECT_NE(window.error().remedy.find("--headless"), std::string::npos);
}

}  // namespace
}  // namespace meridian::graphics

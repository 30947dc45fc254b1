#include "host/graphics/program_cache.h"

#include <algorithm>
#include <atomic>
#include <fstream>
#include <future>
#include <set>
#include <thread>

#include <fmt/format.h>

#include "graphics_fixture.h"
#include "host/api/statistics.h"
#include "host/graphics/render_target.h"

namespace meridian::graphics {
namespace {

constexpr const char* coveringTriangle =
    "void main() { gl_Position = vec4(vec2(gl_VertexID & 1, gl_VertexID >> 1) * 4.0 - 1.0, 0.5, 1.0); }";

/// A program that fills the picture with red = `red` / 255.
ProgramDescription flat(int red) {
  return {
      fmt::format("flat {}", red),
      shader(coveringTriangle, "flat.vert"),
      shader(fmt::format("layout(location = 0) out vec4 c;\nvoid main() {{ c = vec4({}.0 / 255.0, 0, 0, 1); }}", red),
             "flat.frag"),
      {}};
}

void drawOnce(const RenderTarget& target, GLuint program) {
  const VertexArray vertices = VertexArray::create();
  target.bind();
  target.clear(glm::vec4(0.0F));
  glUseProgram(program);
  glBindVertexArray(vertices.id());
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

void warm(GLuint program) {
  auto target = RenderTarget::create({{8, 8}, 1});
  ASSERT_TRUE(target.has_value());
  drawOnce(*target, program);
}

class Programs : public GraphicsTest {
 protected:
  void SetUp() override {
    GraphicsTest::SetUp();
    if (context_) {
      start({});
    }
  }
  void TearDown() override { cache_.reset(); }

  void start(const ProgramCache::Options& options) {
    cache_.reset();
    auto made = ProgramCache::create(*context_, statistics_, options);
    ASSERT_TRUE(made.has_value()) << made.error().message();
    cache_ = std::move(*made);
  }

  [[nodiscard]] int redOf(GLuint program) const {
    auto target = RenderTarget::create({{4, 4}, 1});
    EXPECT_TRUE(target.has_value());
    drawOnce(*target, program);
    return target->readPixels()[0];
  }

  Statistics statistics_;
  std::unique_ptr<ProgramCache> cache_;
};

TEST_F(Programs, AreBuiltWhileFramesGoOnDrawingAndUploading) {
  auto target = RenderTarget::create({{256, 256}, 1});
  ASSERT_TRUE(target.has_value());
  const auto first = cache_->buildNow(flat(10));
  ASSERT_TRUE(first.has_value()) << first.error().message();
  const GLuint drawn = cache_->ready(*first);
  const Texture texture = Texture::image2D(GL_RGBA8, 256, 256);
  const std::vector<std::uint8_t> texels(256 * 256 * 4, 7);

  // With the driver's own cache they could all be there before a second frame.
  std::promise<void> drawnTwice;
  const std::shared_future<void> both = drawnTwice.get_future().share();
  std::vector<ProgramHandle> handles;
  for (int red = 100; red < 108; ++red) {
    ProgramDescription description = flat(red);
    description.warmUp = [both, isFirst = red == 100](GLuint program) {
      if (isFirst) {
        both.wait();
      }
      warm(program);
    };
    handles.push_back(cache_->request(std::move(description)));
  }
  int frames = 0;
  while (cache_->pending() > 0) {
    cache_->beginFrame();
    glTextureSubImage2D(texture.id(), 0, 0, 0, 256, 256, GL_RGBA, GL_UNSIGNED_BYTE, texels.data());
    glBindTextureUnit(0, texture.id());
    drawOnce(*target, drawn);
    glFinish();
    cache_->endFrame();
    if (++frames == 2) {
      drawnTwice.set_value();
    }
  }
  EXPECT_GT(frames, 1);
  cache_->waitAll();
  EXPECT_EQ(statistics_.programs.framesWaited, 0U);
  EXPECT_EQ(statistics_.programs.built, 9U);
  EXPECT_GT(statistics_.programs.buildMsMax, 0.0);
  for (int red = 100; red < 108; ++red) {
    EXPECT_EQ(redOf(cache_->ready(handles[static_cast<std::size_t>(red - 100)])), red);
  }
}

TEST_F(Programs, AreReadyOnlyAfterTheirWarmUpDraw) {
  std::promise<void> arrived;
  std::promise<void> goOn;
  std::atomic<bool> onThisThread = true;
  int calls = 0;
  ProgramDescription description = flat(33);
  description.warmUp = [&, here = std::this_thread::get_id()](GLuint program) {
    if (calls++ > 0) {
      return;
    }
    onThisThread = std::this_thread::get_id() == here;
    EXPECT_TRUE(glIsProgram(program));
    EXPECT_EQ(deviationsFromDefaultState().find("blending"), std::string::npos);
    warm(program);
    arrived.set_value();
    goOn.get_future().wait();
  };
  const ProgramHandle handle = cache_->request(std::move(description));
  arrived.get_future().wait();
  EXPECT_EQ(cache_->ready(handle), 0U);
  const auto underWay = cache_->get(handle);
  ASSERT_TRUE(underWay.has_value());
  EXPECT_EQ(*underWay, 0U);
  goOn.set_value();
  cache_->waitAll();
  EXPECT_FALSE(onThisThread);
  EXPECT_EQ(redOf(cache_->ready(handle)), 33);
}

TEST_F(Programs, FailWithTemplateFileAndLine) {
  const std::filesystem::path folder = std::filesystem::path(MERIDIAN_TEST_FOLDER) / "templates";
  std::filesystem::create_directories(folder / "room");
  std::ofstream(folder / "room" / "wrong.frag") << "#version 450 core\n"
                                                   "#include \"room/part.glsl\"\n"
                                                   "layout(location = 0) out vec4 c;\n"
                                                   "void main() { c = part(); }\n";
  std::ofstream(folder / "room" / "part.glsl") << "\n\nvec4 part() { return missing; }\n";
  auto fragment = ShaderTemplates(folder).load("room/wrong.frag");
  ASSERT_TRUE(fragment.has_value()) << fragment.error().message();
  const ProgramHandle handle =
      cache_->request({"wrong", shader(coveringTriangle, "flat.vert"), std::move(*fragment), {}});
  cache_->waitAll();
  const auto program = cache_->get(handle);
  ASSERT_FALSE(program.has_value());
  EXPECT_EQ(program.error().where, "room/part.glsl:3");
  EXPECT_NE(program.error().what.find("missing"), std::string::npos) << program.error().what;
  EXPECT_EQ(cache_->ready(handle), 0U);
  EXPECT_EQ(statistics_.programs.built, 0U);
}

TEST_F(Programs, FailWhenTheirStagesDoNotFit) {
  const auto handle = cache_->buildNow(
      {"apart",
       shader(coveringTriangle, "apart.vert"),
       shader("in vec4 absent;\nlayout(location = 0) out vec4 c;\nvoid main() { c = absent; }", "apart.frag"),
       {}});
  ASSERT_FALSE(handle.has_value());
  EXPECT_EQ(handle.error().where, "apart.vert with apart.frag");
}

TEST_F(Programs, AreSharedByKey) {
  const ProgramHandle first = cache_->request(flat(50));
  const ProgramHandle second = cache_->request(flat(50));
  EXPECT_EQ(first, second);
  EXPECT_EQ(cache_->find("flat 50"), first);
  EXPECT_FALSE(cache_->find("flat 51"));
  EXPECT_EQ(statistics_.programs.cached, 1U);
  cache_->waitAll();
  const auto now = cache_->buildNow(flat(50));
  ASSERT_TRUE(now.has_value());
  EXPECT_EQ(*now, first);
  EXPECT_EQ(statistics_.programs.built, 1U);
}

TEST_F(Programs, DoNotPileUp) {
  start({.capacity = 4});
  const ProgramHandle held = cache_->request(flat(0));
  cache_->waitAll();
  const GLuint heldProgram = cache_->ready(held);
  std::vector<GLuint> made;
  for (int red = 1; red <= 200; ++red) {
    ProgramHandle handle = cache_->request(flat(red));
    cache_->waitAll();
    made.push_back(cache_->ready(handle));
    ASSERT_NE(made.back(), 0U);
  }
  cache_->endFrame();
  EXPECT_EQ(cache_->size(), 5U);
  EXPECT_TRUE(cache_->find("flat 200"));
  EXPECT_TRUE(cache_->find("flat 197"));
  EXPECT_FALSE(cache_->find("flat 196"));
  EXPECT_EQ(cache_->ready(held), heldProgram) << "one that is held stays";
  const auto alive = std::ranges::count_if(std::set<GLuint>(made.begin(), made.end()),
                                           [](GLuint program) { return glIsProgram(program) == GL_TRUE; });
  EXPECT_LE(alive, 5);
}

TEST_F(Programs, ThatNobodyWantsAnyMoreAreNotBuilt) {
  std::promise<void> goOn;
  std::promise<void> arrived;
  ProgramDescription slow = flat(60);
  slow.warmUp = [&, calls = 0](GLuint) mutable {
    if (calls++ > 0) {
      return;
    }
    arrived.set_value();
    goOn.get_future().wait();
  };
  const ProgramHandle first = cache_->request(std::move(slow));
  arrived.get_future().wait();
  ProgramHandle unwanted = cache_->request(flat(61));
  const ProgramHandle wanted = cache_->request(flat(62));
  EXPECT_EQ(cache_->pending(), 3U);
  unwanted = {};
  cache_->endFrame();
  EXPECT_EQ(cache_->pending(), 2U);
  goOn.set_value();
  cache_->waitAll();
  EXPECT_NE(cache_->ready(wanted), 0U);
  EXPECT_EQ(statistics_.programs.built, 2U);
}

TEST_F(Programs, AskedForLaterAreBuiltAfterTheOthers) {
  std::promise<void> goOn;
  std::vector<std::string> order;  // the builder's until waitAll() returns
  const auto noted = [&order](int red) {
    ProgramDescription description = flat(red);
    description.warmUp = [&order, key = description.key](GLuint) {
      if (order.empty() || order.back() != key) {  // one that compiled something is drawn with twice
        order.push_back(key);
      }
    };
    return description;
  };
  ProgramDescription slow = flat(63);
  slow.warmUp = [ended = goOn.get_future().share()](GLuint) { ended.wait(); };
  using enum ProgramCache::Urgency;
  const std::vector<ProgramHandle> handles{cache_->request(std::move(slow)),  cache_->request(noted(64), Later),
                                           cache_->request(noted(65), Later), cache_->request(noted(66)),
                                           cache_->request(noted(67), Later), cache_->request(noted(67)),
                                           cache_->request(noted(66), Later)};
  goOn.set_value();
  cache_->waitAll();
  EXPECT_EQ(order, (std::vector<std::string>{"flat 66", "flat 67", "flat 64", "flat 65"}));
}

TEST_F(Programs, CountFramesThatWaited) {
  ASSERT_TRUE(cache_->buildNow(flat(70)).has_value());
  EXPECT_EQ(statistics_.programs.framesWaited, 0U) << "before the first frame nobody waits";
  cache_->beginFrame();
  ASSERT_TRUE(cache_->buildNow(flat(71)).has_value());
  ASSERT_TRUE(cache_->buildNow(flat(72)).has_value());
  cache_->endFrame();
  EXPECT_EQ(statistics_.programs.framesWaited, 1U);
  cache_->beginFrame();
  ASSERT_TRUE(cache_->buildNow(flat(71)).has_value());
  cache_->waitAll();
  cache_->endFrame();
  EXPECT_EQ(statistics_.programs.framesWaited, 1U) << "known programs cost nothing";
}

TEST_F(Programs, AreDroppedWhenTheCacheEndsWhileItBuilds) {
  for (int round = 0; round < 3; ++round) {
    std::vector<ProgramHandle> handles;
    std::promise<void> arrived;
    ProgramDescription first = flat(80);
    first.warmUp = [&arrived, calls = 0](GLuint program) mutable {
      if (calls++ == 0) {
        arrived.set_value();
      }
      warm(program);
    };
    handles.push_back(cache_->request(std::move(first)));
    for (int red = 81; red < 100; ++red) {
      handles.push_back(cache_->request(flat(red)));
    }
    arrived.get_future().wait();
    start({});  // ends the first
    EXPECT_EQ(cache_->size(), 0U);
  }
}

}  // namespace
}  // namespace meridian::graphics

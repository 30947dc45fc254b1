#pragma once

#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "host/graphics/context.h"
#include "host/graphics/default_state.h"
#include "host/graphics/shader_cache_folder.h"
#include "host/graphics/shader_template.h"

namespace meridian::graphics {

/// A current off-screen context; skips the test, loudly, where there is no EGL at all.
class GraphicsTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    ASSERT_TRUE(useShaderCacheFolder(std::filesystem::path(MERIDIAN_TEST_FOLDER)).has_value());
  }

  void SetUp() override {
    auto made = OffscreenContext::create({.debug = true});
    if (!made) {
      std::cerr << "NO OPENGL HERE, NOTHING IS TESTED: " << made.error().message() << "\n";
      // Where EGL is there, a failure to make a context on it is a failure of ours.
      if (made.error().what.starts_with("no EGL display")) {
        GTEST_SKIP() << made.error().message();
      }
      FAIL() << made.error().message();
    }
    context_ = std::move(*made);
    const auto current = context_->makeCurrent();
    ASSERT_TRUE(current.has_value()) << current.error().message();
    applyDefaultState();
  }

  std::unique_ptr<OffscreenContext> context_;
};

/// A source that is no file.
[[nodiscard]] inline ShaderSource shader(std::string body, std::string name) {
  return {"#version 450 core\n" + std::move(body), {std::move(name)}, {}};
}

}  // namespace meridian::graphics

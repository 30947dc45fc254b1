#pragma once

#include <filesystem>
#include <iostream>
#include <memory>

#include <gtest/gtest.h>

#include "host/api/module.h"
#include "host/api/statistics.h"
#include "host/graphics/context.h"
#include "host/graphics/graphics.h"
#include "host/graphics/shader_cache_folder.h"

namespace meridian::globebrowsing {

/// Graphics on a current off-screen context; skips the test, loudly, where there is no EGL at all.
class GpuTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    ASSERT_TRUE(graphics::useShaderCacheFolder(std::filesystem::path(MERIDIAN_TEST_FOLDER)).has_value());
  }

  void SetUp() override {
    auto made = graphics::OffscreenContext::create({.debug = false});
    if (!made) {
      std::cerr << "NO OPENGL HERE, NOTHING IS TESTED: " << made.error().message() << "\n";
      if (made.error().what.starts_with("no EGL display")) {
        GTEST_SKIP() << made.error().message();
      }
      FAIL() << made.error().message();
    }
    context_ = std::move(*made);
    ASSERT_TRUE(context_->makeCurrent());
    paths_.shaders = std::filesystem::path(MERIDIAN_SOURCE_FOLDER) / "shaders";
    auto graphics = graphics::Graphics::create(*context_, paths_, statistics_);
    ASSERT_TRUE(graphics) << graphics.error().message();
    graphics_ = std::move(*graphics);
  }

  std::unique_ptr<graphics::OffscreenContext> context_;
  Paths paths_;
  Statistics statistics_;
  std::unique_ptr<graphics::Graphics> graphics_;
};

}  // namespace meridian::globebrowsing

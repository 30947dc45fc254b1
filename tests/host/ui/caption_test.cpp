#include "host/ui/caption.h"

#include <imgui.h>

#include "../graphics/graphics_fixture.h"

namespace meridian::ui {
namespace {

class CaptionTest : public graphics::GraphicsTest {
 protected:
  static constexpr glm::ivec2 size{320, 120};

  void SetUp() override {
    graphics::GraphicsTest::SetUp();
    if (context_ != nullptr) {
      target_ = std::make_unique<graphics::RenderTarget>(std::move(graphics::RenderTarget::create({size, 1}).value()));
      caption_ = std::make_unique<Caption>();
    }
  }
  void TearDown() override {
    caption_.reset();
    target_.reset();
  }

  /// Rows, from the top, that the text touches on a picture of one grey.
  std::vector<int> touchedRows(const std::string& text) {
    constexpr std::uint8_t grey = 128;
    target_->bind();
    target_->clear({grey / 255.0F, grey / 255.0F, grey / 255.0F, 1.0F});
    caption_->draw(*target_, text);
    pixels_ = target_->readPixels();
    std::vector<int> rows;
    for (int y = 0; y < size.y; ++y) {
      for (int x = 0; x < size.x; ++x) {
        if (std::abs(pixels_[static_cast<std::size_t>(4 * (y * size.x + x))] - grey) > 3) {
          rows.push_back(y);
          break;
        }
      }
    }
    return rows;
  }

  std::unique_ptr<graphics::RenderTarget> target_;
  std::unique_ptr<Caption> caption_;
  std::vector<std::uint8_t> pixels_;
};

TEST_F(CaptionTest, StandsAtTheLowerEdge) {
  const std::vector<int> rows = touchedRows("NASA | \u00a9 Somebody");
  ASSERT_FALSE(rows.empty());
  EXPECT_GE(rows.front(), size.y - 20);
  EXPECT_LT(rows.back(), size.y);
  // Letters are lighter than the picture, what is behind them darker; the right half has neither.
  int lighter = 0;
  int darker = 0;
  for (int y = rows.front(); y < size.y; ++y) {
    for (int x = 0; x < size.x; ++x) {
      const int value = pixels_[static_cast<std::size_t>(4 * (y * size.x + x))];
      lighter += value > 200 ? 1 : 0;
      darker += value < 100 ? 1 : 0;
      if (x > size.x * 3 / 4) {
        EXPECT_NEAR(value, 128, 3);
      }
    }
  }
  EXPECT_GT(lighter, 100);
  EXPECT_GT(darker, 400);
}

TEST_F(CaptionTest, NothingIsDrawnForNothing) {
  EXPECT_TRUE(touchedRows("").empty());
}

TEST_F(CaptionTest, LongTextIsWrappedAndThenCut) {
  std::string text;
  const std::size_t one = touchedRows("One line").size();
  for (int i = 0; i < 12; ++i) {
    text += "A long list of names ";
  }
  const std::vector<int> wrapped = touchedRows(text);
  EXPECT_GT(wrapped.size(), 2 * one);
  const std::vector<int> cut = touchedRows(text + text + text + text);
  EXPECT_GE(cut.size(), wrapped.size());
  EXPECT_LE(cut.size(), Caption::mostLines * one + 4);
  EXPECT_FALSE(touchedRows("Onewordthatislongerthanalineisbrokensomewhere" + std::string(400, 'x')).empty());
}

TEST_F(CaptionTest, LeavesThePanelsTheirContext) {
  ImGuiContext* const panels = ImGui::CreateContext();
  ImGui::SetCurrentContext(panels);
  EXPECT_FALSE(touchedRows("Text").empty());
  EXPECT_EQ(ImGui::GetCurrentContext(), panels);
  caption_.reset();
  EXPECT_EQ(ImGui::GetCurrentContext(), panels);
  ImGui::DestroyContext(panels);
}

}  // namespace
}  // namespace meridian::ui

#pragma once

#include <memory>
#include <string_view>

#include "host/graphics/render_target.h"

namespace meridian::ui {

/// Small text at the lower edge of a picture, such as credits: light on a translucent dark ground, wrapped, cut off
/// after a few lines. With or without a window, beside the panels of one. Render thread only; destroyed while the
/// context that it drew with is current.
class Caption {
 public:
  /// Of the first one that is drawn no more is shown.
  static constexpr int mostLines = 4;

  Caption();
  ~Caption();
  Caption(const Caption&) = delete;
  Caption& operator=(const Caption&) = delete;

  /// Leaves the default GL state behind. Costs nothing, neither now nor before, while the text is empty. UTF-8; of what
  /// is beyond Latin-1 only question marks are seen.
  void draw(const graphics::RenderTarget& target, std::string_view text);

 private:
  class Painter;
  std::unique_ptr<Painter> painter_;  ///< since the first text
};

}  // namespace meridian::ui

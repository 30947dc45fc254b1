#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <string>

#include <glm/vec2.hpp>

#include "host/api/error.h"
#include "host/graphics/image.h"

namespace meridian::app {

/// One video file through FFmpeg's libraries: 4:2:0, BT.709, one picture every 1/fps seconds.
class VideoEncoder {
 public:
  /// The container follows from the extension (.mp4, .mov, .mkv, .webm), the encoder from what libavcodec has: H.264,
  /// else MPEG-4; VP9, else VP8 in .webm. Odd sizes lose their last column or row, as 4:2:0 wants.
  [[nodiscard]] static Result<std::unique_ptr<VideoEncoder>> open(const std::filesystem::path& file, glm::ivec2 size,
                                                                  double fps);
  VideoEncoder(const VideoEncoder&) = delete;
  VideoEncoder& operator=(const VideoEncoder&) = delete;
  /// Without finish the file is left as it is: cut off.
  ~VideoEncoder();

  /// `credits`, whom the picture is to be credited to, become the container's "copyright", each of them once: those of
  /// all pictures in .mp4 and .mov, which have it at their end; of the first one in .mkv and .webm.
  [[nodiscard]] Result<void> add(const graphics::Image& picture, std::span<const std::string> credits = {});
  /// Flushes the encoder and writes the index; to be called once, at the end.
  [[nodiscard]] Result<void> finish();

 private:
  struct Implementation;
  explicit VideoEncoder(std::unique_ptr<Implementation> implementation);

  std::unique_ptr<Implementation> implementation_;
};

}  // namespace meridian::app

#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <glm/vec2.hpp>

#include "host/api/error.h"
#include "host/graphics/image.h"

namespace meridian::app {

/// Writes the pictures of `--output`, encoding on a thread of its own so that drawing goes on meanwhile. At most
/// `queueLength` pictures wait; `write` blocks while the queue is full. Used by one thread at a time.
///
/// What it writes follows from the path: NAME.png gets the last picture; NAME.mp4, .mkv, .webm or .mov becomes a video
/// (H.264 or MPEG-4; VP9 or VP8 in .webm); a name without extension, or a folder that is there, becomes a folder of
/// frame_000000.png, frame_000001.png ... A picture's metadata and credits ("Copyright") go into its file; the credits
/// of a video's go into the container, as VideoEncoder says.
class FrameWriter {
 public:
  enum class Kind { Picture, Folder, Video };
  static constexpr std::size_t queueLength = 4;

  /// What such a path stands for. Errors: an extension that is none of the above. Looks whether there is such a folder.
  [[nodiscard]] static Result<Kind> kindOf(const std::filesystem::path& path);

  /// Creates missing folders. `size` in pixels (a video leaves out an odd last row or column), `fps` frames a second.
  /// Errors: an unknown extension; a folder or file that cannot be written; no encoder for such a video.
  [[nodiscard]] static Result<std::unique_ptr<FrameWriter>> open(const std::filesystem::path& path, glm::ivec2 size,
                                                                 double fps);
  /// Closes; an error is then only logged.
  virtual ~FrameWriter() = default;

  /// Hands over the next picture, of the size that open was told, and whom what it shows is to be credited to. Errors:
  /// the first thing that went wrong with this or any picture before it, and from then on the same again.
  [[nodiscard]] virtual Result<void> write(graphics::Image picture, std::vector<std::string> credits) = 0;
  /// Waits until all is on disk and ends the video. Errors as for write. Closing twice does nothing more.
  [[nodiscard]] virtual Result<void> close() = 0;
};

}  // namespace meridian::app

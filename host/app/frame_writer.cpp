#include "host/app/frame_writer.h"

#include <algorithm>
#include <cassert>
#include <condition_variable>
#include <deque>
#include <fstream>
#include <mutex>
#include <optional>
#include <system_error>
#include <thread>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "host/api/log.h"
#include "host/app/video_encoder.h"

namespace meridian::app {
namespace {

namespace fs = std::filesystem;

struct Picture {
  graphics::Image image;
  std::vector<std::string> credits;
};

/// Where pictures end up. Used on the writer's thread only, after it was made.
class Sink {
 public:
  virtual ~Sink() = default;
  virtual Result<void> add(Picture picture) = 0;
  virtual Result<void> finish() = 0;
};

Result<void> writePicture(const fs::path& file, const Picture& picture) {
  graphics::PngOptions options;
  options.metadata = picture.image.metadata;
  if (!picture.credits.empty()) {
    options.metadata["Copyright"] = fmt::format("{}", fmt::join(picture.credits, " | "));
  }
  return graphics::writePng(file, picture.image.pixels, picture.image.size, options);
}

class PictureSink final : public Sink {
 public:
  explicit PictureSink(fs::path file) : file_(std::move(file)) {}
  Result<void> add(Picture picture) override {
    last_ = std::move(picture);
    return {};
  }
  Result<void> finish() override { return last_ ? writePicture(file_, *last_) : Result<void>{}; }

 private:
  fs::path file_;
  std::optional<Picture> last_;
};

class FolderSink final : public Sink {
 public:
  explicit FolderSink(fs::path folder) : folder_(std::move(folder)) {}
  Result<void> add(Picture picture) override {
    return writePicture(folder_ / fmt::format("frame_{:06}.png", count_++), picture);
  }
  Result<void> finish() override { return {}; }

 private:
  fs::path folder_;
  std::size_t count_ = 0;
};

class VideoSink final : public Sink {
 public:
  explicit VideoSink(std::unique_ptr<VideoEncoder> encoder) : encoder_(std::move(encoder)) {}
  Result<void> add(Picture picture) override { return encoder_->add(picture.image, picture.credits); }
  Result<void> finish() override { return encoder_->finish(); }

 private:
  std::unique_ptr<VideoEncoder> encoder_;
};

/// Hands pictures to a sink on a thread of its own.
class QueuedWriter final : public FrameWriter {
 public:
  QueuedWriter(std::unique_ptr<Sink> sink, glm::ivec2 size) : sink_(std::move(sink)), size_(size) {
    thread_ = std::thread([this] { run(); });
  }
  QueuedWriter(const QueuedWriter&) = delete;
  QueuedWriter& operator=(const QueuedWriter&) = delete;
  ~QueuedWriter() override {
    if (const auto closed = close(); !closed) {
      log::error("{}", closed.error().message());
    }
  }

  Result<void> write(graphics::Image picture, std::vector<std::string> credits) override {
    assert(picture.size == size_);
    assert(picture.pixels.size() == 4 * static_cast<std::size_t>(size_.x) * static_cast<std::size_t>(size_.y));
    std::unique_lock lock(mutex_);
    assert(!ended_);
    changed_.wait(lock, [this] { return queue_.size() < queueLength || error_; });
    if (error_) {
      return tl::make_unexpected(*error_);
    }
    queue_.push_back({std::move(picture), std::move(credits)});
    changed_.notify_all();
    return {};
  }

  Result<void> close() override {
    if (thread_.joinable()) {
      {
        const std::lock_guard lock(mutex_);
        ended_ = true;
      }
      changed_.notify_all();
      thread_.join();
    }
    return error_ ? Result<void>(tl::make_unexpected(*error_)) : Result<void>{};
  }

 private:
  std::optional<Picture> next() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return !queue_.empty() || ended_; });
    if (queue_.empty()) {
      return std::nullopt;
    }
    Picture picture = std::move(queue_.front());
    queue_.pop_front();
    changed_.notify_all();
    return picture;
  }

  /// True when all is well so far.
  bool keep(const Result<void>& result) {
    if (result) {
      return true;
    }
    {
      const std::lock_guard lock(mutex_);
      error_ = result.error();
      queue_.clear();
    }
    changed_.notify_all();
    return false;
  }

  void run() {
    while (auto picture = next()) {
      if (!keep(sink_->add(std::move(*picture)))) {
        return;
      }
    }
    keep(sink_->finish());
  }

  std::unique_ptr<Sink> sink_;
  [[maybe_unused]] glm::ivec2 size_;  ///< for assertions
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Picture> queue_;
  std::optional<Error> error_;
  bool ended_ = false;
  std::thread thread_;
};

/// Makes sure that such a file can be written, so that a long run does not fail at its end.
Result<void> tryFile(const fs::path& file) {
  std::error_code ignored;
  const bool existed = fs::exists(file, ignored);
  if (!std::ofstream(file, std::ios::binary | std::ios::app)) {
    return failure("pictures cannot be written there", file.string(), "name a place that can be written");
  }
  if (!existed) {
    fs::remove(file, ignored);
  }
  return {};
}

Result<void> makeFolder(const fs::path& folder, const fs::path& output) {
  std::error_code error;
  if (!folder.empty()) {
    fs::create_directories(folder, error);
  }
  if (error) {
    return failure(fmt::format("the folder {} cannot be made: {}", folder.string(), error.message()), output.string(),
                   "name a place that can be written");
  }
  return {};
}

}  // namespace

Result<FrameWriter::Kind> FrameWriter::kindOf(const fs::path& path) {
  std::error_code ignored;
  const std::string extension = path.extension().string();
  if (fs::is_directory(path, ignored) || extension.empty()) {
    return Kind::Folder;
  }
  if (extension == ".png") {
    return Kind::Picture;
  }
  for (const char* video : {".mp4", ".mkv", ".mov", ".webm"}) {
    if (extension == video) {
      return Kind::Video;
    }
  }
  return failure(fmt::format("'{}' is no kind of output", extension), path.string(),
                 "use .png, .mp4, .mkv, .mov, .webm, or a folder's name without extension");
}

Result<std::unique_ptr<FrameWriter>> FrameWriter::open(const fs::path& path, glm::ivec2 size, double fps) {
  const auto kind = kindOf(path);
  if (!kind) {
    return tl::make_unexpected(kind.error());
  }
  const bool isFolder = *kind == Kind::Folder;
  if (auto made = makeFolder(isFolder ? path : path.parent_path(), path); !made) {
    return tl::make_unexpected(made.error());
  }
  if (auto tried = tryFile(isFolder ? path / "frame_000000.png" : path); !tried) {
    return tl::make_unexpected(tried.error());
  }
  std::unique_ptr<Sink> sink;
  if (*kind == Kind::Video) {
    auto encoder = VideoEncoder::open(path, size, fps);
    if (!encoder) {
      return tl::make_unexpected(encoder.error());
    }
    sink = std::make_unique<VideoSink>(std::move(*encoder));
  } else if (isFolder) {
    sink = std::make_unique<FolderSink>(path);
  } else {
    sink = std::make_unique<PictureSink>(path);
  }
  return std::make_unique<QueuedWriter>(std::move(sink), size);
}

}  // namespace meridian::app

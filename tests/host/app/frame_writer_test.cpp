#include "host/app/frame_writer.h"

#include <array>
#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
}

#include "host/app/locations.h"

namespace meridian::app {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

constexpr std::array<std::uint8_t, 3> reds{20, 120, 220};
constexpr glm::ivec2 size(65, 33);  // odd, as windows can be

/// One colour all over, but for the left column, which is white.
graphics::Image picture(std::uint8_t red, std::uint8_t green, std::uint8_t blue) {
  graphics::Image image{size, {}, {}};
  for (int y = 0; y < size.y; ++y) {
    for (int x = 0; x < size.x; ++x) {
      const std::uint8_t texel[] = {red, green, blue, 255};
      const std::uint8_t white[] = {255, 255, 255, 255};
      image.pixels.insert(image.pixels.end(), x == 0 ? white : texel, (x == 0 ? white : texel) + 4);
    }
  }
  return image;
}

class FrameWriterTest : public ::testing::Test {
 protected:
  fs::path in(const char* name) const { return folder_.path() / name; }

  void writeThree(const fs::path& path) {
    auto writer = FrameWriter::open(path, size, 25.0);
    ASSERT_TRUE(writer) << writer.error().message();
    for (const std::uint8_t red : reds) {
      const auto written = (*writer)->write(picture(red, 60, 100), {});
      ASSERT_TRUE(written) << written.error().message();
    }
    const auto closed = (*writer)->close();
    ASSERT_TRUE(closed) << closed.error().message();
    EXPECT_TRUE((*writer)->close());
  }

  TemporaryFolder folder_ = std::move(TemporaryFolder::create().value());
};

TEST_F(FrameWriterTest, PngGetsTheLastPicture) {
  writeThree(in("new/last.png"));
  const auto image = graphics::readPng(in("new/last.png"));
  ASSERT_TRUE(image) << image.error().message();
  EXPECT_EQ(image->size, size);
  EXPECT_EQ(image->pixels, picture(220, 60, 100).pixels);
}

TEST_F(FrameWriterTest, FolderGetsEveryPictureInOrder) {
  writeThree(in("frames"));
  int index = 0;
  for (const std::uint8_t red : reds) {
    const auto image = graphics::readPng(in("frames") / ("frame_00000" + std::to_string(index++) + ".png"));
    ASSERT_TRUE(image) << image.error().message();
    EXPECT_EQ(image->pixels, picture(red, 60, 100).pixels);
  }
  EXPECT_FALSE(fs::exists(in("frames/frame_000003.png")));
}

TEST_F(FrameWriterTest, PicturesCarryTheirWords) {
  for (const char* path : {"last.png", "frames"}) {
    auto writer = FrameWriter::open(in(path), size, 25.0);
    ASSERT_TRUE(writer);
    graphics::Image image = picture(1, 2, 3);
    image.metadata["Title"] = "Earth";
    ASSERT_TRUE((*writer)->write(image, {"\u00a9 Somebody", "NASA"}));
    image.metadata["Copyright"] = "\u00a9 Somebody | NASA";
    ASSERT_TRUE((*writer)->close());
    const fs::path file = fs::is_directory(in(path)) ? in(path) / "frame_000000.png" : in(path);
    EXPECT_EQ(graphics::readPng(file).value().metadata, image.metadata);
  }
}

TEST_F(FrameWriterTest, ANameWithoutExtensionIsAFolderAndSoIsAFolderWithADot) {
  fs::create_directories(in("v1.0"));
  EXPECT_EQ(FrameWriter::kindOf(in("frames")).value(), FrameWriter::Kind::Folder);
  EXPECT_EQ(FrameWriter::kindOf(in("v1.0")).value(), FrameWriter::Kind::Folder);
  EXPECT_EQ(FrameWriter::kindOf(in("a.png")).value(), FrameWriter::Kind::Picture);
  EXPECT_EQ(FrameWriter::kindOf(in("a.mkv")).value(), FrameWriter::Kind::Video);
}

TEST_F(FrameWriterTest, AnUnknownExtensionIsAnErrorThatNamesTheKnownOnes) {
  const auto writer = FrameWriter::open(in("a.bmp"), size, 25.0);
  ASSERT_FALSE(writer);
  EXPECT_THAT(writer.error().message(), HasSubstr(".bmp"));
  EXPECT_THAT(writer.error().message(), HasSubstr(".mp4"));
  EXPECT_FALSE(fs::exists(in("a.bmp")));
}

TEST_F(FrameWriterTest, AFileInTheWayOfAFolderIsAnError) {
  std::ofstream(in("file")) << "x";
  EXPECT_FALSE(FrameWriter::open(in("file"), size, 25.0));
  EXPECT_FALSE(FrameWriter::open(in("file/below.png"), size, 25.0));
}

TEST_F(FrameWriterTest, AFolderOfThatNameIsTakenAsAFolder) {
  fs::create_directories(in("clip.mp4"));
  EXPECT_EQ(FrameWriter::kindOf(in("clip.mp4")).value(), FrameWriter::Kind::Folder);
}

TEST_F(FrameWriterTest, AProbeLeavesNoFileBehind) {
  auto writer = FrameWriter::open(in("unused"), size, 25.0);
  ASSERT_TRUE(writer);
  EXPECT_TRUE((*writer)->close());
  EXPECT_TRUE(fs::is_empty(in("unused")));
}

// What libavformat reads back from a video.
struct Video {
  int frames = 0;
  glm::ivec2 size{0};
  double fps = 0.0;
  double seconds = 0.0;
  std::string copyright;
};

Video readVideo(const fs::path& file) {
  Video video;
  AVFormatContext* format = nullptr;
  if (avformat_open_input(&format, file.c_str(), nullptr, nullptr) != 0 ||
      avformat_find_stream_info(format, nullptr) < 0) {
    ADD_FAILURE() << file << " is no video";
    return video;
  }
  const int index = av_find_best_stream(format, AVMEDIA_TYPE_VIDEO, -1, -1, nullptr, 0);
  AVStream* const stream = format->streams[index];
  const AVCodec* const decoder = avcodec_find_decoder(stream->codecpar->codec_id);
  AVCodecContext* codec = avcodec_alloc_context3(decoder);
  avcodec_parameters_to_context(codec, stream->codecpar);
  EXPECT_EQ(avcodec_open2(codec, decoder, nullptr), 0);
  video.size = {codec->width, codec->height};
  video.fps = av_q2d(stream->avg_frame_rate);
  video.seconds = static_cast<double>(format->duration) / AV_TIME_BASE;
  if (const AVDictionaryEntry* entry = av_dict_get(format->metadata, "copyright", nullptr, 0)) {
    video.copyright = entry->value;
  }
  AVPacket* packet = av_packet_alloc();
  AVFrame* frame = av_frame_alloc();
  const auto drain = [&] {
    while (avcodec_receive_frame(codec, frame) == 0) {
      ++video.frames;
    }
  };
  while (av_read_frame(format, packet) == 0) {
    avcodec_send_packet(codec, packet);
    av_packet_unref(packet);
    drain();
  }
  avcodec_send_packet(codec, nullptr);
  drain();
  av_frame_free(&frame);
  av_packet_free(&packet);
  avcodec_free_context(&codec);
  avformat_close_input(&format);
  return video;
}

class VideoTest : public FrameWriterTest, public ::testing::WithParamInterface<const char*> {};

TEST_P(VideoTest, HoldsEveryPictureAtItsRate) {
  writeThree(in(GetParam()));
  const Video video = readVideo(in(GetParam()));
  EXPECT_EQ(video.frames, 3);
  EXPECT_EQ(video.size, glm::ivec2(64, 32));
  EXPECT_NEAR(video.fps, 25.0, 0.01);
  EXPECT_NEAR(video.seconds, 3.0 / 25.0, 0.05);
}

TEST_P(VideoTest, NamesWhomItsPicturesAreToBeCreditedTo) {
  auto writer = FrameWriter::open(in(GetParam()), size, 25.0);
  ASSERT_TRUE(writer);
  using Credits = std::vector<std::string>;
  for (const Credits& credits : {Credits{"A \u00a9", "B"}, Credits{"A \u00a9", "B", "C"}, Credits{}, Credits{"C"}}) {
    ASSERT_TRUE((*writer)->write(picture(1, 2, 3), credits));
  }
  ASSERT_TRUE((*writer)->close());
  const Video video = readVideo(in(GetParam()));
  EXPECT_EQ(video.frames, 4);
  const bool knowsAtItsEnd = in(GetParam()).extension() == ".mp4" || in(GetParam()).extension() == ".mov";
  EXPECT_EQ(video.copyright, knowsAtItsEnd ? "A \u00a9 | B | C" : "A \u00a9 | B");
}

INSTANTIATE_TEST_SUITE_P(FrameWriter, VideoTest, ::testing::Values("a.mp4", "a.mkv", "a.mov", "a.webm"),
                         [](const auto& instance) { return std::string(instance.param).substr(2); });

TEST_F(FrameWriterTest, AFullDiskIsReportedForAVideo) {
  fs::create_symlink("/dev/full", in("full.mkv"));
  auto writer = FrameWriter::open(in("full.mkv"), size, 25.0);
  Result<void> result;
  if (writer) {
    for (int i = 0; i < 8 && result; ++i) {
      result = (*writer)->write(picture(static_cast<std::uint8_t>(30 * i), 0, 0), {});
    }
    if (result) {
      result = (*writer)->close();
    }
    EXPECT_FALSE(result);
    EXPECT_FALSE((*writer)->close()) << "the first error stays";
  }
}

TEST_F(FrameWriterTest, AFolderThatGoesAwayIsReported) {
  auto writer = FrameWriter::open(in("gone"), size, 25.0);
  ASSERT_TRUE(writer);
  fs::remove_all(in("gone"));
  Result<void> result;
  for (int i = 0; i < 64 && result; ++i) {
    result = (*writer)->write(picture(1, 2, 3), {});
  }
  if (result) {
    result = (*writer)->close();
  }
  ASSERT_FALSE(result);
  EXPECT_THAT(result.error().message(), HasSubstr("gone"));
}

TEST_F(FrameWriterTest, AVideoOfOnePixelIsRefused) {
  EXPECT_FALSE(FrameWriter::open(in("tiny.mp4"), {1, 1}, 25.0));
}

}  // namespace
}  // namespace meridian::app

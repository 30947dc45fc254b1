#include "host/app/video_encoder.h"

#include <array>
#include <cassert>
#include <set>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/opt.h>
#include <libswscale/swscale.h>
}

namespace meridian::app {
namespace {

template <auto Free>
struct Freed {
  template <class T>
  void operator()(T* object) const {
    Free(&object);
  }
};
struct FormatCloser {
  void operator()(AVFormatContext* format) const {
    if (format->pb != nullptr) {
      avio_closep(&format->pb);
    }
    avformat_free_context(format);
  }
};
struct ScalerFreer {
  void operator()(SwsContext* scaler) const { sws_freeContext(scaler); }
};

std::string describe(int code) {
  std::array<char, AV_ERROR_MAX_STRING_SIZE> text{};
  av_strerror(code, text.data(), text.size());
  return text.data();
}

/// The first of these that libavcodec was built with.
const AVCodec* findEncoder(const std::filesystem::path& file) {
  const bool webm = file.extension() == ".webm";
  const std::array<const char*, 2> names = webm ? std::array{"libvpx-vp9", "libvpx"} : std::array{"libx264", "mpeg4"};
  for (const char* name : names) {
    if (const AVCodec* codec = avcodec_find_encoder_by_name(name)) {
      return codec;
    }
  }
  return nullptr;
}

/// About what the eye calls lossless, at a speed that keeps up with drawing.
void setQuality(AVCodecContext& codec) {
  const std::string name = codec.codec->name;
  if (name == "libx264") {
    av_opt_set(codec.priv_data, "preset", "veryfast", 0);
    av_opt_set(codec.priv_data, "crf", "18", 0);
  } else if (name == "mpeg4") {
    codec.flags |= AV_CODEC_FLAG_QSCALE;
    codec.global_quality = 3 * FF_QP2LAMBDA;
  } else {
    av_opt_set(codec.priv_data, "deadline", "realtime", 0);
    av_opt_set(codec.priv_data, "cpu-used", "6", 0);
    av_opt_set(codec.priv_data, "crf", "24", 0);
    codec.bit_rate = static_cast<std::int64_t>(codec.width) * codec.height * 8;
  }
}

}  // namespace

struct VideoEncoder::Implementation {
  std::filesystem::path file;
  std::unique_ptr<AVFormatContext, FormatCloser> format;
  std::unique_ptr<AVCodecContext, Freed<avcodec_free_context>> codec;
  std::unique_ptr<AVFrame, Freed<av_frame_free>> frame;
  std::unique_ptr<AVPacket, Freed<av_packet_free>> packet;
  std::unique_ptr<SwsContext, ScalerFreer> scaler;
  AVStream* stream = nullptr;
  std::set<std::string> credits;  ///< of all pictures until now
  bool hasHeader = false;

  [[nodiscard]] tl::unexpected<Error> error(int code) const {
    return failure(fmt::format("the video cannot be written: {}", describe(code)), file.string(),
                   "check that the folder can be written and the disk has space left");
  }

  Result<void> openCodec(glm::ivec2 size, double fps) {
    const AVCodec* encoder = findEncoder(file);
    if (encoder == nullptr) {
      return failure("FFmpeg's libraries have no encoder for such a video", file.string(), "use another extension");
    }
    codec.reset(avcodec_alloc_context3(encoder));
    codec->width = size.x & ~1;
    codec->height = size.y & ~1;
    codec->pix_fmt = AV_PIX_FMT_YUV420P;
    codec->framerate = av_d2q(fps, 60000);  // MPEG-4 counts time in 16 bits
    codec->time_base = av_inv_q(codec->framerate);
    codec->gop_size = 60;
    codec->colorspace = AVCOL_SPC_BT709;
    codec->color_primaries = AVCOL_PRI_BT709;
    codec->color_trc = AVCOL_TRC_BT709;
    codec->color_range = AVCOL_RANGE_MPEG;
    if ((format->oformat->flags & AVFMT_GLOBALHEADER) != 0) {
      codec->flags |= AV_CODEC_FLAG_GLOBAL_HEADER;
    }
    setQuality(*codec);
    if (const int code = avcodec_open2(codec.get(), encoder, nullptr); code < 0) {
      return failure(fmt::format("the encoder {} does not take {}x{} pixels at {} frames a second: {}", encoder->name,
                                 size.x, size.y, fps, describe(code)),
                     file.string(), "choose another size, rate or extension");
    }
    return {};
  }

  Result<void> openFile() {
    stream = avformat_new_stream(format.get(), nullptr);
    stream->time_base = codec->time_base;
    stream->avg_frame_rate = codec->framerate;
    if (const int code = avcodec_parameters_from_context(stream->codecpar, codec.get()); code < 0) {
      return error(code);
    }
    if (const int code = avio_open(&format->pb, file.c_str(), AVIO_FLAG_WRITE); code < 0) {
      return error(code);
    }
    return {};
  }

  Result<void> writeHeader() {
    hasHeader = true;
    const int code = avformat_write_header(format.get(), nullptr);
    return code < 0 ? error(code) : Result<void>{};
  }

  void credit(std::span<const std::string> more) {
    const std::size_t before = credits.size();
    credits.insert(more.begin(), more.end());
    if (credits.size() > before) {
      const std::string all = fmt::format("{}", fmt::join(credits, " | "));
      av_dict_set(&format->metadata, "copyright", all.c_str(), 0);
    }
  }

  Result<void> openFrame() {
    frame.reset(av_frame_alloc());
    frame->format = codec->pix_fmt;
    frame->width = codec->width;
    frame->height = codec->height;
    frame->pts = 0;
    packet.reset(av_packet_alloc());
    if (const int code = av_frame_get_buffer(frame.get(), 0); code < 0) {
      return error(code);
    }
    scaler.reset(sws_getContext(codec->width, codec->height, AV_PIX_FMT_RGBA, codec->width, codec->height,
                                codec->pix_fmt, SWS_BICUBIC | SWS_ACCURATE_RND, nullptr, nullptr, nullptr));
    const int* coefficients = sws_getCoefficients(SWS_CS_ITU709);
    constexpr int one = 1 << 16;
    sws_setColorspaceDetails(scaler.get(), coefficients, 1, coefficients, 0, 0, one, one);
    return {};
  }

  /// Sends one picture, or nothing to flush, and writes whatever the encoder has finished.
  Result<void> encode(const AVFrame* picture) {
    if (const int code = avcodec_send_frame(codec.get(), picture); code < 0) {
      return error(code);
    }
    while (true) {
      const int received = avcodec_receive_packet(codec.get(), packet.get());
      if (received == AVERROR(EAGAIN) || received == AVERROR_EOF) {
        return {};
      }
      if (received < 0) {
        return error(received);
      }
      packet->duration = 1;
      av_packet_rescale_ts(packet.get(), codec->time_base, stream->time_base);
      packet->stream_index = stream->index;
      if (const int code = av_interleaved_write_frame(format.get(), packet.get()); code < 0) {
        return error(code);
      }
      // Writes are buffered: an earlier one may have failed since.
      if (format->pb->error < 0) {
        return error(format->pb->error);
      }
    }
  }
};

VideoEncoder::VideoEncoder(std::unique_ptr<Implementation> implementation)
    : implementation_(std::move(implementation)) {}
VideoEncoder::~VideoEncoder() = default;

Result<std::unique_ptr<VideoEncoder>> VideoEncoder::open(const std::filesystem::path& file, glm::ivec2 size,
                                                         double fps) {
  if (size.x < 2 || size.y < 2) {
    return failure("a video needs at least 2x2 pixels", file.string(), "choose a larger --size");
  }
  av_log_set_level(AV_LOG_ERROR);
  auto state = std::make_unique<Implementation>();
  state->file = file;
  AVFormatContext* format = nullptr;
  if (const int code = avformat_alloc_output_context2(&format, nullptr, nullptr, file.c_str()); code < 0) {
    return state->error(code);
  }
  state->format.reset(format);
  if (auto opened = state->openCodec(size, fps); !opened) {
    return tl::make_unexpected(opened.error());
  }
  if (auto opened = state->openFile(); !opened) {
    return tl::make_unexpected(opened.error());
  }
  if (auto opened = state->openFrame(); !opened) {
    return tl::make_unexpected(opened.error());
  }
  return std::unique_ptr<VideoEncoder>(new VideoEncoder(std::move(state)));
}

Result<void> VideoEncoder::add(const graphics::Image& picture, std::span<const std::string> credits) {
  Implementation& state = *implementation_;
  assert(picture.size.x >= state.codec->width && picture.size.y >= state.codec->height);
  state.credit(credits);
  if (!state.hasHeader) {
    if (auto written = state.writeHeader(); !written) {
      return written;
    }
  }
  // The encoder may still look at the last picture.
  if (const int code = av_frame_make_writable(state.frame.get()); code < 0) {
    return state.error(code);
  }
  const std::uint8_t* const rows[] = {picture.pixels.data()};
  const int strides[] = {4 * picture.size.x};
  sws_scale(state.scaler.get(), rows, strides, 0, state.codec->height, state.frame->data, state.frame->linesize);
  auto encoded = state.encode(state.frame.get());
  ++state.frame->pts;
  return encoded;
}

Result<void> VideoEncoder::finish() {
  Implementation& state = *implementation_;
  if (!state.hasHeader) {
    if (auto written = state.writeHeader(); !written) {
      return written;
    }
  }
  if (auto flushed = state.encode(nullptr); !flushed) {
    return flushed;
  }
  if (const int code = av_write_trailer(state.format.get()); code < 0) {
    return state.error(code);
  }
  avio_flush(state.format->pb);
  const int written = state.format->pb->error;
  const int closed = avio_closep(&state.format->pb);
  if (written < 0 || closed < 0) {
    return state.error(written < 0 ? written : closed);
  }
  return {};
}

}  // namespace meridian::app

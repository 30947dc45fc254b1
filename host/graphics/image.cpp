#include "host/graphics/image.h"

#include <algorithm>
#include <csetjmp>
#include <cstdio>
#include <cstring>
#include <memory>
#include <system_error>

#include <fmt/format.h>
#include <png.h>

namespace meridian::graphics {

namespace {

constexpr png_uint_32 longestSide = 16384;

struct FileCloser {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, FileCloser>;

/// libpng leaves by longjmp: nothing with a destructor may be made between setjmp and the last call of libpng, so what
/// the calls need is prepared before and kept here.
struct Message {
  char text[160] = {};
};

void keepMessage(png_structp png, png_const_charp text) {
  auto* message = static_cast<Message*>(png_get_error_ptr(png));
  std::strncpy(message->text, text, sizeof(message->text) - 1);
  longjmp(*png_set_longjmp_fn(png, longjmp, sizeof(jmp_buf)), 1);
}

void ignoreWarning(png_structp /*png*/, png_const_charp /*text*/) {}

struct Writer {
  Message message;
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &message, keepMessage, ignoreWarning);
  png_infop info = png != nullptr ? png_create_info_struct(png) : nullptr;
  Writer() = default;
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;
  ~Writer() { png_destroy_write_struct(&png, &info); }
};

struct Reader {
  Message message;
  png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &message, keepMessage, ignoreWarning);
  png_infop info = png != nullptr ? png_create_info_struct(png) : nullptr;
  Reader() = default;
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;
  ~Reader() { png_destroy_read_struct(&png, &info, nullptr); }
};

struct WriteJob {
  std::FILE* file;
  png_uint_32 width;
  png_uint_32 height;
  bool alpha;
  int compression;
  png_bytepp rows;
  png_textp texts;
  int textCount;
};

bool writeRows(Writer& writer, const WriteJob& job) {
  if (setjmp(png_jmpbuf(writer.png)) != 0) {
    return false;
  }
  png_init_io(writer.png, job.file);
  png_set_user_limits(writer.png, longestSide, longestSide);
  png_set_compression_level(writer.png, job.compression);
  png_set_filter(writer.png, PNG_FILTER_TYPE_BASE, PNG_FILTER_SUB);
  png_set_IHDR(writer.png, writer.info, job.width, job.height, 8,
               job.alpha ? PNG_COLOR_TYPE_RGB_ALPHA : PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_BASE,
               PNG_FILTER_TYPE_BASE);
  png_set_text(writer.png, writer.info, job.texts, job.textCount);
  png_write_info(writer.png, writer.info);
  if (!job.alpha) {
    png_set_filler(writer.png, 0, PNG_FILLER_AFTER);
  }
  png_write_image(writer.png, job.rows);
  png_write_end(writer.png, nullptr);
  return true;
}

bool readHeader(Reader& reader, std::FILE* file) {
  if (setjmp(png_jmpbuf(reader.png)) != 0) {
    return false;
  }
  png_init_io(reader.png, file);
  png_set_user_limits(reader.png, longestSide, longestSide);
  png_read_info(reader.png, reader.info);
  png_set_expand(reader.png);
  png_set_strip_16(reader.png);
  png_set_gray_to_rgb(reader.png);
  png_set_add_alpha(reader.png, 0xff, PNG_FILLER_AFTER);
  png_set_interlace_handling(reader.png);
  png_read_update_info(reader.png, reader.info);
  return true;
}

bool readRows(Reader& reader, png_bytepp rows) {
  if (setjmp(png_jmpbuf(reader.png)) != 0) {
    return false;
  }
  png_read_image(reader.png, rows);
  png_read_end(reader.png, reader.info);
  return true;
}

std::string systemError() {
  return std::generic_category().message(errno);
}

Result<void> writeTo(const std::filesystem::path& file, const WriteJob& shape) {
  File stream(std::fopen(file.c_str(), "wb"));
  if (!stream) {
    return failure(fmt::format("the picture cannot be written ({})", systemError()), file.string(),
                   "choose a folder that is there and can be written");
  }
  Writer writer;
  if (writer.info == nullptr) {
    return failure("libpng cannot be used here", file.string());
  }
  WriteJob job = shape;
  job.file = stream.get();
  if (!writeRows(writer, job)) {
    return failure(fmt::format("the picture cannot be written ({})", writer.message.text), file.string());
  }
  if (std::fclose(stream.release()) != 0) {
    return failure(fmt::format("the picture cannot be written ({})", systemError()), file.string(),
                   "make room on the disk");
  }
  return {};
}

}  // namespace

Result<void> writePng(const std::filesystem::path& file, std::span<const std::uint8_t> pixels, glm::ivec2 size,
                      const PngOptions& options) {
  const auto limit = static_cast<int>(longestSide);
  if (size.x < 1 || size.y < 1 || size.x > limit || size.y > limit ||
      pixels.size() != static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y) * 4) {
    return failure(fmt::format("{} bytes are no picture of {} x {} pixels (1 to {} along a side)", pixels.size(),
                               size.x, size.y, limit),
                   file.string());
  }
  const auto stride = static_cast<std::size_t>(size.x) * 4;
  std::vector<png_bytep> rows;
  for (std::size_t row = 0; row < static_cast<std::size_t>(size.y); ++row) {
    rows.push_back(const_cast<png_bytep>(pixels.data() + row * stride));  // libpng only reads them
  }
  ImageMetadata metadata = options.metadata;
  std::vector<png_text> texts;
  for (auto& [key, value] : metadata) {
    png_text text{};
    const bool isAscii =
        std::all_of(value.begin(), value.end(), [](char c) { return static_cast<signed char>(c) > 0; });
    text.compression = isAscii ? PNG_TEXT_COMPRESSION_NONE : PNG_ITXT_COMPRESSION_NONE;
    text.key = const_cast<png_charp>(key.c_str());
    text.text = value.data();
    (isAscii ? text.text_length : text.itxt_length) = value.size();
    texts.push_back(text);
  }
  const std::filesystem::path part = file.string() + ".part";
  WriteJob job{};
  job.width = static_cast<png_uint_32>(size.x);
  job.height = static_cast<png_uint_32>(size.y);
  job.alpha = options.alpha;
  job.compression = std::clamp(options.compression, 0, 9);
  job.rows = rows.data();
  job.texts = texts.data();
  job.textCount = static_cast<int>(texts.size());
  std::error_code error;
  auto written = writeTo(part, job);
  if (!written) {
    written.error().where = file.string();
    std::filesystem::remove(part, error);
    return written;
  }
  std::filesystem::rename(part, file, error);
  if (error) {
    const std::string reason = error.message();
    std::filesystem::remove(part, error);
    return failure(fmt::format("the picture cannot be written ({})", reason), file.string());
  }
  return {};
}

Result<Image> readPng(const std::filesystem::path& file) {
  const File stream(std::fopen(file.c_str(), "rb"));
  if (!stream) {
    return failure(fmt::format("the picture cannot be read ({})", systemError()), file.string());
  }
  Reader reader;
  if (reader.info == nullptr) {
    return failure("libpng cannot be used here", file.string());
  }
  if (!readHeader(reader, stream.get())) {
    return failure(fmt::format("it is no PNG that can be read ({})", reader.message.text), file.string());
  }
  Image image;
  image.size = glm::ivec2(png_get_image_width(reader.png, reader.info), png_get_image_height(reader.png, reader.info));
  const auto stride = static_cast<std::size_t>(image.size.x) * 4;
  if (png_get_rowbytes(reader.png, reader.info) != stride) {
    return failure("its pixels cannot be made RGBA", file.string());
  }
  image.pixels.resize(stride * static_cast<std::size_t>(image.size.y));
  std::vector<png_bytep> rows;
  for (std::size_t row = 0; row < static_cast<std::size_t>(image.size.y); ++row) {
    rows.push_back(image.pixels.data() + row * stride);
  }
  if (!readRows(reader, rows.data())) {
    return failure(fmt::format("the picture is damaged ({})", reader.message.text), file.string());
  }
  png_textp texts = nullptr;
  const int count = png_get_text(reader.png, reader.info, &texts, nullptr);
  for (int index = 0; index < count; ++index) {
    const png_text& text = texts[index];
    image.metadata[text.key] =
        std::string(text.text, text.compression >= PNG_ITXT_COMPRESSION_NONE ? text.itxt_length : text.text_length);
  }
  return image;
}

}  // namespace meridian::graphics

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "host/recording/formats.h"

namespace meridian::recording {

namespace {

static_assert(std::endian::native == std::endian::little, "the file's numbers are little-endian");

/// No name and no script is as long as this; a longer one means that the file is damaged.
constexpr std::uint32_t longestText = 64U << 20U;

/// Packed numbers, one after the other; once the file has ended everything is zero and `ended` is true.
class Bytes {
 public:
  explicit Bytes(std::string_view content) : content_(content) {}

  template <class Number>
  Number take() {
    Number number{};
    if (content_.size() - position_ < sizeof(Number)) {
      ended_ = true;
      position_ = content_.size();
      return number;
    }
    std::memcpy(&number, content_.data() + position_, sizeof(Number));
    position_ += sizeof(Number);
    return number;
  }

  std::string text(std::uint32_t length) {
    if (length > longestText || content_.size() - position_ < length) {
      ended_ = true;
      position_ = content_.size();
      return {};
    }
    position_ += length;
    return std::string(content_.substr(position_ - length, length));
  }

  [[nodiscard]] bool atEnd() const { return position_ == content_.size(); }
  [[nodiscard]] bool ended() const { return ended_; }
  [[nodiscard]] std::size_t position() const { return position_; }

 private:
  std::string_view content_;
  std::size_t position_ = 0;
  bool ended_ = false;
};

CameraEntry readCamera(Bytes& bytes, int version) {
  CameraEntry entry;
  if (version < 2) {
    static_cast<void>(bytes.take<double>());  // the application's time
  }
  entry.timestamp = bytes.take<double>();
  entry.simulationTime = Time(bytes.take<double>());
  entry.position.x = bytes.take<double>();
  entry.position.y = bytes.take<double>();
  entry.position.z = bytes.take<double>();
  const auto part = [&] { return version < 2 ? bytes.take<double>() : static_cast<double>(bytes.take<float>()); };
  if (version >= 3) {
    entry.rotation.w = part();
  }
  entry.rotation.x = part();
  entry.rotation.y = part();
  entry.rotation.z = part();
  if (version < 3) {
    entry.rotation.w = part();
  }
  entry.followsRotation = bytes.take<char>() != 0;
  entry.node = bytes.text(static_cast<std::uint32_t>(bytes.take<std::int32_t>()));
  entry.scale = static_cast<double>(bytes.take<float>());
  if (version < 2) {
    static_cast<void>(bytes.take<double>());  // the time stamp again
  }
  return entry;
}

ScriptEntry readScript(Bytes& bytes, int version) {
  ScriptEntry entry;
  if (version < 2) {
    static_cast<void>(bytes.take<double>());
  }
  entry.timestamp = bytes.take<double>();
  entry.simulationTime = Time(bytes.take<double>());
  entry.text = bytes.text(bytes.take<std::uint32_t>());
  return entry;
}

}  // namespace

Result<SessionRecording> parseBinaryBody(std::string_view body, int version, std::string_view where) {
  SessionRecording recording;
  Bytes bytes(body);
  double last = 0.0;
  while (!bytes.atEnd()) {
    const std::string place = std::string(where) + ": byte " + std::to_string(bytes.position()) + " after the header";
    const auto damaged = [&](const std::string& what) {
      return failure(what, place, "record the session again, or copy the file again");
    };
    const char kind = bytes.take<char>();
    double timestamp = 0.0;
    if (kind == 'c') {
      CameraEntry entry = readCamera(bytes, version);
      if (!bytes.ended()) {
        if (const auto valid = checkCamera(entry); !valid) {
          return damaged(valid.error().what);
        }
        if (entry.node.empty()) {
          return damaged("expected the identifier of a node, found none");
        }
      }
      timestamp = entry.timestamp;
      recording.entries.emplace_back(std::move(entry));
    } else if (kind == 's') {
      ScriptEntry entry = readScript(bytes, version);
      timestamp = entry.timestamp;
      recording.entries.emplace_back(std::move(entry));
    } else {
      return damaged("expected a frame of type 'c' or 's', found byte " +
                     std::to_string(static_cast<unsigned char>(kind)));
    }
    if (bytes.ended()) {
      return damaged("the file ends within an entry");
    }
    if (!(timestamp >= last) || !std::isfinite(timestamp)) {
      return damaged("the time stamps do not ascend");
    }
    last = timestamp;
  }
  return recording;
}

}  // namespace meridian::recording

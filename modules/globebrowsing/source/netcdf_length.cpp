#include "globebrowsing/source/netcdf_length.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <limits>
#include <string_view>
#include <vector>

namespace meridian::globebrowsing {

namespace {

/// A header after "The NetCDF Classic Format Specification": numbers are big-endian; counts are of 4 bytes, in CDF-5 of
/// 8; offsets of 4, from CDF-2 on of 8; names and values are padded to 4 bytes.
class Header {
 public:
  explicit Header(const std::filesystem::path& file) : stream_(file, std::ios::binary) {}

  std::optional<std::uint64_t> length() {
    std::array<char, 4> magic{};
    stream_.read(magic.data(), magic.size());
    version_ = static_cast<unsigned char>(magic[3]);
    if (std::string_view(magic.data(), 3) != "CDF" || (version_ != 1 && version_ != 2 && version_ != 5)) {
      return std::nullopt;
    }
    // While a file is written the number of records may be left open: all bits set.
    const std::uint64_t records = count();
    const bool isOpen = records == (version_ == 5 ? std::numeric_limits<std::uint64_t>::max()
                                                  : std::numeric_limits<std::uint32_t>::max());
    readDimensions();
    skipAttributes();
    readVariables();
    return stream_ ? end(isOpen ? 0 : records) : std::nullopt;
  }

 private:
  struct Variable {
    std::uint64_t begin = 0;
    double bytes = 0.0;  ///< of a record, where it has records
    bool hasRecords = false;
  };

  static constexpr std::uint64_t most = 1U << 20U;  ///< of anything in a header; more is damage

  std::uint64_t number(int bytes) {
    std::uint64_t value = 0;
    for (int i = 0; i < bytes; ++i) {
      value = value << 8U | static_cast<std::uint64_t>(stream_.get() & 0xff);
    }
    return value;
  }
  std::uint64_t count() { return number(version_ == 5 ? 8 : 4); }
  /// How many elements a list has; 0 after damage, so that loops end.
  std::uint64_t listCount() {
    number(4);  // its tag
    return limited(count());
  }
  std::uint64_t limited(std::uint64_t value) {
    if (value > most) {
      stream_.setstate(std::ios::failbit);
    }
    return stream_ ? value : 0;
  }
  void skip(std::uint64_t bytes) {
    // Reading notices the end, which seeking does not.
    stream_.ignore(static_cast<std::streamsize>((limited(bytes) + 3) / 4 * 4));
  }
  void skipName() { skip(count()); }

  /// 0 for a type that is none.
  static std::uint64_t bytesOf(std::uint64_t type) {
    constexpr std::array<std::uint64_t, 12> bytes{0, 1, 1, 2, 4, 4, 8, 1, 2, 4, 8, 8};
    return type < bytes.size() ? bytes[type] : 0;
  }

  void readDimensions() {
    const std::uint64_t dimensions = listCount();
    for (std::uint64_t i = 0; i < dimensions && stream_; ++i) {
      skipName();
      dimensions_.push_back(count());
    }
  }
  void skipAttributes() {
    const std::uint64_t attributes = listCount();
    for (std::uint64_t i = 0; i < attributes && stream_; ++i) {
      skipName();
      const std::uint64_t bytes = bytesOf(number(4));
      skip(bytes * limited(count()));
    }
  }
  void readVariables() {
    const std::uint64_t variables = listCount();
    for (std::uint64_t i = 0; i < variables && stream_; ++i) {
      skipName();
      Variable variable;
      std::vector<std::uint64_t> lengths;
      const std::uint64_t dimensions = limited(count());
      for (std::uint64_t d = 0; d < dimensions && stream_; ++d) {
        const std::uint64_t which = count();
        lengths.push_back(which < dimensions_.size() ? dimensions_[which] : 0);
      }
      skipAttributes();
      variable.bytes = static_cast<double>(bytesOf(number(4)));
      count();  // its size, which is wrong for large ones
      variable.begin = number(version_ == 1 ? 4 : 8);
      variable.hasRecords = !lengths.empty() && lengths.front() == 0;
      for (std::size_t d = variable.hasRecords ? 1 : 0; d < lengths.size(); ++d) {
        variable.bytes *= static_cast<double>(lengths[d]);
      }
      variables_.push_back(variable);
    }
  }

  /// The records of all variables lie side by side, each padded unless there is one variable alone.
  [[nodiscard]] std::optional<std::uint64_t> end(std::uint64_t records) const {
    const auto padded = [](double bytes) { return 4.0 * std::ceil(bytes / 4.0); };
    double record = 0.0;
    std::size_t withRecords = 0;
    double alone = 0.0;
    for (const Variable& variable : variables_) {
      if (variable.hasRecords) {
        record += padded(variable.bytes);
        alone = variable.bytes;
        ++withRecords;
      }
    }
    record = withRecords == 1 ? alone : record;
    double length = 0.0;
    for (const Variable& variable : variables_) {
      const bool isEmpty = variable.hasRecords && records == 0;
      const double before = variable.hasRecords ? record * (static_cast<double>(records) - 1.0) : 0.0;
      const double end = static_cast<double>(variable.begin) + before + variable.bytes;
      length = isEmpty ? length : std::max(length, end);
    }
    constexpr double absurd = 1e18;
    return length < absurd ? std::optional(static_cast<std::uint64_t>(length)) : std::nullopt;
  }

  std::ifstream stream_;
  int version_ = 0;
  std::vector<std::uint64_t> dimensions_;
  std::vector<Variable> variables_;
};

}  // namespace

std::optional<std::uint64_t> classicNetcdfLength(const std::filesystem::path& file) {
  return Header(file).length();
}

}  // namespace meridian::globebrowsing

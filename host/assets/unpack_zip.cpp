#include "host/assets/unpack_zip.h"

#include <array>
#include <cstdint>
#include <fstream>
#include <memory>
#include <string>

#include <cpl_error.h>
#include <cpl_string.h>
#include <cpl_vsi.h>
#include <fmt/format.h>

#include "host/assets/path_tokens.h"

namespace meridian::assets {

namespace fs = std::filesystem;

namespace {

constexpr int mostEntries = 100'000;
constexpr std::uint64_t mostBytes = std::uint64_t{16} << 30;

struct CloseFile {
  void operator()(VSILFILE* file) const { VSIFCloseL(file); }
};

Result<void> unpackFile(const std::string& source, const fs::path& target, std::uint64_t& bytesLeft) {
  const std::unique_ptr<VSILFILE, CloseFile> in(VSIFOpenL(source.c_str(), "rb"));
  std::error_code ignored;
  fs::create_directories(target.parent_path(), ignored);
  std::ofstream out(target, std::ios::binary | std::ios::trunc);
  if (!in || !out) {
    return failure(in ? "the file cannot be written" : "the archive's entry cannot be read", target.string());
  }
  std::array<char, 1 << 16> buffer{};
  while (const std::size_t count = VSIFReadL(buffer.data(), 1, buffer.size(), in.get())) {
    if (count > bytesLeft) {
      return failure(fmt::format("the archive holds more than {} GiB", mostBytes >> 30), source);
    }
    bytesLeft -= count;
    out.write(buffer.data(), static_cast<std::streamsize>(count));
  }
  if (!out.flush()) {
    return failure("the file cannot be written", target.string());
  }
  return {};
}

/// Keeps GDAL from printing what is returned as an error.
class Quiet {
 public:
  Quiet() { CPLPushErrorHandler(CPLQuietErrorHandler); }
  ~Quiet() { CPLPopErrorHandler(); }
  Quiet(const Quiet&) = delete;
  Quiet& operator=(const Quiet&) = delete;
};

}  // namespace

Result<void> unpackZip(const fs::path& archive, const fs::path& folder) {
  const Quiet quiet;
  // In braces the archive's own name does not matter.
  const std::string inside = "/vsizip/{" + archive.string() + "}";
  const CPLStringList entries(VSIReadDirRecursive(inside.c_str()));
  if (entries.List() == nullptr) {
    return failure("this is no ZIP archive", archive.string(), "fetch it again");
  }
  if (entries.size() > mostEntries) {
    return failure(fmt::format("the archive holds more than {} entries", mostEntries), archive.string());
  }
  std::uint64_t bytesLeft = mostBytes;
  for (int i = 0; i < entries.size(); ++i) {
    const fs::path name = fs::path(entries[i]).lexically_normal();
    const fs::path target = (folder / name).lexically_normal();
    if (name.is_absolute() || !isBelow(target, folder)) {
      return failure(fmt::format("the archive's entry \"{}\" leads out of its folder", entries[i]), archive.string());
    }
    std::error_code error;
    if (std::string_view(entries[i]).ends_with('/')) {
      fs::create_directories(target, error);
      continue;
    }
    if (auto done = unpackFile(inside + '/' + entries[i], target, bytesLeft); !done) {
      return done;
    }
  }
  return {};
}

}  // namespace meridian::assets

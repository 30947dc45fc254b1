#include "host/api/regular_file.h"

#include <fstream>
#include <iterator>
#include <system_error>

#include <fmt/format.h>

namespace meridian {

namespace {

tl::unexpected<Error> refused(const std::filesystem::path& file, const std::string& thing, const std::string& why,
                              const std::string& remedy) {
  return failure(fmt::format("{} cannot be read: {}", thing, why), file.string(), remedy);
}

}  // namespace

Result<void> requireRegularFile(const std::filesystem::path& file, const std::string& thing,
                                const std::string& remedy) {
  std::error_code ignored;
  const std::filesystem::file_status status = std::filesystem::status(file, ignored);
  if (std::filesystem::is_regular_file(status)) {
    return {};
  }
  return refused(file, thing,
                 std::filesystem::is_directory(status) ? "it is a folder"
                 : std::filesystem::exists(status)     ? "it is not a regular file"
                                                       : "there is no such file",
                 remedy);
}

Result<std::string> readRegularFile(const std::filesystem::path& file, std::uintmax_t mostBytes,
                                    const std::string& thing, const std::string& remedy) {
  if (auto regular = requireRegularFile(file, thing, remedy); !regular) {
    return tl::make_unexpected(std::move(regular.error()));
  }
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(file, error);
  if (!error && size > mostBytes) {
    return refused(file, thing, fmt::format("it is larger than {} MiB", mostBytes >> 20U), remedy);
  }
  std::ifstream stream(file, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(stream), {}};
  if (error || !stream) {
    return refused(file, thing, "it cannot be opened", "check its permissions");
  }
  return text;
}

}  // namespace meridian

#include "globebrowsing/source/document_file.h"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <system_error>

#include "host/api/regular_file.h"

namespace meridian::globebrowsing {

Result<Fetched> readDocumentFile(const std::string& path) {
  std::error_code code;
  const bool isRegular = std::filesystem::is_regular_file(path, code);
  const auto size = isRegular ? std::filesystem::file_size(path, code) : 0;
  std::ifstream file;
  if (isRegular && !code) {  // a pipe would wait for its other end
    file.open(path, std::ios::binary);
  }
  if (!file.is_open() || size > largestDocument) {
    return failure("the description of the service cannot be read from that file", path,
                   "check the path and the permissions; at most 64 MiB are read");
  }
  Fetched fetched;
  fetched.body = std::make_shared<const std::vector<std::uint8_t>>(std::istreambuf_iterator<char>(file),
                                                                   std::istreambuf_iterator<char>());
  return fetched;
}

Result<std::string> readTextFile(const std::string& path, std::size_t mostBytes, const std::string& where,
                                 const std::string& remedy) {
  if (auto regular = requireRegularFile(path, "the file", "check the path"); !regular) {
    return tl::make_unexpected(std::move(regular.error()));
  }
  std::ifstream file(path, std::ios::binary);
  std::string text(mostBytes + 1, '\0');
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(file.gcount()));
  if (file.bad() || (text.empty() && !file.eof())) {
    return failure("the file " + path + " cannot be read", where, "check its permissions");
  }
  if (text.size() > mostBytes) {
    return failure("the file " + path + " is longer than " + std::to_string(mostBytes) + " bytes", where, remedy);
  }
  return text;
}

}  // namespace meridian::globebrowsing

#include "globebrowsing/source/document_file.h"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <system_error>

namespace meridian::globebrowsing {

Result<Fetched> readDocumentFile(const std::string& path) {
  std::error_code code;
  const auto size = std::filesystem::file_size(path, code);
  std::ifstream file(path, std::ios::binary);
  if (code || !file || size > largestDocument) {
    return failure("the description of the service cannot be read from that file", path,
                   "check the path and the permissions; at most 64 MiB are read");
  }
  Fetched fetched;
  fetched.body = std::make_shared<const std::vector<std::uint8_t>>(std::istreambuf_iterator<char>(file),
                                                                   std::istreambuf_iterator<char>());
  return fetched;
}

}  // namespace meridian::globebrowsing

#include "host/recording/move_file.h"

#include <string>
#include <system_error>

namespace meridian::recording {

namespace fs = std::filesystem;

Result<void> moveFile(const fs::path& from, const fs::path& to) {
  std::error_code error;
  fs::rename(from, to, error);
  if (!error) {
    return {};
  }
  // On another file system, which may be full: a part of a copy must not take the place of anything.
  fs::path part = to;
  part += ".part";
  fs::copy_file(from, part, fs::copy_options::overwrite_existing, error);
  if (!error) {
    fs::rename(part, to, error);
  }
  std::error_code ignored;
  if (error) {
    fs::remove(part, ignored);
    return failure("the recording cannot be put there: " + error.message(), to.string(),
                   "it is still in " + from.string() + ": move it from there before another one is recorded");
  }
  fs::remove(from, ignored);
  return {};
}

}  // namespace meridian::recording

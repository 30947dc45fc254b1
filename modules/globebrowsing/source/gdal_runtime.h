#pragma once

#include <string>

#include "host/api/error.h"

namespace meridian::globebrowsing {

/// Registers GDAL's drivers, sets its cache to 64 MiB and has damage in JPEG data reported as errors, once per process.
/// Safe from any thread.
void initializeGdal();

/// While it lives, what GDAL and PROJ say on this thread is kept instead of printed. Use as a local variable.
class GdalMessages {
 public:
  GdalMessages();
  ~GdalMessages();
  GdalMessages(const GdalMessages&) = delete;
  GdalMessages& operator=(const GdalMessages&) = delete;

  /// The first error said (the first warning, when there was no error); empty without any.
  [[nodiscard]] const std::string& first() const { return error_.empty() ? warning_ : error_; }
  [[nodiscard]] bool hasError() const { return !error_.empty(); }
  /// The first warning; empty without any.
  [[nodiscard]] const std::string& warning() const { return warning_; }
  /// "WHAT (as GDAL says: ...)".
  [[nodiscard]] tl::unexpected<Error> failure(const std::string& what, const std::string& where,
                                              const std::string& remedy = {}) const;
  void keep(bool isError, const char* text);

 private:
  std::string error_;
  std::string warning_;
};

}  // namespace meridian::globebrowsing

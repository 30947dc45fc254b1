#include "globebrowsing/source/gdal_runtime.h"

#include <mutex>

#include <cpl_conv.h>
#include <cpl_error.h>
#include <gdal_priv.h>

namespace meridian::globebrowsing {

namespace {

/// The user's word, in the environment or a configuration file of GDAL's, goes first.
void setUnlessSet(const char* key, const char* value) {
  if (CPLGetConfigOption(key, nullptr) == nullptr) {
    CPLSetConfigOption(key, value);
  }
}

}  // namespace

void initializeGdal() {
  static std::once_flag once;
  std::call_once(once, [] {
    GDALAllRegister();
    GDALSetCacheMax64(std::int64_t{64} << 20U);
    // A picture that was cut short is an error and not grey where it ends.
    setUnlessSet("GDAL_ERROR_ON_LIBJPEG_WARNING", "YES");
  });
}

namespace {

void CPL_STDCALL keepMessage(CPLErr level, CPLErrorNum /*number*/, const char* text) {
  auto* messages = static_cast<GdalMessages*>(CPLGetErrorHandlerUserData());
  if (level == CE_Warning || level == CE_Failure || level == CE_Fatal) {
    messages->keep(level != CE_Warning, text);
  }
}

}  // namespace

GdalMessages::GdalMessages() {
  CPLPushErrorHandlerEx(keepMessage, this);
}

GdalMessages::~GdalMessages() {
  CPLPopErrorHandler();
}

void GdalMessages::keep(bool isError, const char* text) {
  std::string& kept = isError ? error_ : warning_;
  if (kept.empty() && text != nullptr) {
    kept = text;
  }
}

tl::unexpected<Error> GdalMessages::failure(const std::string& what, const std::string& where,
                                            const std::string& remedy) const {
  return meridian::failure(first().empty() ? what : what + " (GDAL: " + first() + ")", where, remedy);
}

}  // namespace meridian::globebrowsing

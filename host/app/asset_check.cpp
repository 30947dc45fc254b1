#include "host/app/asset_check.h"

#include <filesystem>
#include <set>

#include <fmt/format.h>

#include "host/api/log.h"
#include "host/assets/validate.h"

namespace meridian::app {
namespace {

/// Logs each error once: a failed asset's error is also that of the assets that need it.
class ErrorLog {
 public:
  void add(const Error& error) {
    const std::string message = error.message();
    if (told_.insert(message).second) {
      log::error("{}", message);
    }
  }

 private:
  std::set<std::string> told_;
};

}  // namespace

std::string AssetCheck::line() const {
  return fmt::format("assets {} ok {} failed; globes {}; layers {} usable {}", good, failed, counts.globes,
                     counts.layers, counts.usableLayers);
}

AssetCheck checkAssets(Application& application, const std::vector<std::string>& filesAndFolders) {
  AssetCheck check;
  ErrorLog errors;
  std::vector<std::filesystem::path> files;
  for (const std::string& path : filesAndFolders) {
    const auto found = assets::findAssets(path);
    if (!found) {
      errors.add(found.error());
      ++check.failed;
      continue;
    }
    files.insert(files.end(), found->begin(), found->end());
  }
  for (const assets::AssetReport& report : assets::validate(application.assetLoader(), files)) {
    report.ok ? ++check.good : ++check.failed;
    for (const Error& error : report.errors) {
      errors.add(error);
    }
  }
  check.counts = application.counts();
  for (const Error& unusable : check.counts.unusable) {
    log::warning("not usable: {}", unusable.message());
  }
  return check;
}

std::size_t loadAssets(Application& application, const std::vector<std::string>& files) {
  std::size_t failed = 0;
  ErrorLog errors;
  std::vector<Error> ofRoots;
  for (const std::string& file : files) {
    if (const auto loaded = application.load(file); !loaded) {
      ++failed;
      ofRoots.push_back(loaded.error());
    }
  }
  for (const assets::AssetReport& report : application.assetLoader().reports()) {
    for (const Error& error : report.errors) {
      errors.add(error);
    }
  }
  for (const Error& error : ofRoots) {
    errors.add(error);
  }
  return failed;
}

}  // namespace meridian::app

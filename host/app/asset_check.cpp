#include "host/app/asset_check.h"

#include <algorithm>
#include <filesystem>
#include <optional>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "host/api/log.h"
#include "host/app/profile_start.h"
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

/// Adds what the scene's renderables hold, unless more of it is known already.
void collectParts(Application& application, AssetCheck& check) {
  for (const auto& node : application.scene().nodes()) {
    if (node->renderable() == nullptr) {
      continue;
    }
    AssetCheck::Part part{node->identifier(), node->renderable()->contents()};
    const auto known = std::find_if(check.parts.begin(), check.parts.end(),
                                    [&](const AssetCheck::Part& each) { return each.node == part.node; });
    if (known == check.parts.end()) {
      check.parts.push_back(std::move(part));
    } else if (known->contents.layers.size() < part.contents.layers.size()) {
      *known = std::move(part);
    }
  }
}

/// Two assets of a folder may add nodes of one name, though nobody would load both.
bool loadsAlone(Application& application, const assets::AssetReport& report) {
  application.unload();
  return application.assetLoader().add(report.file.string()).has_value();
}

/// Nothing when it has errors; they are logged.
std::optional<assets::Profile> readProfile(const std::string& file, ErrorLog& errors) {
  auto profile = assets::readProfile(file);
  if (!profile) {
    for (const Error& error : profile.error()) {
      errors.add(error);
    }
    return std::nullopt;
  }
  return std::move(*profile);
}

}  // namespace

void AssetCheck::report() const {
  for (const auto& file : loaded) {
    log::info("ok {}", file.string());
  }
  for (const Error& error : unavailable) {
    log::warning("not available: {}", error.message());
  }
  for (const auto& [node, contents] : parts) {
    if (contents.globes == 0 && contents.layers.empty()) {
      continue;
    }
    const auto usable = std::count_if(contents.layers.begin(), contents.layers.end(),
                                      [](const auto& layer) { return !layer.unusable; });
    log::info("globe {}: layers {} usable {}", node, contents.layers.size(), usable);
    for (const auto& layer : contents.layers) {
      if (layer.unusable) {
        log::warning("{} {} is not usable: {}", node, layer.name, layer.unusable->message());
      } else {
        log::info("{} {} is usable", node, layer.name);
      }
    }
    for (const Error& note : contents.notes) {
      log::info("note: {}", note.message());
    }
  }
}

std::string AssetCheck::line() const {
  std::size_t globes = 0;
  std::size_t layers = 0;
  std::size_t usable = 0;
  for (const Part& part : parts) {
    globes += part.contents.globes;
    layers += part.contents.layers.size();
    for (const auto& layer : part.contents.layers) {
      usable += layer.unusable ? 0 : 1;
    }
  }
  return fmt::format("assets {} ok {} failed; globes {}; layers {} usable {}", good, failed, globes, layers, usable);
}

AssetCheck checkAssets(Application& application, const std::vector<std::string>& filesAndFolders) {
  AssetCheck check;
  ErrorLog errors;
  std::vector<std::filesystem::path> files;
  for (const std::string& path : filesAndFolders) {
    if (assets::isProfile(path)) {
      const auto profile = readProfile(path, errors);
      check.failed += profile ? 0 : 1;
      for (const std::string& asset : profile ? profile->assets : std::vector<std::string>()) {
        files.emplace_back(assetOfProfile(asset));
      }
      continue;
    }
    const auto found = assets::findAssets(path);
    if (!found) {
      errors.add(found.error());
      ++check.failed;
      continue;
    }
    files.insert(files.end(), found->begin(), found->end());
  }
  const std::vector<assets::AssetReport> reports = assets::validate(application.assetLoader(), files);
  collectParts(application, check);
  for (const assets::AssetReport& report : reports) {
    if (report.ok) {
      check.loaded.push_back(report.file);
    } else if (!report.available) {
      check.unavailable.push_back(report.errors.front());
    } else if (loadsAlone(application, report)) {
      collectParts(application, check);
      check.loaded.push_back(report.file);
      log::info("{} loads alone, but not beside the others: {}", report.file.string(), report.errors.front().message());
    } else {
      ++check.failed;
      for (const Error& error : report.errors) {
        errors.add(error);
      }
    }
  }
  check.good = check.loaded.size() + check.unavailable.size();
  return check;
}

LoadedAssets loadAssets(Application& application, const std::vector<std::string>& files) {
  LoadedAssets loaded;
  ErrorLog errors;
  std::vector<Error> ofRoots;
  const auto load = [&](const std::string& asset) {
    const auto done = application.load(asset);
    done ? ++loaded.loaded : ++loaded.failed;
    if (!done) {
      ofRoots.push_back(done.error());
    }
  };
  for (const std::string& file : files) {
    if (!assets::isProfile(file)) {
      load(file);
      continue;
    }
    auto profile = readProfile(file, errors);
    if (!profile) {
      ++loaded.failed;
      continue;
    }
    for (const std::string& asset : profile->assets) {
      load(assetOfProfile(asset));
    }
    ++loaded.loaded;
    loaded.profiles.push_back({file, std::move(*profile)});
  }
  for (const assets::AssetReport& report : application.assetLoader().reports()) {
    for (const Error& error : report.errors) {
      errors.add(error);
    }
  }
  for (const Error& error : ofRoots) {
    errors.add(error);
  }
  return loaded;
}

}  // namespace meridian::app

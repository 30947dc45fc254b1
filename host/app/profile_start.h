#pragma once

#include "host/api/error.h"
#include "host/app/application.h"
#include "host/assets/profile.h"

namespace meridian::app {

/// What a profile asks of a scene whose assets are loaded: scripts for modules, time, speeds, marked nodes (the tag
/// `GUI.Interesting`), actions and keys, properties, camera, and its own scripts, in this order. Every error goes to
/// the log with the key's name, and the rest is done; how many there were. `where` is the profile's file.
std::size_t startProfile(Application& application, const assets::Profile& profile, const std::string& where);

/// As the asset loader takes it: from ${ASSETS} unless the profile says otherwise.
[[nodiscard]] std::string assetOfProfile(const std::string& path);

}  // namespace meridian::app

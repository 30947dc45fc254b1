#pragma once

#include <memory>

#include "host/api/module.h"

namespace meridian::globebrowsing {

/// The module that draws globes: registers RenderableGlobe, `openspace.globebrowsing` and the layer panel.
[[nodiscard]] std::unique_ptr<Module> makeModule();

}  // namespace meridian::globebrowsing

#pragma once

#include <memory>

#include "host/scene/node_transforms.h"

namespace meridian::scene {

/// {Script}: a Lua file that defines `translation`, `rotation` or `scale`, called with the scene's time, that of the
/// call before, and the machine's, all in TDB seconds past J2000. They return 3 metres, 9 numbers of a matrix by
/// columns, or a factor (or 3, of which the geometric mean is taken). Each script has a sandbox of its own, without
/// `openspace`. One that fails says so once, and what it last returned stays.
[[nodiscard]] Result<std::unique_ptr<Translation>> makeLuaTranslation(const TransformRequest& request);
[[nodiscard]] Result<std::unique_ptr<Rotation>> makeLuaRotation(const TransformRequest& request);
[[nodiscard]] Result<std::unique_ptr<Scale>> makeLuaScale(const TransformRequest& request);

}  // namespace meridian::scene

#include "host/graphics/graphics.h"

#include "host/api/log.h"
#include "host/api/module.h"
#include "host/api/statistics.h"
#include "host/graphics/default_state.h"

namespace meridian::graphics {

Graphics::Graphics(const Paths& paths, Statistics& statistics, std::unique_ptr<ProgramCache> programs)
    : paths_(paths),
      statistics_(statistics),
      templates_(paths.shaders),
      limits_(readLimits()),
      programs_(std::move(programs)) {}

Result<std::unique_ptr<Graphics>> Graphics::create(Context& context, const Paths& paths, Statistics& statistics) {
  auto programs = ProgramCache::create(context, statistics);
  if (!programs) {
    return tl::make_unexpected(std::move(programs.error()));
  }
  applyDefaultState();
  std::unique_ptr<Graphics> graphics(new Graphics(paths, statistics, std::move(*programs)));
  log::info("OpenGL {} on {}", graphics->limits_.version, graphics->limits_.renderer);
  return graphics;
}

void Graphics::beginFrame(double uploadMilliseconds) {
  uploads_.begin(uploadMilliseconds);
  programs_->beginFrame();
  applyDefaultState();
}

void Graphics::endFrame() {
  statistics_.frame.upload += uploads_.spent();
  programs_->endFrame();
}

}  // namespace meridian::graphics

#pragma once

#include <memory>

#include "host/api/error.h"
#include "host/graphics/context.h"
#include "host/graphics/limits.h"
#include "host/graphics/program_cache.h"
#include "host/graphics/shader_template.h"
#include "host/graphics/upload_budget.h"

namespace meridian {
struct Paths;
class Statistics;
}  // namespace meridian

namespace meridian::graphics {

/// What everything that draws is given: programs, limits, budgets. Render thread only. Dies before the context, paths
/// and statistics that it is made of, and after all renderables.
class Graphics {
 public:
  /// Needs `context` current. Errors: no second context.
  [[nodiscard]] static Result<std::unique_ptr<Graphics>> create(Context& context, const Paths& paths,
                                                                Statistics& statistics);

  [[nodiscard]] ProgramCache& programs() { return *programs_; }
  [[nodiscard]] const ShaderTemplates& templates() const { return templates_; }
  [[nodiscard]] const Limits& limits() const { return limits_; }
  [[nodiscard]] const Paths& paths() const { return paths_; }
  [[nodiscard]] Statistics& statistics() { return statistics_; }
  [[nodiscard]] UploadBudget& uploads() { return uploads_; }

  /// Around everything that belongs to a frame, updates included. begin starts the upload budget and sets the default
  /// state; end adds the upload time to Statistics::frame.
  void beginFrame(double uploadMilliseconds = 2.0);
  void endFrame();

 private:
  Graphics(const Paths& paths, Statistics& statistics, std::unique_ptr<ProgramCache> programs);

  const Paths& paths_;
  Statistics& statistics_;
  ShaderTemplates templates_;
  Limits limits_;
  UploadBudget uploads_;
  std::unique_ptr<ProgramCache> programs_;
};

}  // namespace meridian::graphics

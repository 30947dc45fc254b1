#include "host/app/program.h"

#include <cstdio>
#include <memory>
#include <utility>

#include <fmt/format.h>

#include "host/api/log.h"
#include "host/api/regular_file.h"
#include "host/app/application.h"
#include "host/app/asset_check.h"
#include "host/app/frame_writer.h"
#include "host/app/interruption.h"
#include "host/app/locations.h"
#include "host/app/picture_memory.h"
#include "host/app/profile_start.h"
#include "host/app/run_loop.h"
#include "host/app/scene_renderer.h"
#include "host/app/session.h"
#include "host/app/start_view.h"
#include "host/app/statistics_report.h"
#include "host/app/window_input.h"
#include "host/assets/validate.h"
#include "host/graphics/context.h"
#include "host/graphics/shader_cache_folder.h"
#include "host/scripting/property_scripts.h"
#include "host/ui/scene_panel.h"
#include "host/ui/statistics_panel.h"
#include "host/ui/user_interface.h"

namespace meridian::app {
namespace {

namespace fs = std::filesystem;

struct ParsedSetting {
  std::string uri;
  Value value;
};

/// Reads the values of `--set` as Lua literals, in a state where there is nothing to call.
Result<std::vector<ParsedSetting>> parseSettings(const std::vector<PropertySetting>& settings) {
  std::vector<ParsedSetting> parsed;
  scripting::ScriptEngine engine;
  for (const PropertySetting& setting : settings) {
    auto values = engine.evaluate(setting.value, "--set");
    if (!values || values->size() != 1 || values->front().isNil()) {
      return failure(fmt::format("--set: '{}' is no value of Lua", setting.value), setting.uri,
                     "write a number, true, false, a \"string\" in quotes, or a {table}");
    }
    parsed.push_back({setting.uri, std::move(values->front())});
  }
  return parsed;
}

Result<void> runScriptFile(Application& application, const fs::path& file) {
  return readRegularFile(file, largestText, "the script", "name a Lua file with --script")
      .and_then([&](const std::string& text) { return application.scripts().run(text, file.string()); });
}

/// What the command line asks of a scene that is loaded.
Result<void> prepareScene(Application& application, const Options& options,
                          const std::vector<ParsedSetting>& settings) {
  if (options.time) {
    application.clock().setTime(*options.time);
  }
  application.scene().evaluate(application.clock().time());
  if (auto placed = placeCamera(application.camera(), options.anchor, options.camera); !placed) {
    return placed;
  }
  for (const ParsedSetting& setting : settings) {
    if (auto set =
            scripting::setProperties(application.properties(), application.animation(), setting.uri, setting.value);
        !set) {
      return failure(fmt::format("--set: {}", set.error().message()));
    }
  }
  return options.script ? runScriptFile(application, *options.script) : Result<void>{};
}

/// The window, or what stands in for it.
struct Surface {
  std::unique_ptr<graphics::Context> context;
  graphics::WindowContext* window = nullptr;  ///< null off screen
};

Result<Surface> openOffscreen() {
  auto context = graphics::OffscreenContext::create();
  if (!context) {
    return tl::make_unexpected(context.error());
  }
  return Surface{std::move(*context), nullptr};
}

Result<Surface> openSurface(const Options& options) {
  if (options.headless) {
    return openOffscreen();
  }
  graphics::WindowOptions windowOptions;
  windowOptions.size = options.size;
  auto window = graphics::WindowContext::create(windowOptions);
  if (window) {
    graphics::WindowContext* const raw = window->get();
    return Surface{std::move(*window), raw};
  }
  if (!options.frames && !options.play && !options.output && !options.stats) {
    return tl::make_unexpected(window.error());
  }
  log::warning("there is no window ({}): drawing off screen, as with --headless", window.error().message());
  return openOffscreen();
}

/// Reports an error; whether there was one.
bool failed(const Result<void>& result) {
  if (!result) {
    log::error("{}", result.error().message());
  }
  return !result;
}

/// Everything that lives while frames are drawn, in the order of making.
class Show {
 public:
  Show(Application& application, const Options& options) : application_(application), options_(options) {}
  ~Show() {
    panels_.reset();
    input_.reset();
    writer_.reset();
    // While there still is a context.
    application_.unload();
  }
  Show(const Show&) = delete;
  Show& operator=(const Show&) = delete;

  Result<void> open() {
    auto surface = openSurface(options_);
    if (!surface) {
      return tl::make_unexpected(surface.error());
    }
    surface_ = std::move(*surface);
    if (auto current = surface_.context->makeCurrent(); !current) {
      return current;
    }
    auto renderer =
        SceneRenderer::create(*surface_.context, application_.paths(), application_.statistics(), application_.scene());
    if (!renderer) {
      return tl::make_unexpected(renderer.error());
    }
    renderer_ = std::move(*renderer);
    auto session = Session::create(application_, options_, options_.hasFixedStep() || surface_.window == nullptr);
    if (!session) {
      return tl::make_unexpected(session.error());
    }
    session_ = std::move(*session);
    if (auto opened = openWriter(); !opened) {
      return opened;
    }
    if (options_.stats) {
      if (auto opened = checkStatisticsFile(*options_.stats); !opened) {
        return opened;
      }
    }
    if (surface_.window != nullptr) {
      if (auto opened = openPanels(); !opened) {
        return opened;
      }
    }
    loop_ = std::make_unique<RunLoop>(
        options_, RunLoop::Parts{application_, *session_, *renderer_, surface_.window, panels_.get(), writer_.get()});
    return {};
  }

  [[nodiscard]] std::size_t failedScripts() const { return session_->failedScripts(); }

  /// Runs, and closes all files whatever happened; the first error.
  Result<void> run() {
    Result<void> result = loop_->run();
    if (session_->hasWaitingScripts()) {
      log::warning("a script still waits for what it asked for: what it would do next is left out");
    }
    const auto keepFirst = [&](Result<void> next) {
      if (result) {
        result = std::move(next);
      } else {
        failed(next);
      }
    };
    if (writer_) {
      keepFirst(writer_->close());
    }
    keepFirst(session_->finish());
    if (options_.stats) {
      keepFirst(writeStatistics(application_.statistics(), *options_.stats));
    }
    return result;
  }

 private:
  Result<void> openWriter() {
    if (!options_.output) {
      return {};
    }
    auto writer = FrameWriter::open(*options_.output, options_.size, options_.fps.value_or(Options::defaultFps));
    if (!writer) {
      return tl::make_unexpected(writer.error());
    }
    writer_ = std::move(*writer);
    return {};
  }

  Result<void> openPanels() {
    WindowInput::Commands commands;
    commands.togglePanels = [this] { panels_->setVisible(!panels_->isVisible()); };
    commands.togglePause = [this] { application_.clock().setPause(!application_.clock().isPaused()); };
    commands.quit = [this] { loop_->quit(); };
    commands.pressKey = [this](const std::string& key) { return application_.keys().press(key); };
    commands.panelHasMouse = [this] { return panels_->hasMouse(); };
    commands.panelHasKeyboard = [this] { return panels_->hasKeyboard(); };
    input_ = std::make_unique<WindowInput>(surface_.window->window(), application_.navigator(), std::move(commands));
    auto panels = ui::UserInterface::create(surface_.window->window());
    if (!panels) {
      return tl::make_unexpected(panels.error());
    }
    panels_ = std::move(*panels);
    panels_->add(std::make_unique<ui::ScenePanel>(
                     ui::ScenePanel::Subjects{application_.clock(), application_.camera(), application_.navigator(),
                                              [this](std::string_view node) {
                                                application_.navigator().stop();
                                                failed(showNode(application_.camera(), node));
                                              }}),
                 ui::UserInterface::Side::Left);
    for (auto& panel : application_.takePanels()) {
      panels_->add(std::move(panel), ui::UserInterface::Side::Right);
    }
    panels_->add(std::make_unique<ui::StatisticsPanel>(application_.statistics()), ui::UserInterface::Side::Left);
    return {};
  }

  Application& application_;
  const Options& options_;
  Surface surface_;
  std::unique_ptr<SceneRenderer> renderer_;
  std::unique_ptr<Session> session_;
  std::unique_ptr<FrameWriter> writer_;
  std::unique_ptr<RunLoop> loop_;
  std::unique_ptr<WindowInput> input_;
  std::unique_ptr<ui::UserInterface> panels_;
};

ExitCode validate(Application& application, const Options& options) {
  application.scripts().neverWait();
  const AssetCheck check = checkAssets(application, options.assets);
  check.report();
  fmt::print("{}\n", check.line());
  return check.failed == 0 ? ExitCode::Done : ExitCode::AssetErrors;
}

ExitCode show(Application& application, const Options& options, const std::vector<ParsedSetting>& settings) {
  if (failed(checkPictureFits(options.size, availableMemory()))) {
    return ExitCode::Failed;
  }
  const LoadedAssets assets = loadAssets(application, options.assets);
  if (assets.loaded == 0) {
    return ExitCode::Failed;
  }
  std::size_t failures = assets.failed;
  for (const auto& [file, profile] : assets.profiles) {
    failures += startProfile(application, profile, file);
  }
  if (failed(prepareScene(application, options, settings))) {
    return ExitCode::Failed;
  }
  Show show(application, options);
  if (failed(show.open()) || failed(show.run())) {
    return ExitCode::Failed;
  }
  if (options.output) {
    log::info("written: {}", options.output->string());
  }
  return failures + show.failedScripts() == 0 ? ExitCode::Done : ExitCode::Failed;
}

}  // namespace

ExitCode runProgram(Options options, std::vector<std::unique_ptr<Module>> modules) {
  // One line is enough: the engine would also warn of a word that is no value.
  log::setLevel(log::Level::Error);
  const auto settings = parseSettings(options.settings);
  if (!settings) {
    log::error("{}", settings.error().message());
    return ExitCode::WrongUsage;
  }
  log::setLevel(options.logLevel);
  if (options.output) {
    if (const auto kind = FrameWriter::kindOf(*options.output); !kind) {
      log::error("--output: {}", kind.error().message());
      return ExitCode::WrongUsage;
    }
  }
  listenForInterruption();
  auto temporary = TemporaryFolder::create();
  if (!temporary) {
    log::error("{}", temporary.error().message());
    return ExitCode::Failed;
  }
  auto paths = findPaths(temporary->path());
  if (!paths) {
    log::error("{}", paths.error().message());
    return ExitCode::Failed;
  }
  if (options.assets.empty()) {
    options.assets.push_back((paths->data / "assets" / "default.asset").string());
  }
  paths->assets = assets::assetsFolder(options.assets.front(), paths->data / "assets");
  if (const auto folder = graphics::useShaderCacheFolder(paths->cache); !folder) {
    log::warning("{}", folder.error().message());
  }

  Application application(std::move(*paths));
  application.addModules(std::move(modules));
  if (options.time) {
    application.clock().setTime(*options.time);
  }
  application.scene().evaluate(application.clock().time());
  return options.validate ? validate(application, options) : show(application, options, *settings);
}

}  // namespace meridian::app

#pragma once

#include <array>
#include <chrono>
#include <cmath>
#include <functional>
#include <map>
#include <memory>
#include <numbers>
#include <string>
#include <thread>
#include <vector>

#include <gdal_priv.h>
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "../gpu/gpu_fixture.h"
#include "globebrowsing/module.h"
#include "globebrowsing/renderable_globe.h"
#include "host/graphics/projection.h"
#include "host/graphics/render_target.h"
#include "host/scripting/lua_data.h"

namespace meridian::globebrowsing {

using Fields = std::map<std::string, Value, std::less<>>;

inline Value tableOf(Fields fields) {
  return Table{{}, std::move(fields)};
}
inline Value listOf(std::vector<Value> items) {
  return Table{std::move(items), {}};
}
inline Value solidLayer(const std::string& identifier, const glm::dvec3& colour, Fields more = {}) {
  more.insert({{"Identifier", identifier}, {"Type", "SolidColor"}, {"Color", Value(colour)}, {"Enabled", true}});
  return tableOf(std::move(more));
}
inline Value fileLayer(const std::string& identifier, const std::string& file, Fields more = {}) {
  more.insert({{"Identifier", identifier}, {"FilePath", file}, {"Enabled", true}});
  return tableOf(std::move(more));
}

/// The host that the module needs, and what it registers there.
class FakeHost final : public Host {
 public:
  FakeHost(const Paths& paths, Statistics& statistics) : paths_(paths), statistics_(statistics) {}
  void registerRenderable(std::string type, RenderableFactory factory) override {
    factories[type] = std::move(factory);
  }
  void registerScriptLibrary(ScriptLibrary library) override { libraries.push_back(std::move(library)); }
  void registerPanel(std::unique_ptr<Panel> panel) override { panels.push_back(std::move(panel)); }
  [[nodiscard]] const Paths& paths() const override { return paths_; }
  [[nodiscard]] Statistics& statistics() override { return statistics_; }
  [[nodiscard]] Renderable* renderable(std::string_view node) override {
    const auto found = renderables.find(node);
    return found == renderables.end() ? nullptr : found->second.get();
  }
  [[nodiscard]] std::vector<std::string> nodes() const override {
    std::vector<std::string> names;
    for (const auto& [name, renderable] : renderables) {
      names.push_back(name);
    }
    return names;
  }

  [[nodiscard]] std::optional<std::filesystem::path> pathToken(std::string_view name) const override {
    const auto found = tokens.find(name);
    return found == tokens.end() ? std::nullopt : std::optional(found->second);
  }
  [[nodiscard]] ScriptPlace scriptPlace() const override { return {place, folder, isAsset}; }
  [[nodiscard]] Result<std::filesystem::path> readablePath(std::string_view path) const override {
    return std::filesystem::path(path).is_absolute() ? std::filesystem::path(path)
                                                     : folder / std::filesystem::path(path);
  }
  [[nodiscard]] Result<std::filesystem::path> writablePath(std::string_view path) const override {
    return path.find("..") == std::string_view::npos ? readablePath(path)
                                                     : failure("scripts may not write there", std::string(path));
  }
  [[nodiscard]] Result<Value> readLuaData(const std::filesystem::path& file) const override {
    return scripting::readLuaData(file);
  }
  Result<void> addSceneGraphNode(const Value& table) override {
    addedNodes.push_back(table);
    return {};
  }

  void noteRegistration(std::string name, std::function<void()> takeBack) override {
    registrations[std::move(name)] = std::move(takeBack);
  }

  std::map<std::string, std::function<void()>> registrations;
  std::map<std::string, std::filesystem::path, std::less<>> tokens;
  std::string place = "test.lua:1";  ///< of the script that runs
  std::string folder;
  bool isAsset = false;  ///< as what scripts run
  std::vector<Value> addedNodes;
  std::map<std::string, RenderableFactory> factories;
  std::vector<ScriptLibrary> libraries;
  std::vector<std::unique_ptr<Panel>> panels;
  std::map<std::string, std::unique_ptr<Renderable>, std::less<>> renderables;

 private:
  const Paths& paths_;
  Statistics& statistics_;
};

/// A whole module drawing off screen, frame by frame.
class GlobeTest : public GpuTest {
 protected:
  static constexpr int width = 320;
  static constexpr int height = 240;
  static constexpr double radius = 6.4e6;

  void SetUp() override {
    GpuTest::SetUp();
    if (!graphics_) {
      return;
    }
    folder_ =
        std::filesystem::path(MERIDIAN_TEST_FOLDER) / ::testing::UnitTest::GetInstance()->current_test_info()->name();
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
    host_ = std::make_unique<FakeHost>(paths_, statistics_);
    host_->folder = folder_.string();
    module_ = makeModule();
    ASSERT_TRUE(module_->initialize(*host_));
    auto target = graphics::RenderTarget::create({{width, height}, 1});
    ASSERT_TRUE(target);
    target_ = std::make_unique<graphics::RenderTarget>(std::move(*target));
    look(0.1, 0.2, 1.5e7);
  }

  void TearDown() override {
    if (host_) {
      removeGlobes();
    }
    if (graphics_) {
      EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));
      EXPECT_EQ(statistics_.programs.framesWaited.load(), 0U);
    }
    module_.reset();
    host_.reset();
    std::filesystem::remove_all(folder_);
  }

  Result<std::unique_ptr<Renderable>> create(Fields table) {
    return host_->factories.at("RenderableGlobe")(
        {tableOf(std::move(table)), "test.asset:7", folder_.string(), "Node"});
  }
  RenderableGlobe& addGlobe(Fields layers, Fields more = {}, const std::string& node = "Globe") {
    more.insert({{"Radii", radius}, {"PerformShading", false}, {"Layers", tableOf(std::move(layers))}});
    auto made = create(std::move(more));
    EXPECT_TRUE(made) << (made ? "" : made.error().message());
    auto& slot = host_->renderables[node];
    slot = std::move(*made);
    EXPECT_TRUE(slot->initializeGraphics(*graphics_));
    return dynamic_cast<RenderableGlobe&>(*slot);
  }
  void removeGlobes() {
    for (const auto& [name, renderable] : host_->renderables) {
      renderable->deinitializeGraphics();
    }
    host_->renderables.clear();
  }
  void setModuleProperty(const char* name, const Value& value) { ASSERT_TRUE(module_->property(name)->set(value)); }

  /// From straight above that place (radians), metres from the middle.
  void look(double latitude, double longitude, double distance) {
    const glm::dvec3 up(std::cos(latitude) * std::cos(longitude), std::cos(latitude) * std::sin(longitude),
                        std::sin(latitude));
    view_.size = {width, height};
    view_.cameraPosition = distance * up;
    view_.lightDirection = up;
    const glm::dvec3 upwards = std::abs(up.z) > 0.99 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 0, 1);
    view_.cameraFromModel = glm::lookAt(view_.cameraPosition, glm::dvec3(0.0), upwards);
    view_.clipFromCamera = graphics::reversedInfinitePerspective(0.8, double{width} / height, 1.0);
    view_.pixelsPerRadian = graphics::pixelsPerRadian(0.8, height);
  }

  void frame() { frame(true); }
  /// Undrawn frames are those in which a host without a window waits for a view to settle.
  void frame(bool isDrawn) {
    const std::array<View, 1> views{view_};
    const FrameContext context{time_, 0.0, 0.0, ++number_, views};
    graphics_->beginFrame();
    for (const auto& [name, renderable] : host_->renderables) {
      renderable->update(context);
    }
    if (isDrawn) {
      target_->bind();
      target_->clear({0.0F, 0.0F, 0.0F, 1.0F});
      for (const auto& [name, renderable] : host_->renderables) {
        renderable->draw(context, 0);
      }
    }
    graphics_->endFrame();
    statistics_.endFrame();
  }

  /// Why it is not, or an empty string.
  [[nodiscard]] std::string unsettled() {
    for (const auto& [name, renderable] : host_->renderables) {
      if (const Settled settled = renderable->ground()->settled(0); !settled.complete) {
        return settled.reason;
      }
    }
    return {};
  }
  /// Draws until that holds; gives up after what even a machine busy with other things does not need: workers have the
  /// idle priority.
  [[nodiscard]] bool framesUntil(const std::function<bool()>& holds, bool areDrawn = true) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(90);
    do {
      frame(areDrawn);
      if (holds()) {
        return true;
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    } while (std::chrono::steady_clock::now() < end);
    return false;
  }
  [[nodiscard]] ::testing::AssertionResult settle(const std::function<void()>& eachFrame = {}) {
    const bool settled = framesUntil([&] {
      if (eachFrame) {
        eachFrame();
      }
      return unsettled().empty();
    });
    if (!settled) {
      return ::testing::AssertionFailure() << "not settled: " << unsettled();
    }
    frame();
    return ::testing::AssertionSuccess();
  }

  using Pixel = std::array<int, 3>;
  [[nodiscard]] Pixel centre() const {
    std::array<std::uint8_t, 4> rgba{};
    glBindFramebuffer(GL_READ_FRAMEBUFFER, target_->framebuffer());
    glReadPixels(width / 2, height / 2, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
    return {rgba[0], rgba[1], rgba[2]};
  }

  /// A raster over the whole globe in the test's folder; value(band from 0, longitude, latitude in degrees).
  std::string raster(const std::string& name, const std::function<double(int, double, double)>& value, int bands = 3,
                     GDALDataType type = GDT_Byte, int columns = 256) {
    GDALAllRegister();
    const std::string path = (folder_ / name).string();
    const int rows = columns / 2;
    GDALDatasetUniquePtr dataset(
        GetGDALDriverManager()->GetDriverByName("GTiff")->Create(path.c_str(), columns, rows, bands, type, nullptr));
    const double pixel = 360.0 / columns;
    std::array<double, 6> transform{-180.0, pixel, 0.0, 90.0, 0.0, -pixel};
    dataset->SetGeoTransform(transform.data());
    OGRSpatialReference crs;
    crs.SetWellKnownGeogCS("WGS84");
    dataset->SetSpatialRef(&crs);
    std::vector<double> line(static_cast<std::size_t>(columns));
    for (int band = 0; band < bands; ++band) {
      for (int row = 0; row < rows; ++row) {
        for (int column = 0; column < columns; ++column) {
          line[static_cast<std::size_t>(column)] =
              value(band, -180.0 + (column + 0.5) * pixel, 90.0 - (row + 0.5) * pixel);
        }
        EXPECT_EQ(CE_None, dataset->GetRasterBand(band + 1)->RasterIO(GF_Write, 0, row, columns, 1, line.data(),
                                                                      columns, 1, GDT_Float64, 0, 0, nullptr));
      }
    }
    return path;
  }
  std::string uniformRaster(const std::string& name, const Pixel& colour, int columns = 256) {
    return raster(
        name, [&](int band, double, double) { return colour[static_cast<std::size_t>(band)]; }, 3, GDT_Byte, columns);
  }

  std::filesystem::path folder_;
  std::unique_ptr<graphics::RenderTarget> target_;
  std::unique_ptr<FakeHost> host_;
  std::unique_ptr<Module> module_;
  View view_;
  Time time_;
  std::uint64_t number_ = 0;
};

}  // namespace meridian::globebrowsing

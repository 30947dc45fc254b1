#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "globebrowsing/renderable_globe.h"
#include "globebrowsing/surface/chunked_surface.h"
#include "host/app/application.h"
#include "host/app/scene_renderer.h"
#include "host/graphics/context.h"

namespace meridian::bench {

/// The program's own scene and renderer, off screen, with a globe in view and nothing left to load.
class SettledGlobe {
 public:
  /// `place`: LAT,LON,ALT[,HEADING,PITCH] as for --camera, over the globe `Earth` of the default scene.
  /// `asset`: another scene with a globe of that name.
  static Result<std::unique_ptr<SettledGlobe>> create(const std::string& place, glm::ivec2 size,
                                                      const std::filesystem::path& asset = {},
                                                      const char* time = "2026-06-21T10:00:00");
  ~SettledGlobe();
  SettledGlobe(const SettledGlobe&) = delete;
  SettledGlobe& operator=(const SettledGlobe&) = delete;

  /// Draws until nothing is left to load, at most a minute. Errors: something is.
  Result<void> settle();
  /// Draws a frame and waits for it, with the blit of a window's frame; milliseconds.
  double frame();
  /// Copies the drawn frame, as a window would show it.
  void blit();
  /// The last frame's pixels, rows of RGBA from the bottom.
  [[nodiscard]] std::vector<std::uint8_t> picture() const;

  [[nodiscard]] globebrowsing::ChunkedSurface& surface();
  [[nodiscard]] app::Application& application() { return *application_; }
  [[nodiscard]] app::SceneRenderer& renderer() { return *renderer_; }
  /// Of the last frame.
  [[nodiscard]] View view() const;

 private:
  SettledGlobe() = default;
  /// Whether tiles beside the picture or programs for later are still under way: they would be measured, too.
  [[nodiscard]] bool isPreparing() const;

  std::unique_ptr<graphics::Context> context_;
  std::unique_ptr<app::Application> application_;
  std::unique_ptr<app::SceneRenderer> renderer_;
  graphics::Texture shown_;
  graphics::Framebuffer showing_;
  glm::ivec2 size_{0};
  std::uint64_t frames_ = 0;
};

}  // namespace meridian::bench

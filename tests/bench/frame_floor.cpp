// How near a settled frame is to the least that drawing its pixels can cost. Prints one JSON object:
//   bench-frame-floor --camera LAT,LON,ALT[,HEADING,PITCH] [--frames N] [--size WxH]

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "floor_draw.h"
#include "host/api/log.h"
#include "settled_globe.h"
#include "surface_figures.h"

namespace {

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
  return values[values.size() / 2];
}

}  // namespace

int main(int argc, char** argv) {
  using namespace meridian;
  std::string camera = "20,10,20000000";
  int frames = 60;
  glm::ivec2 size(1280, 720);
  for (int i = 1; i + 1 < argc; i += 2) {
    if (std::strcmp(argv[i], "--camera") == 0) {
      camera = argv[i + 1];
    } else if (std::strcmp(argv[i], "--frames") == 0) {
      frames = std::max(1, std::atoi(argv[i + 1]));
    } else if (std::strcmp(argv[i], "--size") == 0) {
      std::sscanf(argv[i + 1], "%dx%d", &size.x, &size.y);
    }
  }
  log::setLevel(log::Level::Warning);
  auto globe = bench::SettledGlobe::create(camera, size);
  if (!globe) {
    log::error("{}", globe.error().message());
    return 1;
  }
  const bench::SurfaceFigures figures = bench::measureSurface(**globe, size);
  bench::FloorDraw floor(**globe, size, figures);
  // The floor's vertex layout is a variant of its own, compiled at its first draw.
  floor.frame();
  (*globe)->frame();
  std::vector<double> own;
  std::vector<double> least;
  std::vector<double> ratios;
  // In turn, so that both see the machine in the same mood.
  for (int i = 0; i < frames; ++i) {
    own.push_back((*globe)->frame());
    least.push_back(floor.frame());
    ratios.push_back(own.back() / least.back());
  }
  fmt::print(
      "{{\"ratio\": {:.4f}, \"frame_ms\": {:.3f}, \"floor_ms\": {:.3f}, \"chunks\": {}, \"triangles\": {}, "
      "\"skirt_triangles\": {}, \"covered_pixels\": {}, \"pixels_per_triangle\": {:.2f}, \"texels_per_pixel\": {:.3f}, "
      "\"night\": {}, \"error_pixels\": {:.4f}}}\n",
      median(own) / median(least), median(own), median(least), figures.chunks, figures.triangles,
      figures.skirtTriangles, figures.coveredPixels,
      static_cast<double>(figures.coveredPixels) / static_cast<double>(std::max<std::size_t>(figures.triangles, 1)),
      bench::quantile(figures.texelDensities, 0.5), figures.mostlyNight, figures.errorPixels);
  return 0;
}

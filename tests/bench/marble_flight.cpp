// Draws a flight with Marble's software globe, a peer that scripts/bench compares with in the same run:
//   bench-marble < POSES       a line each: latitude and longitude in degrees, the radius of the outline in pixels
// Marble draws its Blue Marble, from the disk alone, at its normal quality on 1280 x 720 pixels, and nothing else: no
// stars, no atmosphere. A first flight loads what it needs, a second is measured. Prints {"median_ms": M, "frames": N}.

#include <QApplication>
#include <QImage>
#include <algorithm>
#include <chrono>
#include <cstddef>
#include <iostream>
#include <vector>

#include <marble/GeoPainter.h>
#include <marble/MarbleMap.h>
#include <marble/MarbleModel.h>
#include <marble/RenderPlugin.h>

namespace {

using Clock = std::chrono::steady_clock;

constexpr int width = 1280;
constexpr int height = 720;

struct Pose {
  double latitude = 0.0;
  double longitude = 0.0;
  int radius = 0;
};

void setUp(Marble::MarbleMap& map) {
  map.setSize(width, height);
  map.setProjection(Marble::Spherical);
  map.model()->setWorkOffline(true);
  map.setMapThemeId("earth/bluemarble/bluemarble.dgml");
  map.setMapQualityForViewContext(Marble::NormalQuality, Marble::Still);
  map.setViewContext(Marble::Still);
  map.setShowPlaces(false);
  map.setShowCities(false);
  map.setShowTerrain(false);
  map.setShowOtherPlaces(false);
  map.setShowIceLayer(false);
  map.setShowBorders(false);
  map.setShowRivers(false);
  map.setShowLakes(false);
  map.setShowClouds(false);
  map.setShowSunShading(false);
  map.setShowCityLights(false);
  for (Marble::RenderPlugin* plugin : map.renderPlugins()) {
    plugin->setEnabled(false);
  }
}

double milliseconds(Marble::MarbleMap& map, QImage& image, const Pose& pose) {
  const Clock::time_point start = Clock::now();
  map.setRadius(pose.radius);
  map.centerOn(pose.longitude, pose.latitude);
  Marble::GeoPainter painter(&image, map.viewport(), map.mapQuality());
  map.paint(painter, QRect());
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

}  // namespace

int main(int argc, char** argv) {
  qputenv("QT_QPA_PLATFORM", "offscreen");
  const QApplication application(argc, argv);
  std::vector<Pose> poses;
  for (Pose pose; std::cin >> pose.latitude >> pose.longitude >> pose.radius;) {
    poses.push_back(pose);
  }
  if (poses.empty()) {
    std::cerr << "usage: bench-marble < POSES, a line each: latitude longitude radius\n";
    return 2;
  }
  Marble::MarbleMap map;
  setUp(map);
  QImage image(width, height, QImage::Format_ARGB32_Premultiplied);
  image.fill(Qt::transparent);
  std::vector<double> times;
  for (const bool measures : {false, true}) {
    for (const Pose& pose : poses) {
      const double time = milliseconds(map, image, pose);
      QCoreApplication::processEvents();
      if (measures) {
        times.push_back(time);
      }
    }
  }
  if (qAlpha(image.pixel(width / 2, height / 2)) == 0) {
    std::cerr << "bench-marble: there is no globe in its pictures; is its theme earth/bluemarble installed?\n";
    return 1;
  }
  const auto middle = times.begin() + static_cast<std::ptrdiff_t>(times.size() / 2);
  std::nth_element(times.begin(), middle, times.end());
  std::cout << "{\"median_ms\": " << *middle << ", \"frames\": " << times.size() << "}\n";
  return 0;
}

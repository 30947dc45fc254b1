// The default scene along the shipped flight, as users see it: settled frames of the program, against outlines of the
// relief that its height raster holds.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <numbers>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <fmt/format.h>
#include <gdal_priv.h>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include "eye.h"
#include "host/graphics/image.h"
#include "host/recording/session_recording.h"
#include "picture_check.h"
#include "relief.h"

namespace meridian::globebrowsing::test {

namespace {

namespace fs = std::filesystem;

/// Frames of a playback. The seconds from one to the next are a multiple of the recording's fifteenths, so that no pose
/// is interpolated.
struct Sampling {
  int frames;
  double step;
};
constexpr Sampling few{20, 3.2};
constexpr Sampling many{155, 0.4};
const glm::dvec3 wgs84{6378137.0, 6378137.0, 6356752.314245};

fs::path preparedData() {
  const char* cache = std::getenv("XDG_CACHE_HOME");
  const char* home = std::getenv("HOME");
  const fs::path root = cache != nullptr && *cache != '\0' ? fs::path(cache) : fs::path(home ? home : "") / ".cache";
  return root / "meridian" / "data";
}

/// The least and the greatest height near a place, of a global raster of a value every few minutes: any interpolation
/// lies between, but for overshoot.
class HeightBounds {
 public:
  explicit HeightBounds(const fs::path& file) {
    GDALAllRegister();
    const GDALDatasetUniquePtr dataset(GDALDataset::Open(file.c_str(), GDAL_OF_RASTER));
    if (!dataset || dataset->GetGeoTransform(transform_.data()) != CE_None) {
      return;
    }
    width_ = dataset->GetRasterXSize();
    height_ = dataset->GetRasterYSize();
    std::vector<float> values(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_));
    if (dataset->GetRasterBand(1)->RasterIO(GF_Read, 0, 0, width_, height_, values.data(), width_, height_, GDT_Float32,
                                            0, 0, nullptr) != CE_None) {
      return;
    }
    least_ = spread(values, [](float a, float b) { return std::min(a, b); });
    most_ = spread(values, [](float a, float b) { return std::max(a, b); });
  }

  [[nodiscard]] bool isGood() const { return !least_.empty(); }
  [[nodiscard]] double least(const glm::dvec3& normal) const { return least_[at(normal)] - overshoot; }
  [[nodiscard]] double most(const glm::dvec3& normal) const { return most_[at(normal)] + overshoot; }

 private:
  static constexpr double overshoot = 50.0;

  [[nodiscard]] std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(column);
  }
  [[nodiscard]] std::size_t at(const glm::dvec3& normal) const {
    const double latitude = std::asin(std::clamp(normal.z, -1.0, 1.0)) * 180.0 / std::numbers::pi;
    const double longitude = std::atan2(normal.y, normal.x) * 180.0 / std::numbers::pi;
    double column = std::floor((longitude - transform_[0]) / transform_[1]);
    column -= width_ * std::floor(column / width_);
    const double row = std::clamp(std::floor((latitude - transform_[3]) / transform_[5]), 0.0, height_ - 1.0);
    return index(std::min(static_cast<int>(column), width_ - 1), static_cast<int>(row));
  }
  /// Every value becomes the chosen one of itself and the two cells around: one for interpolation, one for the half
  /// pixel by which drawn relief may be off.
  template <typename Choose>
  std::vector<float> spread(std::vector<float> values, Choose choose) const {
    for (const bool across : {true, false}) {
      std::vector<float> result = values;
      for (int row = 0; row < height_; ++row) {
        for (int column = 0; column < width_; ++column) {
          for (int step = -2; step <= 2; ++step) {
            const std::size_t other = across ? index((column + step + width_) % width_, row)
                                             : index(column, std::clamp(row + step, 0, height_ - 1));
            result[index(column, row)] = choose(result[index(column, row)], values[other]);
          }
        }
      }
      values = std::move(result);
    }
    return values;
  }

  std::array<double, 6> transform_{};
  int width_ = 0;
  int height_ = 0;
  std::vector<float> least_;
  std::vector<float> most_;
};

class Flight : public ::testing::Test {
 protected:
  void SetUp() override {
    for (const char* name : {"earth_blue_marble.tif", "earth_etopo5.tif"}) {
      if (!fs::exists(preparedData() / name)) {
        std::cerr << "NO PREPARED DATA, THE FLIGHT IS NOT TESTED: " << preparedData() / name
                  << "; run scripts/lib/prepare-data\n";
        GTEST_SKIP() << "no " << preparedData() / name;
      }
    }
  }

  /// Plays the flight into a folder of that name.
  void play(const std::string& name, const Sampling& sampling, const std::string& arguments) {
    readEyes(sampling);
    folder_ = fs::path(MERIDIAN_TEST_FOLDER) / name;
    fs::remove_all(folder_);
    fs::create_directories(folder_.parent_path());
    const std::string command = fmt::format(
        "timeout 250 '{}' --headless --play '{}' --frames {} --fps {} --size {}x{} {} "
        "--set RenderEngine.ShowAttribution=false "
        "--output '{}' 2>'{}.log'",
        MERIDIAN_PROGRAM, flightFile().string(), sampling.frames, 1.0 / sampling.step, pictureSize.x, pictureSize.y,
        arguments, folder_.string(), folder_.string());
    const int status = std::system(command.c_str());
    const int code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    ASSERT_EQ(code, 0) << command << "; see " << folder_.string() << ".log";
  }

  static fs::path flightFile() {
    return fs::path(MERIDIAN_SOURCE_FOLDER) / "data" / "flights" / "earth_descent.osrectxt";
  }

  void readEyes(const Sampling& sampling) {
    const auto recording = recording::readSessionRecording(flightFile());
    ASSERT_TRUE(recording) << recording.error().message();
    for (int frame = 0; frame < sampling.frames; ++frame) {
      const recording::CameraEntry* nearest = nullptr;
      for (const auto& entry : recording->entries) {
        const auto* camera = std::get_if<recording::CameraEntry>(&entry);
        const auto away = [&](const recording::CameraEntry& one) {
          return std::abs(one.timestamp - frame * sampling.step);
        };
        if (camera != nullptr && (nearest == nullptr || away(*camera) < away(*nearest))) {
          nearest = camera;
        }
      }
      ASSERT_NE(nearest, nullptr);
      ASSERT_NEAR(nearest->timestamp, frame * sampling.step, 1e-3);
      ASSERT_TRUE(nearest->followsRotation && nearest->node == "Earth");
      eyes_.push_back({nearest->position, nearest->rotation * glm::dvec3(0.0, 0.0, -1.0),
                       nearest->rotation * glm::dvec3(0.0, 1.0, 0.0), 0.1, 50.0 * std::numbers::pi / 180.0});
    }
  }

  [[nodiscard]] fs::path frameFile(int frame) const { return folder_ / fmt::format("frame_{:06}.png", frame); }
  [[nodiscard]] Pixels frame(int number) const {
    const auto image = graphics::readPng(frameFile(number));
    EXPECT_TRUE(image) << image.error().message();
    return image && image->size == pictureSize ? image->pixels : Pixels();
  }

  static bool isBlack(const Pixels& pixels, std::size_t i) {
    return pixels[4 * i] == 0 && pixels[4 * i + 1] == 0 && pixels[4 * i + 2] == 0;
  }

  std::vector<Eye> eyes_;
  fs::path folder_;
};

TEST_F(Flight, EveryPixelInsideTheOutlineIsDrawn) {
  if (IsSkipped()) {
    return;
  }
  const HeightBounds heights(preparedData() / "earth_etopo5.tif");
  ASSERT_TRUE(heights.isGood());
  // All of it lit: what is black then was not drawn.
  ASSERT_NO_FATAL_FAILURE(play("flight_lit", few, "--settle 60 --set Scene.Earth.Renderable.AmbientIntensity=1"));
  // Of a field of steps the slope has no bound; a shorter stride than the steps' width finds nearly all of them.
  const Relief within{wgs84, 9000.0, 0.5, [&](const glm::dvec3& normal) { return heights.least(normal); }};
  const Relief beyond{wgs84, 9000.0, 0.5, [&](const glm::dvec3& normal) { return heights.most(normal); }};
  int inside = 0;
  for (int number = 0; number < few.frames; ++number) {
    const Pixels drawn = frame(number);
    ASSERT_FALSE(drawn.empty());
    const Expected inner = expectedOutline(within, eyes_[static_cast<std::size_t>(number)]);
    const std::vector<Region> innerRegions = regionsOf(inner, outlineMargin);
    const std::vector<Region> outerRegions =
        regionsOf(expectedOutline(beyond, eyes_[static_cast<std::size_t>(number)]), outlineMargin);
    Verdict verdict;
    verdict.difference.resize(drawn.size(), 0);
    for (std::size_t i = 0; i < innerRegions.size(); ++i) {
      verdict.difference[4 * i + 3] = 255;
      verdict.inside += int{innerRegions[i] == Region::Inside};
      if (innerRegions[i] == Region::Inside && isBlack(drawn, i)) {
        ++verdict.holes;
        verdict.difference[4 * i] = 255;
      }
      if (outerRegions[i] == Region::Outside && !isBlack(drawn, i)) {
        ++verdict.spilled;
        verdict.difference[4 * i] = verdict.difference[4 * i + 1] = 255;
      }
    }
    inside += verdict.inside;
    EXPECT_TRUE(verdict.isGood()) << frameFile(number) << ": " << verdict.text() << "; see "
                                  << writeEvidence(fs::path(MERIDIAN_TEST_FOLDER) / "pictures" /
                                                       fmt::format("flight_{:02}.png", number),
                                                   drawn, inner, verdict);
  }
  EXPECT_GT(inside, few.frames * pictureSize.x * pictureSize.y / 4) << "the outlines hold next to nothing";
}

TEST_F(Flight, OnceTheGlobeIsThereNoFrameHasAHole) {
  if (IsSkipped()) {
    return;
  }
  // A thirtieth of a second is not enough to load: coarser tiles stand in for what is missing.
  ASSERT_NO_FATAL_FAILURE(
      play("flight_unsettled", many, "--settle 0.03 --set Scene.Earth.Renderable.AmbientIntensity=1"));
  // Below the deepest sea, less what 32 segments over half the globe leave out of it.
  constexpr double inner = 1.0 - 11e3 / 6.35e6 - 0.0025;
  const Relief innermost{inner * wgs84, 0.0, 0.0, [](const glm::dvec3&) { return 0.0; }};
  bool there = false;
  int whole = 0;
  for (int number = 0; number < many.frames; ++number) {
    const Pixels drawn = frame(number);
    ASSERT_FALSE(drawn.empty());
    const Expected outline = expectedOutline(innermost, eyes_[static_cast<std::size_t>(number)]);
    const std::vector<Region> regions = regionsOf(outline, outlineMargin);
    int holes = 0;
    for (std::size_t i = 0; i < regions.size(); ++i) {
      holes += int{regions[i] == Region::Inside && isBlack(drawn, i)};
    }
    EXPECT_FALSE(there && holes > 0) << frameFile(number) << ": " << holes << " pixels inside the outline are black";
    there = there || holes == 0;
    whole += int{holes == 0};
  }
  EXPECT_GT(whole, 0) << "no frame was ever whole";
}

TEST_F(Flight, NoBlockOfTheDaySideIsBlack) {
  if (IsSkipped()) {
    return;
  }
  ASSERT_NO_FATAL_FAILURE(play("flight", few, "--settle 60"));
  // The sun on 21 June 2026 at 6:00 UTC: overhead at 23.4 degrees north and, by the equation of time, 90.4 degrees
  // east.
  const glm::dvec3 sun = normalAt(23.4, 90.4);
  constexpr double day = 0.2;
  constexpr int block = 8;
  const Relief surface{wgs84, 0.0, 0.0, [](const glm::dvec3&) { return 0.0; }};
  int checked = 0;
  for (int number = 0; number < few.frames; ++number) {
    const Pixels drawn = frame(number);
    ASSERT_FALSE(drawn.empty());
    const Eye& eye = eyes_[static_cast<std::size_t>(number)];
    for (int y = 0; y + block <= pictureSize.y; y += block) {
      for (int x = 0; x + block <= pictureSize.x; x += block) {
        bool lit = true;
        for (const int row : {y, y + block - 1}) {
          for (const int column : {x, x + block - 1}) {
            const auto normal = firstHit(surface, eye.position, eye.through(column, row), 1e-4);
            lit = lit && normal && glm::dot(*normal, sun) > day;
          }
        }
        bool black = true;
        for (int i = 0; i < block * block; ++i) {
          black = black && isBlack(drawn, static_cast<std::size_t>((y + i / block) * pictureSize.x + x + i % block));
        }
        checked += int{lit};
        EXPECT_FALSE(lit && black) << frameFile(number) << ": the block at " << x << ", " << y << " is black";
      }
    }
  }
  EXPECT_GT(checked, 1000);
}

}  // namespace

}  // namespace meridian::globebrowsing::test

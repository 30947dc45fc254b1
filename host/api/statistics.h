#pragma once

#include <atomic>
#include <cstdint>
#include <vector>

namespace meridian {

/// The figures of `--stats` and of the statistics panel. Counters may be written by any thread, the rest by the render
/// thread only. Gauges (chunks, memory) hold the last frame's state.
class Statistics {
 public:
  /// Milliseconds of one frame. Whoever measures adds to `frame`; endFrame keeps it and starts the next.
  struct Frame {
    double frame = 0.0;   ///< whole frame; headless it ends when the frame's fence has been waited for
    double cpu = 0.0;     ///< of the render thread until submission
    double gpu = 0.0;     ///< from a timer query
    double select = 0.0;  ///< chunk selection and culling
    double upload = 0.0;
  };
  Frame frame;
  void endFrame();
  /// Oldest first.
  [[nodiscard]] const std::vector<Frame>& frames() const { return frames_; }

  struct {
    std::uint32_t drawn = 0;
    std::uint32_t tree = 0;
    std::uint32_t culledFrustum = 0;
    std::uint32_t culledHorizon = 0;
  } chunks;

  using Counter = std::atomic<std::uint64_t>;
  struct {
    Counter requested{0};
    Counter loaded{0};
    Counter failed{0};
    Counter cancelled{0};
    Counter bytes{0};  ///< of finished tiles
    Counter cacheHits{0};
  } tiles;

  struct {
    Counter built{0};
    Counter cached{0};
    std::atomic<double> buildMsMax{0.0};
    Counter framesWaited{0};  ///< frames in which the render thread waited for a compiler; 0 is the promise
  } programs;

  struct {
    std::uint64_t tileCache = 0;  ///< bytes in use; peak_rss is read when the figures are written
    std::uint64_t texturePool = 0;
  } memory;

  struct {
    std::uint64_t framesSettled = 0;
    std::uint64_t framesTimedOut = 0;
    double waitMs = 0.0;
  } settled;

 private:
  std::vector<Frame> frames_;
};

}  // namespace meridian

#include "host/ui/statistics_panel.h"

#include <algorithm>

#include <fmt/format.h>

namespace meridian::ui {
namespace {

double mebibytes(std::uint64_t bytes) {
  return static_cast<double>(bytes) / (1024.0 * 1024.0);
}

}  // namespace

void StatisticsPanel::frameTime(PanelBuilder& builder, std::string_view name, double Statistics::Frame::*member) {
  const auto& frames = statistics_.frames();
  recent_.clear();
  for (std::size_t i = frames.size() - std::min(frames.size(), window); i < frames.size(); ++i) {
    recent_.push_back(frames[i].*member);
  }
  if (recent_.empty()) {
    return;
  }
  std::sort(recent_.begin(), recent_.end());
  builder.text(
      fmt::format("{:<8} median {:7.2f} ms  max {:7.2f} ms", name, recent_[recent_.size() / 2], recent_.back()));
}

void StatisticsPanel::build(PanelBuilder& builder) {
  frameTime(builder, "frame", &Statistics::Frame::frame);
  frameTime(builder, "cpu", &Statistics::Frame::cpu);
  frameTime(builder, "gpu", &Statistics::Frame::gpu);
  frameTime(builder, "select", &Statistics::Frame::select);
  frameTime(builder, "upload", &Statistics::Frame::upload);

  const auto& chunks = statistics_.chunks;
  builder.text(fmt::format("chunks   {} drawn of {}; culled {} by the frustum, {} by the horizon", chunks.drawn,
                           chunks.tree, chunks.culledFrustum, chunks.culledHorizon));
  const auto& tiles = statistics_.tiles;
  builder.text(fmt::format("tiles    {} loaded of {} requested, {} cancelled, {} from memory; {:.1f} MiB",
                           tiles.loaded.load(), tiles.requested.load(), tiles.cancelled.load(), tiles.cacheHits.load(),
                           mebibytes(tiles.bytes.load())));
  if (const auto failed = tiles.failed.load(); failed > 0) {
    builder.warning(fmt::format("{} tiles failed", failed));
  }
  const auto& programs = statistics_.programs;
  builder.text(fmt::format("programs {} built, {} from the cache, longest {:.0f} ms", programs.built.load(),
                           programs.cached.load(), programs.buildMsMax.load()));
  builder.text(fmt::format("memory   tiles {:.0f} MiB, textures {:.0f} MiB", mebibytes(statistics_.memory.tileCache),
                           mebibytes(statistics_.memory.texturePool)));
}

}  // namespace meridian::ui

#pragma once

#include <string>
#include <vector>

#include "host/api/panel.h"
#include "host/api/statistics.h"

namespace meridian::ui {

/// Frame times of the last seconds, chunks, tiles, programs and memory, as they change.
class StatisticsPanel final : public Panel {
 public:
  /// How many frames back the frame times go.
  static constexpr std::size_t window = 120;

  /// `statistics` must outlive the panel.
  explicit StatisticsPanel(const Statistics& statistics) : statistics_(statistics) {}

  [[nodiscard]] std::string title() const override { return "Statistics"; }
  void build(PanelBuilder& builder) override;

 private:
  void frameTime(PanelBuilder& builder, std::string_view name, double Statistics::Frame::*member);

  const Statistics& statistics_;
  std::vector<double> recent_;
};

}  // namespace meridian::ui

#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "globebrowsing/providers/time_file_name.h"
#include "globebrowsing/providers/time_quantizer.h"
#include "host/api/error.h"
#include "host/api/time.h"
#include "host/api/value.h"

namespace meridian::globebrowsing {

struct ProviderRequest;
class TileProvider;

/// Which raster belongs to which time: what a TemporalTileProvider shows. Opened once, by a worker; immutable after
/// that and safe from any thread.
class TimeSeries {
 public:
  using Instant = Time::UtcInstant;

  /// One raster of the series, and the time during which it is shown.
  struct Entry {
    Instant instant;               ///< of the raster; names it
    std::optional<Instant> begin;  ///< nothing: since ever
    std::optional<Instant> end;    ///< nothing: for ever
  };

  virtual ~TimeSeries() = default;
  /// Whether the local data exist, without reading them.
  [[nodiscard]] virtual Result<void> check() const = 0;
  /// May read from disk.
  [[nodiscard]] virtual Result<void> open() { return {}; }
  [[nodiscard]] virtual Entry at(Instant now) const = 0;
  /// What a fixed time shows.
  [[nodiscard]] virtual Entry atFixed(Instant fixed) const = 0;
  /// The provider of an entry's tiles, unopened; `rasters` is what the keys of each are.
  [[nodiscard]] virtual Result<std::shared_ptr<TileProvider>> tiles(Instant entry,
                                                                    const ProviderRequest& rasters) const = 0;
};

/// A series of rasters that have names.
class RasterSeries : public TimeSeries {
 public:
  /// The FilePath of an entry's raster.
  [[nodiscard]] virtual Result<std::string> filePath(Instant entry) const = 0;
  [[nodiscard]] Result<std::shared_ptr<TileProvider>> tiles(Instant entry, const ProviderRequest& rasters) const final;
};

/// A text with a placeholder for the time: Mode = "Prototyped", and the older XML.
class PrototypedSeries final : public RasterSeries {
 public:
  struct Description {
    std::string start;
    std::string end;  ///< a date, "Today" or "Yesterday" (of the machine's clock, now)
    std::string resolution;
    std::string picture;    ///< for writeTime
    std::string prototype;  ///< every ${OpenSpaceTimeId} becomes the time
  };
  /// From the asset's table `Prototyped`. Errors say which key.
  [[nodiscard]] static Result<std::unique_ptr<RasterSeries>> make(const ProviderRequest& request);
  /// `where` for errors; relative files start at `folder`.
  [[nodiscard]] static Result<std::unique_ptr<RasterSeries>> make(const Description& description,
                                                                  const ProviderRequest& request);

  [[nodiscard]] Result<void> check() const override;
  [[nodiscard]] Entry at(Instant now) const override;
  [[nodiscard]] Entry atFixed(Instant fixed) const override { return {fixed, {}, {}}; }
  [[nodiscard]] Result<std::string> filePath(Instant entry) const override;

 private:
  PrototypedSeries(const TimeQuantizer& quantizer, Description description, std::string folder, std::string where)
      : quantizer_(quantizer),
        description_(std::move(description)),
        folder_(std::move(folder)),
        where_(std::move(where)) {}

  TimeQuantizer quantizer_;
  Description description_;
  std::string folder_;
  std::string where_;
};

/// The files of a folder, each with the time that its name begins with: Mode = "Folder".
class FolderSeries final : public RasterSeries {
 public:
  /// From the asset's table `Folder`. Errors say which key. A format that cannot be read is no error yet: check() and
  /// open() tell it, so that the layer stays.
  [[nodiscard]] static Result<std::unique_ptr<RasterSeries>> make(const ProviderRequest& request);

  [[nodiscard]] Result<void> check() const override;
  /// Reads the folder. Errors: a format that cannot be read; none of its files has a time.
  [[nodiscard]] Result<void> open() override;
  /// The latest that is not later; before the first, that.
  [[nodiscard]] Entry at(Instant now) const override;
  /// The first that is not earlier; after the last, that.
  [[nodiscard]] Entry atFixed(Instant fixed) const override;
  [[nodiscard]] Result<std::string> filePath(Instant entry) const override;

 private:
  struct File {
    Instant instant;
    std::string name;
  };
  FolderSeries(std::string folder, Result<TimeFileName> reader, std::string where)
      : folder_(std::move(folder)), reader_(std::move(reader)), where_(std::move(where)) {}

  std::string folder_;
  Result<TimeFileName> reader_;
  std::string where_;
  std::vector<File> files_;  ///< by time, each time once
};

}  // namespace meridian::globebrowsing

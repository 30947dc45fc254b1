#include <algorithm>

#include <fmt/format.h>

#include "globebrowsing/providers/folder_files.h"
#include "globebrowsing/providers/inner_providers.h"
#include "globebrowsing/providers/time_series.h"
#include "host/api/log.h"
#include "host/api/schema.h"

namespace meridian::globebrowsing {

namespace {

const Schema& folderSchema() {
  using Type = Schema::Type;
  static const Schema fields(
      {{"Folder", Type::String, "the folder of the files, one for each step", true},
       {"Format", Type::String, "how their names begin, as std::get_time reads it: %Y %m %d %j %H %M and other text",
        true}});
  return fields;
}

}  // namespace

Result<std::unique_ptr<RasterSeries>> FolderSeries::make(const ProviderRequest& request) {
  const ProviderRequest own = innerRequest(request, "Folder", valueAt(request.table, "Folder"));
  if (Result<void> valid = folderSchema().validate(own.table, own.where, own.path); !valid) {
    return tl::make_unexpected(std::move(valid.error()));
  }
  Result<TimeFileName> reader = TimeFileName::create(*valueAt(own.table, "Format").string());
  if (!reader) {
    reader.error().where = placeOf(own, "Format");
  }
  return std::unique_ptr<RasterSeries>(new FolderSeries(folderPath(*valueAt(own.table, "Folder").string(), own.folder),
                                                        std::move(reader), placeOf(own, "Folder")));
}

Result<void> FolderSeries::check() const {
  return reader_ ? checkFolder(folder_, where_) : tl::make_unexpected(reader_.error());
}

Result<void> FolderSeries::open() {
  if (!reader_) {
    return tl::make_unexpected(reader_.error());
  }
  Result<std::vector<std::string>> names = filesIn(folder_, where_);
  if (!names) {
    return tl::make_unexpected(std::move(names.error()));
  }
  for (std::string& name : *names) {
    if (const std::optional<Instant> instant = reader_->read(name)) {
      files_.push_back({*instant, std::move(name)});
    }
  }
  if (files_.empty()) {
    return failure(fmt::format("none of the {} files in {} has a name that fits the format", names->size(), folder_),
                   where_, "check Format; a name must begin like it");
  }
  // Of several files for one time the first by name.
  std::stable_sort(files_.begin(), files_.end(), [](const File& a, const File& b) { return a.instant < b.instant; });
  const auto same =
      std::unique(files_.begin(), files_.end(), [](const File& a, const File& b) { return a.instant == b.instant; });
  if (same != files_.end()) {
    log::warning("{}: {} files in {} have the time of another, and are not shown", where_, files_.end() - same,
                 folder_);
  }
  files_.erase(same, files_.end());
  return {};
}

TimeSeries::Entry FolderSeries::at(Instant now) const {
  const auto later = std::upper_bound(files_.begin(), files_.end(), now,
                                      [](Instant instant, const File& file) { return instant < file.instant; });
  const auto shown = later == files_.begin() ? later : later - 1;
  const auto next = shown + 1;
  return {shown->instant, shown == files_.begin() ? std::nullopt : std::optional(shown->instant),
          next == files_.end() ? std::nullopt : std::optional(next->instant)};
}

TimeSeries::Entry FolderSeries::atFixed(Instant fixed) const {
  const auto found = std::lower_bound(files_.begin(), files_.end(), fixed,
                                      [](const File& file, Instant instant) { return file.instant < instant; });
  return {found == files_.end() ? files_.back().instant : found->instant, {}, {}};
}

Result<std::string> FolderSeries::filePath(Instant entry) const {
  const auto found = std::lower_bound(files_.begin(), files_.end(), entry,
                                      [](const File& file, Instant instant) { return file.instant < instant; });
  if (found == files_.end() || found->instant != entry) {
    return failure("there is no file of that time in " + folder_, where_);
  }
  return folder_ + '/' + found->name;
}

}  // namespace meridian::globebrowsing

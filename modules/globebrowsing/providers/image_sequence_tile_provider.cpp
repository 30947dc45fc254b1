#include "globebrowsing/providers/image_sequence_tile_provider.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "globebrowsing/providers/folder_files.h"

namespace meridian::globebrowsing {

namespace {
constexpr double mostImages = 1e6;
}

const Schema& ImageSequenceTileProvider::schema() {
  using Type = Schema::Type;
  static const Schema fields(
      {{"FolderPath", Type::String, "a folder of images, shown in the order of their names", true},
       {"Index", Type::Integer, "the image to begin with, from 0", false, 0.0, mostImages}});
  return fields;
}

Result<std::shared_ptr<TileProvider>> ImageSequenceTileProvider::make(const ProviderRequest& request) {
  if (Result<ProviderPointer> raster = makeInner(rasterRequest(request, "image.png")); !raster) {
    return raster;
  }
  return std::make_shared<ImageSequenceTileProvider>(
      request, folderPath(*valueAt(request.table, "FolderPath").string(), request.folder),
      static_cast<int>(valueAt(request.table, "Index").number().value_or(0.0)));
}

ImageSequenceTileProvider::ImageSequenceTileProvider(ProviderRequest request, std::string folder, int first)
    : index({"Index", "Index", "Which image is shown, from 0"}, first, 0, static_cast<int>(mostImages)),
      request_(std::move(request)),
      folder_(std::move(folder)) {
  for (Property* property : std::initializer_list<Property*>{&index, &numberImages, &currentImage}) {
    owner_.addProperty(*property);
  }
}

Result<void> ImageSequenceTileProvider::check() const {
  return checkFolder(folder_, placeOf(request_, "FolderPath"));
}

Result<void> ImageSequenceTileProvider::openData() {
  const std::string where = placeOf(request_, "FolderPath");
  return filesIn(folder_, where).and_then([&](std::vector<std::string> files) -> Result<void> {
    if (files.empty()) {
      return failure("the folder " + folder_ + " has no files", where, "put images into it");
    }
    files_ = std::move(files);
    return {};
  });
}

std::size_t ImageSequenceTileProvider::current() const {
  return std::min(static_cast<std::size_t>(index.get()), files_.size() - 1);
}

TileStep ImageSequenceTileProvider::at(const Time& /*now*/) const {
  numberImages.put(static_cast<int>(files_.size()));
  if (currentImage.get() != files_[current()]) {
    currentImage.put(files_[current()]);
  }
  TileStep step;
  step.id = current();
  return step;
}

Result<std::shared_ptr<TileProvider>> ImageSequenceTileProvider::make(const Time& /*now*/) const {
  return makeInner(rasterRequest(request_, folder_ + '/' + files_[current()]));
}

}  // namespace meridian::globebrowsing

#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>

#include "globebrowsing/source/resample.h"
#include "host/api/error.h"

namespace meridian::globebrowsing {

/// Colours by value: a row of colours spread evenly over 0 to 1, linear between them. Immutable.
class Colormap {
 public:
  /// The first row of an image, or where that is one pixel wide, its column. Blocking. Errors: no such file, more than
  /// 1 MiB, no image that is read here.
  [[nodiscard]] static Result<std::shared_ptr<const Colormap>> read(const std::string& path, const std::string& where);

  /// Red, green, blue of each of the values 0/255 to 255/255.
  [[nodiscard]] const std::array<std::array<std::uint8_t, 3>, 256>& colours() const { return colours_; }
  /// Each pixel gets the colour of its red as value; alpha stays.
  void apply(ColourPixels& pixels) const;

 private:
  std::array<std::array<std::uint8_t, 3>, 256> colours_{};
};

}  // namespace meridian::globebrowsing

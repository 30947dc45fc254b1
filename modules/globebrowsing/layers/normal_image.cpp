#include "globebrowsing/layers/normal_image.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include <glm/common.hpp>

namespace meridian::globebrowsing {

namespace {

struct Corner {
  int column = 0;
  int row = 0;
};

/// Level 0 fills the width; the others stand side by side below it.
Corner cornerOf(int level) {
  Corner corner;
  for (int above = 0; above < level; ++above) {
    corner = above == 0 ? Corner{0, NormalImage::nodes}
                        : Corner{corner.column + NormalImage::nodesAt(above), NormalImage::nodes};
  }
  return corner;
}

std::size_t place(int level, int column, int row) {
  const Corner corner = cornerOf(level);
  return static_cast<std::size_t>(corner.row + row) * NormalImage::width +
         static_cast<std::size_t>(corner.column + column);
}

std::uint8_t signedByte(double value) {
  return static_cast<std::uint8_t>(128 + std::lround(std::clamp(value, -1.0, 1.0) * 127.0));
}

/// From `nodes` a side to half as many, weights 1 2 1 each way.
std::vector<glm::dvec3> halved(const std::vector<glm::dvec3>& fine, int nodes) {
  const int coarse = (nodes - 1) / 2 + 1;
  std::vector<glm::dvec3> out;
  out.reserve(static_cast<std::size_t>(coarse) * static_cast<std::size_t>(coarse));
  for (int row = 0; row < coarse; ++row) {
    const int down = row == 0 || row == coarse - 1 ? 0 : 1;
    for (int column = 0; column < coarse; ++column) {
      const int across = column == 0 || column == coarse - 1 ? 0 : 1;
      glm::dvec3 sum(0.0);
      double weights = 0.0;
      for (int j = -down; j <= down; ++j) {
        for (int i = -across; i <= across; ++i) {
          const double weight = (2.0 - std::abs(i)) * (2.0 - std::abs(j));
          sum += weight * fine[static_cast<std::size_t>(2 * row + j) * static_cast<std::size_t>(nodes) +
                               static_cast<std::size_t>(2 * column + i)];
          weights += weight;
        }
      }
      out.push_back(sum / weights);
    }
  }
  return out;
}

}  // namespace

glm::vec4 NormalImage::transform(int level) {
  const Corner corner = cornerOf(level);
  const double span = nodesAt(level) - 1;
  return glm::vec4((corner.column + 0.5) / width, (corner.row + 0.5) / height, span / width, span / height);
}

NormalImage::NormalImage(const std::vector<glm::dvec3>& offsets) {
  assert(offsets.size() == static_cast<std::size_t>(nodes) * nodes);
  for (const glm::dvec3& offset : offsets) {
    const glm::dvec3 size = glm::abs(offset);
    scale_ = std::max({scale_, size.x, size.y, size.z});
  }
  texels_.resize(static_cast<std::size_t>(width) * height);
  store(0, offsets);
  std::vector<glm::dvec3> coarser = offsets;
  for (int level = 1; level < levels; ++level) {
    coarser = halved(coarser, nodesAt(level - 1));
    store(level, coarser);
  }
}

void NormalImage::store(int level, const std::vector<glm::dvec3>& offsets) {
  const double unit = scale_ > 0.0 ? 1.0 / scale_ : 0.0;
  const int side = nodesAt(level);
  auto from = offsets.begin();
  for (int row = 0; row < side; ++row) {
    for (int column = 0; column < side; ++column, ++from) {
      texels_[place(level, column, row)] = {signedByte(from->x * unit), signedByte(from->y * unit),
                                            signedByte(from->z * unit), 0};
    }
  }
}

const NormalImage::Texel& NormalImage::texel(int level, int column, int row) const {
  return texels_[place(level, column, row)];
}

}  // namespace meridian::globebrowsing

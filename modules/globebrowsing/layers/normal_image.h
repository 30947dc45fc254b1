#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

namespace meridian::globebrowsing {

/// The normals of one tile as an image that a shader can sample: unit surface normal minus the ellipsoid's, in model
/// space, at every node, and beside it the same at half, a quarter and an eighth as many nodes a side, for a tile that
/// is shown small. (All in one image, because software renderers take mip levels for the whole of an array.)
///
/// Each component is stored as (value - 128) / 127 * scale(), so that 0 is exact and gentle tiles get the finest steps;
/// in bytes, because software renderers filter them several times faster than anything wider.
class NormalImage {
 public:
  using Texel = std::array<std::uint8_t, 4>;  ///< the fourth is 0
  static constexpr int levels = 4;
  static constexpr int nodes = 129;  ///< a side, of level 0
  static constexpr int width = nodes;
  static constexpr int height = nodes + nodes / 2 + 1;
  /// Nodes a side: 129, 65, 33, 17.
  [[nodiscard]] static constexpr int nodesAt(int level) { return ((nodes - 1) >> level) + 1; }
  /// Texture coordinate = xy + zw * unit square; never reaches beyond the outermost texels' centres.
  [[nodiscard]] static glm::vec4 transform(int level);

  NormalImage() = default;
  /// `offsets`: nodes x nodes, rows from the north. Coarser levels are the means of their surroundings; on an edge of
  /// the nodes along it, and at a corner of the corner alone, so that neighbours agree.
  explicit NormalImage(const std::vector<glm::dvec3>& offsets);

  /// width x height, rows from the north.
  [[nodiscard]] std::span<const Texel> texels() const { return texels_; }
  [[nodiscard]] const Texel& texel(int level, int column, int row) const;
  /// The largest component of any offset; 0 for a flat tile.
  [[nodiscard]] double scale() const { return scale_; }
  [[nodiscard]] std::size_t bytes() const { return texels_.size() * sizeof(Texel); }

 private:
  void store(int level, const std::vector<glm::dvec3>& offsets);

  std::vector<Texel> texels_;
  double scale_ = 0.0;
};

}  // namespace meridian::globebrowsing

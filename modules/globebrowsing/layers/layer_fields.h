#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace meridian::globebrowsing {

class Layer;

/// The GLSL types that a field may have.
enum class GlslType : unsigned char { Int, Float, Vec2, Vec3, Vec4 };
[[nodiscard]] std::string_view glslName(GlslType type);

/// One member of the GLSL struct that describes a layer to a shader.
struct LayerField {
  std::string name;
  GlslType type = GlslType::Float;
  /// Writes the field of that layer (the size of its type) there.
  void (*write)(const Layer& layer, std::byte* to) = nullptr;
  std::size_t offset = 0;  ///< in bytes from the start of the struct, by the rules of std140
};

/// The one description of a layer that shaders get: the GLSL struct, the buffer's layout and its contents are all made
/// from this table. Adding a field is one line in layer_fields.cpp.
class LayerFields {
 public:
  /// Takes the fields in order and lays them out.
  explicit LayerFields(std::vector<LayerField> fields);

  [[nodiscard]] const std::vector<LayerField>& fields() const { return fields_; }
  /// Bytes from one layer to the next in an array of layers; a multiple of 16.
  [[nodiscard]] std::size_t stride() const { return stride_; }
  /// Writes one layer; `to` has at least stride() bytes, padding is left alone.
  void write(const Layer& layer, std::span<std::byte> to) const;

 private:
  std::vector<LayerField> fields_;
  std::size_t stride_ = 0;
};

/// The fields of this program. Constant, safe from any thread.
[[nodiscard]] const LayerFields& layerFields();

}  // namespace meridian::globebrowsing

#include "globebrowsing/layers/layer_fields.h"

#include <cassert>
#include <cstdint>
#include <cstring>
#include <optional>
#include <type_traits>
#include <utility>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "globebrowsing/layers/layer.h"

namespace meridian::globebrowsing {

namespace {

template <class T>
constexpr std::optional<GlslType> glslTypeOf() {
  if constexpr (std::is_same_v<T, std::int32_t>) {
    return GlslType::Int;
  } else if constexpr (std::is_same_v<T, float>) {
    return GlslType::Float;
  } else if constexpr (std::is_same_v<T, glm::vec2>) {
    return GlslType::Vec2;
  } else if constexpr (std::is_same_v<T, glm::vec3>) {
    return GlslType::Vec3;
  } else if constexpr (std::is_same_v<T, glm::vec4>) {
    return GlslType::Vec4;
  }
  return std::nullopt;
}

/// A field whose GLSL type is that of what `Read`, a function without captures, returns.
template <class Read>
LayerField field(std::string name, Read /*read*/) {
  using T = std::invoke_result_t<Read, const Layer&>;
  constexpr std::optional<GlslType> type = glslTypeOf<T>();
  static_assert(type, "no GLSL type for this field");
  return {std::move(name), *type, [](const Layer& layer, std::byte* to) {
            const T value = Read{}(layer);
            std::memcpy(to, &value, sizeof(value));
          }};
}

/// Size and base alignment by OpenGL 4.5, section 7.6.2.2 (std140).
struct Std140 {
  std::size_t size;
  std::size_t alignment;
};

Std140 std140(GlslType type) {
  switch (type) {
    case GlslType::Int:
    case GlslType::Float:
      return {4, 4};
    case GlslType::Vec2:
      return {8, 8};
    case GlslType::Vec3:
      return {12, 16};
    case GlslType::Vec4:
      return {16, 16};
  }
  return {16, 16};
}

std::size_t roundUp(std::size_t value, std::size_t multiple) {
  return (value + multiple - 1) / multiple * multiple;
}

}  // namespace

std::string_view glslName(GlslType type) {
  switch (type) {
    case GlslType::Int:
      return "int";
    case GlslType::Float:
      return "float";
    case GlslType::Vec2:
      return "vec2";
    case GlslType::Vec3:
      return "vec3";
    case GlslType::Vec4:
      return "vec4";
  }
  return "vec4";
}

LayerFields::LayerFields(std::vector<LayerField> fields) : fields_(std::move(fields)) {
  std::size_t end = 0;
  for (LayerField& field : fields_) {
    const Std140 layout = std140(field.type);
    field.offset = roundUp(end, layout.alignment);
    end = field.offset + layout.size;
  }
  stride_ = roundUp(end, 16);  // rule 9: a structure is aligned to vec4, and so is the next in an array
}

void LayerFields::write(const Layer& layer, std::span<std::byte> to) const {
  assert(to.size() >= stride_);
  for (const LayerField& field : fields_) {
    field.write(layer, to.data() + field.offset);
  }
}

const LayerFields& layerFields() {
  // A float after a vec3 fills its row of 16 bytes.
  static const LayerFields fields({
      field("colour", [](const Layer& layer) { return glm::vec3(layer.ownColour()); }),
      field("opacity", [](const Layer& layer) { return static_cast<float>(layer.effectiveOpacity()); }),
      field("chromaKeyColour", [](const Layer& layer) { return glm::vec3(layer.chromaKeyColour.get()); }),
      field("chromaKeyTolerance",
            [](const Layer& layer) { return static_cast<float>(layer.chromaKeyTolerance.get()); }),
      field(
          "relief",
          [](const Layer& layer) { return layer.relief() != nullptr ? layer.relief()->parameters : glm::vec4(0.0F); }),
      field("gamma", [](const Layer& layer) { return static_cast<float>(layer.gamma.get()); }),
      field("multiplier", [](const Layer& layer) { return static_cast<float>(layer.multiplier.get()); }),
      field("offset", [](const Layer& layer) { return static_cast<float>(layer.offset.get()); }),
      field("blendMode", [](const Layer& layer) { return static_cast<std::int32_t>(layer.blend()); }),
      field("adjustment", [](const Layer& layer) { return static_cast<std::int32_t>(layer.adjustment()); }),
      field("sampling", [](const Layer& layer) { return static_cast<std::int32_t>(layer.sampling()); }),
  });
  return fields;
}

}  // namespace meridian::globebrowsing

#include "globebrowsing/layers/layer_glsl.h"

#include <fmt/format.h>

#include "globebrowsing/layers/layer_group.h"

namespace meridian::globebrowsing {

std::string glslStruct(const LayerFields& fields, std::string_view name) {
  std::string text = fmt::format("struct {} {{\n", name);
  for (const LayerField& field : fields.fields()) {
    text += fmt::format("  {} {};\n", glslName(field.type), field.name);
  }
  return text + "};\n";
}

std::string glslLayerBlock(const GlslLayerBlock& block) {
  return fmt::format("layout(std140, binding = {}) uniform {} {{\n  {} {}[{}];\n}};\n", block.binding, block.name,
                     block.structName, block.arrayName, block.count);
}

std::string glslLayerConstants() {
  std::string text;
  int number = 0;
  for (const std::string& mode : blendModeNames()) {
    text += fmt::format("const int blendMode{} = {};\n", mode, number++);
  }
  number = 0;
  for (const std::string& adjustment : adjustmentNames()) {
    text += fmt::format("const int adjustment{} = {};\n", adjustment, number++);
  }
  for (const Sampling sampling : allSamplings) {
    text += fmt::format("const int sampling{} = {};\n", name(sampling), static_cast<int>(sampling));
  }
  return text;
}

}  // namespace meridian::globebrowsing

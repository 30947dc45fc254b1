// One layer onto those below it. Needs blend.glsl and the generated struct Layer before it. A program made for one
// structure passes constants for mode and adjustment, which the compiler folds; the one that loops over the layers
// passes layer.blendMode and layer.adjustment. `unchanged`, always a constant, says that gamma, multiplier and offset
// are those that change nothing.
// `sampled`: of the layer's tile, not premultiplied; vec4(layer.colour, 1) for a SolidColor layer.

vec4 composeLayer(Layer layer, int mode, int adjustment, bool unchanged, vec4 sampled, vec4 below) {
  vec4 colour = sampled;
  if (adjustment == adjustmentChromaKey) {
    colour = chromaKey(colour, layer.chromaKeyColour, layer.chromaKeyTolerance);
  }
  if (!unchanged) {
    colour = applySettings(colour, layer.gamma, layer.multiplier, layer.offset);
  }
  return blend(mode, below, vec4(rgbOf(colour), colour.w * layer.opacity));
}

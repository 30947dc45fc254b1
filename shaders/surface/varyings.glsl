// What vertices hand to fragments; VARYING is `out` for those and `in` for these. As few as possible: a software
// renderer sets each up for every triangle.
layout(location = 0) VARYING vec4 baseAndNormals;         // texture coordinates
layout(location = 1) flat VARYING vec3 baseNormalsScale;  // layers of base composite and normals; Chunk.normalScale
#if SHADING
layout(location = 2) VARYING vec3 vertical;
#endif
#if NIGHT || OVERLAY
layout(location = 3) VARYING vec4 nightAndOverlay;        // texture coordinates
layout(location = 4) flat VARYING vec2 nightOverlayLayers;
#endif
#if EDGES
layout(location = 5) VARYING vec2 unitSquare;
layout(location = 6) flat VARYING float level;
#endif
#if WATER
layout(location = 7) VARYING vec3 fromEye;
#endif
#if FADE
layout(location = 8) flat VARYING vec2 other;  // Chunk.otherLayer and otherWeight
#endif

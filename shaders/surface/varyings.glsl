// What vertices hand to fragments; VARYING is `out` for those and `in` for these. As few as possible: a software
// renderer sets each up for every triangle.
layout(location = 0) VARYING vec4 baseAndNormals;         // texture coordinates
layout(location = 1) flat VARYING vec2 baseNormalsLayers; // of base composite and normals
#if SHADING
layout(location = 2) VARYING float sunOnEllipsoid;        // ellipsoid's normal . light
#if ACCURATE_NORMALS
layout(location = 3) flat VARYING vec4 sunOnOffset;       // normal offset . light = xyz . texel + w
#endif
#endif
#if NIGHT || WATER
layout(location = 4) VARYING vec3 vertical;
#endif
#if NIGHT || OVERLAY
layout(location = 5) VARYING vec4 nightAndOverlay;        // texture coordinates
layout(location = 6) flat VARYING vec2 nightOverlayLayers;
#endif
#if EDGES
layout(location = 7) VARYING vec2 unitSquare;
layout(location = 8) flat VARYING float level;
#endif
#if WATER
layout(location = 9) VARYING vec3 fromEye;
#endif
#if FADE
layout(location = 10) flat VARYING vec2 other;  // Chunk.otherLayer and otherWeight
#endif

// What vertices hand to fragments; VARYING is `out` for those and `in` for these.
layout(location = 0) VARYING vec4 baseAndNormals;   // texture coordinates
layout(location = 1) flat VARYING vec4 layers;      // as Chunk.layers
#if SHADING
layout(location = 2) VARYING vec3 vertical;
layout(location = 3) flat VARYING float normalScale;
#endif
#if NIGHT || OVERLAY
layout(location = 4) VARYING vec4 nightAndOverlay;  // texture coordinates
#endif
#if EDGES
layout(location = 5) VARYING vec2 unitSquare;
layout(location = 6) flat VARYING float level;
#endif

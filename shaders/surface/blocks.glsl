// What gpu/chunk_blocks.h declares for C++, field by field.
layout(std140, binding = 0) uniform ViewBlock {
    mat4 clipFromRelative;  // from model axes with their origin at the eye
    vec3 lightDirection;    // unit, model axes, towards the light
    float ambient;
    float opacity;
    float waterReflectance;
} view;

struct Chunk {
    vec4 corners[4];        // north-west, north-east, south-west, south-east; relative to the eye, model axes
    vec4 base;              // composite's texture coordinate = xy + zw * unit square
    vec4 night;
    vec4 overlay;
    vec4 normals;           // the same, of the normals' image
    vec4 layers;            // of the composites' array: base, night, overlay (below 0: none); w: of the normals' array
    float skirt;            // metres
    float level;
    float normalScale;      // normal offset = (texel * 255 - 128) / 127 * this
    float flare;            // metres: how far a skirt's foot stands out
    float lift;             // metres: by how much all vertices are raised
    float otherLayer;       // array layer of the composite that the fading one is mixed with
    float otherWeight;      // how much of it, 0 to 1
};

// Those of one call, in its order. As many as in chunk_blocks.h; 16 KiB is what every driver has.
layout(std140, binding = 1) uniform ChunkBlock {
    Chunk chunks[64];
};

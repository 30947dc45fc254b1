#version 450 core

// The next smaller level of a composite: each texel the mean of four. `larger` is a view of one level.
layout(binding = 0) uniform sampler2DArray larger;
layout(location = 0) uniform int layer;
layout(location = 0) out vec4 colour;

void main() {
    ivec3 corner = ivec3(2 * ivec2(gl_FragCoord.xy), layer);
    colour = 0.25 * (texelFetch(larger, corner, 0) + texelFetch(larger, corner + ivec3(1, 0, 0), 0) +
                     texelFetch(larger, corner + ivec3(0, 1, 0), 0) + texelFetch(larger, corner + ivec3(1, 1, 0), 0));
}

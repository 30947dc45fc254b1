#version 450 core

// The next smaller level of a composite: each texel the mean of four. The source is a view of one level and one layer.
layout(binding = 0) uniform sampler2D larger;
layout(location = 0) out vec4 colour;

void main() {
    ivec2 corner = 2 * ivec2(gl_FragCoord.xy);
    colour = 0.25 * (texelFetch(larger, corner, 0) + texelFetch(larger, corner + ivec2(1, 0), 0) +
                     texelFetch(larger, corner + ivec2(0, 1), 0) + texelFetch(larger, corner + ivec2(1, 1), 0));
}

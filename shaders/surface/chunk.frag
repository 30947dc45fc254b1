#version 450 core
#{defines}

#include "surface/blocks.glsl"

layout(binding = 0) uniform sampler2DArray composites;
#if SHADING && ACCURATE_NORMALS
layout(binding = 1) uniform sampler2DArray normalOffsets;
#endif

layout(location = 0) in vec2 unitSquare;
#if SHADING
layout(location = 1) in vec3 vertical;
#endif

layout(location = 0) out vec4 colour;

vec4 composite(vec4 transform, float layer) {
    return texture(composites, vec3(transform.xy + transform.zw * unitSquare, layer));
}

void main() {
    // Without any composite the grey that composition starts from.
    vec3 lit = chunk.layers.x < 0.0 ? vec3(0.3) : composite(chunk.base, chunk.layers.x).rgb;
#if SHADING
    vec3 normal = vertical;
#if ACCURATE_NORMALS
    // Node-registered: the first and last of the 129 texel centres lie on the edges.
    vec3 texel = texture(normalOffsets, vec3(unitSquare * (128.0 / 129.0) + 0.5 / 129.0, chunk.layers.w)).xyz;
    normal += (texel * (255.0 / 127.0) - 128.0 / 127.0) * chunk.normalScale;
#endif
    normal = normalize(normal);
    lit *= min(view.ambient + max(dot(normal, view.lightDirection), 0.0), 1.0);
#if NIGHT
    if (chunk.layers.y >= 0.0) {
        vec4 night = composite(chunk.night, chunk.layers.y);
        float darkness = clamp(-3.0 * dot(normalize(normalize(vertical) - 0.2 * view.lightDirection), view.lightDirection), 0.0, 1.0);
        lit = mix(lit, night.rgb, night.a * darkness * max(night.r, max(night.g, night.b)));
    }
#endif
#endif
#if OVERLAY
    if (chunk.layers.z >= 0.0) {
        vec4 overlay = composite(chunk.overlay, chunk.layers.z);
        lit = mix(lit, overlay.rgb, overlay.a);
    }
#endif
#if EDGES
    vec2 toEdge = min(unitSquare, 1.0 - unitSquare) / fwidth(unitSquare);
    if (min(toEdge.x, toEdge.y) < 1.0) {
        lit = mix(vec3(1.0, 0.2, 0.1), vec3(0.1, 0.4, 1.0), fract(chunk.level / 4.0));
    }
#endif
    colour = vec4(lit, view.opacity);
}

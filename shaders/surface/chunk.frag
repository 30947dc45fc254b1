#version 450 core
#{defines}

#include "surface/blocks.glsl"

layout(binding = 0) uniform sampler2DArray composites;
#if SHADING && ACCURATE_NORMALS
layout(binding = 1) uniform sampler2DArray normalOffsets;
#endif

#define VARYING in
#include "surface/varyings.glsl"

layout(location = 0) out vec4 colour;

#if FADE
#include "surface/fade.glsl"
#endif
#if WATER
#include "surface/water.glsl"
#endif

void main() {
    // Without any composite the grey that composition starts from.
    float base = baseNormalsLayers.x;
#if FADE == FADE_BASE
    vec4 ground = base < 0.0 ? vec4(vec3(0.3), 1.0) : mixed(baseAndNormals.xy, base);
#else
    vec4 ground = base < 0.0 ? vec4(vec3(0.3), 1.0) : texture(composites, vec3(baseAndNormals.xy, base));
#endif
    vec3 lit = ground.rgb;
#if SHADING
    // The normal that filtering gives is not brought back to unit length: light on the mean of normals is the mean of the
    // light on them.
    float sun = sunOnEllipsoid;
#if ACCURATE_NORMALS
    sun += dot(texture(normalOffsets, vec3(baseAndNormals.zw, baseNormalsLayers.y)).xyz, sunOnOffset.xyz) + sunOnOffset.w;
#endif
    lit *= min(view.ambient + max(sun, 0.0), 1.0);
#if WATER
    float glint = view.waterReflectance * sunGlint(normalize(vertical), -normalize(fromEye), view.lightDirection);
    lit = mix(withLight(lit, glint), lit, ground.a);
#endif
#if NIGHT
    if (nightOverlayLayers.x >= 0.0) {
#if FADE == FADE_NIGHT
        vec4 night = mixedByAlpha(nightAndOverlay.xy, nightOverlayLayers.x);
#else
        vec4 night = texture(composites, vec3(nightAndOverlay.xy, nightOverlayLayers.x));
#endif
        float darkness = clamp(-3.0 * dot(normalize(normalize(vertical) - 0.2 * view.lightDirection), view.lightDirection), 0.0, 1.0);
        lit = mix(lit, night.rgb, night.a * darkness * max(night.r, max(night.g, night.b)));
    }
#endif
#endif
#if OVERLAY
    if (nightOverlayLayers.y >= 0.0) {
#if FADE == FADE_OVERLAY
        vec4 overlay = mixedByAlpha(nightAndOverlay.zw, nightOverlayLayers.y);
#else
        vec4 overlay = texture(composites, vec3(nightAndOverlay.zw, nightOverlayLayers.y));
#endif
        lit = mix(lit, overlay.rgb, overlay.a);
    }
#endif
#if EDGES
    vec2 toEdge = min(unitSquare, 1.0 - unitSquare) / fwidth(unitSquare);
    if (min(toEdge.x, toEdge.y) < 1.0) {
        lit = mix(vec3(1.0, 0.2, 0.1), vec3(0.1, 0.4, 1.0), fract(level / 4.0));
    }
#endif
    colour = vec4(lit, view.opacity);
}

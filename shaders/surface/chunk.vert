#version 450 core
#extension GL_ARB_shader_draw_parameters : require
#{defines}

#include "surface/blocks.glsl"

layout(location = 0) in vec4 offsetAndHeight;
layout(location = 1) in vec3 ellipsoidNormal;
layout(location = 2) in vec4 place;  // column and row of the 32 x 32 grid, 1 at the foot of a skirt

#define VARYING out
#include "surface/varyings.glsl"

void main() {
    vec2 uv = place.xy / 32.0;
    vec3 northWest = chunks[gl_DrawIDARB].corners[0].xyz;
    vec3 northEast = chunks[gl_DrawIDARB].corners[1].xyz;
    vec3 southWest = chunks[gl_DrawIDARB].corners[2].xyz;
    vec3 southEast = chunks[gl_DrawIDARB].corners[3].xyz;
    vec3 patchPoint = mix(mix(northWest, northEast, uv.x), mix(southWest, southEast, uv.x), uv.y);
    float height = offsetAndHeight.w + chunks[gl_DrawIDARB].lift - place.z * chunks[gl_DrawIDARB].skirt;
    vec3 position = patchPoint + offsetAndHeight.xyz + height * ellipsoidNormal;
    // A parallel bends along the surface, too: beside a denser neighbour a gap can open that is seen from straight above,
    // so the skirt's foot stands out under the neighbour.
    vec3 middle = 0.25 * (northWest + northEast + southWest + southEast);
    position += place.z * chunks[gl_DrawIDARB].flare * normalize(position - middle);
    gl_Position = view.clipFromRelative * vec4(position, 1.0);

    vec4 base = chunks[gl_DrawIDARB].base;
    vec4 normals = chunks[gl_DrawIDARB].normals;
    baseAndNormals = vec4(base.xy + base.zw * uv, normals.xy + normals.zw * uv);
    vec4 layers = chunks[gl_DrawIDARB].layers;
    baseNormalsLayers = layers.xw;
#if SHADING
    sunOnEllipsoid = dot(ellipsoidNormal, view.lightDirection);
#if ACCURATE_NORMALS
    vec3 scaled = chunks[gl_DrawIDARB].normalScale / 127.0 * view.lightDirection;
    sunOnOffset = vec4(255.0 * scaled, -128.0 * (scaled.x + scaled.y + scaled.z));
#endif
#endif
#if NIGHT || WATER
    vertical = ellipsoidNormal;
#endif
#if NIGHT || OVERLAY
    vec4 night = chunks[gl_DrawIDARB].night;
    vec4 overlay = chunks[gl_DrawIDARB].overlay;
    nightOverlayLayers = layers.yz;
    nightAndOverlay = vec4(night.xy + night.zw * uv, overlay.xy + overlay.zw * uv);
#endif
#if WATER
    fromEye = position;
#endif
#if FADE
    other = vec2(chunks[gl_DrawIDARB].otherLayer, chunks[gl_DrawIDARB].otherWeight);
#endif
#if EDGES
    unitSquare = uv;
    level = chunks[gl_DrawIDARB].level;
#endif
}

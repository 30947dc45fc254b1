#version 450 core
#{defines}

#include "surface/blocks.glsl"

layout(location = 0) in vec4 offsetAndHeight;
layout(location = 1) in vec3 ellipsoidNormal;
layout(location = 2) in vec4 place;  // column and row of the 32 x 32 grid, 1 at the foot of a skirt

layout(location = 0) out vec2 unitSquare;
#if SHADING
layout(location = 1) out vec3 vertical;
#endif

void main() {
    vec2 uv = place.xy / 32.0;
    vec3 north = mix(chunk.corners[0].xyz, chunk.corners[1].xyz, uv.x);
    vec3 south = mix(chunk.corners[2].xyz, chunk.corners[3].xyz, uv.x);
    float height = offsetAndHeight.w + chunk.lift - place.z * chunk.skirt;
    vec3 position = mix(north, south, uv.y) + offsetAndHeight.xyz + height * ellipsoidNormal;
    // A parallel bends along the surface, too: beside a denser neighbour a gap can open that is seen from straight above,
    // so the skirt's foot stands out under the neighbour.
    vec3 middle = 0.25 * (chunk.corners[0].xyz + chunk.corners[1].xyz + chunk.corners[2].xyz + chunk.corners[3].xyz);
    position += place.z * chunk.flare * normalize(position - middle);
    gl_Position = view.clipFromRelative * vec4(position, 1.0);
    unitSquare = uv;
#if SHADING
    vertical = ellipsoidNormal;
#endif
}

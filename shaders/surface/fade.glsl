// Two composites, mixed while one of their layers fades. Any opacity of a layer between two is a mixture of those two
// where colours are multiplied by their alpha (layers/layer_opacities.h).

vec4 mixed(vec2 at, float layer) {
    return mix(texture(composites, vec3(at, layer)), texture(composites, vec3(at, other.x)), other.y);
}

vec4 mixedByAlpha(vec2 at, float layer) {
    vec4 from = texture(composites, vec3(at, layer));
    vec4 to = texture(composites, vec3(at, other.x));
    vec4 sum = mix(vec4(from.rgb * from.a, from.a), vec4(to.rgb * to.a, to.a), other.y);
    return vec4(sum.rgb / max(sum.a, 1e-4), sum.a);
}

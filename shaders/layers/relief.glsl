// Colours made from composed heights, as `gdaldem` makes them. What the parts of `parameters` are:
// modules/globebrowsing/providers/relief_style.h.
// `normal`: east and north component of the surface's unit normal.

float slopeOf(vec2 normal) {
    float flatness = dot(normal, normal);
    return sqrt(flatness / max(1.0 - flatness, 1e-9));
}

// 1 to 255: gdaldem keeps 0 for no data.
vec3 hillshade(vec4 parameters, vec2 normal) {
    float up = sqrt(max(1.0 - dot(normal, normal), 1e-9));
    float lit = dot(normalize(vec3(parameters.w * normal, up)), parameters.xyz);
    return vec3((1.0 + 254.0 * max(lit, 0.0)) / 255.0);
}

// How much of a pixel the line covers; `around`: the least and the greatest height as far away as a line reaches;
// `pixel`: metres. Where nothing rises there is no line, whatever the height, nor where a slope ends before it gets
// there; and where lines are so close that nobody could tell them apart they fade.
float isolineCoverage(vec4 parameters, float height, vec2 around, float slope, float pixel) {
    float rise = slope * pixel;
    if (rise < 1e-6 * (1.0 + abs(height))) {
        return 0.0;
    }
    float interval = parameters.x;
    float width = parameters.y;
    float line = interval * round(height / interval);
    if (line < around.x || line > around.y) {
        return 0.0;
    }
    float distance = abs(height - line) / rise;
    float room = interval / (rise * width);
    return parameters.z * clamp(0.5 * (width + 1.0) - distance, 0.0, 1.0) * clamp(room - 1.0, 0.0, 1.0);
}

// `ramps`: gpu/relief_textures.h. Of at most 256 stops eight halvings leave one.
vec4 rampColour(sampler2D ramps, int row, int stops, float value) {
    int low = 0;
    int high = stops - 1;
    for (int n = 0; n < 8; ++n) {
        int middle = (low + high + 1) / 2;
        bool above = texelFetch(ramps, ivec2(2 * middle + 1, row), 0).x <= value;
        low = above ? middle : low;
        high = above ? high : max(middle - 1, low);
    }
    int next = min(low + 1, stops - 1);
    float first = texelFetch(ramps, ivec2(2 * low + 1, row), 0).x;
    float last = texelFetch(ramps, ivec2(2 * next + 1, row), 0).x;
    float share = last > first ? clamp((value - first) / (last - first), 0.0, 1.0) : 0.0;
    return mix(texelFetch(ramps, ivec2(2 * low, row), 0), texelFetch(ramps, ivec2(2 * next, row), 0), share);
}

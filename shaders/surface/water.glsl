// The Sun on water, as reflected by facets whose slopes are distributed as measured over the sea by Cox and Munk (1954;
// here alike in all directions, in a breeze of 5 m/s), which mask each other (Cook and Torrance 1982) and reflect by
// Schlick's approximation of Fresnel's law. In units of what a white Lambertian surface shows in full sunlight. All
// vectors are of length 1.

float sunGlint(vec3 normal, vec3 toEye, vec3 toSun) {
    const float slopeVariance = 0.003 + 0.00512 * 5.0;  // mean square slope
    const float reflectanceAlongNormal = 0.02;          // refractive index 1.33
    float sun = dot(normal, toSun);
    float eye = dot(normal, toEye);
    if (sun <= 0.0 || eye <= 0.0) {
        return 0.0;
    }
    vec3 facet = normalize(toEye + toSun);
    float tilt = dot(normal, facet);
    float incidence = dot(facet, toEye);
    float squared = tilt * tilt;
    float density = exp((squared - 1.0) / (squared * slopeVariance)) / (slopeVariance * squared * squared);
    float unmasked = min(1.0, 2.0 * tilt * min(eye, sun) / incidence);
    float fresnel = reflectanceAlongNormal + (1.0 - reflectanceAlongNormal) * pow(max(1.0 - incidence, 0.0), 5.0);
    return fresnel * density * unmasked / (4.0 * eye);
}

// Adds light to a colour as stored in pictures, which is about the square root of the light.
vec3 withLight(vec3 colour, float light) {
    return sqrt(colour * colour + light);
}

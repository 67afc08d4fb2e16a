layout(location = 0) in vec3 v_position;
layout(location = 1) in vec3 v_normal;
layout(location = 2) in vec2 v_uv;
layout(location = 3) flat in int v_material;
layout(location = 4) flat in float v_face;
uniform vec4 u_holes[MAX_HOLES];   // x, y, radius
uniform int u_hole_count;
uniform vec4 u_inner;         // low x, low y, high x, high y of the box inside the wooden frame
out vec4 color;

// Value noise from an integer hash, which gives the same result on every machine, unlike fract(sin()).
uint hash(ivec2 p) {
    uint h = uint(p.x) * 0x9E3779B1u ^ uint(p.y) * 0x85EBCA77u;
    h ^= h >> 15; h *= 0x2C1B3C6Du; h ^= h >> 12; h *= 0x297A2D39u; h ^= h >> 15;
    return h;
}
float lattice(ivec2 p) { return float(hash(p) >> 8) * (1.0 / 16777216.0); }
float noise(vec2 p) {
    ivec2 i = ivec2(floor(p));
    vec2 f = p - vec2(i);
    f = f * f * (3.0 - 2.0 * f);
    return mix(mix(lattice(i), lattice(i + ivec2(1, 0)), f.x),
               mix(lattice(i + ivec2(0, 1)), lattice(i + ivec2(1, 1)), f.x), f.y);
}

bool in_hole(vec2 p) {
    for (int i = 0; i < u_hole_count; ++i) {
        vec2 d = p - u_holes[i].xy;
        if (dot(d, d) < u_holes[i].z * u_holes[i].z) return true;
    }
    return false;
}

vec3 cloth_albedo(vec2 p) {
    vec3 base = from_screen(kCloth);
    // A coarse weave that shows only from nearby. It fades out before its threads are two pixels wide: finer
    // ones would be noise, which also makes the frames' files twenty times as large.
    float pixel = length(fwidth(v_position));
    float fine = 1.0 - smoothstep(0.0004, 0.0009, pixel);
    vec2 thread = sin(p * (6.2831853 / 0.0026));
    float weave = thread.x * thread.y * fine * 0.13;
    float nap = (noise(p * vec2(14.0, 9.0)) - 0.5) * 0.035;
    return base * (1.0 + weave + nap);
}

vec3 wood_albedo(vec2 uv) {
    // The fine grain fades out before its rings are one to two pixels wide; otherwise it would flicker as
    // the camera moves.
    float pixel = length(fwidth(uv)) * 160.0;
    float fine = mix(noise(vec2(uv.x * 9.0, uv.y * 160.0)), 0.5, smoothstep(0.5, 1.2, pixel));
    float rings = noise(vec2(uv.x * 2.2, uv.y * 38.0)) * 0.65 + fine * 0.35;
    return mix(from_screen(kWoodDark), from_screen(kWoodLight), smoothstep(0.15, 0.85, rings));
}

vec3 lit(vec3 albedo, vec3 n) {
    float sky = 0.65 + 0.35 * n.z;
    return albedo * (1.05 * lamp_light(v_position, n) + 0.16 * sky);
}

// Adds the mirror image of the lamp. tint: how much of it the surface reflects, by colour.
vec3 glossy(vec3 base, vec3 n, vec3 tint, float blur) {
    vec3 view = normalize(v_position - u_eye);
    vec3 r = reflect(view, n);
    // Varnish is not polished: the rise at grazing angles is cut off, or a rail would shine like glass.
    float fresnel = min(0.04 + 0.96 * pow(1.0 - max(-dot(view, n), 0.0), 5.0), 0.12);
    return base + tint * fresnel * lamp_mirror(v_position, r, blur);
}

vec3 pocket_wall(vec3 p, vec3 n, float bottom) {
    // Leather that is lit only through the mouth of the pocket: the light decreases with depth.
    float fade = exp(min(p.z, 0.0) / 0.035);
    float light = bottom > 0.5 ? 0.5 : 0.6 + 0.4 * lamp_light(p, n);
    return from_screen(kLeather) * mix(0.06, 0.75, fade) * light;
}

vec3 floor_color(vec3 p) {
    vec2 half_size = 0.5 * (u_inner.zw - u_inner.xy);
    vec2 e = abs(p.xy - 0.5 * (u_inner.xy + u_inner.zw)) - half_size;
    float away = length(max(e, 0.0));
    vec3 near = from_screen(kFloor) * (0.10 + 0.9 * smoothstep(0.0, 1.0, away));
    // The floor fades into the dark room, which has the colour of the background.
    return mix(vec3(0.004), near, 1.0 / (1.0 + 0.25 * away * away));
}

vec4 written(vec3 radiance) { return vec4(to_screen(radiance), v_face); }

void main() {
    vec2 p = v_position.xy;
    vec3 n = normalize(v_normal);
#ifdef HOLES
    if (in_hole(p)) discard;
#endif
#if defined(CLOTH)
    color = written(lit(cloth_albedo(p) * (v_material == 0 ? 1.0 : kCushionGain), n));
#elif defined(CHALK)
    // The share of this pixel's width that lies within the mark.
    float across = max(fwidth(v_uv.y), 1e-4);
    float cover = min(v_uv.y + 0.5 * across, 1.0) - max(v_uv.y - 0.5 * across, -1.0);
    cover = v_uv.x * clamp(cover / across, 0.0, 1.0);
    color = written(mix(lit(cloth_albedo(p), n), lit(vec3(kChalk), n), cover));
#elif defined(SHADE)
    // Only the opacity counts: black is blended over the cloth. In screen values, whose square is the
    // radiance, the same darkening needs another opacity.
    color = vec4(0.0, 0.0, 0.0, 1.0 - sqrt(1.0 - v_uv.x));
#elif defined(WOOD)
    color = written(glossy(lit(wood_albedo(v_uv), n), n, vec3(1.7, 1.0, 0.62), 0.5));
#elif defined(FLOOR)
    color = written(floor_color(v_position));
#else
    if (v_material == 3)
        color = written(pocket_wall(v_position, n, v_uv.x));
    else if (v_material == 4)
        color = written(glossy(lit(from_screen(kTrim), n), n, vec3(6.0), 0.5));
    else
        color = written(glossy(lit(from_screen(kInlay), n), n, vec3(3.0), 0.2));
#endif
}

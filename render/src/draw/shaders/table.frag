in vec3 v_position;
in vec3 v_normal;
in vec2 v_uv;
flat in int v_material;
uniform vec4 u_holes[MAX_HOLES];   // x, y, radius
uniform int u_hole_count;
uniform vec2 u_clear;         // no hole overlaps the range of x between these
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
    // Most of the cloth is far from all holes; the loop is skipped there.
    int count = p.x > u_clear.x && p.x < u_clear.y ? 0 : u_hole_count;
    for (int i = 0; i < count; ++i) {
        vec2 d = p - u_holes[i].xy;
        if (dot(d, d) < u_holes[i].z * u_holes[i].z) return true;
    }
    return false;
}
bool in_inner(vec2 p) { return all(greaterThan(p, u_inner.xy)) && all(lessThan(p, u_inner.zw)); }

vec3 cloth_albedo(vec2 p) {
    vec3 base = from_screen(vec3(0.055, 0.50, 0.345));
    // A coarse weave that is visible only from near: it fades out before its threads are one to two pixels wide.
    float pixel = length(fwidth(p));
    float fine = 1.0 - smoothstep(0.0006, 0.0016, pixel);
    vec2 thread = sin(p * (6.2831853 / 0.0026));
    float weave = thread.x * thread.y * fine * 0.13;
    float nap = (noise(p * vec2(14.0, 9.0)) - 0.5) * 0.035;
    return base * (1.0 + weave + nap);
}

vec3 wood_albedo(vec2 uv) {
    float rings = noise(vec2(uv.x * 2.2, uv.y * 38.0)) * 0.65 + noise(vec2(uv.x * 9.0, uv.y * 160.0)) * 0.35;
    vec3 dark = from_screen(vec3(0.23, 0.105, 0.055)), light = from_screen(vec3(0.44, 0.225, 0.115));
    return mix(dark, light, smoothstep(0.15, 0.85, rings));
}

vec3 lit(vec3 albedo, vec3 n) {
    float sky = 0.65 + 0.35 * n.z;
    return albedo * (1.05 * lamp_light(v_position, n) + 0.16 * sky);
}

vec3 glossy(vec3 base, vec3 n, float strength, float blur) {
    vec3 view = normalize(v_position - u_eye);
    vec3 r = reflect(view, n);
    float fresnel = 0.04 + 0.96 * pow(1.0 - max(-dot(view, n), 0.0), 5.0);
    return base + strength * fresnel * lamp_mirror(v_position, r, blur);
}

vec3 pocket_wall(vec3 p, vec3 n, float bottom) {
    // Leather that is lit only through the mouth of the pocket: the light decreases with depth.
    float fade = exp(min(p.z, 0.0) / 0.035);
    vec3 leather = from_screen(vec3(0.17, 0.13, 0.11));
    return leather * mix(0.06, 0.75, fade) * (bottom > 0.5 ? 0.5 : 0.6 + 0.4 * lamp_light(p, n));
}

vec3 floor_color(vec3 p) {
    vec2 half_size = 0.5 * (u_inner.zw - u_inner.xy), e = abs(p.xy - 0.5 * (u_inner.xy + u_inner.zw)) - half_size;
    float away = length(max(e, 0.0));
    vec3 near = from_screen(vec3(0.16, 0.145, 0.135)) * (0.10 + 0.9 * smoothstep(0.0, 1.0, away));
    // The floor fades into the dark room, which has the colour of the background.
    return mix(vec3(0.004), near, 1.0 / (1.0 + 0.25 * away * away));
}

void main() {
    vec2 p = v_position.xy;
    vec3 n = normalize(v_normal);
#if defined(CLOTH)
    // Cushions extend over the rims of the holes; the playing surface ends there.
    bool playing = v_material == 0;
    if (playing && in_hole(p)) discard;
    color = vec4(lit(cloth_albedo(p) * (playing ? 1.0 : 1.12), n), playing ? 1.0 : 0.0);
#elif defined(WOOD)
    if (in_hole(p)) discard;
    color = vec4(glossy(lit(wood_albedo(v_uv), n), n, 5.0, 0.25), 0.0);
#elif defined(FLOOR)
    color = vec4(floor_color(v_position), 0.0);
#else
    if (v_material == 3) {
        if (v_position.z > 0.0 && in_inner(p)) discard;
        color = vec4(pocket_wall(v_position, n, v_uv.x), 0.0);
    } else if (v_material == 4) {
        if (in_inner(p)) discard;
        color = vec4(glossy(lit(from_screen(vec3(0.19, 0.175, 0.165)), n), n, 6.0, 0.5), 0.0);
    } else if (v_material == 5) {
        color = vec4(glossy(lit(from_screen(vec3(0.88, 0.85, 0.76)), n), n, 3.0, 0.2), 0.0);
    } else {
        if (in_hole(p) || !in_inner(p)) discard;
        color = v_material == 7 ? vec4(0.0, 0.0, 0.0, v_uv.x) : vec4(lit(vec3(0.75), n), v_uv.x);
    }
#endif
}

layout(location = 0) in vec3 v_position;
layout(location = 1) in vec3 v_normal;
layout(location = 2) in vec2 v_uv;
layout(location = 3) flat in int v_material;
layout(location = 4) flat in float v_face;
uniform vec4 u_holes[MAX_HOLES];   // x, y, radius
uniform int u_hole_count;
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

// Noise omitted from frames of a moving camera.
#ifdef LESS_DETAIL
float detail(vec2 p) { return 0.5; }
#else
float detail(vec2 p) { return noise(p); }
#endif

bool in_hole(vec2 p) {
    for (int i = 0; i < u_hole_count; ++i) {
        vec2 d = p - u_holes[i].xy;
        if (dot(d, d) < u_holes[i].z * u_holes[i].z) return true;
    }
    return false;
}

vec3 cloth_albedo(vec2 p) {
    vec3 base = from_screen(u_cloth);
    // A twill of irregular threads, which shows only from nearby. It fades out before its threads are two
    // pixels wide: finer ones would be noise, which also makes the frames' files twenty times as large.
    float pixel = length(fwidth(v_position));
    float fine = 1.0 - smoothstep(0.0004, 0.0009, pixel);
    vec2 thread = sin(vec2(p.x + p.y, p.x - p.y) * (6.2831853 / 0.0026));
    float weave = thread.x * (0.6 + 0.4 * thread.y) * 0.10 + (detail(p * vec2(1500.0, 420.0)) - 0.5) * 0.22;
    float ribs = sin((p.x + 0.35 * p.y) * (6.2831853 / 0.006)) * 0.04 *
                 (1.0 - smoothstep(0.0004, 0.00064, pixel));
    // The nap lies along the table and is brushed in strokes.
    float nap = (noise(p * vec2(14.0, 5.0)) - 0.5) * 0.045 + (detail(p * vec2(75.0, 9.0)) - 0.5) * 0.04;
    return base * (1.0 + mix(ribs, weave, fine) + nap);
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

// Wool looks lighter along its surface: the fibres that stand up are lit from behind.
vec3 cloth(vec3 albedo, vec3 n) {
#ifdef LESS_DETAIL
    return lit(albedo, n);
#endif
    float along = 1.0 - abs(dot(normalize(u_eye - v_position), n));
    return lit(albedo, n) * (1.0 + 0.30 * along * along * along);
}

// The top of a cushion is darker towards the rail, in whose shadow it lies.
float beside_rail(vec2 p, vec3 n) {
    vec2 away = min(p - u_inner.xy, u_inner.zw - p);
    return mix(1.0, mix(0.66, 1.08, smoothstep(0.0, 0.045, min(away.x, away.y))), smoothstep(0.4, 0.8, n.z));
}

// Below the nose of a cushion, where its face turns away from the lamp and the cloth below is dark.
float under_nose(vec3 n, float z) {
    return 1.0 - (1.0 - smoothstep(0.0, 0.5, n.z)) * (0.60 - 9.0 * clamp(z, 0.0, 0.04));
}

vec3 pocket_wall(vec3 p, vec3 n, vec2 uv) {
    // Leather that is lit only through the mouth of the pocket: the light decreases with depth.
    float fade = exp(min(p.z, 0.0) / 0.032);
    float grain = 0.9 + 0.2 * detail(vec2(uv.x > 0.5 ? p.x : atan(n.y, n.x) * 0.06, p.y + p.z) * 240.0);
    float light = uv.x > 0.5 ? 0.07 * (1.0 - 0.75 * uv.y * uv.y) : mix(0.06, 0.9, fade) *
                  (0.45 + 0.55 * lamp_light(p, n));
    // Below a band of leather hangs a net of cords, 32 meshes around.
    vec2 mesh = vec2(1.0, -1.0) * atan(n.y, n.x) * 5.0929582 + p.z / 0.012;
    vec2 off = 0.5 - abs(fract(mesh) - 0.5);
    float cord = 1.0 - smoothstep(0.06, 0.14, min(off.x, off.y));
    cord = mix(cord, 0.25, smoothstep(0.001, 0.003, length(fwidth(p))));
    float net = uv.x > 0.5 ? 0.0 : smoothstep(-0.012, -0.014, p.z);
    return from_screen(kLeather) * light * mix(grain, 0.25 + 2.6 * cord, net);
}

// The boards of a dim room.
vec3 floor_color(vec3 p, vec3 n) {
    vec2 half_size = 0.5 * (u_inner.zw - u_inner.xy), middle = 0.5 * (u_inner.xy + u_inner.zw);
    vec2 e = abs(p.xy - middle) - half_size;
    float away = length(max(e, 0.0));
    float board = floor(p.x / 0.16), seam = abs(fract(p.x / 0.16) - 0.5) * 0.16;
    float tone = 0.7 + 0.35 * detail(vec2(board, floor(p.y / 1.9 + 0.37 * board))) +
                 0.3 * (detail(vec2(p.x * 30.0, p.y * 1.5)) - 0.5);
    float pixel = length(fwidth(p));
    tone *= 1.0 - 0.5 * smoothstep(0.0774 - pixel, 0.08, seam) * (1.0 - smoothstep(0.006, 0.016, pixel));
    float light = 0.07 + 0.55 * lamp_light(p, n);
    return from_screen(kFloor) * tone * light * (0.10 + 0.9 * smoothstep(0.1, 0.9, away));
}

// Its panelled walls, and the lamp, of which a low camera sees the shining side.
vec3 wall_color(vec3 p, vec3 n) {
    if (v_material == 8 && v_uv.x > 0.5) return vec3(6.0, 5.6, 4.9);
    if (v_material == 8) return from_screen(kLampShade) * (0.7 - 0.4 * n.z);
    // The lamp lights the lower part of a wall; its shade throws an edge of shadow.
    float along = abs(n.x) > 0.5 ? p.y : p.x, height = p.z + 0.75;
    float reached = smoothstep(u_lamp.z + 0.25, u_lamp.z - 0.7, p.z) / (1.0 + 0.15 * along * along);
    float light = 0.10 + 0.36 * reached;
    float panel = abs(fract(along / 0.8) - 0.5) * 0.8, rim = 0.34 - panel;
    vec3 paint = from_screen(kWall);
    if (height < 1.0) {
        float line = min(rim, min(height - 0.12, 0.9 - height));
        paint = from_screen(kWoodLight) * (0.55 + 0.25 * smoothstep(-0.004, 0.004, line) -
                                           0.25 * (1.0 - smoothstep(0.0, 0.012, abs(line))));
        paint *= 0.8 + 0.4 * detail(vec2(along * 25.0, height * 2.0));
        if (height > 0.95) paint *= 1.35;
    }
    return paint * light;
}

vec4 written(vec3 radiance) { return vec4(to_screen(radiance), v_face); }

void main() {
    vec2 p = v_position.xy;
    vec3 n = normalize(v_normal);
#ifdef HOLES
    if (in_hole(p)) discard;
#endif
#if defined(CLOTH)
    vec3 felt = cloth(cloth_albedo(p), n);
    color = written(v_material == 0 ? felt : felt * kCushionGain * under_nose(n, v_position.z) *
                                                  beside_rail(p, n));
#elif defined(CHALK)
    // The share of this pixel's width that lies within the mark.
    float across = max(fwidth(v_uv.y), 1e-4);
    float cover = min(v_uv.y + 0.5 * across, 1.0) - max(v_uv.y - 0.5 * across, -1.0);
    cover = v_uv.x * clamp(cover / across, 0.0, 1.0);
    color = written(mix(cloth(cloth_albedo(p), n), lit(vec3(kChalk), n), cover));
#elif defined(SHADE)
    // Only the opacity counts: black is blended over the cloth. In screen values, whose square is the
    // radiance, the same darkening needs another opacity.
    color = vec4(0.0, 0.0, 0.0, 1.0 - sqrt(1.0 - v_uv.x));
#elif defined(WOOD)
    color = written(glossy(lit(wood_albedo(v_uv), n), n, vec3(1.7, 1.0, 0.62), 0.5));
#elif defined(FLOOR)
    color = written(floor_color(v_position, n));
#elif defined(WALL)
    color = written(wall_color(v_position, n));
#else
    if (v_material == 3)
        color = written(pocket_wall(v_position, n, v_uv));
    else if (v_material == 4)
        color = written(glossy(lit(from_screen(kTrim), n), n, vec3(6.0), 0.5));
    else
        color = written(glossy(lit(from_screen(kInlay), n), n, vec3(3.0), 0.2));
#endif
}

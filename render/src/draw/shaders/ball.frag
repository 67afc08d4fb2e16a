flat in vec4 v_ball;
flat in vec4 v_orientation;
flat in vec4 v_color;
flat in vec3 v_pattern;
#ifndef PLAIN
flat in vec4 v_near[MAX_NEAR];
#endif
uniform sampler2D u_glyphs;
out vec4 color;

// Light of the lamp on a ball: its centre is accurate enough. The 0.6 stands for its size, light past the terminator; the
// square lets the light end without an edge.
float lamp_on_ball(vec3 p, vec3 n) {
    vec3 to = vec3(u_lamp.xy, u_lamp.z) - p;
    if (u_lamp_endless > 0.5) to = vec3(0.0, 0.0, u_lamp.z);
    float inverse = inversesqrt(dot(to, to));
    float facing = max((dot(n, to) * inverse + 0.6) * (1.0 / 1.6), 0.0);
    return facing * facing * u_lamp.z * u_lamp.z * inverse * inverse;
}

// Share of the light at normal n that reaches the ball past its neighbours: each hides (r / d)^2 cos of the sky.
float past_neighbours(vec3 n) {
    float open = 1.0;
#ifndef PLAIN
    for (int i = 0; i < MAX_NEAR; ++i) {
        vec3 to = v_near[i].xyz - v_ball.w * n;
        float inverse = inversesqrt(dot(to, to));
        float hidden = v_ball.w * v_ball.w * inverse * inverse * max(dot(to, n) * inverse, 0.0);
        open *= 1.0 - 0.75 * v_near[i].w * min(hidden, 1.0);
    }
#endif
    return open;
}

vec3 to_body(vec3 n) {
    vec3 q = -v_orientation.xyz;
    return n + 2.0 * cross(q, cross(q, n) + v_orientation.w * n);
}

// Coverage: 1 inside. x increases outwards; w is the width of a pixel in the same unit.
float inside(float x, float w) { return clamp(0.5 - x / w, 0.0, 1.0); }

// Coverage by the digits; `at` is in radii of the ball, upright. Of two digits side by side each pixel reads one.
float number_ink(int number, vec2 at, float w) {
    bool two = number > 9;
    int value = two && at.x < 0.0 ? number / 10 : number % 10;
    vec2 box = two ? vec2(0.215, 0.41) : vec2(0.33, 0.48);   // half a cell of the atlas
    vec2 place = vec2(two ? abs(at.x) - 0.192 : at.x, at.y);
    if (two && at.x < 0.0) place.x = -place.x;
    place /= box;
    vec2 unit = clamp(place * 0.5 + 0.5, vec2(0.02), vec2(0.98));
    float near = texture(u_glyphs, (vec2(value % 8, value / 8) + vec2(unit.x, 1.0 - unit.y)) * 0.125).r;
    // The strokes are 1.3 units thick; the height of a cell is 9 units.
    float ink = inside((1.0 - near) * 1.5 - 0.62, max(w * 4.5 / box.y, 0.05));
    ink = any(greaterThan(abs(place), vec2(1.0))) ? 0.0 : ink;
    // A bar below the digit distinguishes 6 from 9 in every orientation.
    float bar = inside(max(abs(at.y + 0.43) - 0.035, abs(at.x) - 0.17), w);
    return number == 6 || number == 9 ? max(ink, bar) : ink;
}

// shine: how much of the mirror image of the lamp is seen; print must stay legible under it.
vec3 albedo(vec3 b, float w, out float shine) {
    shine = 1.0;
    vec3 ivory = from_screen(vec3(0.95, 0.93, 0.86));
    vec3 base = v_color.rgb;
    int pattern = int(v_pattern.x + 0.5);
    if (pattern == 1) base = mix(ivory, base, inside(abs(b.x) - 0.60, w));
    if (pattern == 2) {
        vec3 a = abs(b);
        bool z_axis = a.z >= a.x && a.z >= a.y;
        float from_axis = length(z_axis ? a.xy : (a.x > a.y ? a.yz : a.xz));
        // One of the six is larger, so that a fast turn does not look like a slow one backwards.
        float radius = z_axis && b.z > 0.0 ? 0.34 : 0.17;
        float luminance = dot(base, vec3(0.3, 0.6, 0.1));
        vec3 dot_color = luminance > 0.3 ? from_screen(vec3(0.72, 0.05, 0.07)) : from_screen(vec3(0.93, 0.90, 0.82));
        base = mix(base, dot_color, inside(from_axis - radius, w));
    }
    if (pattern == 3) base = mix(base, mix(base, vec3(1.0), 0.65), inside(b.x, w));
    int number = int(v_color.a + 0.5);
    if (number > 0) {
        // The number is at both ends of the body's z axis, upright for a camera whose right-hand side is +y.
        float spot = inside(length(b.xy) - 0.52, w);
        base = mix(base, ivory, spot);
        vec2 at = vec2(b.y, b.z > 0.0 ? -b.x : b.x);
        float ink = spot * number_ink(number, at, w);
        base = mix(base, vec3(0.012), ink);
        shine = 1.0 - 0.85 * ink;
    }
    return base;
}

void main() {
    vec3 ray = pixel_ray(gl_FragCoord.xy);
    float per_depth = inversesqrt(dot(ray, ray));
    vec3 dir = ray * per_depth, oc = v_ball.xyz - u_eye;
    // Foot of the perpendicular from the centre to the ray: this avoids the difference of large squares.
    float along = dot(dir, oc);
    vec3 perpendicular = dir * along - oc;
    float miss = length(perpendicular), R = v_ball.w;
    float pixel = 2.0 * length(u_up_scaled) / u_size.y * along * per_depth;
    float cover = clamp(0.5 + (R - miss) / pixel, 0.0, 1.0);
    if (cover <= 0.0) discard;
    float rise = sqrt(max(R * R - miss * miss, 0.0));
    vec3 n = normalize(perpendicular - dir * rise);
    vec3 p = v_ball.xyz + n * R;

    cover *= seen(ivec2(gl_FragCoord.xy), (along - rise) * per_depth - 0.001);

    float facing = max(-dot(n, dir), 0.08);
    float shine;
    vec3 base = albedo(to_body(n), pixel / (R * mix(1.0, facing, 0.6)), shine);
    vec3 cloth = from_screen(vec3(0.055, 0.50, 0.345));
    // Light: the lamp, the dim room above, and the reflection of the cloth from below.
    float under = 0.5 - 0.5 * n.z;
    vec3 light = vec3(lamp_on_ball(p, n)) + 0.20 * (1.0 - under) + cloth * 0.75 * under * under;
    light *= (1.0 - 0.45 * smoothstep(0.55, 1.0, under)) * past_neighbours(n);
    vec3 shade = base * light;
    // Specular reflection: a mirror image of the lamp, and of the room at grazing angles.
    vec3 r = reflect(dir, n);
    float grazing = 1.0 - max(-dot(n, dir), 0.0);
    float fresnel = 0.045 + 0.955 * grazing * grazing * grazing * grazing;
    vec3 room = mix(cloth * 0.35, vec3(0.10), smoothstep(-0.25, 0.25, r.z));
    shade += fresnel * (11.0 * shine * lamp_mirror(p, r, 0.10 * u_lamp.z) + room);
    // Below the cloth light comes only through the mouth of the pocket, as on its wall.
    shade *= mix(0.06, 1.0, exp(min(p.z, 0.0) / 0.035));
    color = vec4(to_screen(shade), cover);
}

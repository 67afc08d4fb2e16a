// A ball, as paint_balls.cpp and skin.h paint it.
uniform sampler2D u_glyphs;
in vec3 v_ray;
flat in int v_ball;
out vec4 color;

float inside(float x, float w) { return clamp(0.5 - x / w, 0.0, 1.0); }

float number_ink(int number, vec2 at, float w) {
    bool two = number > 9;
    vec2 box = two ? vec2(0.215, 0.41) : vec2(0.33, 0.48);
    vec2 place = vec2(two ? (at.x < 0.0 ? at.x + 0.192 : at.x - 0.192) : at.x, at.y) / box;
    float ink = 0.0;
    if (max(abs(place.x), abs(place.y)) <= 1.0) {
        int digit = two && at.x < 0.0 ? number / 10 : number % 10;
        vec2 cell = clamp(place * vec2(0.5, -0.5) + 0.5, 0.02, 0.98);
        cell.y = clamp(cell.y, 0.02, 0.98);
        vec2 uv = (vec2(digit % 8, digit / 8) + cell) / 8.0;
        float outside = 1.5 * (1.0 - 2.0 * textureLod(u_glyphs, uv, 0.0).r);
        ink = inside(outside, max(w * (4.5 / box.y), 0.05));
    }
    if (number != 6 && number != 9) return ink;
    return max(ink, inside(max(abs(at.y + 0.43) - 0.035, abs(at.x) - 0.17), w));
}

vec3 skin(Ball ball, vec3 n, float w, out float shine) {
    vec3 axis = -ball.turn.xyz, b = n + 2.0 * cross(axis, cross(axis, n) + n * ball.turn.w);
    vec3 base = ball.color.rgb, ivory = from_screen(kIvory);
    int pattern = int(ball.kind.x + 0.5), number = int(ball.color.w + 0.5);
    shine = 1.0;
    if (pattern == STRIPE) base = mix(ivory, base, inside(abs(b.x) - kStripe, w));
    if (pattern == DOTS) {
        vec3 s = b * b;
        float most = max(max(s.x, s.y), s.z), off = sqrt(max(s.x + s.y + s.z - most, 0.0));
        bool bright = dot(base, vec3(0.3, 0.6, 0.1)) > kBright;
        base = mix(base, from_screen(bright ? kRedDot : kPaleDot),
                   inside(off - (s.z >= most && b.z > 0.0 ? kLargeDot : kDot), w));
    }
    if (pattern == HALVES) base = mix(base, mix(base, vec3(1.0), kPaleHalf), inside(b.x, w));
    if (number == 0) return base;
    float spot = inside(length(b.xy) - kSpot, w);
    base = mix(base, ivory, spot);
    float ink = spot * number_ink(number, vec2(b.y, b.z > 0.0 ? -b.x : b.x), w);
    shine = 1.0 - 0.92 * ink;
    return mix(base, vec3(kInk), ink);
}

vec2 lamp_half() { return u_lamp_endless > 0.5 ? vec2(0.22, 0.5) * u_lamp.z : u_lamp_half; }
float light_on_ball(vec3 p, vec3 n) {
    vec2 away = p.xy - u_lamp.xy, reach = 0.6 * lamp_half();
    vec3 to = vec3(clamp(away, -reach, reach) - away, u_lamp.z - p.z);
    if (u_lamp_endless > 0.5) to = vec3(0.0, 0.0, u_lamp.z);
    float inverse = inversesqrt(dot(to, to));
    float facing = max((dot(n, to) * inverse + 0.6) / 1.6, 0.0);
    return facing * facing * u_lamp.z * u_lamp.z * inverse * inverse;
}
// The lamp has three panes, with bars at a third.
float panes(vec3 p, vec3 r) {
    if (r.z < 0.02) return 0.0;
    vec2 size = lamp_half(), at = p.xy + r.xy * ((u_lamp.z - p.z) / r.z);
    at = abs(at - (u_lamp_endless > 0.5 ? p.xy : u_lamp.xy));
    if (size.x > size.y) { size = size.yx; at = at.yx; }
    float blur = 0.06 * u_lamp.z, bar = abs(at.y - size.y / 3.0) - 0.045 * size.y;
    return (1.0 - smoothstep(-blur, blur, at.y - size.y)) * (1.0 - smoothstep(-blur, blur, at.x - size.x)) *
           (0.25 + 0.75 * smoothstep(-0.3 * blur, 0.3 * blur, bar));
}
vec3 mirrored(vec3 p, vec3 r, float shine, float R) {
    vec2 middle = 0.5 * (u_inner.xy + u_inner.zw), size = u_inner.zw - middle;
    vec2 way = max(size - sign(r.xy) * (p.xy - middle), 0.0) / max(abs(r.xy), 1e-4);
    float to_edge = min(way.x, way.y), edge = p.z + r.z * to_edge, blur = 0.006 + 0.03 * to_edge;
    float to_cloth = p.z / max(-r.z, 0.02), away = to_cloth / R;
    vec2 off = (p.xy + r.xy * to_cloth - u_lamp.xy) / u_lamp.z;
    float square = 1.0 + dot(off, off);
    float lit = (u_lamp_endless > 0.5 ? 1.0 : 1.0 / (square * sqrt(square))) * (away * away / (away * away +
        1.3));
    float dim = 0.035 + 0.05 * max(1.0 - r.z * 2.5, 0.0), bright = 15.0 * shine * panes(p, r);
    vec3 cloth = from_screen(u_cloth), room = dim * vec3(1.08, 1.0, 0.9) + bright * vec3(1.0, 1.0, 0.93);
    vec2 below = clamp(0.5 + (vec2(0.045, 0.0) - edge) / (2.0 * blur), 0.0, 1.0);
    return mix(mix(room, cloth * 0.35, below.x), cloth * lit, below.y);
}

void main() {
    Ball ball = u_balls[v_ball];
    float R = ball.center.w, per_depth = inversesqrt(dot(v_ray, v_ray));
    vec3 dir = v_ray * per_depth, oc = ball.center.xyz - u_eye;
    float along = dot(dir, oc);
    vec3 off = dir * along - oc;
    float miss = length(off), pixel = 2.0 * length(u_up_scaled) / u_size.y * along * dot(dir, u_forward);
    float cover = clamp(0.5 + (R - miss) / pixel, 0.0, 1.0);
    if (cover <= 0.0) discard;
    float rise = sqrt(max(R * R - miss * miss, 0.0));
    vec3 n = (off - dir * rise) / max(miss, R), p = ball.center.xyz + n * R;
    cover *= seen(dot(p - u_eye, u_forward) - 0.001);
    float toward = -dot(n, dir), facing = max(toward, 0.08);
    if (ball.kind.x > 8.5) {   // a ghost ball
        color = vec4(to_screen(ball.color.rgb), cover * mix(0.85, 0.12, smoothstep(0.0, 0.45, toward)));
        return;
    }
    float shine, under = 0.5 - 0.5 * n.z, open = 1.0 - 0.45 * smoothstep(0.55, 1.0, under);
    vec3 base = skin(ball, n, pixel / (R * (1.0 + (facing - 1.0) * 0.6)), shine);
    for (int i = 0; i < 6; ++i) {
        if (ball.near[i].w <= 0.0) break;
        vec3 to = ball.near[i].xyz - R * n;
        float inverse = inversesqrt(dot(to, to)), hidden = R * R * inverse * inverse * max(dot(to,
            n) * inverse, 0.0);
        open *= 1.0 - 0.75 * ball.near[i].w * min(hidden, 1.0);
    }
    vec3 shade = base * (light_on_ball(p,
        n) + 0.20 * (1.0 - under) + from_screen(u_cloth) * (0.75 * under * under)) * open;
    float grazing = 1.0 - max(toward, 0.0),
        fresnel = 0.05 + 0.95 * grazing * grazing * grazing * grazing * grazing;
    shade += mirrored(p, dir + n * (2.0 * toward), shine, R) * (fresnel * (0.4 + 0.6 * open));
    if (ball.center.z < 0.999 * R) shade *= mix(0.06, 1.0, exp(min(p.z, 0.0) / 0.035));
    color = vec4(to_screen(shade), cover);
}

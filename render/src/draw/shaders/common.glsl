// Camera and lamp; precedes every other source. All positions are relative to the origin of the table mesh,
// so that floats resolve a tenth of a micrometre on any table.
layout(std140) uniform View {   // the same layout as struct View in view.h
    mat4 u_view_projection;
    vec3 u_eye;
    float u_lamp_endless;       // 1: the light does not decrease with distance
    vec3 u_forward;
    vec3 u_right_scaled;        // times the tangent of half the horizontal angle
    vec3 u_up_scaled;           // times the tangent of half the vertical angle
    vec3 u_lamp;                // centre of a horizontal rectangle
    vec2 u_size;                // pixels
    vec2 u_lamp_half;
    vec2 u_planes;              // distances of the near and far clip planes
};

// Radiance to screen values and back with gamma 2: a square root costs a fraction of the exact curve, and the
// difference is not visible because both directions agree. A soft shoulder above 0.5 avoids hard clipping.
vec3 to_screen(vec3 c) {
    vec3 over = 1.0 + max(c - 0.5, 0.0);
    return sqrt(min(max(c, 0.0), 0.5) + 0.5 - 0.5 / (over * over));
}
vec3 from_screen(vec3 c) { return c * c; }

// Light of the lamp on a surface at p with normal n; 1 straight below the lamp. Only the nearest point of a
// rectangle of 0.6 times its size is used: this is smooth and needs one square root instead of dozens.
float lamp_light(vec3 p, vec3 n) {
    vec2 away = p.xy - u_lamp.xy, reach = 0.6 * u_lamp_half;
    vec3 to = vec3(clamp(away, -reach, reach) - away, u_lamp.z - p.z);
    if (u_lamp_endless > 0.5) to = vec3(0.0, 0.0, u_lamp.z);
    float inverse = inversesqrt(dot(to, to));
    return max(dot(n, to) * inverse, 0.0) * (u_lamp.z * u_lamp.z * inverse * inverse);
}

// Share of the lamp that a mirror at p shows in direction r; blur is the width of its edge [m, at the lamp].
float lamp_mirror(vec3 p, vec3 r, float blur) {
    if (r.z < 0.02) return 0.0;
    vec2 half_size = u_lamp_endless > 0.5 ? vec2(0.22, 0.5) * u_lamp.z : u_lamp_half;
    vec2 middle = u_lamp_endless > 0.5 ? p.xy : u_lamp.xy;
    vec2 at = p.xy + r.xy * ((u_lamp.z - p.z) / r.z) - middle;
    vec2 e = abs(at) - half_size;
    return smoothstep(blur, -blur, e.x) * smoothstep(blur, -blur, e.y);
}

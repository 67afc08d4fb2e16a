#include "shaders.h"

namespace carom::render::shaders {

// All positions are relative to the origin of the table mesh: floats then keep a tenth of a micrometre on any
// table.
const char* const kCommon = R"(#version 330 core
uniform mat4 u_view_projection;
uniform vec3 u_eye;
uniform vec3 u_forward;
uniform vec3 u_right_scaled;    // times the tangent of half the horizontal angle
uniform vec3 u_up_scaled;       // times the tangent of half the vertical angle
uniform vec2 u_size;            // pixels
uniform vec3 u_lamp;            // centre of a level rectangle
uniform vec2 u_lamp_half;
uniform float u_lamp_endless;   // 1: light does not fall off

// Radiance to sRGB, with a soft shoulder above one half so that highlights do not clip hard.
vec3 to_srgb(vec3 c) {
    vec3 soft = mix(c, 0.5 + 0.5 * (1.0 - exp(-(c - 0.5) * 2.0)), step(0.5, c));
    return pow(clamp(soft, 0.0, 1.0), vec3(1.0 / 2.2));
}
vec3 from_srgb(vec3 c) { return pow(c, vec3(2.2)); }

// Light of the lamp on a surface at p with normal n: five points of the rectangle, 1 straight below its middle.
float lamp_light(vec3 p, vec3 n) {
    float sum = 0.0;
    for (int i = 0; i < 5; ++i) {
        vec2 corner = i == 4 ? vec2(0.0) : vec2((i & 1) == 0 ? -0.7 : 0.7, (i & 2) == 0 ? -0.7 : 0.7);
        vec3 to = vec3(u_lamp.xy + corner * u_lamp_half, u_lamp.z) - p;
        if (u_lamp_endless > 0.5) to = vec3(corner * 0.6, 1.0) * u_lamp.z;
        float d2 = dot(to, to);
        float facing = max(dot(n, to) * inversesqrt(d2), 0.0);
        sum += facing * (u_lamp.z * u_lamp.z / d2);
    }
    return sum * 0.2;
}

// How much of the lamp a mirror at p sends along direction r; blur widens its edge [m at the lamp].
float lamp_mirror(vec3 p, vec3 r, float blur) {
    if (r.z < 0.02) return 0.0;
    vec2 half_size = u_lamp_endless > 0.5 ? vec2(0.22, 0.5) * u_lamp.z : u_lamp_half;
    vec2 middle = u_lamp_endless > 0.5 ? p.xy : u_lamp.xy;
    vec2 at = p.xy + r.xy * ((u_lamp.z - p.z) / r.z) - middle;
    vec2 e = abs(at) - half_size;
    return smoothstep(blur, -blur, e.x) * smoothstep(blur, -blur, e.y);
}

vec3 pixel_ray(vec2 pixel) {
    vec2 s = 2.0 * pixel / u_size - 1.0;
    return u_forward + s.x * u_right_scaled - s.y * u_up_scaled;
}
)";

const char* const kFullscreenVertex = R"(
void main() {
    gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0, 0.0, 1.0);
}
)";

const char* const kAddFragment = R"(
uniform sampler2D u_pass;
uniform float u_weight;
out vec4 color;
void main() { color = texelFetch(u_pass, ivec2(gl_FragCoord.xy), 0) * u_weight; }
)";

const char* const kDepthFragment = R"(
uniform sampler2D u_depth;
uniform vec2 u_planes;   // near and far
out vec4 color;
void main() {
    float z = texelFetch(u_depth, ivec2(gl_FragCoord.xy), 0).r;
    float n = u_planes.x, f = u_planes.y;
    color = vec4(n * f / (f - z * (f - n)));
}
)";

const char* const kResolveFragment = R"(
uniform sampler2D u_pass;
out vec4 color;
void main() {
    vec4 sum = texelFetch(u_pass, ivec2(gl_FragCoord.xy), 0);
    color = vec4(to_srgb(sum.rgb), sum.a);
}
)";

}  // namespace carom::render::shaders

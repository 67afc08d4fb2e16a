#include "shaders.h"

namespace carom::render::shaders {

const char* const kLineVertex = R"(
layout(location = 0) in vec3 a_from;
layout(location = 1) in vec3 a_to;
layout(location = 2) in vec4 a_color;
layout(location = 3) in float a_width;
flat out vec4 v_ends;      // pixels
flat out vec2 v_closeness;  // one over the distance along the view, at both ends
flat out vec4 v_color;
flat out float v_half;
void main() {
    vec4 p = u_view_projection * vec4(a_from, 1.0), q = u_view_projection * vec4(a_to, 1.0);
    // What lies behind the eye is cut off.
    const float kNear = 0.01;
    if (max(p.w, q.w) < kNear) { gl_Position = vec4(2.0, 2.0, 2.0, 1.0); return; }
    if (p.w < kNear) p = mix(q, p, (q.w - kNear) / (q.w - p.w));
    if (q.w < kNear) q = mix(p, q, (p.w - kNear) / (p.w - q.w));
    vec2 a = (p.xy / p.w * 0.5 + 0.5) * u_size, b = (q.xy / q.w * 0.5 + 0.5) * u_size;
    v_ends = vec4(a, b);
    v_closeness = 1.0 / vec2(p.w, q.w);
    v_color = a_color;
    v_half = 0.5 * a_width;
    vec2 along = b - a;
    float length_px = length(along);
    along = length_px > 1e-3 ? along / length_px : vec2(1.0, 0.0);
    vec2 side = vec2(-along.y, along.x);
    float reach = v_half + 1.0;
    vec2 corner = (gl_VertexID & 1) == 0 ? a - along * reach : b + along * reach;
    corner += ((gl_VertexID & 2) == 0 ? -reach : reach) * side;
    gl_Position = vec4(corner / u_size * 2.0 - 1.0, 0.0, 1.0);
}
)";

const char* const kLineFragment = R"(
flat in vec4 v_ends;
flat in vec2 v_closeness;
flat in vec4 v_color;
flat in float v_half;
uniform sampler2D u_occluders;
out vec4 color;
void main() {
    vec2 along = v_ends.zw - v_ends.xy, at = gl_FragCoord.xy - v_ends.xy;
    float t = clamp(dot(at, along) / max(dot(along, along), 1e-6), 0.0, 1.0);
    float cover = clamp(0.5 + v_half - length(at - t * along), 0.0, 1.0);
    float depth = 1.0 / mix(v_closeness.x, v_closeness.y, t);
    vec4 table = texelFetch(u_occluders, ivec2(gl_FragCoord.xy), 0);
    cover *= dot(step(vec4(depth * 0.998 - 0.002), table), vec4(0.25));
    color = vec4(v_color.rgb, v_color.a * cover);
}
)";

const char* const kBoxVertex = R"(
layout(location = 0) in vec4 a_box;      // low and high corner, pixels
layout(location = 1) in vec4 a_color;
layout(location = 2) in float a_glyph;   // cell of the atlas, or below 0 for a filled rectangle
flat out vec4 v_box;
flat out vec4 v_color;
flat out int v_glyph;
void main() {
    v_box = a_box;
    v_color = a_color;
    v_glyph = int(floor(a_glyph + 0.5));
    vec2 corner = vec2((gl_VertexID & 1) == 0 ? a_box.x - 1.0 : a_box.z + 1.0,
                       (gl_VertexID & 2) == 0 ? a_box.y - 1.0 : a_box.w + 1.0);
    gl_Position = vec4(corner / u_size * 2.0 - 1.0, 0.0, 1.0);
}
)";

const char* const kBoxFragment = R"(
flat in vec4 v_box;
flat in vec4 v_color;
flat in int v_glyph;
uniform sampler2D u_glyphs;
out vec4 color;
void main() {
    vec2 extent = v_box.zw - v_box.xy, at = gl_FragCoord.xy - v_box.xy;
    vec2 edge = clamp(min(at, extent - at) + 0.5, 0.0, 1.0);
    float cover = edge.x * edge.y;
    if (v_glyph >= 0) {
        vec2 unit = clamp(at / extent, vec2(0.02), vec2(0.98));
        float near = texture(u_glyphs, (vec2(v_glyph % 8, v_glyph / 8) + unit) * 0.125).r;
        // Distances in units of the letter; 9 of them are the height of the cell.
        cover *= clamp(0.5 - ((1.0 - near) * 1.5 - 0.5) * extent.y / 9.0, 0.0, 1.0);
    }
    color = vec4(v_color.rgb, v_color.a * cover);
}
)";

}  // namespace carom::render::shaders

layout(location = 0) in vec3 a_from;
layout(location = 1) in vec3 a_to;
layout(location = 2) in vec4 a_color;
layout(location = 3) in float a_width;
flat out vec4 v_ends;      // pixels
flat out vec2 v_closeness;  // reciprocal of the distance along the view direction, at both ends
flat out vec4 v_color;
flat out float v_half;
void main() {
    vec4 p = u_view_projection * vec4(a_from, 1.0), q = u_view_projection * vec4(a_to, 1.0);
    // The part behind the eye is clipped.
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

// A strip that faces the eye along a line from a to b: the cue, or one of many lines.
#ifdef LINES
layout(location = 0) in vec3 a_from;
layout(location = 1) in vec3 a_to;
layout(location = 2) in float a_wide;   // half the width [pixels]
layout(location = 3) in vec4 a_colour;
flat out vec4 v_colour;
out float v_aside;                      // [pixels] from the middle
flat out float v_half;
#else
uniform vec3 u_from, u_to;
#endif
out vec3 v_ray;
void main() {
#ifdef LINES
    vec3 from = a_from, to = a_to;
    float solid = 0.0, pixels = a_wide + 1.0;
#else
    vec3 from = u_from, to = u_to;
    float solid = 0.0155, pixels = 1.0;
#endif
    vec3 axis = normalize(to - from);
    bool far = (gl_VertexID & 2) != 0, left = (gl_VertexID & 1) != 0;
    vec3 at = far ? to : from;
    vec3 aside = normalize(cross(axis, at - u_eye));
    float pixel = 2.0 * length(u_up_scaled) / u_size.y * max(dot(at - u_eye, u_forward), 0.02);
    at += (far ? 1.0 : -1.0) * axis * solid + (left ? 1.0 : -1.0) * (solid + pixels * pixel) * aside;
#ifdef LINES
    v_colour = a_colour;
    v_half = a_wide;
    v_aside = left ? pixels : -pixels;
#endif
    v_ray = at - u_eye;
    gl_Position = u_view_projection * vec4(at, 1.0);
}

layout(location = 0) in vec4 a_ball;          // centre, radius
layout(location = 1) in vec4 a_orientation;   // body to table: x, y, z, w
layout(location = 2) in vec4 a_color;         // linear colour, number
layout(location = 3) in vec3 a_pattern;       // pattern, place, distance from the eye
layout(location = 4) in vec4 a_near[MAX_NEAR];   // neighbours: offset of the centre [m], weight
flat out vec4 v_ball;
flat out vec4 v_orientation;
flat out vec4 v_color;
flat out vec3 v_pattern;
#ifndef PLAIN
flat out vec4 v_near[MAX_NEAR];
#endif
void main() {
    v_ball = a_ball;
    v_orientation = a_orientation;
    v_color = a_color;
    v_pattern = a_pattern;
#ifndef PLAIN
    v_near = a_near;
#endif
    vec3 to_eye = u_eye - a_ball.xyz;
    float d = length(to_eye);
    vec3 side = normalize(cross(u_up_scaled, to_eye)), up = cross(to_eye / d, side);
    // The radius of the silhouette at distance d, and 1.5 pixels for its soft edge.
    float pixel = 2.0 * length(u_up_scaled) / u_size.y * d;
    float reach = a_ball.w * d / sqrt(max(d * d - a_ball.w * a_ball.w, 1e-12)) + 1.5 * pixel;
    vec2 corner = octagon_corner(gl_VertexID);
    gl_Position = u_view_projection * vec4(a_ball.xyz + reach * (corner.x * side + corner.y * up), 1.0);
}

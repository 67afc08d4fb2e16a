// A square that faces the eye around a ball, REACH radii wide.
uniform float u_first;
out vec3 v_ray;
flat out int v_ball;
void main() {
    v_ball = int(u_first) + gl_InstanceID;
    vec4 ball = u_balls[v_ball].center;
    vec3 to_eye = u_eye - ball.xyz;
    float d = length(to_eye), R = REACH * ball.w;
    float wide = R * d / sqrt(max(d * d - R * R, 0.01 * d * d)) + 2.0 * length(u_up_scaled) / u_size.y * d;
    vec3 right = normalize(cross(u_up_scaled, to_eye)), up = cross(to_eye, right) / d;
    vec3 at = ball.xyz + wide * (((gl_VertexID & 1) != 0 ? right : -right) + ((gl_VertexID & 2) != 0 ? up
        : -up));
    v_ray = at - u_eye;
    gl_Position = u_view_projection * vec4(at, 1.0);
}

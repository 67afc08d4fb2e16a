// The shadow of a ball on cushions and wood, as paint_shadow_beside() of paint_balls.cpp.
in vec3 v_ray;
flat in int v_ball;
out vec4 color;
void main() {
    vec4 ball = u_balls[v_ball].center;
    vec3 way = v_ray * (behind() / dot(v_ray, u_forward)), away = (u_eye + way - ball.xyz) / ball.w;
    float near = clamp(1.0 - (dot(away, away) - 1.0) / 3.4, 0.0, 1.0);
    float strength = u_balls[v_ball].kind.y > 0.5 ? 0.0 : clamp(ball.z / ball.w, 0.0, 1.0);
    float dark = 0.45 * near * near * smoothstep(0.0, 0.1, (u_eye.z + way.z) / ball.w) * (1.0 - cloth());
    color = vec4(0.0, 0.0, 0.0, dark * strength);
}

in vec2 v_place;
flat in vec2 v_away;
flat in vec4 v_ball;
uniform sampler2D u_background;   // alpha: share of the pixel that is cloth
out vec4 color;
void main() {
#ifdef PLAIN
    float cloth = 1.0;
#elif defined(ONE_SAMPLE)
    float cloth = step(0.99, texelFetch(u_background, ivec2(gl_FragCoord.xy), 0).a);
#else
    float cloth = texelFetch(u_background, ivec2(gl_FragCoord.xy), 0).a;
#endif
#ifdef BESIDE
    // Cushions and wood have any direction: a soft darkening around the ball, down to the cloth.
    vec3 at = u_eye + table_distance(ivec2(gl_FragCoord.xy)) * pixel_ray(gl_FragCoord.xy);
    vec3 away = (at - v_ball.xyz) / v_ball.w;
    float near = clamp(1.0 - (dot(away, away) - 1.0) * (1.0 / 3.4), 0.0, 1.0);
    float dark = 0.6 * near * near * smoothstep(0.0, 0.1, at.z / v_ball.w) * (1.0 - cloth);
#else
    // Share of the sky hidden by a sphere that rests on a plane: (1 + d^2)^(-3/2) at d radii from the contact. The
    // polynomial differs by less than 0.03 up to 2 radii and reaches zero at the edge of the drawn octagon. It needs a
    // fraction of the time, and this shader takes most of the time of a frame.
    float d2 = dot(v_place, v_place);
    float near = max(1.0 - d2 * (1.0 / 6.25), 0.0);
    float hidden = near * near * near;
    // The lamp is wide, so its shadow has no sharp edge.
    vec2 from_shadow = v_place - v_away;
    float inner = max(1.0 - dot(from_shadow, from_shadow) * (1.0 / 3.4), 0.0);
    // From higher up a ball hides less of the sky and of the wide lamp.
    float lift = max(v_ball.z / v_ball.w, 1.0);
    float dark = 1.0 - (1.0 - 0.55 * hidden / (lift * lift)) * (1.0 - 0.55 * inner * inner / lift);
    dark *= cloth;
#endif
    // A ball that falls has no shadow left.
    color = vec4(0.0, 0.0, 0.0, dark * clamp(v_ball.z / v_ball.w, 0.0, 1.0));
}

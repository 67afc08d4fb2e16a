in vec2 v_place;
flat in vec2 v_away;
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
    // Share of the sky hidden by a sphere that rests on a plane: (1 + d^2)^(-3/2) at d radii from the contact. The
    // polynomial differs by less than 0.03 up to 2 radii and reaches zero at the edge of the drawn octagon. It needs a
    // fraction of the time, and this shader takes most of the time of a frame.
    float d2 = dot(v_place, v_place);
    float near = max(1.0 - d2 * (1.0 / 6.25), 0.0);
    float hidden = near * near * near;
    // The lamp is wide, so its shadow has no sharp edge.
    vec2 from_shadow = v_place - v_away;
    float inner = max(1.0 - dot(from_shadow, from_shadow) * (1.0 / 3.4), 0.0);
    float dark = 1.0 - (1.0 - 0.55 * hidden) * (1.0 - 0.55 * inner * inner);
    color = vec4(0.0, 0.0, 0.0, dark * cloth);
}

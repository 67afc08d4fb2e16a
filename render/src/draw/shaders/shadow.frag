in vec2 v_place;
flat in vec2 v_away;
uniform sampler2D u_background;   // alpha: how much of the pixel is cloth
out vec4 color;
void main() {
#ifdef PLAIN
    float cloth = 1.0;
#else
    float cloth = texelFetch(u_background, ivec2(gl_FragCoord.xy), 0).a;
#endif
    // Sky hidden by a sphere that rests on a plane: (1 + d^2)^(-3/2) at d radii from the contact. The polynomial is
    // within 0.03 of it out to 2 radii and then reaches zero with the quad: a fraction of the cost, and it is most of
    // what a frame costs.
    float d2 = dot(v_place, v_place);
    float near = max(1.0 - d2 * (1.0 / 6.25), 0.0);
    float hidden = near * near * near;
    // The lamp is wide: its shadow has no sharp rim.
    vec2 from_shadow = v_place - v_away;
    float inner = max(1.0 - dot(from_shadow, from_shadow) * (1.0 / 3.4), 0.0);
    float dark = 1.0 - (1.0 - 0.55 * hidden) * (1.0 - 0.55 * inner * inner);
    color = vec4(0.0, 0.0, 0.0, dark * cloth);
}

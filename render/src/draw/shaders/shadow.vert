layout(location = 0) in vec4 a_ball;      // centre, radius
layout(location = 3) in vec3 a_pattern;   // pattern, place, unused
out vec2 v_place;                         // position on the cloth relative to the point of contact, in radii
flat out vec4 v_ball;                     // centre, radius
flat out vec2 v_away;                     // centre of the lamp's shadow relative to the point of contact, in radii
void main() {
    // The octagon extends as far as the shading; a ball in a pocket has no shadow.
    float reach = abs(a_pattern.y - 1.0) < 0.5 ? 0.0 : SHADOW_REACH;   // BallPlace: 1 is in a pocket
    v_ball = a_ball;
    vec2 corner = octagon_corner(gl_VertexID);
    v_place = corner * reach;
    vec2 from_lamp = u_lamp_endless > 0.5 ? vec2(0.0) : a_ball.xy - u_lamp.xy;
    // The offset is limited to 0.65 radii, so that the whole shadow lies within SHADOW_REACH.
    v_away = from_lamp / (u_lamp.z - a_ball.z);
    v_away *= min(1.0, 0.65 * inversesqrt(max(dot(v_away, v_away), 1e-12)));
#ifdef BESIDE
    // On what stands beside the ball: the octagon faces the eye and holds everything within 2.15 radii.
    vec3 to_eye = normalize(u_eye - a_ball.xyz), side = normalize(cross(u_up_scaled, to_eye)), up = cross(to_eye, side);
    gl_Position = u_view_projection * vec4(a_ball.xyz + 2.15 * a_ball.w * (corner.x * side + corner.y * up), 1.0);
#else
    // The shadow of a ball in the air is wider, in proportion to the height of its centre, and so farther off.
    float lift = max(a_ball.z / a_ball.w, 1.0);
    gl_Position = u_view_projection * vec4(a_ball.xy + v_place * (a_ball.w * lift), 0.0, 1.0);
#endif
}

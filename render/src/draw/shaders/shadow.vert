layout(location = 0) in vec4 a_ball;      // centre, radius
layout(location = 3) in vec3 a_pattern;   // pattern, in pocket, unused
out vec2 v_place;                         // position on the cloth relative to the point of contact, in radii
flat out vec2 v_away;                     // centre of the lamp's shadow relative to the point of contact, in radii
void main() {
    // The octagon extends as far as the shading; a ball in a pocket has no shadow.
    float reach = a_pattern.y > 0.5 ? 0.0 : SHADOW_REACH;
    vec2 corner = octagon_corner(gl_VertexID);
    v_place = corner * reach;
    vec2 from_lamp = u_lamp_endless > 0.5 ? vec2(0.0) : a_ball.xy - u_lamp.xy;
    // The offset is limited to 0.65 radii, so that the whole shadow lies within SHADOW_REACH.
    v_away = from_lamp / (u_lamp.z - a_ball.z);
    v_away *= min(1.0, 0.65 * inversesqrt(max(dot(v_away, v_away), 1e-12)));
    gl_Position = u_view_projection * vec4(a_ball.xy + v_place * a_ball.w, 0.0, 1.0);
}

layout(location = 0) in vec4 a_ball;      // centre, radius
layout(location = 3) in vec3 a_pattern;   // pattern, in pocket, unused
out vec2 v_place;                         // on the cloth, from the point of contact, in radii
flat out vec2 v_away;                     // where the middle of the lamp's shadow falls, in radii
void main() {
    // The quad reaches as far as the shading does; a ball in a pocket gets none.
    float reach = a_pattern.y > 0.5 ? 0.0 : SHADOW_REACH;
    vec2 corner = octagon_corner(gl_VertexID);
    v_place = corner * reach;
    vec2 from_lamp = u_lamp_endless > 0.5 ? vec2(0.0) : a_ball.xy - u_lamp.xy;
    // No further than that all of it lies within reach.
    v_away = from_lamp / (u_lamp.z - a_ball.z);
    v_away *= min(1.0, 0.65 * inversesqrt(max(dot(v_away, v_away), 1e-12)));
    gl_Position = u_view_projection * vec4(a_ball.xy + v_place * a_ball.w, 0.0, 1.0);
}

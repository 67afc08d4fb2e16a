layout(location = 0) in vec4 a_box;      // low and high corner, pixels
layout(location = 1) in vec4 a_color;
layout(location = 2) in float a_glyph;   // cell of the atlas; negative: a filled rectangle
flat out vec4 v_box;
flat out vec4 v_color;
flat out int v_glyph;
void main() {
    v_box = a_box;
    v_color = a_color;
    v_glyph = int(floor(a_glyph + 0.5));
    vec2 corner = vec2((gl_VertexID & 1) == 0 ? a_box.x - 1.0 : a_box.z + 1.0,
                       (gl_VertexID & 2) == 0 ? a_box.y - 1.0 : a_box.w + 1.0);
    gl_Position = vec4(corner / u_size * 2.0 - 1.0, 0.0, 1.0);
}

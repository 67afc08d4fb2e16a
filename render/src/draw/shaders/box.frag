flat in vec4 v_box;
flat in vec4 v_color;
flat in int v_glyph;
uniform sampler2D u_glyphs;
out vec4 color;
void main() {
    vec2 extent = v_box.zw - v_box.xy, at = gl_FragCoord.xy - v_box.xy;
    vec2 edge = clamp(min(at, extent - at) + 0.5, 0.0, 1.0);
    float cover = edge.x * edge.y;
    if (v_glyph >= 0) {
        vec2 unit = clamp(at / extent, vec2(0.02), vec2(0.98));
        float near = texture(u_glyphs, (vec2(v_glyph % 8, v_glyph / 8) + unit) * 0.125).r;
        // Distances are in units of the glyph; the height of the cell is 9 units.
        cover *= clamp(0.5 - ((1.0 - near) * 1.5 - 0.5) * extent.y / 9.0, 0.0, 1.0);
    }
    color = vec4(v_color.rgb, v_color.a * cover);
}

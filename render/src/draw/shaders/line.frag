flat in vec4 v_ends;
flat in vec2 v_closeness;
flat in vec4 v_color;
flat in float v_half;
out vec4 color;
void main() {
    vec2 along = v_ends.zw - v_ends.xy, at = gl_FragCoord.xy - v_ends.xy;
    float t = clamp(dot(at, along) / max(dot(along, along), 1e-6), 0.0, 1.0);
    float cover = clamp(0.5 + v_half - length(at - t * along), 0.0, 1.0);
    float depth = 1.0 / mix(v_closeness.x, v_closeness.y, t);
    cover *= seen(ivec2(gl_FragCoord.xy), depth * 0.998 - 0.002);
    color = vec4(v_color.rgb, v_color.a * cover);
}

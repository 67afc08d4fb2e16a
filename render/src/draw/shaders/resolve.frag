uniform sampler2D u_pass;
out vec4 color;
void main() {
    vec4 sum = texelFetch(u_pass, ivec2(gl_FragCoord.xy), 0);
    color = vec4(to_screen(sum.rgb), sum.a);
}

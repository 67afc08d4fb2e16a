uniform sampler2D u_pass;
uniform float u_weight;
out vec4 color;
void main() { color = texelFetch(u_pass, ivec2(gl_FragCoord.xy), 0) * u_weight; }

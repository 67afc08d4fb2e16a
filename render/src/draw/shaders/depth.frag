uniform sampler2D u_depth0, u_depth1, u_depth2, u_depth3;
out vec4 color;
void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    vec4 z = vec4(texelFetch(u_depth0, at, 0).r, texelFetch(u_depth1, at, 0).r, texelFetch(u_depth2, at, 0).r,
                  texelFetch(u_depth3, at, 0).r);
    float n = u_planes.x, f = u_planes.y;
    color = n * f / (f - z * (f - n));
}

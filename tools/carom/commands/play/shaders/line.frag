flat in vec4 v_colour;
flat in float v_half;
in float v_aside;
in vec3 v_ray;
out vec4 color;
void main() {
    float cover = clamp(v_half + 0.5 - abs(v_aside), 0.0, 1.0);
    color = vec4(v_colour.rgb, v_colour.a * cover * seen(dot(v_ray, u_forward) - 0.005));
}

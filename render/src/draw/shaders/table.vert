layout(location = 0) in vec3 a_position;
layout(location = 1) in vec3 a_normal;
layout(location = 2) in vec4 a_surface;   // u, v, material, alpha of the picture
uniform vec2 u_jitter;                    // offset of this pass in clip space
out gl_PerVertex { vec4 gl_Position; };
layout(location = 0) out vec3 v_position;
layout(location = 1) out vec3 v_normal;
layout(location = 2) out vec2 v_uv;
layout(location = 3) flat out int v_material;
layout(location = 4) flat out float v_face;
void main() {
    v_position = a_position;
    v_normal = a_normal;
    v_uv = a_surface.xy;
    v_material = int(a_surface.z + 0.5);
    v_face = a_surface.w;
    gl_Position = u_view_projection * vec4(a_position, 1.0);
    gl_Position.xy += u_jitter * gl_Position.w;
}

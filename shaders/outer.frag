#version 330 core
// A headlight without fall-off; a thin wall is denser where the ray runs along it.
in vec3 v_position;
in vec3 v_normal;
in vec3 v_color;

uniform float u_alpha;  // of a wall seen straight on; 1 = opaque

layout(location = 0) out vec4 o_color;  // premultiplied, square root of linear light

void main() {
    float facing = abs(dot(v_normal, v_position)) * inversesqrt(dot(v_position, v_position) * dot(v_normal, v_normal) + 1e-12);
    float alpha = u_alpha >= 1.0 ? 1.0 : clamp(u_alpha / (0.25 + 0.75 * facing), 0.0, 0.9);
    vec3 linear = v_color * (0.35 + 0.65 * facing);
    o_color = vec4(sqrt(clamp(linear, 0.0, 1.0)) * alpha, alpha);
}

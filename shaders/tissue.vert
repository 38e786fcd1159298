#version 330 core
// Lit surfaces seen from a camera that carries the light.
layout(location = 0) in vec3 a_position;  // mm, camera frame (x right, y down, z forward)
layout(location = 1) in vec3 a_normal;    // unit, camera frame
layout(location = 2) in vec4 a_color;     // linear RGB, gloss
layout(location = 3) in vec3 a_grain;     // mm, a point that moves with the tissue

uniform mat4 u_clip;

out vec3 v_position;
out vec3 v_normal;
out vec4 v_color;
out vec3 v_grain;

void main() {
    v_position = a_position;
    v_normal = a_normal;
    v_color = a_color;
    v_grain = a_grain;
    gl_Position = u_clip * vec4(a_position, 1.0);
}

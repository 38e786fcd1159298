#version 330 core
// Vessels and devices from outside.
layout(location = 0) in vec3 a_position;  // mm, camera frame (x right, y down, z forward)
layout(location = 1) in vec3 a_normal;    // unit, camera frame
layout(location = 2) in vec3 a_color;     // linear RGB

uniform mat4 u_clip;

out vec3 v_position;
out vec3 v_normal;
out vec3 v_color;

void main() {
    v_position = a_position;
    v_normal = a_normal;
    v_color = a_color;
    gl_Position = u_clip * vec4(a_position, 1.0);
}

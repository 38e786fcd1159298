#version 330 core
// Panels: pixels from the top left, row 0 of the picture first.
layout(location = 0) in vec2 a_position;
layout(location = 1) in vec2 a_texture;
layout(location = 2) in vec4 a_color;

uniform vec2 u_size;  // pixels

out vec2 v_texture;
out vec4 v_color;

void main() {
    v_texture = a_texture;
    v_color = a_color;
    gl_Position = vec4(2.0 * a_position / u_size - 1.0, 0.0, 1.0);
}

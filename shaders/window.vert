#version 330 core
// Pictures and panels of a window: pixels from the top left.
layout(location = 0) in vec2 a_position;
layout(location = 1) in vec2 a_texture;
layout(location = 2) in vec4 a_color;

uniform vec2 u_size;  // pixels
uniform float u_up;   // 1: row 0 comes first in memory; -1: the window's own way, row 0 at the top

out vec2 v_texture;
out vec4 v_color;

void main() {
    v_texture = a_texture;
    v_color = a_color;
    vec2 at = 2.0 * a_position / u_size - 1.0;
    gl_Position = vec4(at.x, u_up * at.y, 0.0, 1.0);
}

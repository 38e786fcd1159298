#version 330 core
// Adds +distance where the ray leaves a closed surface and -distance where it enters [freud2006].
// Blended with GL_ONE, GL_ONE into float32: (path length, leaving - entering).
in vec3 v_from_source;

uniform float u_leaves_where_front;  // +1 or -1: sign of a front-facing fragment
uniform float u_reference;           // mm, taken off every distance: keeps the sums small

layout(location = 0) out vec2 o_sum;

void main() {
    float sign = gl_FrontFacing ? u_leaves_where_front : -u_leaves_where_front;
    o_sum = vec2(sign * (length(v_from_source) - u_reference), sign);
}

#version 330 core
// Adds +distance where the ray leaves a closed surface and -distance where it enters [freud2006].
// Blended with GL_ONE, GL_ONE into float32: (path length, leaving - entering, contrast moment, contrast jump).
in vec3 v_from_source;
in float v_value;

uniform float u_leaves_where_front;  // +1 or -1: sign of a front-facing fragment
uniform float u_reference;           // mm, taken off every distance: keeps the sums small

layout(location = 0) out vec4 o_sum;
layout(location = 1) out vec4 o_square;

void main() {
    float sign = gl_FrontFacing ? u_leaves_where_front : -u_leaves_where_front;
    float d = length(v_from_source) - u_reference;
    o_sum = vec4(sign * d, sign, sign * v_value * d, sign * v_value);
    o_square = vec4(sign * d * d, 0.0, 0.0, 0.0);
}

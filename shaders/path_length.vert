#version 330 core
// Projects a vertex through the X-ray source onto the detector; the position relative to the source goes along, so that
// the fragment shader has the exact distance on every flat triangle.
layout(location = 0) in vec3 a_position;  // mm, world

uniform vec3 u_source;    // mm, world
uniform mat4 u_detector;  // source-centred mm -> clip space, depth fixed at 0: nothing can be cut by a near plane

out vec3 v_from_source;

void main() {
    v_from_source = a_position - u_source;
    gl_Position = u_detector * vec4(v_from_source, 1.0);
}

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
out vec2 v_grain;  // in turns of the two waves whose product is the grain

// sin(x) within 0.06, by parabolas: a software rasteriser pays dearly for the real one.
float wave(float x) {
    float f = fract(x * 0.15915494) - 0.5;
    return 8.0 * f * (2.0 * abs(f) - 1.0);
}

void main() {
    v_position = a_position;
    v_normal = a_normal;
    v_color = a_color;
    // The slow waves that bend the streaks are many triangles long: a value a corner is enough.
    v_grain = 0.15915494 * vec2(a_grain.x * 1.7 + 1.3 * wave(a_grain.z * 0.45),
                                a_grain.y * 1.9 + 1.1 * wave(a_grain.z * 0.6));
    gl_Position = u_clip * vec4(a_position, 1.0);
}

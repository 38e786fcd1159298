#version 330 core
// Headlight at the camera: diffuse + specular (Blinn), fall-off with distance, wrapped a little as wet tissue scatters.
in vec3 v_position;
in vec3 v_normal;
in vec4 v_color;
in vec3 v_grain;

uniform float u_light_range;  // mm, intensity there is a quarter

layout(location = 0) out vec4 o_color;

// sin(x) within 0.06, by parabolas: a software rasteriser pays dearly for the real one.
float wave(float x) {
    float f = fract(x * 0.15915494) - 0.5;
    return 8.0 * f * (2.0 * abs(f) - 1.0);
}

void main() {
    float distance = length(v_position);
    vec3 to_eye = -v_position / max(distance, 1e-4);
    vec3 normal = normalize(v_normal);
    if (dot(normal, to_eye) < 0.0) normal = -normal;
    float facing = dot(normal, to_eye);
    float reach = 1.0 / (1.0 + 3.0 * (distance / u_light_range) * (distance / u_light_range));
    float diffuse = 0.18 + 0.82 * facing;
    // Light and camera stand at the same place, so the half vector is the direction to the eye.
    float facing_4 = facing * facing * facing * facing;
    float facing_16 = facing_4 * facing_4 * facing_4 * facing_4;
    float specular = v_color.a * facing_16 * facing_16 * facing_16;  // exponent 48
    // Faint streaks, finer along one axis: gives the eye something that moves with the wall.
    float grain = wave(v_grain.x * 1.7 + 1.3 * wave(v_grain.z * 0.45)) * wave(v_grain.y * 1.9 + 1.1 * wave(v_grain.z * 0.6));
    vec3 color = v_color.rgb * (1.0 + 0.07 * v_color.a * grain);
    vec3 linear = (color * diffuse + vec3(0.45) * specular) * reach * 0.62;
    // Filmic shoulder; the square root keeps the dark shades apart in eight bits, and the reader makes the display's gamma
    // of it.
    linear = linear / (linear + vec3(0.55)) * 1.55;
    o_color = vec4(sqrt(clamp(linear, 0.0, 1.0)), 1.0);
}

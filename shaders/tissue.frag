#version 330 core
// Headlight at the camera: diffuse + specular (Blinn), fall-off with distance, wrapped a little as wet tissue scatters.
in vec3 v_position;
in vec3 v_normal;
in vec4 v_color;
in vec2 v_grain;

uniform float u_light_falloff;  // 3 / range^2, 1/mm2: at the range a quarter is left

layout(location = 0) out vec4 o_color;

void main() {
    // Light and camera stand at the same place, so the half vector is the direction to the eye.
    float away = dot(v_position, v_position);
    float facing = abs(dot(v_normal, v_position)) * inversesqrt(away * dot(v_normal, v_normal) + 1e-12);
    float reach = 0.62 / (1.0 + u_light_falloff * away);
    float diffuse = (0.18 + 0.82 * facing) * reach;
    float facing_4 = facing * facing * facing * facing;
    float facing_16 = facing_4 * facing_4 * facing_4 * facing_4;
    float specular = 0.45 * reach * v_color.a * facing_16 * facing_16 * facing_16;  // exponent 48
    // Faint streaks, finer along one axis: gives the eye something that moves with the wall.  Of both waves, the sine by
    // parabolas as in tissue.vert.
    vec2 f = fract(v_grain) - 0.5;
    vec2 wave = f * (2.0 * abs(f) - 1.0);
    float grain = 1.0 + 4.48 * v_color.a * wave.x * wave.y;  // 0.07 * 8 * 8
    vec3 linear = v_color.rgb * (diffuse * grain) + vec3(specular);
    // Filmic shoulder; the square root keeps the dark shades apart in eight bits, and the reader makes the display's gamma
    // of it.
    linear = linear / (linear + vec3(0.55)) * 1.55;
    o_color = vec4(sqrt(clamp(linear, 0.0, 1.0)), 1.0);
}

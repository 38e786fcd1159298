#version 330 core
// Headlight at the camera: diffuse + specular (Blinn), fall-off with distance, wrapped a little as wet tissue scatters.
in vec3 v_position;
in vec3 v_normal;
in vec4 v_color;
in vec3 v_grain;

uniform float u_light_range;  // mm, intensity there is a quarter

layout(location = 0) out vec4 o_color;

void main() {
    float distance = length(v_position);
    vec3 to_eye = -v_position / max(distance, 1e-4);
    vec3 normal = normalize(v_normal);
    if (dot(normal, to_eye) < 0.0) normal = -normal;
    float facing = dot(normal, to_eye);
    float reach = 1.0 / (1.0 + 3.0 * (distance / u_light_range) * (distance / u_light_range));
    float diffuse = 0.18 + 0.82 * facing;
    // Light and camera stand at the same place, so the half vector is the direction to the eye.
    float specular = v_color.a * pow(facing, 48.0);
    // Faint streaks, finer along one axis: gives the eye something that moves with the wall.
    float grain = sin(v_grain.x * 1.7 + 1.3 * sin(v_grain.z * 0.45)) * sin(v_grain.y * 1.9 + 1.1 * sin(v_grain.z * 0.6));
    vec3 color = v_color.rgb * (1.0 + 0.07 * v_color.a * grain);
    vec3 linear = (color * diffuse + vec3(0.45) * specular) * reach * 0.62;
    // Filmic shoulder, then the display's gamma.
    linear = linear / (linear + vec3(0.55)) * 1.55;
    o_color = vec4(pow(clamp(linear, 0.0, 1.0), vec3(1.0 / 2.2)), 1.0);
}

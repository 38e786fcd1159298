#version 330 core
in vec2 v_texture;
in vec4 v_color;

uniform sampler2D u_atlas;  // coverage

layout(location = 0) out vec4 o_color;  // premultiplied

void main() {
    float alpha = v_color.a * texture(u_atlas, v_texture).r;
    o_color = vec4(v_color.rgb * alpha, alpha);
}

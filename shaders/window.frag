#version 330 core
in vec2 v_texture;
in vec4 v_color;

uniform sampler2D u_texture;
uniform int u_coverage;  // 1: the texture's red is the coverage of a panel's glyphs; 0: the texture is a picture

layout(location = 0) out vec4 o_color;  // premultiplied

void main() {
    vec4 texel = texture(u_texture, v_texture);
    if (u_coverage == 0) {
        o_color = vec4(texel.rgb, 1.0);
    } else {
        float alpha = v_color.a * texel.r;
        o_color = vec4(v_color.rgb * alpha, alpha);
    }
}

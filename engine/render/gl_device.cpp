#include "render/gl_device.h"

#include <bit>
#include <cstdint>
#include <utility>

#include "core/check.h"
#include "core/errors.h"

namespace cathlab {
namespace {

/// OpenGL takes offsets into the bound buffer in the shape of addresses.
const void* buffer_offset(std::uintptr_t bytes) {
    return std::bit_cast<const void*>(bytes);
}

}  // namespace

GlDevice::GlDevice(std::unique_ptr<GlTarget> target) : target_(std::move(target)) {
    target_->make_current();
#define X(type, name)                                                          \
    gl_.name = reinterpret_cast<PFNGL##type##PROC>(target_->proc("gl" #name)); \
    if (gl_.name == nullptr) throw UserError("cannot draw off-screen: this OpenGL lacks gl" #name);
    CATHLAB_GL_FUNCTIONS(X)
#undef X
}

std::string GlDevice::description() const {
    const auto text = [&](GLenum what) {
        const GLubyte* found = gl_.GetString(what);
        return std::string(found != nullptr ? reinterpret_cast<const char*>(found) : "?");
    };
    return target_->name() + ": " + text(GL_VERSION) + ", " + text(GL_RENDERER);
}

void GlDevice::check(const char* what) const {
    const GLenum error = gl_.GetError();
    CATHLAB_CHECK(error == GL_NO_ERROR, std::string("OpenGL error ") + std::to_string(error) + " in " + what);
}

namespace {

GLuint compiled(const GlTable& gl, GLenum kind, const std::string& source) {
    const GLuint shader = gl.CreateShader(kind);
    const char* text = source.c_str();
    gl.ShaderSource(shader, 1, &text, nullptr);
    gl.CompileShader(shader);
    GLint good = 0;
    gl.GetShaderiv(shader, GL_COMPILE_STATUS, &good);
    if (good == 0) {
        std::string message(2000, '\0');
        gl.GetShaderInfoLog(shader, static_cast<GLsizei>(message.size()), nullptr, message.data());
        CATHLAB_CHECK(false, "shader does not compile: " + message);
    }
    return shader;
}

}  // namespace

GlProgram::GlProgram(GlDevicePtr device, const std::string& vertex_source, const std::string& fragment_source)
    : device_(std::move(device)) {
    const GlTable& gl = device_->gl();
    const GLuint vertex = compiled(gl, GL_VERTEX_SHADER, vertex_source);
    const GLuint fragment = compiled(gl, GL_FRAGMENT_SHADER, fragment_source);
    id_ = gl.CreateProgram();
    gl.AttachShader(id_, vertex);
    gl.AttachShader(id_, fragment);
    gl.LinkProgram(id_);
    gl.DeleteShader(vertex);
    gl.DeleteShader(fragment);
    GLint good = 0;
    gl.GetProgramiv(id_, GL_LINK_STATUS, &good);
    if (good == 0) {
        std::string message(2000, '\0');
        gl.GetProgramInfoLog(id_, static_cast<GLsizei>(message.size()), nullptr, message.data());
        CATHLAB_CHECK(false, "program does not link: " + message);
    }
}

GlProgram::~GlProgram() {
    device_->make_current();
    device_->gl().DeleteProgram(id_);
}

void GlProgram::use() const {
    device_->gl().UseProgram(id_);
}
GLint GlProgram::uniform(const char* name) const {
    return device_->gl().GetUniformLocation(id_, name);
}

GlMesh::GlMesh(GlDevicePtr device, std::vector<int> attribute_sizes) : device_(std::move(device)) {
    const GlTable& gl = device_->gl();
    gl.GenVertexArrays(1, &array_);
    gl.GenBuffers(1, &vertices_);
    gl.GenBuffers(1, &indices_);
    gl.BindVertexArray(array_);
    gl.BindBuffer(GL_ARRAY_BUFFER, vertices_);
    gl.BindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices_);
    int stride = 0;
    for (const int size : attribute_sizes) stride += size;
    std::uintptr_t offset = 0;
    for (std::size_t i = 0; i < attribute_sizes.size(); ++i) {
        gl.EnableVertexAttribArray(static_cast<GLuint>(i));
        gl.VertexAttribPointer(static_cast<GLuint>(i), attribute_sizes[i], GL_FLOAT, GL_FALSE,
                               static_cast<GLsizei>(static_cast<std::size_t>(stride) * sizeof(float)),
                               buffer_offset(offset));
        offset += static_cast<std::uintptr_t>(attribute_sizes[i]) * sizeof(float);
    }
}

GlMesh::~GlMesh() {
    device_->make_current();
    const GlTable& gl = device_->gl();
    gl.DeleteBuffers(1, &vertices_);
    gl.DeleteBuffers(1, &indices_);
    gl.DeleteVertexArrays(1, &array_);
}

void GlMesh::set_vertices(const std::vector<float>& data) {
    const GlTable& gl = device_->gl();
    gl.BindBuffer(GL_ARRAY_BUFFER, vertices_);
    gl.BufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(data.size() * sizeof(float)), data.data(), GL_STREAM_DRAW);
}

void GlMesh::set_indices(const std::vector<GLuint>& indices) {
    const GlTable& gl = device_->gl();
    gl.BindVertexArray(array_);
    gl.BindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices_);
    gl.BufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(indices.size() * sizeof(GLuint)), indices.data(),
                  GL_STREAM_DRAW);
    count_ = indices.size();
}

void GlMesh::draw() const {
    draw(0, count_);
}

void GlMesh::draw(std::size_t first, std::size_t count) const {
    if (count == 0) return;
    const GlTable& gl = device_->gl();
    gl.BindVertexArray(array_);
    gl.DrawElements(GL_TRIANGLES, static_cast<GLsizei>(count), GL_UNSIGNED_INT, buffer_offset(first * sizeof(GLuint)));
}

GlFramebuffer::GlFramebuffer(GlDevicePtr device, int width, int height, const std::vector<GLenum>& formats, bool depth)
    : device_(std::move(device)), width_(width), height_(height), textures_(formats.size()) {
    const GlTable& gl = device_->gl();
    gl.GenFramebuffers(1, &id_);
    gl.BindFramebuffer(GL_FRAMEBUFFER, id_);
    gl.GenTextures(static_cast<GLsizei>(textures_.size()), textures_.data());
    std::vector<GLenum> buffers;
    for (std::size_t i = 0; i < formats.size(); ++i) {
        gl.BindTexture(GL_TEXTURE_2D, textures_[i]);
        const GLenum type = formats[i] == GL_RGBA8 ? GL_UNSIGNED_BYTE : GL_FLOAT;
        gl.TexImage2D(GL_TEXTURE_2D, 0, static_cast<GLint>(formats[i]), width, height, 0, GL_RGBA, type, nullptr);
        gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
        gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
        buffers.push_back(GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(i));
        gl.FramebufferTexture2D(GL_FRAMEBUFFER, buffers.back(), GL_TEXTURE_2D, textures_[i], 0);
    }
    gl.DrawBuffers(static_cast<GLsizei>(buffers.size()), buffers.data());
    if (depth) {
        gl.GenRenderbuffers(1, &depth_);
        gl.BindRenderbuffer(GL_RENDERBUFFER, depth_);
        gl.RenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH_COMPONENT24, width, height);
        gl.FramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, depth_);
    }
    if (gl.CheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
        throw UserError("cannot draw off-screen: no framebuffer of " + std::to_string(width) + "x" +
                        std::to_string(height) + " in the wanted format");
    }
}

GlFramebuffer::~GlFramebuffer() {
    device_->make_current();
    const GlTable& gl = device_->gl();
    gl.DeleteTextures(static_cast<GLsizei>(textures_.size()), textures_.data());
    if (depth_ != 0) gl.DeleteRenderbuffers(1, &depth_);
    gl.DeleteFramebuffers(1, &id_);
}

void GlFramebuffer::bind() const {
    const GlTable& gl = device_->gl();
    gl.BindFramebuffer(GL_FRAMEBUFFER, id_);
    gl.Viewport(0, 0, width_, height_);
}

void GlFramebuffer::read(int attachment, GLenum format, GLenum type, void* out) const {
    device_->gl().BindFramebuffer(GL_FRAMEBUFFER, id_);
    device_->gl().ReadBuffer(GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(attachment));
    read_rows(0, height_, format, type, out);
}

void GlFramebuffer::read_rows(int first, int last, GLenum format, GLenum type, void* out) const {
    const GlTable& gl = device_->gl();
    gl.BindFramebuffer(GL_FRAMEBUFFER, id_);
    gl.PixelStorei(GL_PACK_ALIGNMENT, 1);
    gl.ReadPixels(0, first, width_, last - first, format, type, out);
}

}  // namespace cathlab

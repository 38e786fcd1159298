// A context with its table, and owners for the GL objects that the room uses.  For this room's .cpp files only.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "render/gl_table.h"
#include "render/gl_target.h"

namespace cathlab {

/// One context; everything below holds it alive.
class GlDevice {
public:
    explicit GlDevice(std::unique_ptr<GlTarget> target);
    void make_current() { target_->make_current(); }
    const GlTable& gl() const { return gl_; }
    std::string description() const;     ///< "osmesa: 4.5 (Core Profile) Mesa ..., llvmpipe ..."
    void check(const char* what) const;  ///< CATHLAB_CHECK that GL reports no error

private:
    std::unique_ptr<GlTarget> target_;
    GlTable gl_;
};
using GlDevicePtr = std::shared_ptr<GlDevice>;

class GlProgram {
public:
    GlProgram(GlDevicePtr device, const std::string& vertex_source, const std::string& fragment_source);
    ~GlProgram();
    GlProgram(const GlProgram&) = delete;
    GlProgram& operator=(const GlProgram&) = delete;
    void use() const;
    GLint uniform(const char* name) const;

private:
    GlDevicePtr device_;
    GLuint id_ = 0;
};

/// Vertices of `floats` numbers each and 32-bit indices; attributes 0, 1, ... of the given sizes follow one another.
class GlMesh {
public:
    GlMesh(GlDevicePtr device, std::vector<int> attribute_sizes);
    ~GlMesh();
    GlMesh(const GlMesh&) = delete;
    GlMesh& operator=(const GlMesh&) = delete;
    void set_vertices(const std::vector<float>& data);
    void set_indices(const std::vector<GLuint>& indices);
    void draw() const;
    void draw(std::size_t first, std::size_t count) const;

private:
    GlDevicePtr device_;
    GLuint array_ = 0, vertices_ = 0, indices_ = 0;
    std::size_t count_ = 0;
};

/// Colour textures of one format, optionally with a depth buffer.
class GlFramebuffer {
public:
    GlFramebuffer(GlDevicePtr device, int width, int height, const std::vector<GLenum>& formats, bool depth);
    ~GlFramebuffer();
    GlFramebuffer(const GlFramebuffer&) = delete;
    GlFramebuffer& operator=(const GlFramebuffer&) = delete;
    void bind() const;  ///< for drawing, with its viewport
    void read(int attachment, GLenum format, GLenum type, void* out) const;
    /// Rows [first, last) only, to the start of `out`.
    void read_rows(int first, int last, GLenum format, GLenum type, void* out) const;
    int width() const { return width_; }
    int height() const { return height_; }

private:
    GlDevicePtr device_;
    int width_, height_;
    GLuint id_ = 0, depth_ = 0;
    std::vector<GLuint> textures_;
};

}  // namespace cathlab

// Every GL function that this room calls, filled from whichever library made the context.  For this room's .cpp files
// only.
#pragma once

#include <GL/glcorearb.h>

#define CATHLAB_GL_FUNCTIONS(X)                         \
    X(ACTIVETEXTURE, ActiveTexture)                     \
    X(ATTACHSHADER, AttachShader)                       \
    X(BINDBUFFER, BindBuffer)                           \
    X(BINDFRAMEBUFFER, BindFramebuffer)                 \
    X(BINDRENDERBUFFER, BindRenderbuffer)               \
    X(BINDTEXTURE, BindTexture)                         \
    X(BINDVERTEXARRAY, BindVertexArray)                 \
    X(BLENDEQUATION, BlendEquation)                     \
    X(BLENDFUNC, BlendFunc)                             \
    X(BLENDFUNCSEPARATE, BlendFuncSeparate)             \
    X(BUFFERDATA, BufferData)                           \
    X(CHECKFRAMEBUFFERSTATUS, CheckFramebufferStatus)   \
    X(CLAMPCOLOR, ClampColor)                           \
    X(CLEAR, Clear)                                     \
    X(CLEARCOLOR, ClearColor)                           \
    X(COMPILESHADER, CompileShader)                     \
    X(CREATEPROGRAM, CreateProgram)                     \
    X(CREATESHADER, CreateShader)                       \
    X(CULLFACE, CullFace)                               \
    X(DELETEBUFFERS, DeleteBuffers)                     \
    X(DELETEFRAMEBUFFERS, DeleteFramebuffers)           \
    X(DELETEPROGRAM, DeleteProgram)                     \
    X(DELETERENDERBUFFERS, DeleteRenderbuffers)         \
    X(DELETESHADER, DeleteShader)                       \
    X(DELETETEXTURES, DeleteTextures)                   \
    X(DELETEVERTEXARRAYS, DeleteVertexArrays)           \
    X(DEPTHMASK, DepthMask)                             \
    X(DISABLE, Disable)                                 \
    X(DRAWBUFFERS, DrawBuffers)                         \
    X(DRAWELEMENTS, DrawElements)                       \
    X(ENABLE, Enable)                                   \
    X(ENABLEVERTEXATTRIBARRAY, EnableVertexAttribArray) \
    X(FRAMEBUFFERRENDERBUFFER, FramebufferRenderbuffer) \
    X(FRAMEBUFFERTEXTURE2D, FramebufferTexture2D)       \
    X(GENBUFFERS, GenBuffers)                           \
    X(GENFRAMEBUFFERS, GenFramebuffers)                 \
    X(GENRENDERBUFFERS, GenRenderbuffers)               \
    X(GENTEXTURES, GenTextures)                         \
    X(GENVERTEXARRAYS, GenVertexArrays)                 \
    X(GETERROR, GetError)                               \
    X(GETPROGRAMINFOLOG, GetProgramInfoLog)             \
    X(GETPROGRAMIV, GetProgramiv)                       \
    X(GETSHADERINFOLOG, GetShaderInfoLog)               \
    X(GETSHADERIV, GetShaderiv)                         \
    X(GETSTRING, GetString)                             \
    X(GETUNIFORMLOCATION, GetUniformLocation)           \
    X(LINKPROGRAM, LinkProgram)                         \
    X(PIXELSTOREI, PixelStorei)                         \
    X(READBUFFER, ReadBuffer)                           \
    X(READPIXELS, ReadPixels)                           \
    X(RENDERBUFFERSTORAGE, RenderbufferStorage)         \
    X(SCISSOR, Scissor)                                 \
    X(SHADERSOURCE, ShaderSource)                       \
    X(TEXIMAGE2D, TexImage2D)                           \
    X(TEXPARAMETERI, TexParameteri)                     \
    X(UNIFORM1F, Uniform1f)                             \
    X(UNIFORM1I, Uniform1i)                             \
    X(UNIFORM2F, Uniform2f)                             \
    X(UNIFORM3F, Uniform3f)                             \
    X(UNIFORM4F, Uniform4f)                             \
    X(UNIFORMMATRIX4FV, UniformMatrix4fv)               \
    X(USEPROGRAM, UseProgram)                           \
    X(VERTEXATTRIBPOINTER, VertexAttribPointer)         \
    X(VIEWPORT, Viewport)

namespace cathlab {

struct GlTable {
#define X(type, name) PFNGL##type##PROC name = nullptr;
    CATHLAB_GL_FUNCTIONS(X)
#undef X
};

}  // namespace cathlab

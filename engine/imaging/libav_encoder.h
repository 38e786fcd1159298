// One film through libavcodec and libavformat, without a thread of its own.  For this room's .cpp files only.
#pragma once

#include <memory>
#include <string>

#include "imaging/image.h"

namespace cathlab {

enum class FilmCodec {
    h264,     ///< libx264, 4:2:0
    mpeg4,    ///< MPEG-4 part 2, 4:2:0: where the system has no H.264 encoder
    lossless  ///< FFV1, every byte of RGB
};

/// Opened in the constructor, whole after finish().  The bytes are a function of the pictures alone: one thread, no
/// clock, no version in the container.
class LibavEncoder {
public:
    /// Whether this system's libavcodec can.
    static bool knows(FilmCodec codec);

    /// The container follows the path's ending.  Throws std::runtime_error with the library's own words.
    LibavEncoder(const std::string& path, FilmCodec codec, int width, int height, double fps);
    ~LibavEncoder();
    LibavEncoder(const LibavEncoder&) = delete;
    LibavEncoder& operator=(const LibavEncoder&) = delete;

    /// The next picture, of the film's size.  Throws std::runtime_error, for instance on a full disk.
    void write(const Image8& picture);
    /// What the encoder still holds, then the container's index.  Throws std::runtime_error.
    void finish();

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace cathlab

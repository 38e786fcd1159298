// Frames -> a film that plays everywhere (H.264 in MP4), or one without loss (FFV1 in AVI).
#pragma once

#include <cstddef>
#include <memory>
#include <string>

#include "imaging/image.h"

namespace cathlab {

/// Writes NAME.part.EXT and renames it to NAME.EXT in close(), so the final name never holds half a film.
/// Encodes on the caller's thread and takes no other, so that a program's threads are those that it was given.
/// The codec follows the name: .avi = FFV1 (lossless), .mp4 = H.264 (avc1), or MPEG-4 part 2 (mp4v) with a line in the
/// log where the system has no H.264 encoder.
class VideoWriter {
public:
    /// fps in (0, 240]; width and height even (4:2:0 halves the colour planes), at least 16.
    /// codec: "h264", "mpeg4" (.mp4) or "ffv1" (.avi), and nothing else is taken for it; "": as the name says.
    /// Throws UserError on odd or tiny sizes, an unknown extension, an unwritable or full folder, a codec that is
    /// unknown, does not go with the name, or that this system has no encoder of.
    VideoWriter(const std::string& path, int width, int height, double fps, const std::string& codec = "");
    /// Without close() before it: the film is given up, and its part file removed.
    ~VideoWriter();
    VideoWriter(const VideoWriter&) = delete;
    VideoWriter& operator=(const VideoWriter&) = delete;

    /// Appends a frame.  Throws UserError where the encoder stopped; CATHLAB_CHECK on a wrong size.
    void add(const Image8& frame);

    /// Finishes what is there, reads it back, checks number and size of the frames, then gives it its final name.
    /// Throws UserError (no frame, count or size differ, for instance on a full disk) and then leaves no file.
    void close();

    std::size_t frames() const;
    const std::string& codec() const;  ///< "FFV1", "avc1" or "mp4v"

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// What a film holds: every picture's data are read from the file, and those that others do not lean on (in an .avi:
/// all) are decoded.  Throws UserError where it cannot be opened, or one of them is cut short, broken or of another
/// size.
struct VideoFacts {
    std::size_t frames = 0;
    int width = 0;
    int height = 0;
    double fps = 0;
};
VideoFacts read_video_facts(const std::string& path);

/// Frame `index` of a film as a picture; throws UserError where there is none.
Image8 read_video_frame(const std::string& path, std::size_t index);

}  // namespace cathlab

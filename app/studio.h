// Where a film's pictures are drawn and encoded: the GL context and the encoder, both of the thread that made it.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "imaging/dicom_writer.h"
#include "imaging/image.h"
#include "render/frame_description.h"
#include "view_change.h"

namespace cathlab {

struct FilmOptions {
    std::string path;  ///< "" = no film, pictures alone (for a benchmark)
    int width = 1024;
    int height = 512;
    double fps = 15.0;
    std::function<void(std::string_view part)> probe = {};  ///< called as each part of a picture begins, "" as it ends
    std::string labels = {};                                ///< a COCO file, "" = none
    std::string dicom = {};                                 ///< a DICOM file of the fluoroscopy, "" = none
    DicomFacts dicom_facts = {};
    std::string frames = {};       ///< a folder for what the detector read in each picture, "" = none
    std::string codec = {};        ///< of the film, "" = as its name says
    bool frames_as_float = false;  ///< raw floats instead of 16-bit PNG
    ViewChange view = {};
    int draw_threads = 1;  ///< of a picture; the bytes are the same on any number
    /// Called as the film is closed: pictures that were exposed, and those of them in which a ray did not leave what it
    /// entered.
    std::function<void(std::size_t exposed, std::size_t open)> at_close = {};
};

/// What a picture is drawn from, and what the machine said when it was taken.
struct FilmFrame {
    FrameDescription picture;
    DicomFrame machine;
};

/// One description after another -> pictures -> the film.  Make it, use it and let it go on one thread: a GL context
/// belongs to the thread where it is current.  The encoder may work beside it, a picture behind.
class Studio {
public:
    /// Throws UserError: no off-screen GL, no encoder, an unwritable folder, an odd size.
    Studio(const FilmOptions& options, bool encode_apart);
    ~Studio();
    Studio(const Studio&) = delete;
    Studio& operator=(const Studio&) = delete;

    /// Draws and appends a picture.  Throws UserError where the encoder stopped, at this picture or the one before.
    void add(const FilmFrame& frame);
    /// The last picture; empty before the first.
    const Image8& last() const;
    /// Closes the film; it then holds all pictures so far (none: nothing is written).  Throws UserError.
    void close();

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace cathlab

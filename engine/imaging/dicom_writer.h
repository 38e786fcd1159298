// A film as DICOM: X-ray angiographic image, multi-frame [dicom-ps3.3, A.14].
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>

namespace cathlab {

/// What the file says of the whole film.  No real patient can be named: the patient is SIM^PHANTOM.
struct DicomFacts {
    std::string description;  ///< of the series, at most 64 characters are kept
    std::string software;     ///< name and version of what made it
    double frames_per_s = 15.0;
    double sid_mm = 1050.0, sod_mm = 750.0;
    double pixel_mm = 0.2;       ///< at the detector
    bool round_field = false;    ///< an image intensifier
    std::uint64_t identity = 0;  ///< of the run; with the pictures' own bytes it makes the unique identifiers
};

/// One frame's state of the machine.
struct DicomFrame {
    double primary_deg = 0.0, secondary_deg = 0.0;  ///< + LAO, + cranial
    double kvp = 80.0;
    double dose_area_gycm2 = 0.0;  ///< cumulative
    double air_kerma_mgy = 0.0;    ///< cumulative, at the reference point
    double beam_time_s = 0.0;
};

/// Eight bits a pixel, MONOCHROME2, uncompressed, explicit little endian.  Angles that change go into the increments of
/// the positioner module.  Nothing in the file depends on the clock: the same frames give the same bytes.
class DicomWriter {
public:
    /// Throws UserError where the folder is missing or not writable.
    DicomWriter(const std::string& path, const DicomFacts& facts, int width, int height);
    /// Without close() before it: given up, and the part file removed.
    ~DicomWriter();
    DicomWriter(const DicomWriter&) = delete;
    DicomWriter& operator=(const DicomWriter&) = delete;

    /// width x height bytes, rows from the top.  Throws UserError beyond 2 GB of pixels.
    void add(std::span<const std::uint8_t> grey, const DicomFrame& frame);
    /// Writes PATH.part and renames it.  Throws UserError: no frame, a full disk.
    void close();

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace cathlab

#include "imaging/dicom_writer.h"

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dctk.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <system_error>
#include <vector>

#include "core/check.h"
#include "core/errors.h"
#include "core/hash.h"

namespace cathlab {

namespace {

constexpr std::size_t most_bytes = 2'000'000'000;  // what one element and readers of 32 bits can hold

// A decimal string of at most 16 characters, as the standard wants them.
std::string decimal(double value) {
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), "%.6g", value);
    return text.data();
}

// 2.25 and a number of 128 bits in decimal, of the form of a random UUID [dicom-ps3.5, B.2].
std::string unique_identifier(std::uint64_t high, std::uint64_t low) {
    high = (high & ~0xF000ULL) | 0x4000ULL;
    low = (low & ~(3ULL << 62)) | (2ULL << 62);
    unsigned __int128 number = (static_cast<unsigned __int128>(high) << 64) | low;
    std::string digits;
    for (; number > 0; number /= 10) digits += static_cast<char>('0' + static_cast<int>(number % 10));
    std::reverse(digits.begin(), digits.end());
    return "2.25." + digits;
}

bool moves(const std::vector<DicomFrame>& frames, double DicomFrame::*angle) {
    return std::any_of(frames.begin(), frames.end(),
                       [&](const DicomFrame& f) { return std::fabs(f.*angle - frames.front().*angle) > 1e-3; });
}

std::string increments(const std::vector<DicomFrame>& frames, double DicomFrame::*angle) {
    std::string text;  // relative to the first frame
    for (const DicomFrame& f : frames)
        text += (text.empty() ? "" : "\\") + decimal(std::round((f.*angle - frames.front().*angle) * 1000.0) / 1000.0);
    return text;
}

}  // namespace

struct DicomWriter::Impl {
    std::string path, part;
    DicomFacts facts;
    int width = 0, height = 0;
    std::vector<std::uint8_t> pixels;
    std::vector<DicomFrame> frames;
    bool closed = false;

    std::string identifier(const char* what, bool of_this_film) const {
        Hash64 a, b;
        for (Hash64* hash : {&a, &b}) {
            hash->word(facts.identity);
            hash->text(what);
            if (of_this_film) hash->bytes(pixels.data(), pixels.size());
        }
        b.word(1);
        return unique_identifier(a.value(), b.value());
    }
    void describe_patient_and_study(DcmDataset& d) const;
    void describe_equipment(DcmDataset& d) const;
    void describe_pixels(DcmDataset& d) const;
    void describe_beam(DcmDataset& d) const;
    void describe_positioner(DcmDataset& d) const;
};

namespace {

// Every element goes through here: what the toolkit refuses is a developer's mistake.
void put(DcmDataset& d, const DcmTagKey& tag, const std::string& value) {
    const OFCondition done = d.putAndInsertString(tag, value.c_str());
    CATHLAB_CHECK(done.good(), std::string("DICOM element refused: ") + done.text());
}

void put(DcmDataset& d, const DcmTagKey& tag, int value) {
    const OFCondition done = d.putAndInsertUint16(tag, static_cast<Uint16>(value));
    CATHLAB_CHECK(done.good(), std::string("DICOM element refused: ") + done.text());
}

}  // namespace

void DicomWriter::Impl::describe_patient_and_study(DcmDataset& d) const {
    put(d, DCM_SOPClassUID, UID_XRayAngiographicImageStorage);
    put(d, DCM_SOPInstanceUID, identifier("instance", true));
    put(d, DCM_PatientName, "SIM^PHANTOM");
    put(d, DCM_PatientID, "SIMULATION");
    put(d, DCM_PatientBirthDate, "");
    put(d, DCM_PatientSex, "O");
    put(d, DCM_StudyInstanceUID, identifier("study", false));
    put(d, DCM_StudyDate, "");
    put(d, DCM_StudyTime, "");
    put(d, DCM_ReferringPhysicianName, "");
    put(d, DCM_StudyID, "1");
    put(d, DCM_AccessionNumber, "");
    put(d, DCM_StudyDescription, "SIMULATION - NOT FOR DIAGNOSIS");
    put(d, DCM_Modality, "XA");
    put(d, DCM_SeriesInstanceUID, identifier("series", true));
    put(d, DCM_SeriesNumber, "1");
    put(d, DCM_SeriesDescription, facts.description.substr(0, 64));
    put(d, DCM_Laterality, "");
    put(d, DCM_InstanceNumber, "1");
    put(d, DCM_PatientOrientation, "");
}

void DicomWriter::Impl::describe_equipment(DcmDataset& d) const {
    put(d, DCM_Manufacturer, "cathlab");
    put(d, DCM_ManufacturerModelName, "simulated C-arm");
    put(d, DCM_SoftwareVersions, facts.software.substr(0, 64));
}

void DicomWriter::Impl::describe_pixels(DcmDataset& d) const {
    put(d, DCM_ImageType, "DERIVED\\PRIMARY\\SINGLE PLANE");
    put(d, DCM_SamplesPerPixel, 1);
    put(d, DCM_PhotometricInterpretation, "MONOCHROME2");
    put(d, DCM_NumberOfFrames, std::to_string(frames.size()));
    const OFCondition pointer = d.putAndInsertTagKey(DCM_FrameIncrementPointer, DCM_FrameTime);
    CATHLAB_CHECK(pointer.good(), "DICOM frame increment pointer refused");
    put(d, DCM_FrameTime, decimal(1000.0 / facts.frames_per_s));
    put(d, DCM_Rows, height);
    put(d, DCM_Columns, width);
    put(d, DCM_BitsAllocated, 8);
    put(d, DCM_BitsStored, 8);
    put(d, DCM_HighBit, 7);
    put(d, DCM_PixelRepresentation, 0);
    put(d, DCM_PixelIntensityRelationship, "DISP");  // windowed and sharpened: no line leads back to intensities
    put(d, DCM_WindowCenter, "127.5");
    put(d, DCM_WindowWidth, "255");
    put(d, DCM_RecommendedDisplayFrameRate, std::to_string(std::lround(facts.frames_per_s)));
    put(d, DCM_CineRate, std::to_string(std::lround(facts.frames_per_s)));
    const OFCondition done =
        d.putAndInsertUint8Array(DCM_PixelData, pixels.data(), static_cast<unsigned long>(pixels.size()));
    CATHLAB_CHECK(done.good(), std::string("DICOM pixels refused: ") + done.text());
}

void DicomWriter::Impl::describe_beam(DcmDataset& d) const {
    const DicomFrame& last = frames.back();
    put(d, DCM_KVP, decimal(std::round(last.kvp * 10.0) / 10.0));
    put(d, DCM_RadiationSetting, "SC");
    put(d, DCM_XRayTubeCurrent, "");
    put(d, DCM_ExposureTime, "");
    put(d, DCM_Exposure, "");
    put(d, DCM_RadiationMode, "PULSED");
    put(d, DCM_ImagerPixelSpacing, decimal(facts.pixel_mm) + "\\" + decimal(facts.pixel_mm));
    put(d, DCM_FieldOfViewShape, facts.round_field ? "ROUND" : "RECTANGLE");
    // dGy cm2 of the whole film.
    put(d, DCM_ImageAndFluoroscopyAreaDoseProduct,
        decimal(10.0 * (last.dose_area_gycm2 - frames.front().dose_area_gycm2)));
}

void DicomWriter::Impl::describe_positioner(DcmDataset& d) const {
    put(d, DCM_DistanceSourceToDetector, decimal(facts.sid_mm));
    put(d, DCM_DistanceSourceToPatient, decimal(facts.sod_mm));
    put(d, DCM_EstimatedRadiographicMagnificationFactor, decimal(facts.sid_mm / facts.sod_mm));
    put(d, DCM_PositionerPrimaryAngle, decimal(std::round(frames.front().primary_deg * 1000.0) / 1000.0));
    put(d, DCM_PositionerSecondaryAngle, decimal(std::round(frames.front().secondary_deg * 1000.0) / 1000.0));
    const bool dynamic = moves(frames, &DicomFrame::primary_deg) || moves(frames, &DicomFrame::secondary_deg);
    put(d, DCM_PositionerMotion, dynamic ? "DYNAMIC" : "STATIC");
    if (!dynamic) return;
    put(d, DCM_PositionerPrimaryAngleIncrement, increments(frames, &DicomFrame::primary_deg));
    put(d, DCM_PositionerSecondaryAngleIncrement, increments(frames, &DicomFrame::secondary_deg));
}

DicomWriter::DicomWriter(const std::string& path, const DicomFacts& facts, int width, int height)
    : impl_(std::make_unique<Impl>()) {
    CATHLAB_CHECK(width > 0 && height > 0 && width < 65536 && height < 65536,
                  "DICOM counts rows and columns in 16 bits");
    impl_->path = path;
    impl_->part = path + ".part";
    impl_->facts = facts;
    impl_->width = width;
    impl_->height = height;
    const std::ofstream probe(impl_->part, std::ios::binary | std::ios::trunc);
    if (!probe) throw UserError("cannot write '" + path + "': the folder is missing or not writable");
}

DicomWriter::~DicomWriter() {
    if (impl_->closed) return;
    std::error_code ignored;
    std::filesystem::remove(impl_->part, ignored);
}

void DicomWriter::add(std::span<const std::uint8_t> grey, const DicomFrame& frame) {
    Impl& m = *impl_;
    CATHLAB_CHECK(grey.size() == static_cast<std::size_t>(m.width) * static_cast<std::size_t>(m.height),
                  "one byte a pixel of the frame");
    if (m.pixels.size() + grey.size() > most_bytes)
        throw UserError("'" + m.path +
                        "': a DICOM file holds at most 2 GB of pixels; take a smaller --size or fewer pictures");
    m.pixels.insert(m.pixels.end(), grey.begin(), grey.end());
    m.frames.push_back(frame);
}

void DicomWriter::close() {
    Impl& m = *impl_;
    if (m.frames.empty()) throw UserError("'" + m.path + "': no picture was taken");
    if (m.pixels.size() % 2 != 0) m.pixels.push_back(0);
    DcmFileFormat file;
    DcmDataset& d = *file.getDataset();
    m.describe_patient_and_study(d);
    m.describe_equipment(d);
    m.describe_beam(d);
    m.describe_positioner(d);
    m.describe_pixels(d);
    const OFCondition saved = file.saveFile(m.part.c_str(), EXS_LittleEndianExplicit);
    if (saved.bad()) throw UserError("cannot write '" + m.path + "': " + saved.text());
    std::error_code error;
    std::filesystem::rename(m.part, m.path, error);
    if (error) throw UserError("cannot write '" + m.path + "': " + error.message());
    m.closed = true;
}

}  // namespace cathlab

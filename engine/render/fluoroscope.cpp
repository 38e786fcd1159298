#include "render/fluoroscope.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "core/check.h"
#include "core/errors.h"
#include "core/mesh.h"
#include "render/attenuation.h"
#include "render/closed_surface.h"
#include "render/detector.h"
#include "render/device_chords.h"
#include "render/fast_math.h"
#include "render/image_intensifier.h"
#include "render/path_lengths.h"
#include "render/path_raster.h"
#include "render/pixel_loops.h"
#include "render/projection.h"
#include "render/scatter.h"
#include "render/shutter.h"
#include "render/solid_groups.h"
#include "render/subtraction.h"
#include "render/view_key.h"

namespace cathlab {

namespace {

constexpr int device_samples = 3;          // rays a side and pixel: a wire is about one pixel wide
constexpr double scatter_sigma_mm = 40.0;  // width of the scatter kernel at the detector
constexpr double harmonisation_sigma_mm = 25.0;
constexpr float blade_transmission = 1e-4F;           // of 3 mm lead: 4e-4 at 80 keV, less below
constexpr double dsa_window = 1.2, dsa_level = 0.82;  // width in ln, grey of what has not changed
constexpr double roadmap_share = 0.7;
constexpr double other_dose = 1.4;  // a kerma that differs by more restarts the temporal filter

// mu of what is drawn minus mu of what it displaces: exponents are linear, so nested media need no boolean operations.
BinValues difference(const BeamTable& beam, const std::string& inside, const std::string& outside) {
    BinValues mu = beam.attenuation(inside);
    const BinValues other = beam.attenuation(outside);
    for (std::size_t k = 0; k < energy_bins; ++k) mu[k] -= other[k];
    return mu;
}

static_assert(pixel_loops::bins == energy_bins);

// Pixels that wait for their exponentials, which are cheaper for many at a time.
struct Batch {
    std::vector<std::size_t> pixel;
    std::vector<BinValues> exponent, transmission;

    BinValues& add(std::size_t i) {
        pixel.push_back(i);
        return exponent.emplace_back();
    }
    bool full() const { return pixel.size() == 256; }
};

}  // namespace

struct Fluoroscope::Impl {
    explicit Impl(Workers w) : workers(std::move(w)), raster(workers) {}

    Workers workers;
    std::function<void(std::string_view)> probe;
    const pixel_loops::Set& loops = pixel_loops::best();
    PathRaster raster;
    std::unique_ptr<BeamTable> beam;
    double beam_kvp = 0, beam_copper = -1;

    SolidGroups groups;
    std::uint64_t lumen_revision = 0;
    bool lumen_known = false;

    // The context of the present view.
    ViewKey context, view;
    std::vector<float> geometry;               // a pixel: inverse square, obliquity and blades
    std::vector<BinValues> transmission;       // a pixel: weight * exp(-E) of each bin, geometry factor included
    std::vector<PathLengths> context_lengths;  // one a group of solids that stand still
    ImageF context_intensity, scatter, coarse_log;
    double reference = 1, coarse_mean = 0, photons_of_kerma = 1;
    std::size_t context_bad = 0, bad = 0;

    // What a frame's rays pass beside the context.
    struct Part {
        PathLengths lengths;
        BinValues mu, mu_of_contrast;
        bool with_contrast() const { return !lengths.contrast_mm_mg_ml.values.empty(); }
    };

    // One frame.
    DeviceLengths devices;
    std::vector<ChordPiece> pieces;
    std::vector<BinValues> device_mu;
    std::vector<Part> parts;  // kept for their memory; the first part_count are the frame's
    std::size_t part_count = 0;
    ImageF intensity, signal, history, log_image;
    GaussianBlur focal_blur, detector_blur;
    double history_kerma = 0;
    Subtraction subtraction;
    std::uint64_t references = 0;
    std::vector<std::uint8_t> grey, reference_grey;

    void use_beam(const FrameExposure& e) {
        const double kvp = generator_kvp(e);
        if (beam && beam_kvp == kvp && beam_copper == e.copper_mm) return;
        beam = std::make_unique<BeamTable>(kvp, e.copper_mm);
        beam_kvp = kvp;
        beam_copper = e.copper_mm;
    }

    // Its path lengths as the solids stand in this frame.
    void draw_group(const FrameDescription& f, const Projection& projection, SolidGroup& group, PathLengths& out) {
        group.place(f, workers);
        raster.draw(projection, group.vertices, group.triangles, {}, out);
    }

    void begin(std::string_view name) const {
        if (probe) probe(name);
    }

    Part& next_part() {
        if (part_count == parts.size()) parts.emplace_back();
        return parts[part_count++];
    }

    void make_context(const FrameDescription& f, const Projection& projection);
    void draw_moving(const FrameDescription& f, const Projection& projection);
    void draw_lumen(const FrameDescription& f, const Projection& projection);
    void draw_all_devices(const FrameDescription& f, const Projection& projection);
    void combine();
    void detect(const FrameDescription& f, const Projection& projection);
    void display(const FrameDescription& f);
    void add_exponent(std::size_t i, BinValues& exponent) const;
    void attenuate_pixels(Batch& batch);
};

void Fluoroscope::Impl::make_context(const FrameDescription& f, const Projection& projection) {
    const auto count = static_cast<std::size_t>(projection.width()) * static_cast<std::size_t>(projection.height());
    const int width = projection.width();
    const auto columns = static_cast<std::size_t>(width);
    context_bad = 0;
    std::vector<BinValues> mu;
    std::size_t passes = 0;
    for (SolidGroup& group : groups.all()) {
        if (group.moving) continue;
        if (passes == context_lengths.size()) context_lengths.emplace_back();
        PathLengths& lengths = context_lengths[passes++];
        draw_group(f, projection, group, lengths);
        context_bad += lengths.bad_pixels;
        mu.push_back(difference(*beam, group.material, group.surrounding));
    }
    std::vector<pixel_loops::Absorber> absorbers;
    for (std::size_t p = 0; p < passes; ++p)
        absorbers.push_back({context_lengths[p].length_mm.values.data(), mu[p].data()});
    transmission.resize(count);
    geometry.resize(count);
    context_intensity = ImageF(width, projection.height());
    std::vector<float> blades(columns);  // what they let through in each column
    for (int x = 0; x < width; ++x)
        blades[static_cast<std::size_t>(x)] = is_open(x + 0.5, width, f.view.open_width) ? 1.0F : blade_transmission;
    const double sid = projection.source_detector_mm();
    workers.for_ranges(count / columns, 16, [&](std::size_t begin, std::size_t end) {
        for (std::size_t y = begin; y < end; ++y) {
            const double row = static_cast<double>(y) + 0.5;
            const bool row_lit = is_open(row, projection.height(), f.view.open_height);
            // Inverse square and obliquity together: cos^3 of the angle to the detector's normal.  Along a row the
            // squared way from the source to the pixel is a + (b + c x) x.
            const Vec3 start = projection.to_detector(0.5, row), across = projection.to_detector(1.5, row) - start;
            const double a = start.squaredNorm(), b = 2.0 * start.dot(across), c = across.squaredNorm();
            float* g = geometry.data() + y * columns;
            for (int x = 0; x < width; ++x) {
                const double cosine = sid / std::sqrt(a + (b + c * x) * x);
                g[x] = static_cast<float>(cosine * cosine * cosine);
            }
            for (std::size_t x = 0; x < columns; ++x) g[x] *= row_lit ? blades[x] : blade_transmission;
        }
        loops.pass_context(absorbers.data(), absorbers.size(), beam->weights().data(), geometry.data(), begin * columns,
                           end * columns, transmission.data()->data(), context_intensity.values.data());
    });
    // The measuring field stays within what the collimator leaves open.
    const double side = std::clamp(f.exposure.measuring_field, 0.05, 1.0);
    const auto inside = [&](int x, int y) {
        return is_open(x + 0.5, width, std::min(side, 0.9 * f.view.open_width)) &&
               is_open(y + 0.5, projection.height(), std::min(side, 0.9 * f.view.open_height));
    };
    double sum = 0, sum_of_logs = 0;
    std::size_t pixels = 0;
    for (int y = 0; y < projection.height(); ++y) {
        for (int x = 0; x < width; ++x) {
            if (!inside(x, y)) continue;
            sum += context_intensity.at(x, y);
            ++pixels;
        }
    }
    const double water_mm = beam->water_mm(sum / static_cast<double>(pixels));
    const double lit_mm = projection.pixel_mm() * width * std::sqrt(f.view.open_width * f.view.open_height) /
                          magnification(f.view, projection);
    const double share = f.exposure.scatter_to_primary.value_or(scatter_to_primary(water_mm, lit_mm));
    scatter = wide_blur(context_intensity, scatter_sigma_mm / projection.pixel_mm(), workers);
    for (float& s : scatter.values) s *= static_cast<float>(share);

    // The measuring field holds the detector's kerma; a coarse picture of the logarithm evens out lung and spine.
    ImageF logs(width, projection.height());
    std::vector<std::pair<double, double>> row_sums(static_cast<std::size_t>(projection.height()));
    workers.for_ranges(row_sums.size(), 16, [&](std::size_t begin, std::size_t end) {
        for (auto y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
            auto& [of_row, logs_of_row] = row_sums[static_cast<std::size_t>(y)];
            for (int x = 0; x < width; ++x) {
                const std::size_t i = logs.offset(x, y);
                const float total = std::max(1e-12F, context_intensity.values[i] + scatter.values[i]);
                logs.values[i] = fast_log(total);
                if (!inside(x, y)) continue;
                of_row += total;
                logs_of_row += logs.values[i];
            }
        }
    });
    sum = 0;
    for (const auto& [of_row, logs_of_row] : row_sums) {
        sum += of_row;
        sum_of_logs += logs_of_row;
    }
    reference = sum / static_cast<double>(pixels);
    coarse_mean = sum_of_logs / static_cast<double>(pixels);
    // What the blades shade must not darken its surroundings: it counts as the field's mean.
    if (f.view.open_width < 1 || f.view.open_height < 1)
        for (int y = 0; y < projection.height(); ++y)
            for (int x = 0; x < width; ++x)
                if (!is_open(x + 0.5, width, f.view.open_width) ||
                    !is_open(y + 0.5, projection.height(), f.view.open_height))
                    logs.values[logs.offset(x, y)] = static_cast<float>(coarse_mean);
    coarse_log = wide_blur(logs, harmonisation_sigma_mm / projection.pixel_mm(), workers);
}

void Fluoroscope::Impl::draw_moving(const FrameDescription& f, const Projection& projection) {
    for (SolidGroup& group : groups.all()) {
        if (!group.moving) continue;
        Part& part = next_part();
        draw_group(f, projection, group, part.lengths);
        part.mu = difference(*beam, group.material, group.surrounding);
        bad += part.lengths.bad_pixels;
    }
}

void Fluoroscope::Impl::draw_lumen(const FrameDescription& f, const Projection& projection) {
    if (f.lumen.triangles.empty()) return;
    if (!lumen_known || lumen_revision != f.lumen.topology_revision) {
        require_closed({f.lumen.vertices, f.lumen.triangles}, "lumen");
        lumen_revision = f.lumen.topology_revision;
        lumen_known = true;
    }
    const bool has_wall = !f.lumen.wall_material.empty() && !f.lumen.wall_mm.empty();
    Part& inner = next_part();
    raster.draw(projection, f.lumen.vertices, f.lumen.triangles, f.lumen.contrast_mg_ml, inner.lengths,
                f.lumen.radius_mm);
    inner.mu = difference(*beam, f.lumen.material, has_wall ? f.lumen.wall_material : f.lumen.surrounding);
    if (inner.with_contrast()) inner.mu_of_contrast = beam->iodine();
    bad += inner.lengths.bad_pixels;
    if (!has_wall) return;
    const std::size_t n = f.lumen.vertices.size();
    CATHLAB_CHECK(f.lumen.wall_mm.size() == n, "one wall thickness a vertex");
    const std::vector<Vec3> normals =
        f.lumen.normals.size() == n ? f.lumen.normals : vertex_normals({f.lumen.vertices, f.lumen.triangles});
    std::vector<Vec3> outer(n);
    for (std::size_t i = 0; i < n; ++i) outer[i] = f.lumen.vertices[i] + f.lumen.wall_mm[i] * normals[i];
    Part& wall = next_part();
    raster.draw(projection, outer, f.lumen.triangles, {}, wall.lengths);
    wall.mu = difference(*beam, f.lumen.wall_material, f.lumen.surrounding);
    bad += wall.lengths.bad_pixels;
}

void Fluoroscope::Impl::draw_all_devices(const FrameDescription& f, const Projection& projection) {
    pieces.clear();
    device_mu.clear();
    std::map<std::pair<std::string, std::string>, std::uint8_t> media;
    for (const FrameDevice& device : f.devices) {
        std::vector<std::uint8_t> medium_of;
        for (const std::string& material : device.materials) {
            const auto [entry, is_new] =
                media.emplace(std::pair(material, device.surrounding), static_cast<std::uint8_t>(media.size()));
            if (is_new) device_mu.push_back(difference(*beam, material, device.surrounding));
            medium_of.push_back(entry->second);
        }
        append_pieces(device, medium_of, pieces);
    }
    draw_devices(pieces, static_cast<int>(device_mu.size()), projection, device_samples, workers, devices);
}

void Fluoroscope::Impl::add_exponent(std::size_t i, BinValues& exponent) const {
    const auto add = [&](const BinValues& mu, float amount) {
        for (std::size_t k = 0; k < energy_bins; ++k) exponent[k] += mu[k] * amount;
    };
    for (std::size_t p = 0; p < part_count; ++p) {
        add(parts[p].mu, parts[p].lengths.length_mm.values[i]);
        if (parts[p].with_contrast()) add(parts[p].mu_of_contrast, parts[p].lengths.contrast_mm_mg_ml.values[i]);
    }
}

void Fluoroscope::Impl::attenuate_pixels(Batch& batch) {
    const std::size_t count = batch.pixel.size();
    batch.transmission.resize(count);
    for (std::size_t n = 0; n < count; ++n) batch.transmission[n] = transmission[batch.pixel[n]];
    loops.attenuate(batch.transmission.data()->data(), count * energy_bins, batch.exponent.data()->data());
    for (std::size_t n = 0; n < count; ++n) {
        float sum = 0;
        for (const float bin : batch.exponent[n]) sum += bin;
        intensity.values[batch.pixel[n]] = sum + scatter.values[batch.pixel[n]];
    }
    batch.pixel.clear();
    batch.exponent.clear();
}

void Fluoroscope::Impl::combine() {
    const std::size_t count = context_intensity.values.size();
    intensity.width = context_intensity.width;
    intensity.height = context_intensity.height;
    intensity.values.resize(count);
    std::vector<pixel_loops::Absorber> absorbers;
    for (std::size_t p = 0; p < part_count; ++p) {
        const Part& part = parts[p];
        absorbers.push_back({part.lengths.length_mm.values.data(), part.mu.data()});
        if (part.with_contrast())
            absorbers.push_back({part.lengths.contrast_mm_mg_ml.values.data(), part.mu_of_contrast.data()});
    }
    workers.for_ranges(count, 8192, [&](std::size_t begin, std::size_t end) {
        loops.absorb(absorbers.data(), absorbers.size(), transmission.data()->data(), context_intensity.values.data(),
                     scatter.values.data(), begin, end, intensity.values.data());
    });
    const auto media = static_cast<std::size_t>(devices.media);
    workers.for_ranges(devices.pixel.size(), 1024, [&](std::size_t begin, std::size_t end) {
        Batch batch;
        for (std::size_t d = begin; d < end; ++d) {
            const std::size_t i = devices.pixel[d];
            BinValues& exponent = batch.add(i);
            add_exponent(i, exponent);
            for (std::size_t m = 0; m < media; ++m) {
                const float length = devices.length_mm[d * media + m];
                for (std::size_t k = 0; k < energy_bins; ++k) exponent[k] += device_mu[m][k] * length;
            }
            if (batch.full()) attenuate_pixels(batch);
        }
        if (!batch.pixel.empty()) attenuate_pixels(batch);
    });
}

void Fluoroscope::Impl::detect(const FrameDescription& f, const Projection& projection) {
    const FrameExposure& e = f.exposure;
    const double area = projection.pixel_mm() * projection.pixel_mm();
    const double kerma = e.open_field_kerma_ngy > 0 ? e.open_field_kerma_ngy : e.detector_kerma_ngy / reference;
    const double photons = kerma * beam->photons_per_mm2_ngy() * area;
    photons_of_kerma = e.detector_kerma_ngy * beam->photons_per_mm2_ngy() * area;
    signal = intensity;
    const double magnified = (magnification(f.view, projection) - 1) * e.focal_spot_mm;
    focal_blur.apply(signal, 0.29 * magnified / projection.pixel_mm(), workers);  // 0.29 = sigma of a unit box
    const auto gain = static_cast<float>(photons);
    workers.for_ranges(signal.values.size(), 16384, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) signal.values[i] *= gain;
    });
    add_quantum_noise(signal, f.seed, f.frame_index, workers);
    detector_blur.apply(signal, e.detector.blur_sigma_mm / projection.pixel_mm(), workers);
    distort(signal, e.detector, projection.pixel_mm(), workers);
    add_electronic_noise(signal, e.detector.electronic_noise_photons, f.seed, f.frame_index, workers);
    // A picture of a subtracted series stands for itself, and one of another dose has another number of quanta.
    const bool other =
        history_kerma > 0 && std::fabs(std::log(e.detector_kerma_ngy / history_kerma)) > std::log(other_dose);
    if (f.series.subtracted || other) history = {};
    history_kerma = e.detector_kerma_ngy;
    recurse(history, signal, e.recursion, workers);
}

void Fluoroscope::Impl::display(const FrameDescription& f) {
    const FrameExposure& e = f.exposure;
    const int width = history.width, height = history.height;
    const auto columns = static_cast<std::size_t>(width);
    log_image.width = width;
    log_image.height = height;
    log_image.values.resize(history.values.size());
    const auto mean = static_cast<float>(coarse_mean);
    const auto even = static_cast<float>(e.harmonisation);
    // The wanted kerma makes the measuring field's middle (the mean of its logarithms) grey `level`.
    const auto unit = static_cast<float>(reference / std::exp(coarse_mean) / photons_of_kerma);
    workers.for_ranges(static_cast<std::size_t>(height), 32, [&](std::size_t begin, std::size_t end) {
        loops.to_log(history.values.data() + begin * columns, coarse_log.values.data() + begin * columns, unit, even,
                     mean, (end - begin) * columns, log_image.values.data() + begin * columns);
    });
    if (f.series.number != subtraction.series()) subtraction.begin(f.series.number);
    if (f.series.subtracted || f.series.collected) {
        const double kept = f.series.subtracted ? 1.0 : std::sqrt((1 - e.recursion) / (1 + e.recursion));
        subtraction.add(log_image, f.series.collected && !f.lumen.contrast_mg_ml.empty(),
                        kept / std::sqrt(std::max(1.0, photons_of_kerma)), workers);
    }
    const bool subtracted = f.series.subtracted && subtraction.has_mask();
    if (subtracted) subtraction.subtract(log_image);
    if (f.series.roadmap && !f.series.subtracted) subtraction.lay_roadmap(log_image, roadmap_share);
    const auto edge = static_cast<float>(0.25 * e.edge_enhancement);
    const auto scale = static_cast<float>(255.0 / (subtracted ? dsa_window : e.window));
    const auto offset = static_cast<float>(255.0 * (subtracted ? dsa_level : e.level));
    grey.resize(history.values.size());
    workers.for_ranges(static_cast<std::size_t>(height), 32, [&](std::size_t begin, std::size_t end) {
        std::vector<float> padded(columns + 2);
        for (std::size_t y = begin; y < end; ++y) {
            const float* row = log_image.values.data() + y * columns;
            const float* above = y > 0 ? row - columns : row;
            const float* below = y + 1 < static_cast<std::size_t>(height) ? row + columns : row;
            std::copy(row, row + columns, padded.begin() + 1);  // edges repeat
            padded.front() = row[0];
            padded.back() = row[columns - 1];
            loops.sharpen(padded.data(), above, below, edge, scale, offset, columns, grey.data() + y * columns);
        }
    });
    blacken_shaded(f.view, columns, grey);
}

Fluoroscope::Fluoroscope(Workers workers) : impl_(std::make_unique<Impl>(std::move(workers))) {}
Fluoroscope::~Fluoroscope() = default;

const std::vector<std::uint8_t>& Fluoroscope::draw(const FrameDescription& frame, int width, int height) {
    Impl& self = *impl_;
    const auto count = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    if (frame.series.references != self.references) {
        self.references = frame.series.references;
        self.reference_grey = self.grey;
    }
    if (!frame.beam_on) {  // last image hold; black before the first exposure
        self.grey.resize(count, 0);
        return self.grey;
    }
    const Projection projection(frame.view, width, height);
    self.begin("checks");
    ViewKey context = context_key(frame, width, height);
    const bool new_context = !(context == self.context);
    require_before_source(frame, projection, new_context);
    self.use_beam(frame.exposure);
    self.groups.update(frame);
    ViewKey view = view_key(frame, width, height);
    if (!(view == self.view)) {
        self.history = {};
        self.subtraction.forget();
    }
    self.view = std::move(view);
    if (new_context) {
        self.begin("context");
        self.make_context(frame, projection);
        self.context = std::move(context);
    }
    self.bad = self.context_bad;
    self.part_count = 0;
    self.begin("moving solids");
    self.draw_moving(frame, projection);
    self.begin("lumen");
    self.draw_lumen(frame, projection);
    self.begin("devices");
    self.draw_all_devices(frame, projection);
    self.begin("beam");
    self.combine();
    self.begin("detector");
    self.detect(frame, projection);
    self.begin("display");
    self.display(frame);
    self.begin("");
    return self.grey;
}

const ImageF& Fluoroscope::intensity() const {
    return impl_->intensity;
}
const ImageF& Fluoroscope::detected() const {
    return impl_->signal;
}
const std::vector<std::uint8_t>& Fluoroscope::grey() const {
    return impl_->grey;
}
const std::vector<std::uint8_t>& Fluoroscope::reference() const {
    return impl_->reference_grey;
}
bool Fluoroscope::has_roadmap() const {
    return impl_->subtraction.has_roadmap();
}
double Fluoroscope::wanted_photons() const {
    return impl_->photons_of_kerma;
}
std::size_t Fluoroscope::bad_pixels() const {
    return impl_->bad;
}
void Fluoroscope::set_probe(std::function<void(std::string_view)> begin) {
    impl_->probe = std::move(begin);
}
void Fluoroscope::reset() {
    impl_->history = {};
    impl_->subtraction.forget();
    impl_->reference_grey.clear();
    impl_->context = {};
    impl_->groups.forget();
}

}  // namespace cathlab

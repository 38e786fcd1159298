#include "rigid_vessel_wire.h"

#include <mujoco/mujoco.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <sstream>
#include <stdexcept>

#include "core/units.h"

namespace cathlab {
namespace {

// MuJoCo's reader of XML goes no deeper into nested elements than a hundred, and a link is a body in a body: so many
// bodies stand in one file, and the next file is included in the last of them.
constexpr int bodies_per_file = 60;

// A polygon's corners stand a thirtieth of the radius outside its circle, and points of the way 4 mm apart.
constexpr double outside_mm = 1.5;

std::string file_name(std::size_t file) {
    return "wire" + std::to_string(file) + ".xml";
}

/// A point of the way and its direction, by arc length.
struct Way {
    explicit Way(const LumenWay& lumen) : lumen_(lumen), arc_(lumen.points.size(), 0.0) {
        for (std::size_t i = 1; i < arc_.size(); ++i)
            arc_[i] = arc_[i - 1] + (lumen.points[i] - lumen.points[i - 1]).norm();
    }
    double length() const { return arc_.back(); }
    std::size_t segment(double s) const {
        const auto it = std::upper_bound(arc_.begin() + 1, arc_.end() - 1, s);
        return static_cast<std::size_t>(it - arc_.begin()) - 1;
    }
    double share(std::size_t i, double s) const { return (s - arc_[i]) / (arc_[i + 1] - arc_[i]); }
    Vec3 at(double s) const {
        const std::size_t i = segment(s);
        return lumen_.points[i] + share(i, s) * (lumen_.points[i + 1] - lumen_.points[i]);
    }
    double radius(double s) const {
        const std::size_t i = segment(s);
        return lumen_.radius[i] + share(i, s) * (lumen_.radius[i + 1] - lumen_.radius[i]);
    }
    Vec3 direction(double s) const {
        constexpr double reach = 1.0;
        return (at(std::min(s + reach, length())) - at(std::max(s - reach, 0.0))).normalized();
    }
    /// Where a rigid link of this length that begins at s ends.
    double next(double s, double link) const {
        double low = s, high = std::min(s + 2.0 * link, length());
        for (int k = 0; k < 50; ++k) {
            const double middle = 0.5 * (low + high);
            ((at(middle) - at(s)).norm() < link ? low : high) = middle;
        }
        return high;
    }

private:
    const LumenWay& lumen_;
    std::vector<double> arc_;
};

Quat turned_to(const Vec3& direction) {
    return Quat::FromTwoVectors(Vec3::UnitZ(), direction);
}

std::string pose(const Vec3& p, const Quat& q) {
    std::ostringstream out;
    out.precision(12);
    out << "pos=\"" << p.x() << ' ' << p.y() << ' ' << p.z() << "\" quat=\"" << q.w() << ' ' << q.x() << ' ' << q.y()
        << ' ' << q.z() << '"';
    return out.str();
}

/// EI [mN mm2], GJ, diameter and density where the wire is s_tip mm behind its tip.
const WireSection& section_at(const WireSpec& wire, double s_tip) {
    double begin = 0.0;
    for (const WireSection& section : wire.sections) {
        begin += section.length_mm;
        if (s_tip < begin) return section;
    }
    return wire.sections.back();
}

void write_vessel(std::ostream& out, const Way& way, const PeerOptions& options) {
    constexpr double half_thickness = 5.0, overlap = 1.15;
    const int rings = static_cast<int>(way.length() / options.ring_mm);
    for (int k = 0; k < rings; ++k) {
        const double s = (k + 0.5) * options.ring_mm, r = way.radius(s);
        out << "<body " << pose(way.at(s), turned_to(way.direction(s))) << ">\n";
        for (int i = 0; i < options.boxes_per_ring; ++i) {
            const double angle = 2.0 * units::pi * i / options.boxes_per_ring;
            const Vec3 outward(std::cos(angle), std::sin(angle), 0.0);
            const Quat q(std::cos(0.5 * angle), 0.0, 0.0, std::sin(0.5 * angle));
            out << "<geom class=\"vessel\" " << pose((r + half_thickness) * outward, q) << " size=\"" << half_thickness
                << ' ' << overlap * r * std::tan(units::pi / options.boxes_per_ring) << ' '
                << 0.5 * overlap * options.ring_mm << "\"/>\n";
        }
        out << "</body>\n";
    }
}

}  // namespace

struct RigidVesselWire::Impl {
    mjModel* model = nullptr;
    mjData* data = nullptr;
    ~Impl() {
        if (data) mj_deleteData(data);
        if (model) mj_deleteModel(model);
    }
};

RigidVesselWire::RigidVesselWire(const LumenWay& lumen, const WireSpec& wire, const PeerOptions& options)
    : impl_(std::make_unique<Impl>()), lumen_(lumen), link_mm_(options.wire_mm / options.links) {
    const Way way(lumen);
    const double h = options.timestep_s, link = link_mm_;
    std::ostringstream out;
    out.precision(12);
    // Contacts come to rest in two steps (solref), the least that MuJoCo allows.
    out << "<mujoco>\n<compiler angle=\"radian\"/>\n<size njmax=\"6000\" nconmax=\"1500\" nstack=\"30000000\"/>\n"
        << "<option timestep=\"" << h << "\" gravity=\"0 0 0\" solver=\"" << options.solver << "\"/>\n"
        << "<default><geom friction=\"" << options.friction << " 0.005 0.0001\" solref=\"" << 2.0 * h
        << " 1\" solimp=\"" << options.impedance << ' ' << options.impedance << " 0.001\"/>\n"
        << "<default class=\"vessel\"><geom type=\"box\" contype=\"0\" conaffinity=\"1\"/></default>\n"
        << "<default class=\"wire\"><geom type=\"capsule\" contype=\"1\" conaffinity=\"0\"/></default></default>\n"
        << "<worldbody>\n";
    write_vessel(out, way, options);

    mju_user_warning = [](const char*) {};  // they are counted (faults), and not written into a file of its own
    std::vector<std::string> files;
    const auto close = [&](int bodies) {
        for (int k = 0; k < bodies; ++k) out << "</body>\n";
        if (files.empty())
            // The hand: the slide and the hinge stand where it has them, as hard as a contact.
            out << "</worldbody>\n<equality>\n<joint joint1=\"feed\" solref=\"" << 2.0 * h
                << " 1\" solimp=\"0.99 0.999 0.001\"/>\n<joint joint1=\"turn\" solref=\"" << 2.0 * h
                << " 1\" solimp=\"0.99 0.999 0.001\"/>\n</equality>\n</mujoco>\n";
        else
            out << "</mujocoinclude>\n";
        files.push_back(out.str());
        out.str("");
    };
    std::vector<double> angles;
    double s = 0.0;
    Quat frame = turned_to((way.at(way.next(0.0, link)) - way.at(0.0)).normalized());
    for (int i = 0; i < options.links; ++i) {
        const double s_tip = (options.links - i) * link;
        const WireSection& section = section_at(wire, s_tip - 0.5 * link);
        const double radius = 0.5 * section.diameter_mm;
        const double mass = 1e-9 * section.density_kg_m3 * units::pi * radius * radius * link;
        const double next = way.next(s, link);
        if (i > 0 && i % bodies_per_file == 0) {
            out << "<include file=\"" << file_name(files.size() + 1) << "\"/>\n";
            close(bodies_per_file);
            out << "<mujocoinclude>\n";
        }
        if (i == 0) {
            out << "<body " << pose(way.at(0.0), frame) << ">\n<joint name=\"feed\" type=\"slide\" axis=\"0 0 1\"/>\n"
                << "<joint name=\"turn\" type=\"hinge\" axis=\"0 0 1\"/>\n";
        } else {
            // Between two links' centres lies half of either.
            const WireSection& behind = section_at(wire, s_tip + 0.5 * link);
            const double bend = 2e3 / (link / section.bending_stiffness_n_mm2 + link / behind.bending_stiffness_n_mm2);
            const double twist = 2e3 / (link / section.torsion_stiffness_n_mm2 + link / behind.torsion_stiffness_n_mm2);
            const auto hinge = [&](const char* axis, double k) {
                const double armature = options.armature_steps * k * h * h;
                out << "<joint type=\"hinge\" axis=\"" << axis << "\" stiffness=\"" << k << "\" damping=\"" << k * h
                    << "\" armature=\"" << armature << "\"/>\n";
            };
            out << "<body pos=\"0 0 " << link << "\">\n";
            hinge("1 0 0", bend);
            hinge("0 1 0", bend);
            if (options.twist) hinge("0 0 1", twist);
            const double armature = options.armature_steps * bend * h * h;
            armature_min_ = std::min(armature_min_, armature);
            armature_max_ = std::max(armature_max_, armature);
            armature_ratio_ = std::max(armature_ratio_, armature / (mass * link * link / 3.0));
            const Vec3 d = frame.conjugate() * (way.at(next) - way.at(s)).normalized();
            const double about_y = std::asin(d.x()), about_x = std::atan2(-d.y(), d.z());
            angles.push_back(about_x);
            angles.push_back(about_y);
            if (options.twist) angles.push_back(0.0);
            frame = frame * Quat(std::cos(0.5 * about_x), std::sin(0.5 * about_x), 0.0, 0.0) *
                    Quat(std::cos(0.5 * about_y), 0.0, std::sin(0.5 * about_y), 0.0);
        }
        out << "<geom class=\"wire\" fromto=\"0 0 0 0 0 " << link << "\" size=\"" << radius << "\" mass=\"" << mass
            << "\"/>\n";
        s = next;
    }
    close((options.links - 1) % bodies_per_file + 1);

    const auto memory = std::make_unique<mjVFS>();
    mj_defaultVFS(memory.get());
    for (std::size_t k = 0; k < files.size(); ++k) {
        mj_makeEmptyFileVFS(memory.get(), file_name(k).c_str(), static_cast<int>(files[k].size()));
        std::memcpy(memory->filedata[k], files[k].data(), files[k].size());
    }
    char error[1000] = "";
    impl_->model = mj_loadXML(file_name(0).c_str(), memory.get(), error, sizeof error);
    mj_deleteVFS(memory.get());
    if (!impl_->model) throw std::runtime_error(std::string("MuJoCo: ") + error);
    impl_->data = mj_makeData(impl_->model);
    for (std::size_t i = 0; i < angles.size(); ++i) impl_->data->qpos[2 + i] = angles[i];
    mj_forward(impl_->model, impl_->data);
}

RigidVesselWire::~RigidVesselWire() = default;

void RigidVesselWire::step(double advance, double turn) {
    fed_ += advance * impl_->model->opt.timestep;
    turned_ += turn * impl_->model->opt.timestep;
    impl_->model->eq_data[0] = fed_;
    impl_->model->eq_data[mjNEQDATA] = turned_;
    mj_step(impl_->model, impl_->data);
}

void RigidVesselWire::settle(double seconds) {
    const std::vector<mjtNum> stiffness(impl_->model->jnt_stiffness, impl_->model->jnt_stiffness + impl_->model->njnt);
    const int steps = static_cast<int>(seconds / impl_->model->opt.timestep);
    for (int k = 1; k <= steps; ++k) {
        for (std::size_t i = 0; i < stiffness.size(); ++i)
            impl_->model->jnt_stiffness[i] = stiffness[i] * std::min(1.0, 2.0 * k / steps);
        step(0.0, 0.0);
    }
}

int RigidVesselWire::degrees_of_freedom() const {
    return impl_->model->nv;
}
int RigidVesselWire::boxes() const {
    int boxes = 0;
    for (int i = 0; i < impl_->model->ngeom; ++i) boxes += impl_->model->geom_type[i] == mjGEOM_BOX ? 1 : 0;
    return boxes;
}
int RigidVesselWire::contacts() const {
    return impl_->data->ncon;
}
int RigidVesselWire::faults() const {
    int faults = 0;
    for (const int kind :
         {mjWARN_INERTIA, mjWARN_CONTACTFULL, mjWARN_CNSTRFULL, mjWARN_BADQPOS, mjWARN_BADQVEL, mjWARN_BADQACC})
        faults += impl_->data->warning[kind].number;
    return faults;
}
double RigidVesselWire::penetration_mm() const {
    double deepest = 0.0;
    for (int i = 0; i < impl_->data->ncon; ++i) deepest = std::max(deepest, -impl_->data->contact[i].dist);
    return deepest;
}
int RigidVesselWire::outside() const {
    const mjModel& m = *impl_->model;
    int outside = 0;
    for (int b = m.jnt_bodyid[0]; b < m.nbody; ++b) {
        const Vec3 p(impl_->data->xpos[3 * b], impl_->data->xpos[3 * b + 1], impl_->data->xpos[3 * b + 2]);
        double least = 1e300;
        for (std::size_t i = 0; i < lumen_.points.size(); ++i)
            least = std::min(least, (p - lumen_.points[i]).norm() - lumen_.radius[i]);
        outside += least > outside_mm ? 1 : 0;
    }
    return outside;
}
double RigidVesselWire::joint_gap_mm() const {
    double gap = 0.0;
    const mjModel& m = *impl_->model;
    for (int b = m.jnt_bodyid[0] + 1; b < m.nbody; ++b) {
        const mjtNum* behind = impl_->data->xpos + 3 * (b - 1);
        const mjtNum* axis = impl_->data->xmat + 9 * (b - 1);
        const mjtNum* here = impl_->data->xpos + 3 * b;
        double square = 0.0;
        for (int k = 0; k < 3; ++k) {
            const double off = here[k] - behind[k] - link_mm_ * axis[3 * k + 2];
            square += off * off;
        }
        gap = std::max(gap, std::sqrt(square));
    }
    return gap;
}
double RigidVesselWire::fed_mm() const {
    return impl_->data->qpos[0];
}

}  // namespace cathlab

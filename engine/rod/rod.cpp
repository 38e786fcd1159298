#include "rod/rod.h"

#include <algorithm>
#include <cmath>

#include "core/check.h"
#include "core/deterministic_math.h"
#include "rod/rod_impl.h"
#include "rod/wire_layout.h"

namespace cathlab {
namespace {

constexpr std::size_t link_grain = 32;  // links that are worth a thread of their own

bool finite(const Vec3& v) {
    return std::isfinite(v.squaredNorm());
}

Vec3 shortened(const Vec3& v, double most) {
    const double size = v.norm();
    return size > most ? Vec3(v * (most / size)) : v;
}

}  // namespace

std::size_t Rod::Impl::free_count() const {
    const auto behind = [](const WireLink& link, double s) { return link.start < s; };
    return static_cast<std::size_t>(std::lower_bound(links.begin(), links.end(), insertion, behind) - links.begin());
}

std::size_t Rod::Impl::chain_length(double at) const {
    std::size_t n = 0;
    while (n < links.size() && links[n].start < at + sheath.length_mm) ++n;
    const std::size_t least = free_count() + 1;
    return std::min(std::max(n, least), links.size());
}

Pose Rod::Impl::held_pose(std::size_t i, double at, double turned) const {
    const Pose& mouth = sheath.mouth;
    const Quat about(det::cos(0.5 * turned), 0.0, 0.0, det::sin(0.5 * turned));
    return {mouth.to_world(Vec3(0.0, 0.0, at - links[i].centre())), mouth.orientation * about};
}

void Rod::Impl::grow(std::size_t length, double at, double turned) {
    while (world.size() < length) {
        const BodyMotion motion{held_pose(world.size(), at, turned), Vec3::Zero(), Vec3::Zero()};
        world.add(links[world.size()], motion);
        x.push_back(motion.pose.position);
        q.push_back(motion.pose.orientation);
    }
    while (world.size() > length) {
        world.remove_last();
        x.pop_back();
        q.pop_back();
    }
    x_start.resize(length);
    x_predicted.resize(length);
    q_start.resize(length);
    q_predicted.resize(length);
    force.resize(length);
}

void Rod::Impl::update_joints() {
    const std::size_t free = free_count();
    for (std::size_t i = 0; i + 1 < world.size(); ++i)
        world.set_joint(i, joint_stiffness(links[i], links[i + 1], insertion, i + 1 == front ? sleeve->turn : 0.0));
    for (std::size_t i = 0; i < world.size(); ++i) world.set_held(i, i >= free);
}

void Rod::Impl::begin(const WireSpec& wire, const SheathPose& grip, std::span<const Vec3> path) {
    CATHLAB_CHECK(finite(grip.mouth.position) && std::isfinite(grip.mouth.orientation.squaredNorm()) &&
                      std::isfinite(grip.length_mm) && grip.length_mm > 0.0,
                  "the sheath's pose must be finite and its length positive");
    for (const Vec3& p : path) CATHLAB_CHECK(finite(p), "the initial path must be finite");
    spec = wire;
    sheath = grip;
    sheath.mouth.orientation.normalize();
}

void Rod::Impl::lay(std::span<const Vec3> path) {
    grow(chain_length(insertion), insertion, 0.0);
    const std::vector<Pose> poses = lay_along(links, free_count(), insertion, sheath.mouth, path);
    for (std::size_t i = 0; i < poses.size(); ++i) {
        x[i] = poses[i].position;
        q[i] = poses[i].orientation;
        world.set_motion(i, {poses[i], Vec3::Zero(), Vec3::Zero()});
    }
    update_joints();
}

Rod::Rod(const WireSpec& spec, const SheathPose& sheath, double initial_insertion_mm,
         std::span<const Vec3> initial_path)
    : impl_(std::make_unique<Impl>()) {
    validate(spec);
    Impl& m = *impl_;
    m.begin(spec, sheath, initial_path);
    m.links = cut_into_links(spec);
    m.tension.assign(m.links.size(), 0.0);
    CATHLAB_CHECK(std::isfinite(initial_insertion_mm), "the initial insertion must be finite");
    m.insertion = std::clamp(initial_insertion_mm, min_insertion_mm(), max_insertion_mm());
    m.lay(initial_path);
}

Rod::~Rod() = default;
Rod::Rod(Rod&&) noexcept = default;
Rod& Rod::operator=(Rod&&) noexcept = default;

void Rod::move_mouth(const Pose& mouth) {
    CATHLAB_CHECK(finite(mouth.position) && std::isfinite(mouth.orientation.squaredNorm()),
                  "the sheath's pose must be finite");
    impl_->sheath.mouth = mouth;
    impl_->sheath.mouth.orientation.normalize();
}

double Rod::command(double advance_mm, double rotate_rad) {
    Impl& m = *impl_;
    if (m.sleeve) {
        SleeveState& s = *m.sleeve;
        const double before = s.wire_insertion;
        if (std::isfinite(rotate_rad)) s.wire_rotation += std::clamp(rotate_rad, -max_turn_rad, max_turn_rad);
        const double step = std::isfinite(advance_mm) ? std::clamp(advance_mm, -max_travel_mm(), max_travel_mm()) : 0.0;
        m.slide(std::clamp(before + step, min_insertion_mm(), max_insertion_mm()), s.insertion, m.rotation);
        return s.wire_insertion - before;
    }
    const double before = m.insertion, turned = m.rotation;
    if (std::isfinite(advance_mm)) {
        const double step = std::clamp(advance_mm, -max_travel_mm(), max_travel_mm());
        m.insertion = std::clamp(before + step, min_insertion_mm(), max_insertion_mm());
    }
    if (std::isfinite(rotate_rad)) m.rotation += std::clamp(rotate_rad, -max_turn_rad, max_turn_rad);
    // New links begin where the grip was, so that predict() finds them in motion like their neighbours.
    m.grow(m.chain_length(m.insertion), before, turned);
    m.update_joints();
    return m.insertion - before;
}

void Rod::predict(double h, std::span<const Vec3> link_force, const Workers& workers) {
    CATHLAB_CHECK(h > 0.0 && std::isfinite(h), "a substep must be longer than zero");
    Impl& m = *impl_;
    CATHLAB_CHECK(link_force.size() <= m.count(), "more forces than links");
    const std::size_t free = m.free_count();
    workers.for_ranges(m.count(), link_grain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const BodyMotion motion = m.world.motion(i);
            m.x_start[i] = motion.pose.position;
            m.q_start[i] = motion.pose.orientation;
            m.force[i] = i < link_force.size() ? link_force[i] : Vec3(Vec3::Zero());
            CATHLAB_CHECK(finite(m.force[i]), "a force on a link is not finite");
            if (i < free) {
                m.x[i] = m.x_start[i] + shortened(h * motion.velocity, max_travel_mm());
                m.q[i] = det::rotation_from_vector(shortened(h * motion.spin, max_turn_rad)) * m.q_start[i];
                m.q[i].normalize();
            } else {
                const Pose held = m.held_pose(i, m.insertion, m.rotation);
                m.x[i] = held.position;
                m.q[i] = held.orientation;
            }
            m.x_predicted[i] = m.x[i];
            m.q_predicted[i] = m.q[i];
        }
    });
}

void Rod::finish(double h, const Workers& workers) {
    Impl& m = *impl_;
    workers.for_ranges(m.count(), link_grain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const Vec3 turn = det::vector_from_rotation(m.q[i] * m.q_start[i].conjugate());
            m.world.set_motion(i, {{m.x[i], m.q[i]}, (m.x[i] - m.x_start[i]) / h, turn / h});
        }
    });
    if (m.sleeve) m.measure_rubbing(h);
}

std::size_t Rod::link_count() const {
    return impl_->count();
}
std::size_t Rod::free_link_count() const {
    return impl_->free_count();
}
Pose Rod::link_pose(std::size_t i) const {
    return {impl_->x.at(i), impl_->q.at(i)};
}
Vec3 Rod::link_velocity(std::size_t i) const {
    CATHLAB_CHECK(i < link_count(), "no such link");
    return impl_->world.motion(i).velocity;
}
double Rod::link_length(std::size_t i) const {
    return impl_->links.at(i).length;
}
double Rod::link_radius(std::size_t i) const {
    return impl_->links.at(i).radius;
}
double Rod::link_mass(std::size_t i) const {
    return impl_->links.at(i).mass;
}
const std::string& Rod::material(std::size_t i) const {
    const Impl& m = *impl_;
    const bool tube = m.sleeve && i >= m.front;
    const std::vector<WireSection>& sections = tube ? m.sleeve->spec.sections : m.spec.sections;
    return sections[static_cast<std::size_t>(m.links.at(i).section)].material;
}

std::vector<Vec3> Rod::polyline() const {
    const Impl& m = *impl_;
    std::vector<Vec3> points{m.x[0] + m.q[0] * Vec3(0.0, 0.0, 0.5 * m.links[0].length)};
    points.reserve(m.count() + 1);
    for (std::size_t i = 0; i < m.count(); ++i)
        points.push_back(m.x[i] + m.q[i] * Vec3(0.0, 0.0, -0.5 * m.links[i].length));
    return points;
}

double Rod::rotation_rad() const {
    return impl_->sleeve ? impl_->sleeve->wire_rotation : impl_->rotation;
}
Vec3 Rod::sheath_reaction_mn() const {
    return impl_->sheath_reaction;
}
double Rod::sheath_force_mn() const {
    if (impl_->sleeve) return impl_->wire_force_mn();
    return impl_->sheath_reaction.dot(impl_->sheath.mouth.orientation * Vec3::UnitZ());
}
double Rod::sheath_torque_mn_mm() const {
    return impl_->sheath_torque;
}
Vec3 Rod::drag_mn() const {
    return impl_->drag;
}
const WireSpec& Rod::spec() const {
    return impl_->spec;
}
const SheathPose& Rod::sheath() const {
    return impl_->sheath;
}

void Rod::samples(double spacing_mm, std::vector<RodSample>& out) const {
    CATHLAB_CHECK(spacing_mm > 0.0, "the spacing of samples must be positive");
    const Impl& m = *impl_;
    out.clear();
    for (std::size_t i = 0; i < m.free_count(); ++i) {
        const WireLink& link = m.links[i];
        const Vec3 axis = m.q[i] * Vec3::UnitZ();
        const double pieces = std::max(1.0, std::ceil(link.length / spacing_mm - 1e-9));
        for (int k = i == 0 || i == m.front ? 0 : 1; k <= pieces; ++k) {  // a catheter's end is wider than the wire
            const double s = link.length * k / pieces;
            if (link.start + s > m.insertion) break;
            const Vec3 arm = axis * (0.5 * link.length - s);
            out.push_back({static_cast<Index>(i), arm, m.x[i] + arm, link.radius});
        }
    }
}

void visit(Archive& archive, Rod& rod) {
    Rod::Impl& m = *rod.impl_;
    archive.field("insertion", m.insertion);
    archive.field("rotation", m.rotation);
    std::vector<Vec3> velocity(m.count()), spin(m.count());
    for (std::size_t i = 0; i < m.count(); ++i) {
        const BodyMotion motion = m.world.motion(i);
        velocity[i] = motion.velocity;
        spin[i] = motion.spin;
    }
    archive.field("position", m.x);
    archive.field("orientation", m.q);
    archive.field("velocity", velocity);
    archive.field("spin", spin);
    archive.field("tension", m.tension);
    if (!m.sleeve) return;
    archive.field("wire_insertion", m.sleeve->wire_insertion);
    archive.field("wire_rotation", m.sleeve->wire_rotation);
    archive.field("sleeve_insertion", m.sleeve->insertion);
    archive.field("turn", m.sleeve->turn);
    archive.field("play", m.sleeve->play);
}

}  // namespace cathlab

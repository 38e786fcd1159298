// The wire with a passive catheter over it: moving either, and what they do to each other.
#include <algorithm>
#include <cmath>

#include "core/check.h"
#include "core/deterministic_math.h"
#include "core/units.h"
#include "rod/rod_impl.h"

namespace cathlab {
namespace {

constexpr double creep_mm_s = 0.5;  // slower sliding meets less friction than Coulomb's

Quat about_z(double angle) {
    return {det::cos(0.5 * angle), 0.0, 0.0, det::sin(0.5 * angle)};
}

// The wire's own link at an arc from its tip; null beyond either end.
const WireLink* link_at(std::span<const WireLink> wire, double arc) {
    if (arc < 0.0 || arc >= wire.back().end()) return nullptr;
    const auto behind = [](double s, const WireLink& link) { return s < link.start; };
    return &*(std::upper_bound(wire.begin(), wire.end(), arc, behind) - 1);
}

}  // namespace

Rod::Rod(const WireSpec& spec, const SleeveSpec& sleeve, const SheathPose& sheath, double wire_insertion_mm,
         double sleeve_insertion_mm, std::span<const Vec3> initial_path)
    : impl_(std::make_unique<Impl>()) {
    validate(spec);
    validate(sleeve, spec);
    CATHLAB_CHECK(std::isfinite(wire_insertion_mm) && std::isfinite(sleeve_insertion_mm),
                  "the initial insertions must be finite");
    Impl& m = *impl_;
    m.begin(spec, sheath, initial_path);
    m.sleeve = std::make_unique<SleeveState>();
    SleeveState& s = *m.sleeve;
    s.spec = sleeve;
    s.wire = cut_into_links(spec);
    s.tube = cut_into_links(as_wire(sleeve));
    s.insertion = std::clamp(sleeve_insertion_mm, 0.0, s.tube.back().start);
    s.wire_insertion = std::clamp(wire_insertion_mm, min_insertion_mm(), max_insertion_mm());
    Coaxial chain = compose(s.wire, s.tube, s.wire_insertion, s.insertion, 0.0);
    m.links = std::move(chain.links);
    m.front = chain.front;
    m.insertion = chain.ahead_mm + s.insertion;
    m.tension.assign(m.links.size(), 0.0);
    m.lay(initial_path);
}

double Rod::command_sleeve(double advance_mm, double rotate_rad) {
    Impl& m = *impl_;
    if (!m.sleeve) return 0.0;
    SleeveState& s = *m.sleeve;
    const double before = s.insertion;
    const double step = std::isfinite(advance_mm) ? std::clamp(advance_mm, -max_travel_mm(), max_travel_mm()) : 0.0;
    const double turn = std::isfinite(rotate_rad) ? std::clamp(rotate_rad, -max_turn_rad, max_turn_rad) : 0.0;
    // One of the two keeps two links beyond the mouth.
    const double least = s.wire_insertion < s.wire[1].end() ? s.tube[1].end() : 0.0;
    m.slide(s.wire_insertion, std::clamp(before + step, least, s.tube.back().start), m.rotation + turn);
    return s.insertion - before;
}

// The bodies' places and motions in the next chain, which has another number of links in front: the wire is where it
// was, cut anew.
std::vector<BodyMotion> Rod::Impl::reshaped(const Coaxial& next, double wire_insertion, double sleeve_insertion) const {
    std::vector<BodyMotion> now;
    for (std::size_t i = 0; i < world.size(); ++i) now.push_back(world.motion(i));
    const double before = sleeve->wire_insertion - sleeve->insertion;  // ahead of the catheter's tip
    const double grown = (wire_insertion - sleeve_insertion) - before;
    const auto link_before = [&](double arc) {
        std::size_t i = 0;
        while (i + 1 < front && links[i].end() <= arc) ++i;
        return i;
    };
    const auto point_before = [&](double arc) {
        const std::size_t i = link_before(arc);
        const double from_centre =
            front > 0 ? 0.5 * links[i].length - (arc - links[i].start) : 0.5 * links[i].length + before - arc;
        return Vec3(now[i].pose.to_world(Vec3(0.0, 0.0, from_centre)));
    };
    std::vector<BodyMotion> out;
    const std::size_t unchanged = std::min(front, next.front) > 0 ? std::min(front, next.front) - 1 : 0;
    for (std::size_t i = 0; i < next.front; ++i) {
        if (i < unchanged) {
            out.push_back(now[i]);
            continue;
        }
        const WireLink& link = next.links[i];
        const double end = link.end() - (i + 1 == next.front ? grown : 0.0);
        const Vec3 tip = point_before(link.start), rear = point_before(end);
        BodyMotion motion = now[front > 0 ? std::min(i, front - 1) : 0];
        Quat frame = now[link_before(link.start)].pose.orientation;
        if (front == 0) frame = frame * about_z(sleeve->turn);
        const Vec3 axis = frame * Vec3::UnitZ(), along = tip - rear;
        if (along.norm() > 0.2 * link.length) frame = det::rotation_between(axis, along.normalized()) * frame;
        frame.normalize();
        motion.pose = {0.5 * (tip + rear), frame};
        out.push_back(motion);
    }
    out.insert(out.end(), now.begin() + static_cast<std::ptrdiff_t>(front), now.end());
    return out;
}

void Rod::Impl::slide(double wire_insertion, double sleeve_insertion, double sleeve_rotation) {
    SleeveState& s = *sleeve;
    const double held_before = s.insertion, rotation_before = rotation;
    s.slide_mm += (wire_insertion - s.wire_insertion) - (sleeve_insertion - s.insertion);
    const double apart = s.wire_rotation - sleeve_rotation;
    s.turn = std::clamp(s.turn, apart - s.play, apart + s.play);
    Coaxial next = compose(s.wire, s.tube, wire_insertion, sleeve_insertion, s.turn);
    if (next.front != front) {
        const std::vector<BodyMotion> motion = reshaped(next, wire_insertion, sleeve_insertion);
        while (world.size() > 0) world.remove_last();
        x.clear();
        q.clear();
        for (std::size_t i = 0; i < motion.size() && i < next.links.size(); ++i) {
            world.add(next.links[i], motion[i]);
            x.push_back(motion[i].pose.position);
            q.push_back(motion[i].pose.orientation);
        }
        const std::size_t kept = std::min(front, next.front);
        std::vector<double> pulls(tension.begin(), tension.begin() + static_cast<std::ptrdiff_t>(kept));
        pulls.resize(next.front, kept > 0 ? tension[kept - 1] : 0.0);
        pulls.insert(pulls.end(), tension.begin() + static_cast<std::ptrdiff_t>(front), tension.end());
        tension = std::move(pulls);
        front = next.front;
    }
    links = std::move(next.links);
    s.wire_insertion = wire_insertion;
    s.insertion = sleeve_insertion;
    insertion = next.ahead_mm + sleeve_insertion;
    rotation = sleeve_rotation;
    grow(chain_length(insertion), next.ahead_mm + held_before, rotation_before);
    update_joints();
}

void Rod::Impl::measure_rubbing(double h) {
    SleeveState& s = *sleeve;
    const double ahead = s.wire_insertion - s.insertion;
    const double to_wire = front > 0 ? 0.0 : ahead;  // from the chain's arc to the wire's
    Vec3 moment = Vec3::Zero(), shear = Vec3::Zero();
    double load = 0.0, torque = 0.0, lag = 0.0, last = 0.0;
    for (std::size_t i = 0; i < free_count() && i + 1 < count(); ++i) {
        const double arc = links[i].end();
        const WireLink* wire = link_at(s.wire, arc + to_wire);
        if (!wire) continue;
        const double span = world.joint(i).span;
        if (span <= 0.0) break;
        const Vec3 ta = q[i] * Vec3::UnitZ(), tb = q[i + 1] * Vec3::UnitZ();
        const Vec3 next = (wire->bend / span) * ta.cross(tb);
        const Vec3 next_shear = last > 0.0 ? Vec3((next - moment) / (arc - last)) : Vec3(Vec3::Zero());
        // The step of the shear stands at the joint before; from the catheter's tip on it is the catheter that makes
        // it.
        if (i > 0 && i >= front && last > 0.0) {
            const double press = (next_shear - shear).norm();
            load += press;
            torque += s.spec.wire_friction * press * wire->radius;
        }
        if (i >= front) lag += torque * span / wire->twist;
        moment = next;
        shear = next_shear;
        last = arc;
    }
    s.load_mn = load;
    s.play = std::min(lag, 4.0 * units::pi);
    const double most = s.spec.wire_friction * load, creep = creep_mm_s * h;
    s.rubbing_mn = most * std::clamp(s.slide_mm / creep, -1.0, 1.0);
    s.slide_mm = 0.0;
}

double Rod::Impl::wire_force_mn() const {
    return (front > 0 ? -tension[front - 1] : 0.0) + sleeve->rubbing_mn;
}

Vec3 Rod::tip() const {
    const Impl& m = *impl_;
    std::size_t i = 0;
    double inside = 0.0;  // how far behind the chain's tip
    if (m.sleeve && m.front == 0) {
        inside = std::max(0.0, m.sleeve->insertion - m.sleeve->wire_insertion);
        while (i + 1 < m.count() && m.links[i].end() < inside) ++i;
    }
    return m.x[i] + m.q[i] * Vec3(0.0, 0.0, 0.5 * m.links[i].length - (inside - m.links[i].start));
}

double Rod::insertion_mm() const {
    return impl_->sleeve ? impl_->sleeve->wire_insertion : impl_->insertion;
}
double Rod::min_insertion_mm() const {
    const SleeveState* s = impl_->sleeve.get();
    if (!s) return impl_->links[1].end();
    return s->insertion < s->tube[1].end() ? s->wire[1].end() : 0.0;
}
double Rod::max_insertion_mm() const {
    return impl_->sleeve ? impl_->sleeve->wire.back().start : impl_->links.back().start;
}
bool Rod::has_sleeve() const {
    return impl_->sleeve != nullptr;
}
const SleeveSpec& Rod::sleeve_spec() const {
    CATHLAB_CHECK(impl_->sleeve, "there is no catheter over this wire");
    return impl_->sleeve->spec;
}
std::size_t Rod::front_count() const {
    return impl_->front;
}
double Rod::sleeve_insertion_mm() const {
    return impl_->sleeve ? impl_->sleeve->insertion : 0.0;
}
double Rod::sleeve_rotation_rad() const {
    return impl_->sleeve ? impl_->rotation : 0.0;
}
Vec3 Rod::sleeve_tip() const {
    const Impl& m = *impl_;
    if (!m.sleeve) return tip();
    const std::size_t i = m.front;
    return m.x[i] + m.q[i] * Vec3(0.0, 0.0, 0.5 * m.links[i].length);
}
double Rod::sleeve_force_mn() const {
    const Impl& m = *impl_;
    if (!m.sleeve) return 0.0;
    return m.sheath_reaction.dot(m.sheath.mouth.orientation * Vec3::UnitZ()) - m.wire_force_mn();
}
double Rod::sleeve_load_mn() const {
    return impl_->sleeve ? impl_->sleeve->load_mn : 0.0;
}
double Rod::sleeve_play_rad() const {
    return impl_->sleeve ? impl_->sleeve->play : 0.0;
}

}  // namespace cathlab

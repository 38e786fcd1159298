// The Newton step of the whole chain.  Written in the bodies' own unknowns it is block tridiagonal; eliminating the
// joints' multipliers instead gives the system of Deul et al. 2018 [deul2018], eq. 19 on: the same step by the Woodbury
// identity, for compliances alpha = 1 / (K h^2).
//
// Joint between link a (nearer to the tip) and b behind it, arms r_a = -(L_a / 2) t_a, r_b = +(L_b / 2) t_b:
//   gap    g = x_b + r_b - x_a - r_a                                  energy k/2 |g|^2, k = EA / span
//   bend   e = t_b - u,  u = R_a rest z, where t_b should point        energy k/2 |e|^2, k = EI / span
//          de = dtheta_b x t_b - dtheta_a x u
//   twist  c = 2 Im(q_a^* q_b rest^*)_z = 2 v_z                        energy k/2 c^2, k = GJ / span
//          dc = g . (dtheta_b - dtheta_a),  g = R_a (v_y, -v_x, w), with w the real part
// The bend is taken from the tangents: as two components of 2 v it would be the same energy, but its linearisation lets
// a bent wire trade bending for turning about itself, and a wire that is turned then flutters.
// Second derivatives are left out (Gauss-Newton: the system stays positive definite) but for the string stiffness of a
// joint under tension T, T L / 2 (I - t t^T) on a link's rotation: without it a pulled wire would be stepped
// explicitly.
#include <algorithm>

#include "core/check.h"
#include "core/deterministic_math.h"
#include "rod/rod_impl.h"

namespace cathlab {
namespace {

constexpr double brake_tolerance = 1.25;  // of max_travel_mm
constexpr int braking_passes = 12;
// A Newton step in which a link swings by more is followed by another one at once: the ends of a link that is turned
// move along an arc and not along the tangent, which would open its joints.
constexpr double linear_swing_rad = 0.15;
constexpr double most_swing_rad = 0.2;
constexpr int newton_steps = 8;
constexpr double first_guess = 0.1;  // of a joint's stiffness, for the brake of a swing

Mat3 hat(const Vec3& v) {
    Mat3 m;
    m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
    return m;
}

// 2 Im(to * from^*), the short way round: the rotation vector from `from` to `to` for small angles.
Vec3 turn(const Quat& from, const Quat& to) {
    const Quat q = to * from.conjugate();
    return (q.w() < 0.0 ? -2.0 : 2.0) * q.vec();
}

struct JointNow {
    Vec3 ta, tb, ra, rb, gap;
    Vec3 u, g;
    double twist = 0.0;  // c
    Vec3 moment;         // of bend and twist, on a
};

JointNow joint_now(const Vec3& xa, const Quat& qa, double la, const Vec3& xb, const Quat& qb, double lb,
                   const JointStiffness& s) {
    JointNow j;
    const Mat3 frame = qa.toRotationMatrix();
    j.ta = frame.col(2);
    j.tb = qb * Vec3::UnitZ();
    j.ra = (-0.5 * la) * j.ta;
    j.rb = (0.5 * lb) * j.tb;
    j.gap = xb + j.rb - xa - j.ra;
    j.u = s.curved ? Vec3(frame * (s.rest * Vec3::UnitZ())) : j.ta;
    Quat delta = qa.conjugate() * qb;
    if (s.curved) delta = delta * s.rest.conjugate();
    if (delta.w() < 0.0) delta.coeffs() = -delta.coeffs();
    j.g = frame * Vec3(delta.y(), -delta.x(), delta.w());
    j.twist = 2.0 * delta.z();
    j.moment = s.bend * j.u.cross(j.tb) + (s.twist * j.twist) * j.g;
    return j;
}

}  // namespace

void Rod::Impl::assemble_joint(std::size_t i, std::size_t free) {
    const std::size_t b = i + 1;
    const JointStiffness& s = world.joint(i);
    const double la = links[i].length, lb = links[b].length;
    const JointNow j = joint_now(x[i], q[i], la, x[b], q[b], lb, s);
    const double k = s.axial;
    const Vec3 pull = k * j.gap;
    const Mat3 twist = s.twist * j.g * j.g.transpose();
    const double string = 0.5 * std::max(0.0, tension[i]);
    const auto add = [&](std::size_t link, const Vec3& r, const Vec3& t, const Vec3& pointer, double length) {
        Mat6& d = system.diagonal[link];
        d.topLeftCorner<3, 3>().diagonal().array() += k;
        d.bottomLeftCorner<3, 3>() += k * hat(r);
        Mat3 m = twist - k * r * r.transpose() - (string * length) * t * t.transpose() -
                 s.bend * pointer * pointer.transpose();
        m.diagonal().array() += k * r.squaredNorm() + string * length + s.bend;
        d.bottomRightCorner<3, 3>() += m;
    };
    add(i, j.ra, j.ta, j.u, la);
    system.right[i].head<3>() += pull;
    system.right[i].tail<3>() += j.ra.cross(pull) + j.moment;
    if (b >= free) return;
    add(b, j.rb, j.tb, j.tb, lb);
    system.right[b].head<3>() -= pull;
    system.right[b].tail<3>() -= j.rb.cross(pull) + j.moment;
    Mat6& e = system.below[i];
    e.topLeftCorner<3, 3>() = -k * Mat3::Identity();
    e.topRightCorner<3, 3>() = k * hat(j.ra);
    e.bottomLeftCorner<3, 3>() = -k * hat(j.rb);
    Mat3 m = k * j.ra * j.rb.transpose() + s.bend * j.u * j.tb.transpose() - twist;
    m.diagonal().array() -= k * j.ra.dot(j.rb) + s.bend * j.u.dot(j.tb);
    e.bottomRightCorner<3, 3>() = m;
}

void Rod::Impl::assemble(double h) {
    const std::size_t free = free_count();
    system.resize(free);
    const double inertial = 1.0 / (h * h);
    const double drag = spec.damping_per_s / h, spin_drag = spec.spin_damping_per_s / h;
    for (std::size_t i = 0; i < free; ++i) {
        const WireLink& link = links[i];
        const Vec3 t = q[i] * Vec3::UnitZ();
        const Mat3 inertia =
            link.inertia_across * Mat3::Identity() + (link.inertia_along - link.inertia_across) * t * t.transpose();
        Mat6& d = system.diagonal[i];
        d.topLeftCorner<3, 3>().diagonal().array() += link.mass * (inertial + drag);
        d.bottomRightCorner<3, 3>() += (inertial + spin_drag) * inertia;
        system.right[i].head<3>() +=
            link.mass * (inertial * (x_predicted[i] - x[i]) + drag * (x_start[i] - x[i])) + force[i];
        system.right[i].tail<3>() -=
            inertia * (inertial * turn(q_predicted[i], q[i]) + spin_drag * turn(q_start[i], q[i]));
    }
    for (std::size_t i = 0; i < free; ++i) assemble_joint(i, free);
}

// A link that would travel further than max_travel_mm is braked by a viscous force of its own, so that contact, which
// looks ahead by that much, is never jumped over when a stored bend is let go.  One that would swing by more than
// max_turn_rad is braked likewise: a joint's linear law holds for small turns, and a shaped tip that snaps round in one
// step would tear its joints open.  The brakes only take energy.
std::size_t Rod::Impl::update_brakes(double h) {
    const std::size_t free = free_count();
    std::size_t first = free;
    for (std::size_t i = 0; i < free; ++i) {
        const double travel = (x[i] + system.solution[i].head<3>() - x_start[i]).norm();
        const Vec3 turned = system.solution[i].tail<3>();
        const double swing = (turned - axis[i] * axis[i].dot(turned)).norm();
        if (travel <= brake_tolerance * max_travel_mm() && swing <= most_swing_rad) continue;
        if (travel > brake_tolerance * max_travel_mm()) {
            const double needed = links[i].mass / (h * h) * (travel / max_travel_mm() - 1.0);
            brake[i] = std::max(3.0 * brake[i], needed);
        }
        if (swing > most_swing_rad) {
            const double stiffness = links[i].inertia_across / (h * h) + first_guess * world.joint(i).bend;
            swing_brake[i] = std::max(3.0 * swing_brake[i], stiffness * (swing / linear_swing_rad - 1.0));
        }
        if (first == free) first = i;
    }
    return first;
}

// Moves the links and keeps the joints' forces as the linear system had them: after the move the stiff springs' own
// lengths would show the second order of the rotations instead.
void Rod::Impl::apply_solution(double h) {
    const std::size_t free = free_count();
    for (std::size_t i = 0; i < free; ++i) {
        const JointStiffness& s = world.joint(i);
        const std::size_t b = i + 1;
        const JointNow j = joint_now(x[i], q[i], links[i].length, x[b], q[b], links[b].length, s);
        const Vec6& da = system.solution[i];
        const Vec6 db = b < free ? system.solution[b] : Vec6::Zero().eval();
        const Vec3 gap = j.gap + db.head<3>() + db.tail<3>().cross(j.rb) - da.head<3>() - da.tail<3>().cross(j.ra);
        const Vec3 pull = s.axial * gap;  // on a
        tension[i] = -pull.dot(j.ta + j.tb) * 0.5;
        if (b < free) continue;
        const Vec3 turned = da.tail<3>();
        const Vec3 moment = j.moment - s.bend * (turned - j.u * j.u.dot(turned)) - s.twist * j.g * j.g.dot(turned);
        sheath_reaction = pull;
        sheath_torque = moment.dot(sheath.mouth.orientation * Vec3::UnitZ());
    }
    drag = rows.side_force(system.solution);
    for (std::size_t i = 0; i < free; ++i) {
        x[i] += system.solution[i].head<3>();
        drag -= (links[i].mass * spec.damping_per_s / h + brake[i]) * (x[i] - x_start[i]);
        q[i] = det::rotation_from_vector(system.solution[i].tail<3>()) * q[i];
        q[i].normalize();
    }
}

void Rod::Impl::newton_step(double h, std::span<ChainRow> chain_rows) {
    Impl& m = *this;
    const std::size_t free = m.free_count();
    m.assemble(h);
    m.axis.resize(free);
    for (std::size_t i = 0; i < free; ++i) m.axis[i] = m.q[i] * Vec3::UnitZ();
    m.rows.begin(chain_rows, m.axis, h);
    m.diagonal = m.system.diagonal;
    m.right = m.system.right;
    m.brake.assign(free, 0.0);
    m.swing_brake.assign(free, 0.0);
    std::size_t first = 0;
    for (int pass = 0; first < free || pass == 0; ++pass) {
        for (std::size_t i = first; i < free; ++i) {
            m.system.diagonal[i] = m.diagonal[i];
            m.system.right[i] = m.right[i];
            m.rows.add_to(i, m.system.diagonal[i], m.system.right[i]);
            if (m.brake[i] > 0.0) {
                m.system.diagonal[i].topLeftCorner<3, 3>().diagonal().array() += m.brake[i];
                m.system.right[i].head<3>() += m.brake[i] * (m.x_start[i] - m.x[i]);
            }
            if (m.swing_brake[i] > 0.0) {
                m.system.diagonal[i].bottomRightCorner<3, 3>().diagonal().array() += m.swing_brake[i];
            }
        }
        m.system.factor_and_solve(first);
        first = m.rows.update(m.system.solution, pass);
        if (pass < braking_passes) first = std::min(first, m.update_brakes(h));
    }
    m.rows.end(chain_rows);
    m.apply_solution(h);
}

// Rows after a Newton step, as their owner would measure them: the point has moved with its link, the partner has given
// way to the change of the forces.
void Rod::Impl::carry_on(std::span<ChainRow> now, std::span<const ChainRow> before) const {
    for (std::size_t r = 0; r < now.size(); ++r) {
        const auto link = static_cast<std::size_t>(now[r].link);
        Vec3 moved = Vec3::Zero();
        if (link < system.solution.size()) {
            const Vec3 arm = det::rotation_from_vector(system.solution[link].tail<3>()) * now[r].arm;
            moved = system.solution[link].head<3>() + arm - now[r].arm;
            now[r].arm = arm;
        }
        const Vec3& n = now[r].normal;
        now[r].gap += n.dot(moved) + now[r].compliance * (now[r].multiplier - before[r].multiplier);
        now[r].slip += moved - n * n.dot(moved) + now[r].compliance * (now[r].tangent_force - before[r].tangent_force);
    }
}

void Rod::solve(double h, std::span<ChainRow> chain_rows) {
    Impl& m = *impl_;
    for (const ChainRow& row : chain_rows)
        CATHLAB_CHECK(row.link >= 0 && static_cast<std::size_t>(row.link) < m.count(), "a chain row names no link");
    std::vector<ChainRow> now(chain_rows.begin(), chain_rows.end()), before;
    for (int step = 0; step < newton_steps; ++step) {
        before = now;
        m.newton_step(h, now);
        double swing = 0.0;
        for (std::size_t i = 0; i < m.system.size(); ++i) {
            const Vec3& turned = m.system.solution[i].tail<3>();
            swing = std::max(swing, (turned - m.axis[i] * m.axis[i].dot(turned)).squaredNorm());
        }
        if (swing < linear_swing_rad * linear_swing_rad) break;
        m.carry_on(now, before);
    }
    for (std::size_t r = 0; r < now.size(); ++r) {
        chain_rows[r].multiplier = now[r].multiplier;
        chain_rows[r].tangent_force = now[r].tangent_force;
    }
}

double Rod::max_stretch() const {
    const Impl& m = *impl_;
    double most = 0.0;
    for (std::size_t i = 0; i < m.free_count(); ++i) {
        const JointStiffness& s = m.world.joint(i);
        const JointNow j =
            joint_now(m.x[i], m.q[i], m.links[i].length, m.x[i + 1], m.q[i + 1], m.links[i + 1].length, s);
        const double span = 0.5 * (m.links[i].length + m.links[i + 1].length);
        most = std::max(most, j.gap.norm() / span);
    }
    return most;
}

double Rod::energy_uj() const {
    const Impl& m = *impl_;
    double sum = 0.0;
    for (std::size_t i = 0; i < m.free_count(); ++i) {
        const WireLink& link = m.links[i];
        const BodyMotion motion = m.world.motion(i);
        const double along = motion.spin.dot(motion.pose.orientation * Vec3::UnitZ());
        const double across2 = motion.spin.squaredNorm() - along * along;
        sum += 0.5 * (link.mass * motion.velocity.squaredNorm() + link.inertia_along * along * along +
                      link.inertia_across * across2);
        const JointStiffness& s = m.world.joint(i);
        const JointNow j = joint_now(m.x[i], m.q[i], link.length, m.x[i + 1], m.q[i + 1], m.links[i + 1].length, s);
        sum +=
            0.5 * (s.axial * j.gap.squaredNorm() + s.bend * (j.tb - j.u).squaredNorm() + s.twist * j.twist * j.twist);
    }
    return sum;
}

}  // namespace cathlab

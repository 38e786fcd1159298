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
// move along an arc and not along the tangent, which opens its joints by a quarter of swing^2 of their length.
constexpr double linear_swing_rad = 0.15;
// ... and what is left of that after the last step is taken back.
constexpr double small_swing_rad = 0.01;
constexpr double most_swing_rad = 0.2;
constexpr int newton_steps = 8;
constexpr double first_guess = 0.1;     // of a joint's stiffness, for the brake of a swing
constexpr std::size_t link_grain = 32;  // links that are worth a thread of their own

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

// What joints, inertia and drag put into the blocks of link i.
void Rod::Impl::assemble_link(std::size_t i, double h) {
    const double inertial = 1.0 / (h * h);
    const double slowing = spec.damping_per_s / h, spin_slowing = spec.spin_damping_per_s / h;
    const WireLink& link = links[i];
    Mat6& d = system.diagonal[i];
    Vec6& right_hand = system.right[i];
    const Vec3 t = q[i] * Vec3::UnitZ();
    const Mat3 inertia =
        link.inertia_across * Mat3::Identity() + (link.inertia_along - link.inertia_across) * t * t.transpose();
    d.setZero();
    d.topLeftCorner<3, 3>().diagonal().array() += link.mass * (inertial + slowing);
    d.bottomRightCorner<3, 3>() += (inertial + spin_slowing) * inertia;
    right_hand.head<3>() = link.mass * (inertial * (x_predicted[i] - x[i]) + slowing * (x_start[i] - x[i])) + force[i];
    right_hand.tail<3>() = -(inertia * (inertial * turn(q_predicted[i], q[i]) + spin_slowing * turn(q_start[i], q[i])));

    const auto add = [&](std::size_t joint, const Vec3& r, const Vec3& along, const Vec3& pointer) {
        const JointStiffness& s = world.joint(joint);
        const JointNow& j = joints[joint];
        const double k = s.axial, string = 0.5 * std::max(0.0, tension[joint]), length = link.length;
        d.topLeftCorner<3, 3>().diagonal().array() += k;
        d.bottomLeftCorner<3, 3>() += k * hat(r);
        Mat3 m = s.twist * j.g * j.g.transpose() - k * r * r.transpose() -
                 (string * length) * along * along.transpose() - s.bend * pointer * pointer.transpose();
        m.diagonal().array() += k * r.squaredNorm() + string * length + s.bend;
        d.bottomRightCorner<3, 3>() += m;
    };
    if (i > 0) {
        const JointNow& j = joints[i - 1];
        const Vec3 pull = world.joint(i - 1).axial * j.gap;
        add(i - 1, j.rb, j.tb, j.tb);
        right_hand.head<3>() -= pull;
        right_hand.tail<3>() -= j.rb.cross(pull) + j.moment;
    }
    const JointStiffness& s = world.joint(i);
    const JointNow& j = joints[i];
    const double k = s.axial;
    const Vec3 pull = k * j.gap;
    add(i, j.ra, j.ta, j.u);
    right_hand.head<3>() += pull;
    right_hand.tail<3>() += j.ra.cross(pull) + j.moment;
    if (i + 1 == joints.size()) return;
    Mat6& e = system.below[i];
    e.topLeftCorner<3, 3>() = -k * Mat3::Identity();
    e.topRightCorner<3, 3>() = k * hat(j.ra);
    e.bottomLeftCorner<3, 3>() = -k * hat(j.rb);
    Mat3 m = k * j.ra * j.rb.transpose() + s.bend * j.u * j.tb.transpose() - s.twist * j.g * j.g.transpose();
    m.diagonal().array() -= k * j.ra.dot(j.rb) + s.bend * j.u.dot(j.tb);
    e.bottomRightCorner<3, 3>() = m;
}

void Rod::Impl::assemble(double h, const Workers& workers) {
    const std::size_t free = free_count();
    system.resize(free);
    joints.resize(free);
    opening.resize(free);
    axis.resize(free);
    workers.for_ranges(free, link_grain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            axis[i] = q[i] * Vec3::UnitZ();
            joints[i] = joint_now(x[i], q[i], links[i].length, x[i + 1], q[i + 1], links[i + 1].length, world.joint(i));
        }
    });
    workers.for_ranges(free, link_grain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) assemble_link(i, h);
    });
}

// A link that would travel further than max_travel_mm is braked by a viscous force of its own, so that contact, which
// looks ahead by that much, is never jumped over when a stored bend is let go.  One that would swing by more than
// max_turn_rad is braked likewise: a joint's linear law holds for small turns, and a shaped tip that snaps round in one
// step would tear its joints open.  The brakes only take energy.
bool Rod::Impl::update_brakes(std::size_t i, double h) {
    const double travel = (x[i] + system.solution[i].head<3>() - x_start[i]).norm();
    const Vec3 turned = system.solution[i].tail<3>();
    const double swing = (turned - axis[i] * axis[i].dot(turned)).norm();
    if (travel <= brake_tolerance * max_travel_mm() && swing <= most_swing_rad) return false;
    if (travel > brake_tolerance * max_travel_mm()) {
        const double needed = links[i].mass / (h * h) * (travel / max_travel_mm() - 1.0);
        brake[i] = std::max(3.0 * brake[i], needed);
    }
    if (swing > most_swing_rad) {
        const double stiffness = links[i].inertia_across / (h * h) + first_guess * world.joint(i).bend;
        swing_brake[i] = std::max(3.0 * swing_brake[i], stiffness * (swing / linear_swing_rad - 1.0));
    }
    return true;
}

// Moves the links and keeps the joints' forces as the linear system had them: after the move the stiff springs' own
// lengths would show the second order of the rotations instead.
void Rod::Impl::apply_solution(double h, const Workers& workers) {
    const std::size_t free = free_count();
    drag = rows.side_force(system.solution);
    workers.for_ranges(free, link_grain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const JointStiffness& s = world.joint(i);
            const std::size_t b = i + 1;
            const JointNow& j = joints[i];
            const Vec6& da = system.solution[i];
            const Vec6 db = b < free ? system.solution[b] : Vec6::Zero().eval();
            const Vec3 gap = j.gap + db.head<3>() + db.tail<3>().cross(j.rb) - da.head<3>() - da.tail<3>().cross(j.ra);
            const Vec3 pull = s.axial * gap;  // on a
            tension[i] = -pull.dot(j.ta + j.tb) * 0.5;
            opening[i] = gap;
            x[i] += da.head<3>();
            q[i] = det::rotation_from_vector(da.tail<3>()) * q[i];
            q[i].normalize();
            if (b < free) continue;
            const Vec3 turned = da.tail<3>();
            const Vec3 moment = j.moment - s.bend * (turned - j.u * j.u.dot(turned)) - s.twist * j.g * j.g.dot(turned);
            sheath_reaction = pull;
            sheath_torque = moment.dot(sheath.mouth.orientation * Vec3::UnitZ());
        }
    });
    for (std::size_t i = 0; i < free; ++i)
        drag -= (links[i].mass * spec.damping_per_s / h + brake[i]) * (x[i] - x_start[i]);
}

// Puts the links, from the sheath on, where their joints are as far open as the linear system had them.
void Rod::Impl::close_joints() {
    for (std::size_t i = free_count(); i-- > 0;) {
        const std::size_t b = i + 1;
        const Vec3 rear = x[i] - (0.5 * links[i].length) * (q[i] * Vec3::UnitZ());
        const Vec3 front = x[b] + (0.5 * links[b].length) * (q[b] * Vec3::UnitZ());
        x[i] += front - rear - opening[i];
    }
}

// The block of link i with its rows and brakes.
void Rod::Impl::add_rows_and_brakes(std::size_t i) {
    system.diagonal[i] = diagonal[i];
    system.right[i] = right[i];
    rows.add_to(i, system.diagonal[i], system.right[i]);
    if (brake[i] > 0.0) {
        system.diagonal[i].topLeftCorner<3, 3>().diagonal().array() += brake[i];
        system.right[i].head<3>() += brake[i] * (x_start[i] - x[i]);
    }
    if (swing_brake[i] > 0.0) system.diagonal[i].bottomRightCorner<3, 3>().diagonal().array() += swing_brake[i];
}

void Rod::Impl::newton_step(double h, std::span<ChainRow> chain_rows, const Workers& workers) {
    const std::size_t free = free_count();
    assemble(h, workers);
    rows.begin(chain_rows, axis, h);
    diagonal = system.diagonal;
    right = system.right;
    brake.assign(free, 0.0);
    swing_brake.assign(free, 0.0);
    to_build.resize(free);
    BlockRange changed{0, free};
    for (int pass = 0; !changed.empty() || pass == 0; ++pass) {
        system.factor_and_solve(
            changed, workers, [&](std::size_t i) { add_rows_and_brakes(i); },
            [&](std::size_t i) {
                bool anew = rows.update(i, system.solution[i], pass);
                if (pass < braking_passes && update_brakes(i, h)) anew = true;
                to_build[i] = anew ? 1 : 0;
            });
        rows.update_held(pass);
        const auto first = std::find(to_build.begin(), to_build.end(), 1);
        const auto last = std::find(to_build.rbegin(), to_build.rend(), 1);
        changed = {static_cast<std::size_t>(first - to_build.begin()),
                   static_cast<std::size_t>(to_build.rend() - last)};
    }
    rows.end(chain_rows);
    apply_solution(h, workers);
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

void Rod::solve(double h, std::span<ChainRow> chain_rows, const Workers& workers) {
    Impl& m = *impl_;
    for (const ChainRow& row : chain_rows)
        CATHLAB_CHECK(row.link >= 0 && static_cast<std::size_t>(row.link) < m.count(), "a chain row names no link");
    std::vector<ChainRow> now(chain_rows.begin(), chain_rows.end()), before;
    double swing = 0.0;
    for (int step = 0; step < newton_steps; ++step) {
        before = now;
        m.newton_step(h, now, workers);
        swing = 0.0;
        for (std::size_t i = 0; i < m.system.size(); ++i) {
            const Vec3& turned = m.system.solution[i].tail<3>();
            swing = std::max(swing, (turned - m.axis[i] * m.axis[i].dot(turned)).squaredNorm());
        }
        if (swing < linear_swing_rad * linear_swing_rad) break;
        m.carry_on(now, before);
    }
    if (swing > small_swing_rad * small_swing_rad) m.close_joints();
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

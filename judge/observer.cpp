#include "downwash/judge/observer.hpp"

#include <cmath>
#include <cstddef>

#include "downwash/dynamics/plant_model.hpp"

namespace downwash::judge {
namespace {

double planar_dot(Planar a, Planar b) {
    return a.x * b.x + a.z * b.z;
}

/// e^x as docs/model.md 5.6 sums it up.
double growth_of(double x) {
    double term = 1;
    double sum = 1;
    for (int i = 1; i <= 4; ++i) {
        term *= x / i;
        sum += term;
    }
    return sum;
}

/// The two bodies of a moving vehicle.
struct Bodies {
    Planar joint, arm;                            ///< from the multirotor to the joint, from there to the arm's centre
    double arm_rate_rad_s;                        ///< Rate against the world.
    Planar joint_per_pitch, arm_per_pitch;        ///< how the levers change with the pitch
    Planar arm_velocity_m_s;                      ///< Velocity of the arm's centre of mass.
    Planar velocity_per_pitch, velocity_per_arm;  ///< how that changes with the angles at the same rates

    Bodies(const Vehicle& v, const Motion& m)
        : joint(from_body(v.joint_m, m.pitch_rad)),
          arm(v.arm_center_of_mass_m * arm_direction(m.pitch_rad, m.arm_rad)),
          arm_rate_rad_s(m.pitch_rate_rad_s + m.arm_rate_rad_s),
          joint_per_pitch(turned(1, joint)),
          arm_per_pitch(turned(1, arm)),
          arm_velocity_m_s(m.velocity_m_s + turned(m.pitch_rate_rad_s, joint) + turned(arm_rate_rad_s, arm)),
          velocity_per_pitch(turned(m.pitch_rate_rad_s, joint_per_pitch) + turned(arm_rate_rad_s, arm_per_pitch)),
          velocity_per_arm(turned(arm_rate_rad_s, arm_per_pitch)) {}
};

}  // namespace

Four momentum_of(const Vehicle& v, const Motion& m) {
    const Bodies b(v, m);
    const Planar arm = v.arm_mass_kg * b.arm_velocity_m_s;
    const Planar both = v.body_mass_kg * m.velocity_m_s + arm;
    const double arm_spin = v.arm_inertia_kg_m2 * b.arm_rate_rad_s;
    return {both.x, both.z,
            v.body_inertia_kg_m2 * m.pitch_rate_rad_s + arm_spin + planar_dot(arm, b.joint_per_pitch + b.arm_per_pitch),
            arm_spin + planar_dot(arm, b.arm_per_pitch)};
}

Four free_momentum_rate(const Vehicle& v, const Motion& m) {
    const Bodies b(v, m);
    constexpr double g = standard_gravity_m_s2;
    const Planar arm = v.arm_mass_kg * b.arm_velocity_m_s;
    return {0, -v.mass_kg() * g,
            planar_dot(arm, b.velocity_per_pitch) - v.arm_mass_kg * g * (b.joint_per_pitch.z + b.arm_per_pitch.z),
            planar_dot(arm, b.velocity_per_arm) - v.arm_mass_kg * g * b.arm_per_pitch.z};
}

Observer::Observer(const Vehicle& nominal, double gain_1_s, double tick_s)
    : nominal_vehicle_(nominal), tick_s_(tick_s), share_(1 - 1 / growth_of(gain_1_s * tick_s)) {}

ObserverMemory Observer::at_start(const Motion& motion) const {
    return {{}, momentum_of(nominal_vehicle_, motion)};
}

ObserverMemory Observer::of_kept(const Four& kept) const {
    ObserverMemory memory;
    for (std::size_t i = 0; i < 4; ++i) {
        memory.expected_momentum[i] = -kept[i] * tick_s_ / share_;
    }
    return memory;
}

void Observer::look(const Motion& seen, ObserverMemory& memory) const {
    const Four momentum = momentum_of(nominal_vehicle_, seen);
    for (std::size_t i = 0; i < 4; ++i) {
        memory.estimate[i] += share_ * (momentum[i] - memory.expected_momentum[i]) / tick_s_;
    }
}

void Observer::expect(const Motion& seen, double thrust_n, double pitch_torque_nm, double joint_torque_nm,
                      ObserverMemory& memory) const {
    Motion middle = seen;
    middle.pitch_rad += 0.5 * tick_s_ * seen.pitch_rate_rad_s;
    middle.arm_rad += 0.5 * tick_s_ * seen.arm_rate_rad_s;
    const Four rate = free_momentum_rate(nominal_vehicle_, middle);
    const Planar push = from_body({0, thrust_n}, middle.pitch_rad);
    const Four force{push.x, push.z, pitch_torque_nm, joint_torque_nm};
    memory.expected_momentum = momentum_of(nominal_vehicle_, seen);
    for (std::size_t i = 0; i < 4; ++i) {
        memory.expected_momentum[i] += tick_s_ * (rate[i] + force[i] + memory.estimate[i]);
    }
}

ObserverMemory Observer::held(ObserverMemory memory, const Motion& from, const Motion& to) const {
    const Four start = momentum_of(nominal_vehicle_, from);
    const Four end = momentum_of(nominal_vehicle_, to);
    for (std::size_t i = 0; i < 4; ++i) {
        memory.expected_momentum[i] += end[i] - start[i];
    }
    return memory;
}

}  // namespace downwash::judge

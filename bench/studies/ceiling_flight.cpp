#include "downwash/studies/ceiling_flight.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "downwash/controllers/lyapunov.hpp"
#include "downwash/controllers/pid.hpp"
#include "downwash/dynamics/ceiling_tick.hpp"
#include "downwash/dynamics/quadrotor.hpp"
#include "downwash/effects/effect_curve.hpp"
#include "downwash/simulation/noise.hpp"

namespace downwash::studies {
namespace {

constexpr double ceiling_tick_s = 0.01;

const EffectCurve& curve_of_ceiling() {
    static const EffectCurve curve(EffectModel::sanchez_cuevas, 2);
    return curve;
}

/// Height and climb rate of the reference.
struct Reference {
    double height_m, climb_m_s;
};

/// Up to the ceiling and beyond at constant speed, a rest, and down again.
Reference reference_at(const CeilingExperiment& e, double time_s, double leaves_s) {
    if (time_s < leaves_s) {
        const double height_m = e.start_m + e.speed_m_s * time_s;
        return height_m < e.press_m ? Reference{height_m, e.speed_m_s} : Reference{e.press_m, 0};
    }
    const double height_m = e.press_m - e.speed_m_s * (time_s - leaves_s);
    return height_m > e.leave_to_m ? Reference{height_m, -e.speed_m_s} : Reference{e.leave_to_m, 0};
}

}  // namespace

SpacePlant plant_of(const CeilingVehicle& vehicle) {
    QuadrotorParameters quadrotor;
    quadrotor.mass_kg = vehicle.mass_kg;
    quadrotor.inertia_kg_m2 = {0.02, 0.02, 0.035};
    quadrotor.arm_m = vehicle.arm_m;
    quadrotor.rotor_height_m = vehicle.rotor_height_m;
    quadrotor.drag_torque_m = 0.016;
    return make_quadrotor(quadrotor);
}

dynamics::CeilingContact frame_of(const CeilingVehicle& vehicle) {
    dynamics::CeilingContact contact;
    const double half = vehicle.arm_m * std::numbers::sqrt2 / 2;
    for (const double x : {half, -half}) {
        for (const double y : {half, -half}) {
            contact.point_m[contact.point_count++] = {x, y, vehicle.rotor_height_m + vehicle.guard_m};
        }
    }
    return contact;
}

double ceiling_factor_at(const CeilingVehicle& vehicle, double distance_m) {
    return curve_of_ceiling()(std::max(0.0, distance_m) / vehicle.radius_m);
}

std::optional<double> CeilingFlight::delay_s() const {
    constexpr double below_m = -0.05;
    std::optional<double> reference_s;
    for (std::size_t i = 0; i < time_s.size(); ++i) {
        if (time_s[i] < leaves_s) {
            continue;
        }
        if (!reference_s && reference_m[i] <= below_m) {
            reference_s = time_s[i];
        }
        if (reference_s && height_m[i] <= below_m) {
            return time_s[i] - *reference_s;
        }
    }
    return std::nullopt;
}

double CeilingFlight::overshoot_m(double leave_to_m) const {
    double lowest_m = leave_to_m;
    for (std::size_t i = 0; i < time_s.size(); ++i) {
        lowest_m = time_s[i] < leaves_s ? lowest_m : std::min(lowest_m, height_m[i]);
    }
    return leave_to_m - lowest_m;
}

double CeilingFlight::command_in_contact() const {
    constexpr double last_s = 3;
    double sum = 0;
    int count = 0;
    for (std::size_t i = 0; i < time_s.size(); ++i) {
        if (time_s[i] < leaves_s && time_s[i] >= leaves_s - last_s) {
            sum += command_over_weight[i];
            ++count;
        }
    }
    return sum / count;
}

CeilingFlight fly(const CeilingExperiment& e) {
    using dynamics::LaneVector;
    const SpaceModel<0> model = make_space_model<0>(plant_of(e.vehicle));
    const SpaceAllocation allocation = make_space_allocation(model);
    const dynamics::CeilingContact contact = frame_of(e.vehicle);
    const UnderWideCeiling around(e.vehicle);
    const double frame_m = e.vehicle.rotor_height_m + e.vehicle.guard_m;  // over the centre of mass
    const double weight_n = e.vehicle.mass_kg * standard_gravity_m_s2;

    controllers::LyapunovLaw law;
    law.z.k *= e.gain_scale;
    law.z.k_rate *= e.gain_scale;
    AltitudePid pid = e.pid;
    pid.height_kp *= e.gain_scale;
    pid.climb_kp *= e.gain_scale;
    pid.climb_ki *= e.gain_scale;

    dynamics::SpaceState<double, 0> state{};
    state.q[2] = e.start_m - frame_m;
    state.q[3] = 1;
    std::fill(state.thrust_n, state.thrust_n + 4, weight_n / 4);
    CeilingFlight flight;
    flight.leaves_s = (e.press_m - e.start_m) / e.speed_m_s + e.contact_s;
    const auto ticks = static_cast<std::int64_t>(std::lround((flight.leaves_s + e.after_s) / ceiling_tick_s));
    double integral_m = 0;
    double seen_m = e.start_m;
    for (std::int64_t tick = 0; tick < ticks; ++tick) {
        const double time_s = static_cast<double>(tick) * ceiling_tick_s;
        const double height_m = state.q[2] + frame_m;
        const auto per_sample = std::max<std::int64_t>(1, std::lround(e.sample_s / ceiling_tick_s));
        if (tick % per_sample == 0) {
            double noise[simulation::noise_count];
            simulation::draw_noise(simulation::normal_levels(), 1, tick, noise, 1);
            seen_m = height_m + e.height_noise_m * noise[0];
        }
        const Reference reference = reference_at(e, time_s, flight.leaves_s);
        // What the law takes K_c to be where it believes the rotors.
        const double believed = ceiling_factor_at(e.vehicle, e.vehicle.guard_m - (seen_m + e.height_bias_m));
        const dynamics::LaneRotation<double> attitude = dynamics::rotation_of(state.q + 3);
        double acting_n = 0;
        bool is_clipped = false;
        if (e.law == AltitudeLaw::pid) {
            const double climb_error_m_s =
                reference.climb_m_s + pid.height_kp * (reference.height_m - seen_m) - state.u[2];
            const double acceleration_m_s2 =
                pid.climb_kp * climb_error_m_s +
                controllers::integral_action(pid.climb_ki, pid.integral_limit_m_s2, integral_m);
            acting_n = e.vehicle.mass_kg * (standard_gravity_m_s2 + acceleration_m_s2) / attitude.third.z;
            is_clipped = acting_n < 0 || acting_n > 2 * weight_n;
            if (!is_clipped) {
                integral_m = controllers::integrate(pid.climb_ki, pid.integral_limit_m_s2, integral_m, climb_error_m_s,
                                                    ceiling_tick_s);
            }
        } else {
            acting_n = controllers::altitude_thrust(model, law, seen_m, state.u[2], attitude.third.z,
                                                    {reference.height_m, reference.climb_m_s, 0.0});
        }
        acting_n = std::clamp(acting_n, 0.05 * weight_n, 2 * weight_n);
        const double k_c = e.law == AltitudeLaw::lyapunov ? believed : 1.0;
        const controllers::AttitudeTarget<double> level{};
        const LaneVector<double> torque = controllers::attitude_torque(
            model, law, controllers::euler_angles(attitude), LaneVector<double>{state.u[3], state.u[4], state.u[5]},
            dynamics::rotor_spin_of(model, state.thrust_n), level);
        dynamics::SpaceCommand<double, 0> command{};
        controllers::lyapunov_thrusts(allocation, acting_n, torque, k_c, command.thrust_n);
        double sum_n = 0;
        for (int i = 0; i < model.rotor_count; ++i) {
            command.thrust_n[i] = std::clamp(command.thrust_n[i], 0.0, weight_n / 2);
            sum_n += command.thrust_n[i];
        }
        flight.time_s.push_back(time_s);
        flight.height_m.push_back(height_m);
        flight.reference_m.push_back(reference.height_m);
        flight.climb_m_s.push_back(state.u[2]);
        flight.reference_climb_m_s.push_back(reference.climb_m_s);
        flight.command_over_weight.push_back(sum_n / weight_n);
        flight.ceiling_factor.push_back(ceiling_factor_at(e.vehicle, e.vehicle.guard_m - height_m));
        const auto next = dynamics::contact_tick(model, contact, state, command, ceiling_tick_s, around);
        flight.max_depth_m = std::max(flight.max_depth_m, next.max_depth_m);
        state = next.state;
    }
    return flight;
}

}  // namespace downwash::studies

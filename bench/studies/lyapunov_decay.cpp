#include "downwash/studies/lyapunov_decay.hpp"

#include <algorithm>
#include <cmath>

#include "downwash/controllers/lyapunov.hpp"
#include "downwash/dynamics/space_model.hpp"
#include "downwash/studies/ceiling_flight.hpp"

namespace downwash::studies {
namespace {

constexpr double decay_tick_s = 0.01;
constexpr double start_m = -0.5, target_m = -0.2;  // of the rotors, from the ceiling
}  // namespace

LyapunovDecay lyapunov_decay() {
    const UnderWideCeiling ceiling;
    const double rotor_height_m = ceiling.vehicle.rotor_height_m;
    const SpaceModel<0> model = make_space_model<0>(plant_of(ceiling.vehicle));
    const SpaceAllocation allocation = make_space_allocation(model);
    const controllers::LyapunovLaw law;
    const controllers::LyapunovTarget<double> target{target_m - rotor_height_m, 0, 0};
    const auto errors_of = [&](const dynamics::SpaceState<double, 0>& at) {
        return controllers::lyapunov_errors(law.z, at.q[2] - target.value, at.u[2], target);
    };
    const auto command_at = [&](const dynamics::SpaceState<double, 0>& at) {
        const double acting_n = controllers::altitude_thrust(model, law, at.q[2], at.u[2], 1.0, target);
        dynamics::SpaceCommand<double, 0> command{};
        controllers::lyapunov_thrusts(allocation, acting_n, {0.0, 0.0, 0.0},
                                      ceiling_factor_at(ceiling.vehicle, -(at.q[2] + rotor_height_m)),
                                      command.thrust_n);
        return command;
    };

    dynamics::SpaceState<double, 0> state{};
    state.q[2] = start_m - rotor_height_m;
    state.q[3] = 1;
    const controllers::LyapunovErrors<double> first = errors_of(state);
    const double at_start = controllers::lyapunov_function(first);
    // What a continuous command does: de/dt = e' - k e, de'/dt = -k' e' - e, in small steps.
    double e = first.e;
    double e_rate = first.e_rate;
    LyapunovDecay decay;
    for (int tick = 0; tick < 500; ++tick) {
        const auto errors = errors_of(state);
        const auto command = command_at(state);
        double du[6];
        dynamics::accelerations(model, state.q, state.u, command.thrust_n,
                                dynamics::rotor_spin_of(model, command.thrust_n), command.joint_torque_nm, ceiling, du);
        const double error_speed = state.u[2] - target.rate;
        const double v_rate =
            errors.e * error_speed + errors.e_rate * (du[2] - target.acceleration + law.z.k * error_speed);
        const double promised = -law.z.k * errors.e * errors.e - law.z.k_rate * errors.e_rate * errors.e_rate;
        decay.worst_rate_error = std::max(decay.worst_rate_error, std::abs(v_rate - promised) / at_start);
        const double ideal = controllers::lyapunov_function(controllers::LyapunovErrors<double>{e, e_rate});
        decay.sampled_excess =
            std::max(decay.sampled_excess, std::abs(controllers::lyapunov_function(errors) - ideal) / at_start);
        constexpr int small_steps = 1000;
        for (int i = 0; i < small_steps; ++i) {
            const double h = decay_tick_s / small_steps;
            const double half_e = e + h / 2 * (e_rate - law.z.k * e);
            const double half_rate = e_rate + h / 2 * (-law.z.k_rate * e_rate - e);
            e += h * (half_rate - law.z.k * half_e);
            e_rate += h * (-law.z.k_rate * half_rate - half_e);
        }
        state = dynamics::space_step(model, state, command, decay_tick_s, ceiling);
    }
    return decay;
}

}  // namespace downwash::studies

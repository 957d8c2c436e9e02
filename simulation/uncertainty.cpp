#include "downwash/simulation/uncertainty.hpp"

#include <array>
#include <string>

#include "downwash/base/text.hpp"
#include "downwash/simulation/noise.hpp"

namespace downwash {
namespace {

using U = Uncertainty;
using W = World;

double believed_lag_s(const Robot& robot) {
    return robot.rotors.time_constant_s;
}
double believed_delay_s(const Robot& robot) {
    return robot.controller.delay_s;
}

constexpr std::size_t parameter_count = 25;
constexpr std::array<WorldParameter, parameter_count> parameters{{
    {"aero.ceiling_scale", &U::ceiling_scale, &W::ceiling_scale},
    {"aero.ground_scale", &U::ground_scale, &W::ground_scale},
    {"aero.scene_offset_m.x", &U::scene_x_m, &W::scene_x_m},
    {"aero.scene_offset_m.z", &U::scene_z_m, &W::scene_z_m},
    {"vehicle.mass_scale", &U::mass_scale, &W::mass_scale},
    {"vehicle.inertia_scale", &U::inertia_scale, &W::inertia_scale},
    {"vehicle.arm_mass_scale", &U::arm_mass_scale, &W::arm_mass_scale},
    {"vehicle.com_offset_m.x", &U::center_of_mass_x_m, &W::center_of_mass_x_m},
    {"vehicle.com_offset_m.z", &U::center_of_mass_z_m, &W::center_of_mass_z_m},
    {"vehicle.thrust_scale", &U::thrust_scale, &W::thrust_scale},
    {"vehicle.rotor_thrust_scale 1", &U::rotor_thrust_scale, nullptr, 0},
    {"vehicle.rotor_thrust_scale 2", &U::rotor_thrust_scale, nullptr, 1},
    {"vehicle.rotor_thrust_scale 3", &U::rotor_thrust_scale, nullptr, 2},
    {"vehicle.rotor_thrust_scale 4", &U::rotor_thrust_scale, nullptr, 3},
    {"vehicle.rotor_thrust_scale 5", &U::rotor_thrust_scale, nullptr, 4},
    {"vehicle.rotor_thrust_scale 6", &U::rotor_thrust_scale, nullptr, 5},
    {"vehicle.rotor_thrust_scale 7", &U::rotor_thrust_scale, nullptr, 6},
    {"vehicle.rotor_thrust_scale 8", &U::rotor_thrust_scale, nullptr, 7},
    {"vehicle.rotor_time_constant_s", &U::rotor_time_constant_s, &W::rotor_time_constant_s, 0, believed_lag_s},
    {"vehicle.delay_s", &U::delay_s, &W::delay_s, 0, believed_delay_s},
    {"sensing.position_bias_m x", &U::position_bias_m, &W::position_bias_x_m},
    {"sensing.position_bias_m z", &U::position_bias_m, &W::position_bias_z_m},
    {"sensing.pitch_bias_deg", &U::pitch_bias_rad, &W::pitch_bias_rad},
    {"wind.steady_m_s.x", &U::wind_x_m_s, &W::wind_x_m_s},
    {"wind.steady_m_s.z", &U::wind_z_m_s, &W::wind_z_m_s},
}};

/// The least and the greatest value of a number that the robot has.
std::array<double, 2> ends_of(const Spread& spread, double believed) {
    return {believed + spread.difference(0, believed, true), believed + spread.difference(1, believed, true)};
}

}  // namespace

std::span<const WorldParameter> world_parameters() noexcept {
    return parameters;
}

World world_at(const Uncertainty& uncertainty, const Robot& robot, std::span<const double> quantiles,
               std::uint64_t tape) noexcept {
    World world;
    for (std::size_t i = 0; i < parameter_count; ++i) {
        const WorldParameter& parameter = parameters[i];
        const Spread& spread = uncertainty.*parameter.spread;
        const double believed = parameter.believed != nullptr ? parameter.believed(robot) : 0;
        const double value = spread.difference(quantiles[i], believed, parameter.believed != nullptr);
        (parameter.value != nullptr ? world.*parameter.value : world.rotor_thrust_scale[parameter.rotor]) = value;
    }
    world.position_noise_m = uncertainty.position_noise_m.high;
    world.velocity_noise_m_s = uncertainty.velocity_noise_m_s.high;
    world.gyro_noise_rad_s = uncertainty.gyro_noise_rad_s.high;
    world.gust_m_s = uncertainty.gust_m_s.high;
    world.gust_length_x_m = uncertainty.gust_length_x_m;
    world.gust_length_z_m = uncertainty.gust_length_z_m;
    world.tape = tape;
    return world;
}

World draw_world(const Uncertainty& uncertainty, const Robot& robot, std::uint64_t seed, std::uint64_t index) noexcept {
    if (index == 0) {
        return {};
    }
    const std::uint64_t tape = simulation::mixed(simulation::mixed(seed) ^ index);
    double quantiles[parameter_count];
    std::uint64_t bits = tape;
    for (double& quantile : quantiles) {
        bits = simulation::mixed(bits);
        quantile = (static_cast<double>(bits >> 11U) + 0.5) * 0x1p-53;
    }
    return world_at(uncertainty, robot, quantiles, tape);
}

std::vector<KeyError> uncertainty_errors(const RobotUncertainty& uncertainty, const Robot& robot) {
    std::vector<KeyError> errors;
    const double tick_s = 1 / robot.controller.rate_hz;
    const double lag_s = robot.rotors.time_constant_s;
    const auto lags_s = ends_of(uncertainty.rotor_time_constant_s, lag_s);
    if (lag_s == 0 && (lags_s[0] != 0 || lags_s[1] != 0)) {
        errors.push_back({"vehicle.rotor_time_constant_s",
                          "is uncertain for rotors without a lag: give the robot its rotors.time_constant_s first"});
    } else if (lag_s > 0 && lags_s[0] < 0.5 * tick_s) {
        errors.push_back({"vehicle.rotor_time_constant_s", "reaches down to " + to_text(lags_s[0], 4) +
                                                               " s: expected at least half a control tick, " +
                                                               to_text(0.5 * tick_s, 4) + " s"});
    }
    const auto delays_s = ends_of(uncertainty.delay_s, robot.controller.delay_s);
    if (delays_s[0] < 0 || delays_s[1] > simulation::max_delay_ticks * tick_s * (1 + 1e-9)) {
        errors.push_back({"vehicle.delay_s", "reaches from " + to_text(delays_s[0], 4) + " to " +
                                                 to_text(delays_s[1], 4) + " s: expected 0 to " +
                                                 std::to_string(simulation::max_delay_ticks) + " control ticks, " +
                                                 to_text(simulation::max_delay_ticks * tick_s, 4) + " s"});
    }
    return errors;
}

}  // namespace downwash

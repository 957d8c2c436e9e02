#include "downwash/simulation/world_parameters.hpp"

#include <array>
#include <string>

#include "downwash/base/text.hpp"
#include "downwash/simulation/noise.hpp"

namespace downwash {
namespace {

using U = Uncertainty;
using W = World;
using Nominal = double (*)(const Robot&);

/// A number of the worlds that a key stands for.
struct Drawn {
    std::string_view suffix;  ///< What the parameter's name has behind the key.
    double World::*value;
    DangerQuantiles danger = {};
};

struct Tables {
    std::vector<UncertaintyKey> keys;
    std::vector<WorldParameter> parameters;

    bool is_of_robot = false;  ///< the keys that are added next

    void group(std::string_view path, std::string_view description) {
        keys.push_back({path, description, is_of_robot});
    }
    /// What may be as much more as less than nominal.
    void difference(std::string_view path, std::string_view description, double most, Spread U::*spread,
                    const std::vector<Drawn>& drawn) {
        keys.push_back({path, description, is_of_robot, spread, {"sd", "range"}, -most, most});
        for (const Drawn& each : drawn) {
            parameters.push_back(
                {std::string(path) + std::string(each.suffix), spread, nullptr, each.value, 0, each.danger});
        }
    }
    /// A difference of which each rotor draws its own.
    void of_rotors(std::string_view path, std::string_view description, double most, Spread U::*spread) {
        difference(path, description, most, spread, {});
        for (int rotor = 0; rotor < max_rotors; ++rotor) {
            parameters.push_back(
                {std::string(path) + " " + std::to_string(rotor + 1), spread, nullptr, nullptr, rotor});
        }
    }
    /// What the robot has and is never negative; factors and ranges are of the robot's number.
    void of_robot(std::string_view path, std::string_view description, double most, Spread U::*spread, Nominal nominal,
                  const Drawn& drawn) {
        keys.push_back({path, description, is_of_robot, spread, {"sd", "range", "factor"}, 0, most, nominal});
        parameters.push_back({std::string(path), spread, nominal, drawn.value, 0, drawn.danger});
    }
    /// A difference of what only some robots have.
    void of_some(std::string_view path, std::string_view description, double most, Spread U::*spread,
                 std::string_view condition, bool (*is_in_effect)(const Robot&)) {
        keys.push_back(
            {path, description, is_of_robot, spread, {"sd", "range"}, -most, most, nullptr, is_in_effect, condition});
    }
    /// What is drawn anew in every tick.
    void noise(std::string_view path, std::string_view description, double most, Spread U::*spread, double W::*sd) {
        keys.push_back({path, description, is_of_robot, spread, {"sd"}, 0, most, nullptr, nullptr, {}, sd});
    }
};

Tables made_tables() {
    constexpr double far = 0.98;
    Tables t;
    t.group("aero", "surfaces and their effects");
    t.difference("aero.ceiling_scale", "relative change of K - 1 below surfaces, and of a given map", 0.9,
                 &U::ceiling_scale, {{"", &W::ceiling_scale, {far, 1 - far, 0.85, 0.85}}});
    t.difference("aero.ground_scale", "relative change of K - 1 above surfaces", 0.9, &U::ground_scale,
                 {{"", &W::ground_scale, {far, 1 - far}}});
    t.group("aero.scene_offset_m", "where surfaces and obstacles are, from where they nominally are");
    t.difference("aero.scene_offset_m.x", "along the plane [m]", 10, &U::scene_x_m,
                 {{"", &W::scene_x_m, {.forward = far, .backward = 1 - far}}});
    t.difference("aero.scene_offset_m.y", "to the left of the plane [m]; of obstacles, surfaces stay", 10,
                 &U::scene_y_m, {});
    t.difference("aero.scene_offset_m.z", "upwards [m]", 10, &U::scene_z_m,
                 {{"", &W::scene_z_m, {1 - far, far, 0.2, 0.2}}});

    t.is_of_robot = true;
    t.group("vehicle", "the vehicle, beside what its controller knows");
    t.difference("vehicle.mass_scale", "relative change of the multirotor's mass", 0.9, &U::mass_scale,
                 {{"", &W::mass_scale}});
    t.difference("vehicle.inertia_scale", "relative change of both inertias", 0.9, &U::inertia_scale,
                 {{"", &W::inertia_scale}});
    t.difference("vehicle.arm_mass_scale", "relative change of the arm's mass", 0.9, &U::arm_mass_scale,
                 {{"", &W::arm_mass_scale}});
    t.group("vehicle.com_offset_m", "where the multirotor's centre of mass is, in its frame");
    t.difference("vehicle.com_offset_m.x", "forward [m]", 1, &U::center_of_mass_x_m,
                 {{"", &W::center_of_mass_x_m, {.forward = far, .backward = 1 - far}}});
    t.difference("vehicle.com_offset_m.z", "upward [m]", 1, &U::center_of_mass_z_m, {{"", &W::center_of_mass_z_m}});
    t.difference("vehicle.thrust_scale", "relative change of the thrust of all rotors", 0.9, &U::thrust_scale,
                 {{"", &W::thrust_scale}});
    t.of_rotors("vehicle.rotor_thrust_scale", "the same of each rotor for itself", 0.9, &U::rotor_thrust_scale);
    t.of_robot("vehicle.rotor_time_constant_s", "lag of the rotors; sd around the robot's, range in s", 10,
               &U::rotor_time_constant_s, [](const Robot& robot) { return robot.rotors.time_constant_s; },
               {"", &W::rotor_time_constant_s, {.strong = far}});
    t.of_robot("vehicle.delay_s", "age of what the controller sees; sd around the robot's, range in s", 0.3,
               &U::delay_s, [](const Robot& robot) { return robot.controller.delay_s; },
               {"", &W::delay_s, {.strong = far}});
    t.difference("vehicle.lateral_error_m",
                 "how far the loop across the plane lets the vehicle be to the left of it, beside gusts", 10,
                 &U::lateral_error_m, {});
    const auto is_washed = [](const Robot& robot) { return robot.arm.wash.has_value(); };
    t.of_some("vehicle.arm_wash_scale", "relative change of the speed of the slipstreams at the arm", 0.9,
              &U::arm_wash_scale, "where the robot has arm.wash", is_washed);
    t.group("sensing", "what the controller sees instead of the state");
    t.difference("sensing.position_bias_m", "constant error along x, y and z", 10, &U::position_bias_m,
                 {{" x", &W::position_bias_x_m, {.forward = far, .backward = 1 - far}},
                  {" z", &W::position_bias_z_m, {0.1, 0.9}}});
    t.difference("sensing.pitch_bias_deg", "constant error", 30, &U::pitch_bias_rad,
                 {{"", &W::pitch_bias_rad, {.forward = far, .backward = 1 - far}}});
    t.noise("sensing.gyro_noise_rad_s", "error of the pitch rate, anew in every control tick", 10, &U::gyro_noise_rad_s,
            &W::gyro_noise_rad_s);
    t.noise("sensing.velocity_noise_m_s", "the same of the velocity", 10, &U::velocity_noise_m_s,
            &W::velocity_noise_m_s);
    t.noise("sensing.position_noise_m", "the same of the position", 10, &U::position_noise_m, &W::position_noise_m);

    t.is_of_robot = false;
    t.group("wind", "moving air; it acts through the drag of the robot");
    t.group("wind.steady_m_s", "wind that does not change");
    t.difference("wind.steady_m_s.x", "along the plane [m/s]", 30, &U::wind_x_m_s,
                 {{"", &W::wind_x_m_s, {.forward = far, .backward = 1 - far}}});
    t.difference("wind.steady_m_s.y",
                 "to the left [m/s]; it displaces where no integral and no observer of the controller carries it", 30,
                 &U::wind_y_m_s, {});
    t.difference("wind.steady_m_s.z", "upwards [m/s]", 30, &U::wind_z_m_s, {{"", &W::wind_z_m_s, {0.9, 0.1}}});
    t.noise("wind.gust_m_s", "Dryden gusts along x and z; along y one that lasts", 30, &U::gust_m_s, &W::gust_m_s);

    // Drawn after all above: worlds are otherwise those of the same robot without a wash.
    t.parameters.push_back(
        {"vehicle.arm_wash_scale", &U::arm_wash_scale, nullptr, &W::arm_wash_scale, 0, {}, is_washed});

    // Drawn last: what displaces the vehicle beside the plane, and changes nothing in it. Together these quantiles come
    // to some two standard deviations of the displacement.
    constexpr double somewhat = 0.9;
    constexpr DangerQuantiles moves_left{.forward = somewhat, .backward = 1 - somewhat};
    constexpr DangerQuantiles moves_right{.forward = 1 - somewhat, .backward = somewhat};
    const auto lateral = [&](const char* name, Spread U::*spread, double W::*value, const DangerQuantiles& danger) {
        t.parameters.push_back({name, spread, nullptr, value, 0, danger, nullptr, true});
    };
    lateral("aero.scene_offset_m.y", &U::scene_y_m, &W::scene_y_m, moves_right);
    lateral("sensing.position_bias_m y", &U::position_bias_m, &W::position_bias_y_m, moves_right);
    lateral("vehicle.lateral_error_m", &U::lateral_error_m, &W::lateral_error_m, moves_left);
    lateral("wind.steady_m_s.y", &U::wind_y_m_s, &W::wind_y_m_s, moves_left);
    lateral("wind.gust_m_s y", &U::gust_m_s, &W::gust_y_m_s, moves_left);
    return t;
}

const Tables& tables() {
    static const Tables made = made_tables();
    return made;
}

/// The least and the greatest value of a number that the robot has.
std::array<double, 2> ends_of(const Spread& spread, double nominal) {
    return {nominal + spread.difference(0, nominal, true), nominal + spread.difference(1, nominal, true)};
}

}  // namespace

void WorldParameter::put(World& world, const Uncertainty& uncertainty, const Robot& robot,
                         double quantile) const noexcept {
    double& place = value != nullptr ? world.*value : world.rotor_thrust_scale[rotor];
    place = (uncertainty.*spread).difference(quantile, nominal != nullptr ? nominal(robot) : 0, nominal != nullptr);
}

std::span<const UncertaintyKey> uncertainty_keys() {
    return tables().keys;
}

std::span<const WorldParameter> world_parameters() {
    return tables().parameters;
}

std::vector<const WorldParameter*> world_parameters_of(const Robot& robot) {
    std::vector<const WorldParameter*> all;
    for (const WorldParameter& parameter : world_parameters()) {
        if (parameter.matters_to(robot)) {
            all.push_back(&parameter);
        }
    }
    return all;
}

World world_at(const Uncertainty& uncertainty, const Robot& robot, std::span<const double> quantiles,
               std::uint64_t tape) {
    World world;
    const std::vector<const WorldParameter*> parameters = world_parameters_of(robot);
    for (std::size_t i = 0; i < parameters.size(); ++i) {
        parameters[i]->put(world, uncertainty, robot, quantiles[i]);
    }
    for (const UncertaintyKey& key : uncertainty_keys()) {
        if (key.noise != nullptr) {
            world.*key.noise = (uncertainty.*key.spread).high;
        }
    }
    world.gust_length_x_m = uncertainty.gust_length_x_m;
    world.gust_length_z_m = uncertainty.gust_length_z_m;
    world.tape = tape;
    return world;
}

World draw_world(const Uncertainty& uncertainty, const Robot& robot, std::uint64_t seed, std::uint64_t index) {
    if (index == 0) {
        return {};
    }
    const std::uint64_t tape = simulation::mixed(simulation::mixed(seed) ^ index);
    std::vector<double> quantiles;
    std::uint64_t bits = tape;
    for (const WorldParameter& parameter : world_parameters()) {
        bits = simulation::mixed(bits);
        if (parameter.matters_to(robot)) {
            quantiles.push_back(simulation::quantile_of(bits));
        }
    }
    return world_at(uncertainty, robot, quantiles, tape);
}

std::vector<KeyError> uncertainty_errors(const Uncertainty& uncertainty, const Robot& robot) {
    std::vector<KeyError> errors;
    const double tick_s = 1 / robot.controller.rate_hz;
    const double lag_s = robot.rotors.time_constant_s;
    const auto lags_s = ends_of(uncertainty.rotor_time_constant_s, lag_s);
    if (lag_s == 0 && (lags_s[0] != 0 || lags_s[1] != 0)) {
        errors.push_back({"uncertainty.vehicle.rotor_time_constant_s",
                          "is uncertain for rotors without a lag: give the robot its rotors.time_constant_s first"});
    } else if (lag_s > 0 && lags_s[0] < 0.5 * tick_s) {
        errors.push_back({"uncertainty.vehicle.rotor_time_constant_s",
                          "reaches down to " + to_text(lags_s[0], 4) + " s: expected at least half a control tick, " +
                              to_text(0.5 * tick_s, 4) + " s; a controller.rate_hz of " +
                              to_text(std::ceil(0.5 / std::max(lags_s[0], 1e-6))) + " or more would do"});
    }
    const auto delays_s = ends_of(uncertainty.delay_s, robot.controller.delay_s);
    if (delays_s[0] < 0 || delays_s[1] > simulation::max_delay_ticks * tick_s * (1 + 1e-9)) {
        errors.push_back({"uncertainty.vehicle.delay_s",
                          "reaches from " + to_text(delays_s[0], 4) + " to " + to_text(delays_s[1], 4) +
                              " s: expected 0 to " + std::to_string(simulation::max_delay_ticks) + " control ticks, " +
                              to_text(simulation::max_delay_ticks * tick_s, 4) + " s; a controller.rate_hz of " +
                              to_text(std::floor(simulation::max_delay_ticks / delays_s[1])) +
                              " or less would do, or a narrower {range: [low, high]} of delays"});
    }
    return errors;
}

}  // namespace downwash

#include "downwash/simulation/space_world_parameters.hpp"

#include <algorithm>
#include <string_view>

#include "downwash/simulation/noise.hpp"

namespace downwash {
namespace {

using U = Uncertainty;
using W = SpaceWorld;
using Place = double& (*)(W&, int);
using InEffect = bool (*)(const SpaceRobot&, int);

/// A place of a world that is a number of its own.
template <double W::*member>
double& number_of(W& world, int /*number*/) {
    return world.*member;
}
/// A coordinate of a vector of a world.
template <Vector3 W::*member>
double& coordinate_of(W& world, int axis) {
    return (world.*member)[static_cast<std::size_t>(axis)];
}

double lag_of(const SpaceRobot& robot) {
    return robot.plant.time_constant_s;
}
double delay_of(const SpaceRobot& robot) {
    return robot.controller.delay_s;
}
bool has_rotor(const SpaceRobot& robot, int rotor) {
    return rotor < static_cast<int>(robot.plant.rotors.size());
}
bool has_joint(const SpaceRobot& robot, int joint) {
    return joint < robot.joints();
}
bool is_washed(const SpaceRobot& robot, int /*number*/) {
    return robot.plant.wash.has_value();
}

struct Tables {
    std::vector<UncertaintyKey> keys;
    std::vector<SpaceWorldParameter> parameters;

    /// The key of the plane, which space shares, with words of its own.
    void shared(std::string_view path, std::string_view description) {
        const auto all = uncertainty_keys();
        UncertaintyKey key = *std::find_if(all.begin(), all.end(), [&](const auto& each) { return each.path == path; });
        key.description = description;
        keys.push_back(std::move(key));
    }
    /// A key that the plane does not have.
    void own(std::string_view path, std::string_view description, double most, Spread U::*spread, bool is_of_robot) {
        keys.push_back({path, description, is_of_robot, spread, {"sd", "range"}, -most, most});
    }
    void draw(std::string name, Spread U::*spread, Place place, const DangerQuantiles& danger = {}, int number = 0) {
        parameters.push_back({std::move(name), spread, place, number, nullptr, danger});
    }
    /// A number for each of several things.
    void draw_each(const std::string& name, Spread U::*spread, Place place, int count, InEffect is_in_effect) {
        for (int i = 0; i < count; ++i) {
            parameters.push_back({name + " " + std::to_string(i + 1), spread, place, i, nullptr, {}, is_in_effect});
        }
    }
    /// What the robot has and is never negative.
    void draw_of_robot(std::string name, Spread U::*spread, Place place, double (*nominal)(const SpaceRobot&),
                       const DangerQuantiles& danger) {
        parameters.push_back({std::move(name), spread, place, 0, nominal, danger});
    }
};

/// The worlds of a search push the vehicle forwards and to the left in one of them, backwards and to the right in
/// another.
constexpr double far = 0.98;
constexpr double somewhat = 0.9;
constexpr DangerQuantiles pushes_forward{.forward = far, .backward = 1 - far};
constexpr DangerQuantiles pushes_left{.forward = somewhat, .backward = 1 - somewhat};
constexpr DangerQuantiles pushes_right{.forward = 1 - somewhat, .backward = somewhat};

void add_keys(Tables& t) {
    t.shared("aero", "surfaces and their effects");
    t.shared("aero.ceiling_scale", "relative change of K - 1 below surfaces, and of a given map");
    t.shared("aero.ground_scale", "relative change of K - 1 above surfaces");
    t.shared("aero.scene_offset_m", "where surfaces and obstacles are, from where they nominally are");
    t.shared("aero.scene_offset_m.x", "along x [m]");
    t.shared("aero.scene_offset_m.y", "along y [m]");
    t.shared("aero.scene_offset_m.z", "upwards [m]");
    t.own("aero.scene_yaw_deg", "turn of surfaces and obstacles about the z axis at the origin, before the offset", 30,
          &U::scene_yaw_rad, false);
    t.shared("vehicle", "the vehicle, beside what its controller knows");
    t.shared("vehicle.mass_scale", "relative change of the multirotor's mass");
    t.shared("vehicle.inertia_scale", "relative change of all inertias");
    t.shared("vehicle.arm_mass_scale", "relative change of the mass of each link for itself");
    t.shared("vehicle.com_offset_m", "where the multirotor's centre of mass is, in its frame");
    t.shared("vehicle.com_offset_m.x", "forward [m]");
    t.own("vehicle.com_offset_m.y", "to the left [m]", 1, &U::center_of_mass_y_m, true);
    t.shared("vehicle.com_offset_m.z", "upward [m]");
    t.shared("vehicle.thrust_scale", "relative change of the thrust of all rotors");
    t.shared("vehicle.rotor_thrust_scale", "the same of each rotor for itself");
    t.shared("vehicle.rotor_time_constant_s", "lag of the rotors; sd around the robot's, range in s");
    t.shared("vehicle.delay_s", "age of what the controller sees; sd around the robot's, range in s");
    t.own("vehicle.joint_offset_deg", "what the controller sees of each joint less its angle", 30, &U::joint_offset_rad,
          true);
    t.shared("vehicle.arm_wash_scale", "relative change of the speed of the slipstreams at the links");
    t.shared("sensing", "what the controller sees instead of the state");
    t.shared("sensing.position_bias_m", "constant error along x, y and z");
    t.shared("sensing.pitch_bias_deg", "constant error of roll and pitch, each for itself");
    t.own("sensing.yaw_bias_deg", "constant error of the yaw", 30, &U::yaw_bias_rad, true);
    t.shared("sensing.gyro_noise_rad_s", "error of each body rate, anew in every control tick");
    t.shared("sensing.velocity_noise_m_s", "the same of the velocity");
    t.shared("sensing.position_noise_m", "the same of the position");
    t.shared("wind", "moving air; it acts through the drag of the robot");
    t.shared("wind.steady_m_s", "wind that does not change");
    t.shared("wind.steady_m_s.x", "along x [m/s]");
    t.shared("wind.steady_m_s.y", "along y [m/s]");
    t.shared("wind.steady_m_s.z", "upwards [m/s]");
    t.shared("wind.gust_m_s", "Dryden gusts in all directions");
}

void add_parameters(Tables& t) {
    t.draw("aero.ceiling_scale", &U::ceiling_scale, number_of<&W::ceiling_scale>, {far, 1 - far, 0.85, 0.85});
    t.draw("aero.ground_scale", &U::ground_scale, number_of<&W::ground_scale>, {far, 1 - far});
    t.draw("aero.scene_offset_m.x", &U::scene_x_m, coordinate_of<&W::scene_m>, pushes_forward, 0);
    t.draw("aero.scene_offset_m.y", &U::scene_y_m, coordinate_of<&W::scene_m>, pushes_right, 1);
    t.draw("aero.scene_offset_m.z", &U::scene_z_m, coordinate_of<&W::scene_m>, {1 - far, far, 0.2, 0.2}, 2);
    t.draw("aero.scene_yaw_deg", &U::scene_yaw_rad, number_of<&W::scene_yaw_rad>);
    t.draw("vehicle.mass_scale", &U::mass_scale, number_of<&W::mass_scale>);
    t.draw("vehicle.inertia_scale", &U::inertia_scale, number_of<&W::inertia_scale>);
    t.draw_each(
        "vehicle.arm_mass_scale", &U::arm_mass_scale,
        [](W& world, int link) -> double& { return world.link_mass_scale[link]; }, max_joints, has_joint);
    t.draw("vehicle.com_offset_m.x", &U::center_of_mass_x_m, coordinate_of<&W::center_of_mass_m>, pushes_forward, 0);
    t.draw("vehicle.com_offset_m.y", &U::center_of_mass_y_m, coordinate_of<&W::center_of_mass_m>, pushes_left, 1);
    t.draw("vehicle.com_offset_m.z", &U::center_of_mass_z_m, coordinate_of<&W::center_of_mass_m>, {}, 2);
    t.draw("vehicle.thrust_scale", &U::thrust_scale, number_of<&W::thrust_scale>);
    t.draw_each(
        "vehicle.rotor_thrust_scale", &U::rotor_thrust_scale,
        [](W& world, int rotor) -> double& { return world.rotor_thrust_scale[rotor]; }, max_rotors, has_rotor);
    t.draw_of_robot("vehicle.rotor_time_constant_s", &U::rotor_time_constant_s, number_of<&W::rotor_time_constant_s>,
                    lag_of, {.strong = far});
    t.draw_of_robot("vehicle.delay_s", &U::delay_s, number_of<&W::delay_s>, delay_of, {.strong = far});
    t.draw_each(
        "vehicle.joint_offset_deg", &U::joint_offset_rad,
        [](W& world, int joint) -> double& { return world.joint_offset_rad[joint]; }, max_joints, has_joint);
    t.parameters.push_back(
        {"vehicle.arm_wash_scale", &U::arm_wash_scale, number_of<&W::wash_scale>, 0, nullptr, {}, is_washed});
    t.draw("sensing.position_bias_m x", &U::position_bias_m, coordinate_of<&W::position_bias_m>, pushes_forward, 0);
    t.draw("sensing.position_bias_m y", &U::position_bias_m, coordinate_of<&W::position_bias_m>, pushes_right, 1);
    t.draw("sensing.position_bias_m z", &U::position_bias_m, coordinate_of<&W::position_bias_m>, {0.1, 0.9}, 2);
    t.draw("sensing.pitch_bias_deg roll", &U::pitch_bias_rad, coordinate_of<&W::attitude_bias_rad>, pushes_left, 0);
    t.draw("sensing.pitch_bias_deg pitch", &U::pitch_bias_rad, coordinate_of<&W::attitude_bias_rad>, pushes_forward, 1);
    t.draw("sensing.yaw_bias_deg", &U::yaw_bias_rad, coordinate_of<&W::attitude_bias_rad>, {}, 2);
    t.draw("wind.steady_m_s.x", &U::wind_x_m_s, coordinate_of<&W::wind_m_s>, pushes_forward, 0);
    t.draw("wind.steady_m_s.y", &U::wind_y_m_s, coordinate_of<&W::wind_m_s>, pushes_left, 1);
    t.draw("wind.steady_m_s.z", &U::wind_z_m_s, coordinate_of<&W::wind_m_s>, {0.9, 0.1}, 2);
}

const Tables& tables() {
    static const Tables made = [] {
        Tables t;
        add_keys(t);
        add_parameters(t);
        return t;
    }();
    return made;
}

}  // namespace

void SpaceWorldParameter::put(SpaceWorld& world, const Uncertainty& uncertainty, const SpaceRobot& robot,
                              double quantile) const noexcept {
    place(world, number) =
        (uncertainty.*spread).difference(quantile, nominal != nullptr ? nominal(robot) : 0, nominal != nullptr);
}

std::span<const UncertaintyKey> space_uncertainty_keys() {
    return tables().keys;
}

std::span<const SpaceWorldParameter> space_world_parameters() {
    return tables().parameters;
}

std::vector<const SpaceWorldParameter*> space_world_parameters_of(const SpaceRobot& robot) {
    std::vector<const SpaceWorldParameter*> all;
    for (const SpaceWorldParameter& parameter : space_world_parameters()) {
        if (parameter.matters_to(robot)) {
            all.push_back(&parameter);
        }
    }
    return all;
}

SpaceWorld space_world_at(const Uncertainty& uncertainty, const SpaceRobot& robot, std::span<const double> quantiles,
                          std::uint64_t tape) {
    SpaceWorld world;
    const std::vector<const SpaceWorldParameter*> parameters = space_world_parameters_of(robot);
    for (std::size_t i = 0; i < parameters.size(); ++i) {
        parameters[i]->put(world, uncertainty, robot, quantiles[i]);
    }
    world.position_noise_m = uncertainty.position_noise_m.high;
    world.velocity_noise_m_s = uncertainty.velocity_noise_m_s.high;
    world.gyro_noise_rad_s = uncertainty.gyro_noise_rad_s.high;
    world.gust_m_s = uncertainty.gust_m_s.high;
    world.gust_length_level_m = uncertainty.gust_length_x_m;
    world.gust_length_up_m = uncertainty.gust_length_z_m;
    world.tape = tape;
    return world;
}

SpaceWorld draw_space_world(const Uncertainty& uncertainty, const SpaceRobot& robot, std::uint64_t seed,
                            std::uint64_t index) {
    if (index == 0) {
        return {};
    }
    const std::uint64_t tape = simulation::mixed(simulation::mixed(seed) ^ index);
    std::vector<double> quantiles;
    std::uint64_t bits = tape;
    for (const SpaceWorldParameter& parameter : space_world_parameters()) {
        bits = simulation::mixed(bits);
        if (parameter.matters_to(robot)) {
            quantiles.push_back(simulation::quantile_of(bits));
        }
    }
    return space_world_at(uncertainty, robot, quantiles, tape);
}

}  // namespace downwash

#include "downwash/simulation/robot_parameters.hpp"

#include <string>
#include <vector>

#include "downwash/base/parameter_factories.hpp"
#include "downwash/scene/shape_parameters.hpp"

namespace downwash {
namespace {

using Rows = std::vector<Parameter<Robot>>;

// The factories for this table's Model; the members are named by lambdas.
template <class Member>
Parameter<Robot> number(std::string_view path, std::string_view description, Member member) {
    return parameters::number<Robot>(path, description, member);
}
Parameter<Robot> group(std::string_view path, std::string_view description) {
    return parameters::group<Robot>(path, description).is_required();
}

void add_multirotor(Rows& rows) {
    rows.push_back(group("multirotor", "the multirotor without its arm"));
    rows.push_back(number(
                       "multirotor.mass_kg", "mass, rotors and battery included, arm excluded",
                       [](auto& r) -> auto& { return r.multirotor.mass_kg; })
                       .is_required()
                       .above(0)
                       .at_most(1e4));
    rows.push_back(number(
                       "multirotor.pitch_inertia_kg_m2",
                       "moment of inertia about the pitch axis through its centre of mass",
                       [](auto& r) -> auto& { return r.multirotor.pitch_inertia_kg_m2; })
                       .is_required()
                       .above(0)
                       .at_most(1e5));
    rows.push_back(parameters::list<Robot>(
                       "multirotor.body", "solids that can touch obstacles, in the body frame",
                       [](auto& r) -> auto& { return r.body; })
                       .is_required());
    add_shape_rows<Robot>(
        rows, "multirotor.body[]", [](auto& r, std::size_t i) -> auto& { return r.body[i].shape; },
        [](Rows& to, const std::string& path) {
            to.push_back(parameters::vector<Robot>(
                             path + ".center_m", "centre from the multirotor's centre of mass", {"x", "y", "z"},
                             [](auto& r, std::size_t i) -> auto& { return r.body[i].center_body_m; })
                             .at_least(-100)
                             .at_most(100));
        });
}

void add_rotors(Rows& rows) {
    rows.push_back(group("rotors", "the rotors, all alike"));
    rows.push_back(number(
                       "rotors.radius_m", "radius", [](auto& r) -> auto& { return r.rotors.radius_m; })
                       .is_required()
                       .above(0)
                       .at_most(10));
    rows.push_back(parameters::points<Robot>(
                       "rotors.positions_m", "hubs from the multirotor's centre of mass",
                       [](auto& r) -> auto& { return r.rotors.positions_m; })
                       .is_required()
                       .at_least(-100)
                       .at_most(100));
    rows.push_back(number(
                       "rotors.min_thrust_n", "least thrust of one rotor in free air that can be commanded",
                       [](auto& r) -> auto& { return r.rotors.min_thrust_n; })
                       .at_least(0)
                       .at_most(1e5));
    rows.push_back(number(
                       "rotors.max_thrust_n", "greatest thrust of one rotor in free air that can be commanded",
                       [](auto& r) -> auto& { return r.rotors.max_thrust_n; })
                       .is_required()
                       .above(0)
                       .at_most(1e5));
    rows.push_back(number(
                       "rotors.time_constant_s", "of the first-order lag of thrust behind command; 0 for none",
                       [](auto& r) -> auto& { return r.rotors.time_constant_s; })
                       .at_least(0)
                       .at_most(10));
    rows.push_back(number(
                       "rotors.power_coefficient_w_n1p5", "power of one rotor is this times its commanded thrust^1.5",
                       [](auto& r) -> auto& { return r.rotors.power_coefficient_w_n1p5; })
                       .is_required()
                       .above(0)
                       .at_most(1e6));
}

Parameter<Robot> arm_limits() {
    auto limits = parameters::numbers<Robot>(
        "arm.limits_deg", "least and greatest angle relative to the multirotor; null turns through 360 degrees",
        {"lower", "upper"},
        [](const Robot& r, std::size_t) {
            return r.arm.is_limited ? Value(std::vector{r.arm.lower_limit_rad, r.arm.upper_limit_rad}) : Value();
        },
        [](Robot&, std::size_t, const std::vector<double>&) {});
    limits.nullable = true;
    limits.set = [](Robot& r, std::size_t, const Value& value) {
        const auto* given = std::get_if<std::vector<double>>(&value);
        r.arm.is_limited = given != nullptr;
        r.arm.lower_limit_rad = given ? (*given)[0] : 0;
        r.arm.upper_limit_rad = given ? (*given)[1] : 0;
    };
    return std::move(limits).at_least(-3600).at_most(3600);
}

void add_arm(Rows& rows) {
    rows.push_back(group("arm", "the arm with its end effector, one rigid body on one joint"));
    rows.push_back(parameters::pair<Robot>(
                       "arm.joint_m", "joint from the multirotor's centre of mass", {"x", "z"},
                       [](auto& r) -> auto& { return r.arm.joint_x_m; },
                       [](auto& r) -> auto& { return r.arm.joint_z_m; })
                       .at_least(-100)
                       .at_most(100));
    rows.push_back(number(
                       "arm.length_m", "joint to end effector", [](auto& r) -> auto& { return r.arm.length_m; })
                       .is_required()
                       .above(0)
                       .at_most(100));
    rows.push_back(number(
                       "arm.mass_kg", "mass, end effector included", [](auto& r) -> auto& { return r.arm.mass_kg; })
                       .is_required()
                       .above(0)
                       .at_most(1e4));
    rows.push_back(number(
                       "arm.center_of_mass_m", "joint to the arm's centre of mass",
                       [](auto& r) -> auto& { return r.arm.center_of_mass_m; })
                       .is_required()
                       .at_least(0)
                       .at_most(100));
    rows.push_back(number(
                       "arm.inertia_kg_m2", "moment of inertia about the arm's own centre of mass",
                       [](auto& r) -> auto& { return r.arm.inertia_kg_m2; })
                       .is_required()
                       .above(0)
                       .at_most(1e5));
    rows.push_back(
        number(
            "arm.radius_m", "radius of the capsule that encloses it", [](auto& r) -> auto& { return r.arm.radius_m; })
            .is_required()
            .above(0)
            .at_most(10));
    rows.push_back(arm_limits());
    rows.push_back(
        number(
            "arm.max_torque_nm", "greatest torque of the joint", [](auto& r) -> auto& { return r.arm.max_torque_nm; })
            .is_required()
            .above(0)
            .at_most(1e5));
}

/// A gain or a limit of a controller: never negative.
template <class Member>
Parameter<Robot> gain(std::string_view path, std::string_view description, Member member) {
    return number("controller." + std::string(path), description, member).at_least(0).at_most(1e4);
}

void add_controller(Rows& rows) {
    rows.push_back(group("controller", "the model-inversion controllers of multirotor and arm"));
    rows.push_back(gain(
                       "rate_hz", "control ticks per second", [](auto& r) -> auto& { return r.controller.rate_hz; })
                       .at_least(10)
                       .at_most(1000));
    rows.push_back(group("controller.position", "position of the multirotor to acceleration"));
    rows.push_back(gain(
                       "position.kp", "[1/s2]", [](auto& r) -> auto& { return r.controller.position_kp; })
                       .is_required());
    rows.push_back(gain(
                       "position.kd", "[1/s]", [](auto& r) -> auto& { return r.controller.position_kd; })
                       .is_required());
    rows.push_back(gain(
        "position.ki", "[1/s3]", [](auto& r) -> auto& { return r.controller.position_ki; }));
    rows.push_back(gain(
        "position.integral_limit_m_s2", "most that the integral may ask for, per axis",
        [](auto& r) -> auto& { return r.controller.position_integral_limit_m_s2; }));
    rows.push_back(group("controller.attitude", "pitch of the multirotor to angular acceleration"));
    rows.push_back(
        gain(
            "attitude.k5", "pitch error to pitch rate [1/s]", [](auto& r) -> auto& { return r.controller.attitude_k5; })
            .is_required());
    rows.push_back(gain(
                       "attitude.ku5", "pitch rate error to angular acceleration [1/s]",
                       [](auto& r) -> auto& { return r.controller.attitude_ku5; })
                       .is_required());
    rows.push_back(gain(
        "attitude.kiu5", "integral of the pitch rate error [1/s2]",
        [](auto& r) -> auto& { return r.controller.attitude_kiu5; }));
    rows.push_back(gain(
        "attitude.integral_limit_rad_s2", "most that the integral may ask for",
        [](auto& r) -> auto& { return r.controller.attitude_integral_limit_rad_s2; }));
    rows.push_back(gain(
                       "attitude.pitch_rate_filter_s", "time constant of the derivative of the pitch reference",
                       [](auto& r) -> auto& { return r.controller.pitch_rate_filter_s; })
                       .at_most(10));
    rows.push_back(parameters::flag<Robot>(
        "controller.attitude.rate_feed_forward", "adds the derivative of the pitch rate reference",
        [](auto& r) -> auto& { return r.controller.rate_feed_forward; }));
    rows.push_back(group("controller.arm", "arm angle to angular acceleration"));
    rows.push_back(gain(
                       "arm.kp", "[1/s2]", [](auto& r) -> auto& { return r.controller.arm_kp; })
                       .is_required());
    rows.push_back(gain(
                       "arm.kd", "[1/s]", [](auto& r) -> auto& { return r.controller.arm_kd; })
                       .is_required());
    rows.push_back(gain(
        "arm.ki", "[1/s3]", [](auto& r) -> auto& { return r.controller.arm_ki; }));
    rows.push_back(gain(
        "arm.integral_limit_rad_s2", "most that the integral may ask for",
        [](auto& r) -> auto& { return r.controller.arm_integral_limit_rad_s2; }));
    rows.push_back(number(
                       "controller.max_tilt_deg", "the pitch reference is clipped to this",
                       [](auto& r) -> auto& { return r.controller.max_tilt_rad; })
                       .above(0)
                       .below(90));
    rows.push_back(number(
                       "controller.min_vertical_force_ratio", "least vertical force of the inversion over the weight",
                       [](auto& r) -> auto& { return r.controller.min_vertical_force_ratio; })
                       .above(0)
                       .at_most(1));
}

Rows all_rows() {
    Rows rows;
    rows.push_back(parameters::constant<Robot>("schema", "format and version of a robot file", "downwash/robot/v1"));
    rows.push_back(parameters::identifier<Robot>(
                       "name", "name of the robot", [](auto& r) -> auto& { return r.name; })
                       .is_required());
    add_multirotor(rows);
    add_rotors(rows);
    add_arm(rows);
    add_controller(rows);
    return rows;
}

}  // namespace

const ParameterTable<Robot>& robot_parameters() {
    static const ParameterTable<Robot> table(all_rows());
    return table;
}

}  // namespace downwash

#include "downwash/problems/space_problem_parameters.hpp"

#include <array>
#include <string>
#include <utility>

#include "downwash/base/parameter_factories.hpp"
#include "downwash/problems/aero_parameters.hpp"
#include "downwash/problems/obstacle_parameters.hpp"
#include "downwash/problems/planner_parameters.hpp"
#include "downwash/problems/space_goal_parameters.hpp"
#include "downwash/problems/space_rows.hpp"
#include "downwash/problems/uncertainty_parameters.hpp"
#include "downwash/simulation/space_robot_parameters.hpp"
#include "downwash/simulation/space_world_parameters.hpp"

namespace downwash {
namespace {

using Row = Parameter<SpaceProblem>;
using Rows = std::vector<Row>;
using parameters::append;
using parameters::in;

template <class Member>
Row number(std::string_view path, std::string_view description, Member member) {
    return parameters::number<SpaceProblem>(path, description, member);
}
Row group(std::string_view path, std::string_view description) {
    return parameters::group<SpaceProblem>(path, description);
}

void add_robot(Rows& rows) {
    rows.push_back(group("robot", "the aerial manipulator, here or in a file of its own").is_required().or_file());
    for (const Parameter<SpaceRobot>& inner : space_robot_parameters().rows()) {
        rows.push_back(parameters::nested<SpaceProblem>(inner, "robot.", &SpaceProblem::robot));
    }
}

void add_environment(Rows& rows) {
    rows.push_back(group("environment", "the world and where the vehicle may be").is_required());
    rows.push_back(
        group("environment.bounds", "where the multirotor's centre of mass may be, in the world").is_required());
    constexpr std::array<std::pair<std::string_view, std::string_view>, 3> axes{
        {{"environment.bounds.x_m", "along the world's x"},
         {"environment.bounds.y_m", "along its y; with it the problem is one in space"},
         {"environment.bounds.z_m", "upwards"}}};
    for (std::size_t axis = 0; axis < axes.size(); ++axis) {
        rows.push_back(parameters::pair<SpaceProblem>(
                           axes[axis].first, axes[axis].second,
                           {"low", "high"}, [axis](auto& p) -> auto& { return p.bounds.low_m[axis]; },
                           [axis](auto& p) -> auto& { return p.bounds.high_m[axis]; })
                           .between(-farthest_m, farthest_m)
                           .is_required());
    }
    add_obstacle_rows(rows);
}

void add_aero(Rows& rows) {
    rows.push_back(aero_group<SpaceProblem>());
    for (const Parameter<AeroSettings>& row : aero_rows()) {
        rows.push_back(parameters::nested<SpaceProblem>(row, "aero.", &SpaceProblem::aero));
        if (rows.back().condition == "without aero.map") {  // problems in space have no such key
            rows.back().condition.clear();
            rows.back().applies = {};
        }
    }
}

Row attitude() {
    auto row = parameters::row<SpaceProblem>(
        ParameterKind::numbers, "start.attitude",
        "of a vehicle in flight: quaternion of the body axes in the world, of any length but zero; null: level");
    row.elements = {"w", "x", "y", "z"};
    row.nullable = true;
    row.get = [](const SpaceProblem& p, std::size_t) {
        return p.start.attitude ? Value(std::vector<double>(p.start.attitude->begin(), p.start.attitude->end()))
                                : Value();
    };
    row.set = [](SpaceProblem& p, std::size_t, const Value& value) {
        p.start.attitude.reset();
        if (const auto* given = std::get_if<std::vector<double>>(&value)) {
            std::copy(given->begin(), given->end(), p.start.attitude.emplace().begin());
        }
    };
    return std::move(row).between(-1e3, 1e3);
}

/// The reference at the start; the default where there is none.
const SpaceStart::Reference& reference_in(const SpaceProblem& p) {
    static const SpaceStart::Reference still;
    return p.start.reference ? *p.start.reference : still;
}
SpaceStart::Reference& reference_in(SpaceProblem& p) {
    return p.start.reference ? *p.start.reference : p.start.reference.emplace();
}

/// What a vehicle in flight has besides its motion.
void add_flight(Rows& rows) {
    const auto numbers = [&](std::string_view path, std::string_view description,
                             std::vector<double> SpaceCarry::*member) {
        rows.push_back(number_list<SpaceProblem>(
            path, description, [member](auto& p) -> auto& { return p.start.carry.*member; }));
    };
    numbers("start.rotor_thrust_n", "of a vehicle in flight: free-air thrust of each rotor; none: those of a hover",
            &SpaceCarry::rotor_thrust_n);
    numbers("start.controller_memory",
            "of a vehicle in flight: what its controller remembers; none: as after a long hover",
            &SpaceCarry::controller_memory);
    rows.push_back(parameters::optional_group<SpaceProblem>(
        "start.reference",
        "that a vehicle in flight follows: a number for x, y, z [m], yaw and each joint [rad]; else where it is, as it "
        "moves",
        in(&SpaceProblem::start, &SpaceStart::reference)));
    const auto along = [&](std::string_view path, std::string_view description, double most,
                           std::vector<double> SpaceStart::Reference::*member) {
        rows.push_back(number_list<SpaceProblem>(
                           path, description, [member](auto& p) -> auto& { return reference_in(p).*member; })
                           .between(-most, most));
    };
    along("start.reference.position", "along each axis", farthest_m, &SpaceStart::Reference::position);
    along("start.reference.velocity", "its rate along each axis, per s", 100, &SpaceStart::Reference::velocity);
    along("start.reference.acceleration", "its acceleration along each axis, per s2", 1e4,
          &SpaceStart::Reference::acceleration);
}

void add_start(Rows& rows) {
    const auto of = [](auto member) { return in(&SpaceProblem::start, member); };
    rows.push_back(group("start", "where the flight begins").is_required());
    constexpr std::array<std::string_view, 3> axes{"start.x_m", "start.y_m", "start.z_m"};
    for (std::size_t axis = 0; axis < axes.size(); ++axis) {
        rows.push_back(number(
                           axes[axis], axis == 2 ? "upwards" : "of the multirotor's centre of mass, in the world",
                           [axis](auto& p) -> auto& { return p.start.position_m[axis]; })
                           .between(-farthest_m, farthest_m)
                           .is_required());
    }
    append(rows, {number("start.yaw_deg", "from the world's x to its y", of(&SpaceStart::yaw_rad)).between(-3600, 3600),
                  number_list<SpaceProblem>("start.joints_deg", "one angle for each joint; left out: all zero",
                                            of(&SpaceStart::joints_rad))
                      .between(-3600, 3600),
                  space_vector<SpaceProblem>("start.velocity_m_s", "speed in the world", of(&SpaceStart::velocity_m_s))
                      .between(-100, 100),
                  attitude(),
                  space_vector<SpaceProblem>("start.body_rates_rad_s", "rates about the body axes",
                                             of(&SpaceStart::body_rates_rad_s))
                      .between(-100, 100),
                  number_list<SpaceProblem>("start.joint_rates_rad_s", "one rate for each joint; left out: all zero",
                                            of(&SpaceStart::joint_rates_rad_s))
                      .between(-100, 100)});
    add_flight(rows);
}

/// Far below what moves a vehicle; with less, a motion has more control ticks than can be counted.
template <class Member>
Row limit(std::string_view path, std::string_view description, double most, Member member) {
    return number(path, description, member).between(1e-6, most);
}

/// Problem files have one limit for all joints.
Row joint_limit(std::string_view path, std::string_view description, double most,
                std::array<double, max_joints> SpaceMotionLimits::*member) {
    Row row = limit(
        path, description, most, [member](auto& p) -> auto& { return (p.motion.*member)[0]; });
    row.set = [member, set = row.set](SpaceProblem& p, std::size_t i, const Value& value) {
        set(p, i, value);
        p.motion.*member = SpaceMotionLimits::every((p.motion.*member)[0]);
    };
    return row;
}

void add_motion(Rows& rows) {
    using M = SpaceMotionSettings;
    const auto of = [](auto member) { return in(&SpaceProblem::motion, member); };
    append(
        rows,
        {group("motion", "limits of the reference"), limit("motion.max_speed_m_s", "speed", 100, of(&M::max_speed_m_s)),
         limit("motion.max_acceleration_m_s2", "acceleration", 100, of(&M::max_acceleration_m_s2)),
         limit("motion.max_jerk_m_s3", "jerk; PX4's default for its own missions", 10000, of(&M::max_jerk_m_s3)),
         limit("motion.max_yaw_rate_deg_s", "yaw rate", 3600, of(&M::max_yaw_rate_rad_s)),
         limit("motion.max_yaw_acceleration_deg_s2", "yaw acceleration", 36000, of(&M::max_yaw_acceleration_rad_s2)),
         joint_limit("motion.max_joint_rate_deg_s", "rate of each joint", 3600, &M::max_joint_rate_rad_s),
         joint_limit("motion.max_joint_acceleration_deg_s2", "acceleration of each joint", 36000,
                     &M::max_joint_acceleration_rad_s2),
         number("motion.max_thrust_ratio",
                "force that a point mass needs to follow the reference, over its weight; null: any force",
                of(&M::max_thrust_ratio))
             .between(1.001, 100),
         number("motion.max_tilt_rate_deg_s", "how fast the direction of that force turns; null: at any rate",
                of(&M::max_tilt_rate_rad_s))
             .between(0.1, 36000),
         parameters::choice<SpaceProblem>(
             "motion.yaw",
             "where the vehicle looks, where no goal asks for a yaw; free: as the next goal asks, by the shortest "
             "turn; "
             "hold: as at the start; along: along the way; toward: to a point",
             parameters::named(all_yaw_modes), [](auto& p) -> auto& { return p.motion.yaw.mode; }),
         parameters::pair<SpaceProblem>(
             "motion.yaw_toward_m", "the point, in the world", {"x", "y"},
             [](auto& p) -> auto& { return p.motion.yaw.target_m[0]; },
             [](auto& p) -> auto& { return p.motion.yaw.target_m[1]; })
             .between(-farthest_m, farthest_m)
             .is_required()
             .only("with yaw: toward",
                   [](const SpaceProblem& p, std::size_t) { return p.motion.yaw.mode == YawMode::toward; })});
}

Rows all_rows() {
    Rows rows;
    rows.push_back(
        parameters::constant<SpaceProblem>("schema", "format and version of a problem file", "downwash/problem/v1")
            .is_required());
    append(rows,
           {parameters::identifier<SpaceProblem>("name", "name of the problem; it becomes part of a path",
                                                 &SpaceProblem::name),
            parameters::text<SpaceProblem>("description", "what the problem is about", &SpaceProblem::description)});
    add_robot(rows);
    add_environment(rows);
    add_aero(rows);
    add_uncertainty_rows(rows, space_uncertainty_keys(),
                         [](const SpaceProblem& problem) { return uncertain_parts_of(problem.robot); });
    add_start(rows);
    add_space_goal_rows(rows);
    add_motion(rows);
    add_planner_rows(rows);
    return rows;
}

}  // namespace

const ParameterTable<SpaceProblem>& space_problem_parameters() {
    static const ParameterTable<SpaceProblem> table(all_rows());
    return table;
}

std::string_view name_of(YawMode mode) {
    switch (mode) {
        case YawMode::free:
            break;
        case YawMode::hold:
            return "hold";
        case YawMode::along:
            return "along";
        case YawMode::toward:
            return "toward";
    }
    return "free";
}

}  // namespace downwash

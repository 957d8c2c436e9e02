#include "downwash/problems/problem_parameters.hpp"

#include <array>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "downwash/base/parameter_factories.hpp"
#include "downwash/base/text.hpp"
#include "downwash/controllers/plan.hpp"
#include "downwash/problems/aero_parameters.hpp"
#include "downwash/problems/algorithms.hpp"
#include "downwash/problems/goal_parameters.hpp"
#include "downwash/problems/obstacle_parameters.hpp"
#include "downwash/problems/planner_parameters.hpp"
#include "downwash/problems/problem_model.hpp"
#include "downwash/problems/uncertainty_parameters.hpp"
#include "downwash/simulation/robot_parameters.hpp"

namespace downwash {
namespace {

using Rows = std::vector<Parameter<Problem>>;

using parameters::append;
using parameters::in;

template <class Member>
Parameter<Problem> number(std::string_view path, std::string_view description, Member member) {
    return parameters::number<Problem>(path, description, member);
}
Parameter<Problem> group(std::string_view path, std::string_view description) {
    return parameters::group<Problem>(path, description);
}
template <class Member>
Parameter<Problem> position(std::string_view path, std::string_view description, Member member) {
    return number(path, description, member).between(-farthest_m, farthest_m);
}
template <class Member>
Parameter<Problem> angle(std::string_view path, std::string_view description, double max_deg, Member member) {
    return number(path, description, member).between(-max_deg, max_deg);
}

/// Far below what moves a vehicle; with less, a motion has more control ticks than can be counted.
template <class Member>
Parameter<Problem> motion_limit(std::string_view path, std::string_view description, double most, Member member) {
    return number(path, description, member).between(1e-6, most);
}

void add_robot(Rows& rows) {
    rows.push_back(group("robot", "the aerial manipulator, here or in a file of its own").is_required().or_file());
    for (const Parameter<Robot>& inner : robot_parameters().rows()) {
        rows.push_back(parameters::nested<Problem>(inner, "robot.", &Problem::robot));
    }
}

void add_plane(Rows& rows) {
    rows.push_back(group("environment.plane", "the vertical plane of motion"));
    rows.push_back(parameters::numbers<Problem>(
                       "environment.plane.origin_m", "a world point of the plane, its (0, 0)", {"x", "y", "z"},
                       [](const Problem& p, std::size_t) {
                           return std::vector<double>(p.plane.origin_m().begin(), p.plane.origin_m().end());
                       },
                       [](Problem& p, std::size_t, const std::vector<double>& given) {
                           p.plane = PlaneOfMotion({given[0], given[1], given[2]}, p.plane.heading_rad());
                       })
                       .between(-farthest_m, farthest_m));
    auto heading = parameters::row<Problem>(ParameterKind::number, "environment.plane.heading_deg",
                                            "direction of its x axis, from the world's x to its y");
    heading.get = [](const Problem& p, std::size_t) { return Value(p.plane.heading_rad()); };
    heading.set = [](Problem& p, std::size_t, const Value& value) {
        p.plane = PlaneOfMotion(p.plane.origin_m(), std::get<double>(value));
    };
    rows.push_back(std::move(heading).between(-360, 360));
}

void add_environment(Rows& rows) {
    rows.push_back(group("environment", "the world and where the vehicle may be").is_required());
    add_plane(rows);
    rows.push_back(group("environment.bounds", "where the multirotor's centre of mass may be").is_required());
    const auto bounds = [&rows](std::string_view path, std::string_view description, double Bounds::*low,
                                double Bounds::*high) {
        rows.push_back(parameters::pair<Problem>(path, description, {"low", "high"}, in(&Problem::bounds, low),
                                                 in(&Problem::bounds, high))
                           .between(-farthest_m, farthest_m)
                           .is_required());
    };
    bounds("environment.bounds.x_m", "along the plane", &Bounds::x_low_m, &Bounds::x_high_m);
    bounds("environment.bounds.z_m", "upwards", &Bounds::z_low_m, &Bounds::z_high_m);
    add_obstacle_rows(rows);
}

/// The reference at the start; the default where there is none.
const ReferencePoint& reference_in(const Problem& p) {
    static const ReferencePoint still;
    if (p.start.reference) {
        return *p.start.reference;
    }
    return still;
}
ReferencePoint& reference_in(Problem& p) {
    if (!p.start.reference) {
        p.start.reference.emplace();
    }
    return *p.start.reference;
}

/// One row for each coordinate of the reference that a vehicle in flight follows.
void add_start_reference(Rows& rows) {
    rows.push_back(parameters::optional_group<Problem>(
        "start.reference", "that a vehicle in flight follows; else where it is, as it moves",
        in(&Problem::start, &Start::reference)));
    struct Coordinate {
        std::string_view path, description;
        double most;
        double (ReferencePoint::*part)[max_axes];
        int axis;
    };
    static constexpr Coordinate coordinates[] = {
        {"start.reference.x_m", "along the plane", farthest_m, &ReferencePoint::position, 0},
        {"start.reference.z_m", "upwards", farthest_m, &ReferencePoint::position, 1},
        {"start.reference.arm_deg", "of the arm", 3600, &ReferencePoint::position, 2},
        {"start.reference.vx_m_s", "its speed along the plane", 100, &ReferencePoint::velocity, 0},
        {"start.reference.vz_m_s", "its speed upwards", 100, &ReferencePoint::velocity, 1},
        {"start.reference.arm_rate_deg_s", "its rate of the arm", 1800, &ReferencePoint::velocity, 2},
        {"start.reference.ax_m_s2", "its acceleration along the plane", 1000, &ReferencePoint::acceleration, 0},
        {"start.reference.az_m_s2", "its acceleration upwards", 1000, &ReferencePoint::acceleration, 1},
        {"start.reference.arm_acceleration_deg_s2", "its acceleration of the arm", 1e5, &ReferencePoint::acceleration,
         2},
    };
    for (const Coordinate& each : coordinates) {
        rows.push_back(angle(
            each.path, each.description, each.most, [&each](auto& p) -> auto& {
                auto& point = reference_in(p);
                return (point.*each.part)[each.axis];
            }));
    }
}

void add_start(Rows& rows) {
    const auto of = [](auto member) { return in(&Problem::start, member); };
    const auto at = [](std::size_t axis) {
        return [axis](auto& p) -> auto& {
            return p.start.at.coordinate[axis];
        };
    };
    const auto rate = [](std::size_t axis) {
        return [axis](auto& p) -> auto& {
            return p.start.velocity[axis];
        };
    };
    append(rows, {group("start", "where the flight begins").is_required(),
                  position("start.x_m", "along the plane", at(plane::x)).is_required(),
                  position("start.z_m", "upwards", at(plane::z)).is_required(),
                  angle("start.arm_deg", "arm from the vehicle's nose, down is 90", 3600, at(plane::arm)).is_required(),
                  angle("start.pitch_deg", "pitch, nose down", 89, of(&Start::pitch_rad)),
                  angle("start.vx_m_s", "speed along the plane", 100, rate(plane::x)),
                  angle("start.vz_m_s", "speed upwards", 100, rate(plane::z)),
                  angle("start.pitch_rate_deg_s", "pitch rate, nose down", 1800, of(&Start::pitch_rate_rad_s)),
                  angle("start.arm_rate_deg_s", "rate of the arm's joint", 1800, rate(plane::arm))});
    const auto numbers = [&](std::string_view path, std::string_view description, std::vector<double> Start::*member) {
        rows.push_back(parameters::numbers<Problem>(
            path, description, {}, [member](const Problem& p, std::size_t) { return Value(p.start.*member); },
            [member](Problem& p, std::size_t, const std::vector<double>& given) { p.start.*member = given; }));
    };
    numbers("start.rotor_thrust_n", "of a vehicle in flight: free-air thrust of each rotor; none: those of a hover",
            &Start::rotor_thrust_n);
    numbers("start.controller_memory",
            "of a vehicle in flight: what its controller remembers; none: as after a long hover",
            &Start::controller_memory);
    add_start_reference(rows);
}

void add_motion(Rows& rows) {
    const auto of = [](auto member) { return in(&Problem::motion, member); };
    append(rows,
           {group("motion", "limits of the reference"),
            motion_limit("motion.max_speed_m_s", "speed", 100, of(&MotionLimits::max_speed_m_s)),
            motion_limit("motion.max_acceleration_m_s2", "acceleration", 100, of(&MotionLimits::max_acceleration_m_s2)),
            motion_limit("motion.max_jerk_m_s3", "jerk; PX4's default for its own missions", 10000,
                         of(&MotionLimits::max_jerk_m_s3)),
            motion_limit("motion.max_arm_rate_deg_s", "rate of the arm's joint", 3600,
                         of(&MotionLimits::max_arm_rate_rad_s)),
            motion_limit("motion.max_arm_acceleration_deg_s2", "acceleration of the arm's joint", 36000,
                         of(&MotionLimits::max_arm_acceleration_rad_s2)),
            // What only agile references need.
            number("motion.max_thrust_ratio",
                   "force that a point mass needs to follow the reference, over its weight; collisions of the "
                   "reference are then those of the tilted vehicle; null: any force, and a level vehicle",
                   of(&MotionLimits::max_thrust_ratio))
                .between(1.001, 100),
            number("motion.max_pitch_rate_deg_s", "how fast the direction of that force turns; null: at any rate",
                   of(&MotionLimits::max_pitch_rate_rad_s))
                .between(0.1, 36000)});
}

Rows all_rows() {
    Rows rows;
    rows.push_back(
        parameters::constant<Problem>("schema", "format and version of a problem file", "downwash/problem/v1")
            .is_required());
    append(rows,
           {parameters::identifier<Problem>("name", "name of the problem; it becomes part of a path", &Problem::name),
            parameters::text<Problem>("description", "what the problem is about", &Problem::description)});
    add_robot(rows);
    add_environment(rows);
    add_aero_rows(rows);
    add_uncertainty_rows(rows, uncertainty_keys(),
                         [](const Problem& problem) -> const Robot& { return problem.robot; });
    add_start(rows);
    add_goal_rows(rows);
    add_motion(rows);
    add_planner_rows(rows);
    return rows;
}

}  // namespace

const ParameterTable<Problem>& problem_parameters() {
    static const ParameterTable<Problem> table(all_rows());
    return table;
}

}  // namespace downwash

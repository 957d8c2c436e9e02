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
#include "downwash/problems/problem_model.hpp"
#include "downwash/problems/uncertainty_parameters.hpp"
#include "downwash/simulation/robot_parameters.hpp"

namespace downwash {
namespace {

using Rows = std::vector<Parameter<Problem>>;

// The factories for this table's Model; the members are named by lambdas.
template <class Member>
Parameter<Problem> number(std::string_view path, std::string_view description, Member member) {
    return parameters::number<Problem>(path, description, member);
}
Parameter<Problem> group(std::string_view path, std::string_view description) {
    return parameters::group<Problem>(path, description);
}
template <class Member>
Parameter<Problem> position(std::string_view path, std::string_view description, Member member) {
    return number(path, description, member).at_least(-farthest_m).at_most(farthest_m);
}
template <class Member>
Parameter<Problem> angle(std::string_view path, std::string_view description, double max_deg, Member member) {
    return number(path, description, member).at_least(-max_deg).at_most(max_deg);
}
template <class Member>
Parameter<Problem> positive(std::string_view path, std::string_view description, double most, Member member) {
    return number(path, description, member).above(0).at_most(most);
}

/// Far below what moves a vehicle; with less, a motion has more control ticks than can be counted.
template <class Member>
Parameter<Problem> motion_limit(std::string_view path, std::string_view description, double most, Member member) {
    return number(path, description, member).at_least(1e-6).at_most(most);
}

void add_robot(Rows& rows) {
    rows.push_back(group("robot", "the aerial manipulator, here or in a file of its own").is_required().or_file());
    for (const Parameter<Robot>& inner : robot_parameters().rows()) {
        rows.push_back(parameters::nested<Problem>(
            inner, "robot.", [](auto& p) -> auto& { return p.robot; }));
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
                       .at_least(-farthest_m)
                       .at_most(farthest_m));
    auto heading = parameters::row<Problem>(ParameterKind::number, "environment.plane.heading_deg",
                                            "direction of its x axis, from the world's x to its y");
    heading.get = [](const Problem& p, std::size_t) { return Value(p.plane.heading_rad()); };
    heading.set = [](Problem& p, std::size_t, const Value& value) {
        p.plane = PlaneOfMotion(p.plane.origin_m(), std::get<double>(value));
    };
    rows.push_back(std::move(heading).at_least(-360).at_most(360));
}

void add_environment(Rows& rows) {
    rows.push_back(group("environment", "the world and where the vehicle may be").is_required());
    add_plane(rows);
    rows.push_back(group("environment.bounds", "where the multirotor's centre of mass may be").is_required());
    rows.push_back(parameters::pair<Problem>(
                       "environment.bounds.x_m", "along the plane", {"low", "high"},
                       [](auto& p) -> auto& { return p.bounds.x_low_m; },
                       [](auto& p) -> auto& { return p.bounds.x_high_m; })
                       .is_required()
                       .at_least(-farthest_m)
                       .at_most(farthest_m));
    rows.push_back(parameters::pair<Problem>(
                       "environment.bounds.z_m", "upwards", {"low", "high"},
                       [](auto& p) -> auto& { return p.bounds.z_low_m; },
                       [](auto& p) -> auto& { return p.bounds.z_high_m; })
                       .is_required()
                       .at_least(-farthest_m)
                       .at_most(farthest_m));
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
    const auto reference = [](auto& p) -> auto& {
        return p.start.reference;
    };
    rows.push_back(parameters::optional_group<Problem>(
        "start.reference", "that a vehicle in flight follows; else where it is, as it moves", reference));
    struct Coordinate {
        std::string_view path, description;
        double most;
        double (ReferencePoint::*part)[3];
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
    rows.push_back(group("start", "where the flight begins").is_required());
    rows.push_back(position(
                       "start.x_m", "along the plane", [](auto& p) -> auto& { return p.start.x_m; })
                       .is_required());
    rows.push_back(position(
                       "start.z_m", "upwards", [](auto& p) -> auto& { return p.start.z_m; })
                       .is_required());
    rows.push_back(angle(
                       "start.arm_deg", "arm from the vehicle's nose, down is 90", 3600,
                       [](auto& p) -> auto& { return p.start.arm_rad; })
                       .is_required());
    rows.push_back(angle(
        "start.pitch_deg", "pitch, nose down", 89, [](auto& p) -> auto& { return p.start.pitch_rad; }));
    rows.push_back(angle(
        "start.vx_m_s", "speed along the plane", 100, [](auto& p) -> auto& { return p.start.vx_m_s; }));
    rows.push_back(angle(
        "start.vz_m_s", "speed upwards", 100, [](auto& p) -> auto& { return p.start.vz_m_s; }));
    rows.push_back(angle(
        "start.pitch_rate_deg_s", "pitch rate, nose down", 1800,
        [](auto& p) -> auto& { return p.start.pitch_rate_rad_s; }));
    rows.push_back(angle(
        "start.arm_rate_deg_s", "rate of the arm's joint", 1800,
        [](auto& p) -> auto& { return p.start.arm_rate_rad_s; }));
    rows.push_back(parameters::numbers<Problem>(
        "start.rotor_thrust_n", "of a vehicle in flight: free-air thrust of each rotor; none: those of a hover", {},
        [](const Problem& p, std::size_t) { return Value(p.start.rotor_thrust_n); },
        [](Problem& p, std::size_t, const std::vector<double>& given) { p.start.rotor_thrust_n = given; }));
    rows.push_back(parameters::numbers<Problem>(
        "start.controller_memory", "of a vehicle in flight: what its controller remembers; none: as after a long hover",
        {}, [](const Problem& p, std::size_t) { return Value(p.start.controller_memory); },
        [](Problem& p, std::size_t, const std::vector<double>& given) { p.start.controller_memory = given; }));
    add_start_reference(rows);
}

/// What only agile references need.
void add_agile_motion(Rows& rows) {
    rows.push_back(number(
                       "motion.max_thrust_ratio",
                       "force that a point mass needs to follow the reference, over its weight; collisions of the "
                       "reference are then those of the tilted vehicle; null: any force, and a level vehicle",
                       [](auto& p) -> auto& { return p.motion.max_thrust_ratio; })
                       .at_least(1.001)
                       .at_most(100));
    rows.push_back(number(
                       "motion.max_pitch_rate_deg_s", "how fast the direction of that force turns; null: at any rate",
                       [](auto& p) -> auto& { return p.motion.max_pitch_rate_rad_s; })
                       .at_least(0.1)
                       .at_most(36000));
}

void add_motion(Rows& rows) {
    rows.push_back(group("motion", "limits of the reference"));
    rows.push_back(motion_limit(
        "motion.max_speed_m_s", "speed", 100, [](auto& p) -> auto& { return p.motion.max_speed_m_s; }));
    rows.push_back(motion_limit(
        "motion.max_acceleration_m_s2", "acceleration", 100,
        [](auto& p) -> auto& { return p.motion.max_acceleration_m_s2; }));
    rows.push_back(motion_limit(
        "motion.max_jerk_m_s3", "jerk; PX4's default for its own missions", 10000,
        [](auto& p) -> auto& { return p.motion.max_jerk_m_s3; }));
    rows.push_back(motion_limit(
        "motion.max_arm_rate_deg_s", "rate of the arm's joint", 3600,
        [](auto& p) -> auto& { return p.motion.max_arm_rate_rad_s; }));
    rows.push_back(motion_limit(
        "motion.max_arm_acceleration_deg_s2", "acceleration of the arm's joint", 36000,
        [](auto& p) -> auto& { return p.motion.max_arm_acceleration_rad_s2; }));
    add_agile_motion(rows);
}

std::vector<std::string_view> algorithm_names() {
    std::vector<std::string_view> names;
    for (const AlgorithmInfo& algorithm : algorithms()) {
        names.push_back(algorithm.name);
    }
    return names;
}

void add_objective(Rows& rows) {
    std::vector<std::pair<Objective, std::string_view>> names;
    names.reserve(all_objectives.size());
    for (const Objective objective : all_objectives) {
        names.emplace_back(objective, name_of(objective));
    }
    rows.push_back(parameters::choice<Problem>(
                       "planner.objective", "what a plan should keep small", names,
                       [](auto& p) -> auto& { return p.planner.objective; })
                       .or_group([](const Problem& p) { return !p.planner.objective.single(); },
                                 [](Problem& p) { p.planner.objective = CostFunction::of_nothing(); }));
    for (const Objective objective : all_objectives) {
        rows.push_back(number("planner.objective." + std::string(name_of(objective)),
                              "weight of 1 " + std::string(unit_of(objective)),
                              [objective](auto& p) -> decltype(auto) { return p.planner.objective.weight(objective); })
                           .at_least(0)
                           .at_most(1e9));
    }
}

/// A row for each name; what it means depends on the algorithm, and so does its default.
void add_algorithm_parameters(Rows& rows) {
    rows.push_back(
        group("planner.parameters",
              "parameters of the algorithm; `downwash planners` shows each algorithm's with their defaults"));
    for (const auto& [known, algorithms] : known_parameters()) {
        const AlgorithmParameter& parameter = *known;
        const std::string_view name = parameter.name;
        Parameter<Problem> row = parameters::row<Problem>(
            ParameterKind::number, "planner.parameters." + std::string(name), parameter.description);
        row.range = {parameter.low, parameter.high};
        row.get = [name = name, usual = parameter.value](const Problem& p, std::size_t) {
            return Value(algorithm_parameter(p.planner, name) != nullptr ? parameter_value(p.planner, name) : usual);
        };
        row.set = [name = std::string(name)](Problem& p, std::size_t, const Value& value) {
            p.planner.parameters[name] = std::get<double>(value);
        };
        rows.push_back(std::move(row).only(
            "with " + joined_names(algorithms),
            [name = name](const Problem& p, std::size_t) { return algorithm_parameter(p.planner, name) != nullptr; }));
    }
}

void add_planner(Rows& rows) {
    std::vector<std::pair<Variant, std::string_view>> variants;
    for (const Variant variant : {Variant::mp_arm, Variant::mp_arm_da, Variant::mp_arm_ada}) {
        variants.emplace_back(variant, name_of(variant));
    }
    rows.push_back(group("planner", "how to search"));
    rows.push_back(parameters::choice<Problem>(
        "planner.variant", "what the planner knows of the physics", variants,
        [](auto& p) -> auto& { return p.planner.variant; }));
    rows.push_back(parameters::choice<Problem>(
        "planner.algorithm", "how it searches; some plan for some variants only, see `downwash planners`",
        algorithm_names(), [](auto& p) -> auto& { return p.planner.algorithm; }));
    add_objective(rows);
    rows.push_back(positive(
        "planner.time_limit_s",
        "for the search alone, without aero map and last flight; null: 10 s, or none where max_iterations is set", 1e6,
        [](auto& p) -> auto& { return p.planner.time_limit_s; }));
    rows.push_back(parameters::integer<Problem>(
                       "planner.max_iterations", "limit for a run that is repeatable bit for bit",
                       [](auto& p) -> auto& { return p.planner.max_iterations; })
                       .at_least(1)
                       .at_most(1e15));
    rows.push_back(parameters::integer<Problem>(
                       "planner.seed", "every random number of the search follows from it",
                       [](auto& p) -> auto& { return p.planner.seed; })
                       .at_least(0)
                       .at_most(4294967295.0));
    rows.push_back(number(
                       "planner.safety_margin_m", "least clearance while planning",
                       [](auto& p) -> auto& { return p.planner.safety_margin_m; })
                       .at_least(0)
                       .at_most(100));
    rows.push_back(number(
                       "planner.max_saturation",
                       "greatest demand on a rotor or the joint over its limit while planning; above 1 it is clipped",
                       [](auto& p) -> auto& { return p.planner.max_saturation; })
                       .at_least(1)
                       .at_most(1000));
    rows.push_back(number(
                       "planner.max_pitch_rate_deg_s",
                       "how fast the vehicle may turn while planning; an edge that turns faster is rejected as "
                       "unstable; null: at any rate",
                       [](auto& p) -> auto& { return p.planner.max_pitch_rate_rad_s; })
                       .at_least(1e-3)
                       .at_most(1e5));
    const auto is_uncertain = [](const Problem& p, std::size_t) { return p.uncertainty.has_value(); };
    constexpr std::string_view with_uncertainty = "with an uncertainty";
    rows.push_back(parameters::integer<Problem>(
                       "planner.worlds", "in which every edge has to succeed, the nominal one included",
                       [](auto& p) -> auto& { return p.planner.worlds; })
                       .at_least(1)
                       .at_most(64)
                       .only(with_uncertainty, is_uncertain));
    rows.push_back(number(
                       "planner.max_failure_probability", "share of worlds in which a plan may fail",
                       [](auto& p) -> auto& { return p.planner.max_failure_probability; })
                       .at_least(1e-4)
                       .at_most(0.5)
                       .only(with_uncertainty, is_uncertain));
    rows.push_back(number(
                       "planner.confidence", "that a plan which is called solved does not fail more often",
                       [](auto& p) -> auto& { return p.planner.confidence; })
                       .at_least(0.5)
                       .at_most(0.999999)
                       .only(with_uncertainty, is_uncertain));
    add_algorithm_parameters(rows);
}

Rows all_rows() {
    Rows rows;
    rows.push_back(
        parameters::constant<Problem>("schema", "format and version of a problem file", "downwash/problem/v1")
            .is_required());
    rows.push_back(parameters::identifier<Problem>(
        "name", "name of the problem; it becomes part of a path", [](auto& p) -> auto& { return p.name; }));
    rows.push_back(parameters::text<Problem>(
        "description", "what the problem is about", [](auto& p) -> auto& { return p.description; }));
    add_robot(rows);
    add_environment(rows);
    add_aero_rows(rows);
    add_uncertainty_rows(rows);
    add_start(rows);
    add_goal_rows(rows);
    add_motion(rows);
    add_planner(rows);
    return rows;
}

}  // namespace

const ParameterTable<Problem>& problem_parameters() {
    static const ParameterTable<Problem> table(all_rows());
    return table;
}

}  // namespace downwash

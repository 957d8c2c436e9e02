#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <string>

#include "downwash/aeromap/aero_map.hpp"
#include "downwash/aeromap/direct_effect.hpp"
#include "downwash/base/angles.hpp"
#include "downwash/base/parameter.hpp"
#include "downwash/base/text.hpp"
#include "downwash/controllers/plan.hpp"
#include "downwash/grids/factor_grid.hpp"
#include "downwash/problems/algorithms.hpp"
#include "downwash/problems/goal_errors.hpp"
#include "downwash/problems/goal_kinds.hpp"
#include "downwash/problems/number_text.hpp"
#include "downwash/problems/problem.hpp"
#include "downwash/problems/problem_check.hpp"
#include "downwash/problems/problem_model.hpp"
#include "downwash/problems/problem_parameters.hpp"
#include "downwash/problems/shared_checks.hpp"
#include "downwash/problems/touch_places.hpp"
#include "downwash/scene/collision_checker.hpp"
#include "downwash/simulation/flight_model.hpp"
#include "downwash/simulation/robot_parameters.hpp"
#include "downwash/simulation/world_parameters.hpp"

namespace downwash {
namespace {

using problems::rounded;

std::vector<KeyError> reversed_bounds(const Problem& p) {
    std::vector<KeyError> errors;
    const auto check = [&errors](const char* key, double low, double high) {
        if (low >= high) {
            errors.push_back(
                {key, "is [" + to_text(low) + ", " + to_text(high) + "]: expected [low, high], low below high"});
        }
    };
    check("environment.bounds.x_m", p.bounds.x_low_m, p.bounds.x_high_m);
    check("environment.bounds.z_m", p.bounds.z_low_m, p.bounds.z_high_m);
    return errors;
}

/// What shows when obstacles are placed: a mesh without area, a scale that makes it huge.
std::vector<KeyError> unplaceable_obstacles(const ProblemCheck& check) {
    std::vector<KeyError> errors;
    try {
        static_cast<void>(check.scene());
    } catch (const InputError& invalid) {
        for (const KeyError& error : invalid.errors()) {
            errors.push_back({"environment." + error.key, error.message});
        }
    }
    return errors;
}

/// A planar map of the user's has to stand in the plane of motion, or beside it.
std::vector<KeyError> map_of_another_plane(const Problem& p) {
    constexpr double min_sine = 1e-6;
    if (!p.aero.enabled || !p.aero.map || !p.aero.map->is_planar()) {
        return {};
    }
    const PlaneOfMotion& frame = p.aero.map->frame();
    const double sine = frame.sin_heading() * p.plane.cos_heading() - frame.cos_heading() * p.plane.sin_heading();
    if (std::abs(sine) <= min_sine) {
        return {};
    }
    return {{"aero.map", "stands in another vertical plane (" + to_text(frame.heading_rad() * degrees_per_radian, 8) +
                             " deg): expected the heading of environment.plane (" +
                             to_text(p.plane.heading_rad() * degrees_per_radian, 8) + " deg)"}};
}

/// A map of the user's that says of which rotors it is has to be of the robot's.
std::vector<KeyError> map_of_another_rotor(const Problem& p) {
    constexpr double largest_difference = 1e-6;  // relative
    if (!p.aero.enabled || !p.aero.map) {
        return {};
    }
    const double radius_m = p.robot.rotors.radius_m;
    for (const auto& [key, value] : p.aero.map->provenance()) {
        const auto map_radius_m = key == "rotor_radius_m" ? parse_number<double>(value) : std::nullopt;
        if (map_radius_m && std::abs(*map_radius_m - radius_m) > largest_difference * radius_m) {
            return {{"aero.map", "is of rotors of " + to_text(*map_radius_m) +
                                     " m radius, as its rotor_radius_m says: expected robot.rotors.radius_m, " +
                                     to_text(radius_m) + " m"}};
        }
    }
    return {};
}

/// A map of the user's has to hold wherever a rotor can get.
std::vector<KeyError> unreached_places(const Problem& p) {
    if (!p.aero.enabled || !p.aero.map || !map_of_another_plane(p).empty()) {
        return {};
    }
    const Bounds reach = rotor_extent(p.robot.rotors, p.bounds);
    for (const Vector3& rotor_m : p.robot.rotors.positions_m) {
        for (const double x : {reach.x_low_m, reach.x_high_m}) {
            for (const double z : {reach.z_low_m, reach.z_high_m}) {
                const Vector3 hub = p.plane.to_world(x, rotor_m[1], z);
                if (!p.aero.map->contains(hub)) {
                    return {{"aero.map", "does not reach the world point (" + rounded(hub[0]) + ", " + rounded(hub[1]) +
                                             ", " + rounded(hub[2]) +
                                             "), where a rotor can get at the edge of environment.bounds: expected a "
                                             "grid that covers " +
                                             rounded(reach.x_low_m) + " to " + rounded(reach.x_high_m) +
                                             " m along the "
                                             "plane and " +
                                             rounded(reach.z_low_m) + " to " + rounded(reach.z_high_m) +
                                             " m in z, at every lateral offset of a rotor"}};
                }
            }
        }
    }
    return {};
}

std::vector<KeyError> too_large_map(const Problem& p) {
    if (!p.aero.enabled) {
        return {};
    }
    const auto no_obstacles = std::make_shared<const Scene>(std::vector<Obstacle>{});
    const double cells =
        map_cells(effect_layers(p.robot.rotors, no_obstacles, p.aero).layers, rotor_extent(p.robot.rotors, p.bounds));
    if (cells <= max_map_cells) {
        return {};
    }
    return {{"aero.grid_m", "makes a map of " + rounded(cells) + " cells over the bounds: expected at most " +
                                rounded(max_map_cells) + "; choose a coarser grid or narrower bounds"}};
}

std::vector<KeyError> start_outside_bounds(const Problem& p) {
    std::vector<KeyError> errors;
    const auto check = [&errors](const char* key, double value, double low, double high) {
        if (value < low || value > high) {
            errors.push_back({key, "is " + to_text(value) + ", outside the bounds: expected " + to_text(low) + " to " +
                                       to_text(high)});
        }
    };
    check("start.x_m", p.start.at[plane::x], p.bounds.x_low_m, p.bounds.x_high_m);
    check("start.z_m", p.start.at[plane::z], p.bounds.z_low_m, p.bounds.z_high_m);
    return errors;
}

std::vector<KeyError> misfit_start(const Problem& p) {
    return start_errors(p.start, p.robot);
}

/// A vehicle in flight is as fast as it is; what has limits is its reference.
std::vector<KeyError> start_too_fast(const Problem& p) {
    std::vector<KeyError> errors;
    if (p.start.reference) {
        return errors;
    }
    const double speed = std::hypot(p.start.velocity[plane::x], p.start.velocity[plane::z]);
    if (speed > p.motion.max_speed_m_s) {
        errors.push_back({p.start.velocity[plane::x] == 0 ? "start.vz_m_s" : "start.vx_m_s",
                          "makes a start speed of " + rounded(speed) + " m/s: expected at most motion.max_speed_m_s, " +
                              to_text(p.motion.max_speed_m_s)});
    }
    if (std::abs(p.start.velocity[plane::arm]) > p.motion.max_arm_rate_rad_s) {
        errors.push_back({"start.arm_rate_deg_s", "is faster than motion.max_arm_rate_deg_s: expected at most " +
                                                      rounded(p.motion.max_arm_rate_rad_s * degrees_per_radian) +
                                                      " in size"});
    }
    return errors;
}

bool is_beyond_limits(const ArmParameters& arm, double angle_rad, double tolerance_rad = 1e-9) {
    return arm.is_limited &&
           (angle_rad < arm.lower_limit_rad - tolerance_rad || angle_rad > arm.upper_limit_rad + tolerance_rad);
}

std::vector<KeyError> start_beyond_arm_limits(const Problem& p) {
    if (!is_beyond_limits(p.robot.arm, p.start.at[plane::arm])) {
        return {};
    }
    return {{"start.arm_deg", "is beyond the arm's limits: expected " + arm_limits_text(p.robot.arm)}};
}

std::vector<KeyError> start_in_collision(const ProblemCheck& check) {
    return start_near_obstacle(check.problem(), check.collisions(), check.problem().start.pose());
}

/// World position of a rotor's hub (docs/model.md 1: body axes b1 = (cos p, -sin p), b3 = (sin p, cos p)).
Vector3 hub_m(const Problem& p, const Vector3& in_body_m) {
    const double c = std::cos(p.start.pitch_rad);
    const double s = std::sin(p.start.pitch_rad);
    return p.plane.to_world(p.start.at[plane::x] + in_body_m[0] * c + in_body_m[2] * s, in_body_m[1],
                            p.start.at[plane::z] - in_body_m[0] * s + in_body_m[2] * c);
}

std::vector<KeyError> start_not_flyable(const ProblemCheck& check) {
    const Problem& p = check.problem();
    if (!p.aero.enabled) {
        return {};
    }
    const std::shared_ptr<const Scene>& scene = check.scene();
    const DirectEffect effect(scene, p.aero, p.robot.rotors.radius_m);
    for (std::size_t i = 0; i < p.robot.rotors.positions_m.size(); ++i) {
        const Vector3 hub = hub_m(p, p.robot.rotors.positions_m[i]);
        if (!effect.is_flyable(hub)) {
            return {{"start", "is outside the flyable area: the disc of rotor " + std::to_string(i + 1) + " is " +
                                  rounded(disc_clearance_m(*scene, hub, p.robot.rotors.radius_m)) +
                                  " m from an obstacle; expected at least " +
                                  rounded(p.aero.min_distance_radii * p.robot.rotors.radius_m) +
                                  " m (aero.min_distance_radii times the rotor radius)"}};
        }
    }
    return {};
}

std::vector<KeyError> unflyable_uncertainty(const Problem& p) {
    return p.uncertainty ? uncertainty_errors(*p.uncertainty, p.robot) : std::vector<KeyError>();
}

const std::array<Check<ProblemCheck>, 20> checks{{
    {{"environment.bounds"}, reversed_bounds},
    {{"environment.obstacles"}, repeated_names<Problem>},
    {{"environment.obstacles"}, shapeless_cylinders<Problem>},
    {{"environment.obstacles"}, unplaceable_obstacles},
    {{"aero"}, incomplete_effects<Problem>},
    {{"environment.bounds", "environment.plane", "aero.map", "robot.rotors"}, unreached_places},
    {{"environment.plane", "aero.map"}, map_of_another_plane},
    {{"aero.map", "robot.rotors"}, map_of_another_rotor},
    {{"environment.bounds", "aero", "robot.rotors"}, too_large_map},
    {{"environment.bounds", "start"}, start_outside_bounds},
    {{"start", "robot.rotors", "robot.controller"}, misfit_start},
    {{"start", "motion"}, start_too_fast},
    {{"start.arm_deg", "robot.arm"}, start_beyond_arm_limits},
    {{"environment.obstacles", "environment.plane", "start", "robot.multirotor.body", "robot.arm",
      "planner.safety_margin_m"},
     start_in_collision},
    {{"environment.obstacles", "environment.plane", "start", "robot.rotors", "aero"}, start_not_flyable},
    {{"uncertainty", "robot.uncertainty", "robot.rotors.time_constant_s", "robot.controller"}, unflyable_uncertainty},
    {{"planner.objective"}, weightless_objective<Problem>},
    {{"planner.variant", "planner.algorithm"}, algorithm_of_another_variant<Problem>},
    {{"planner.variant", "planner.worlds", "planner.max_saturation", "planner.max_pitch_rate_deg_s"},
     flights_without_flying<Problem>},
    {{"planner.parameters"}, split_whole_numbers<Problem>},
}};

}  // namespace

std::vector<KeyError> start_errors(const Start& start, const Robot& robot) {
    std::vector<KeyError> errors;
    const auto check = [&errors](const char* key, const std::vector<double>& given, std::size_t expected,
                                 const char* of_what) {
        if (!given.empty() && given.size() != expected) {
            errors.push_back({key, "has " + std::to_string(given.size()) + " numbers: expected " +
                                       std::to_string(expected) + ", " + of_what});
        }
        if (!std::all_of(given.begin(), given.end(), [](double number) { return std::isfinite(number); })) {
            errors.push_back({key, "has a number that is not finite: expected finite ones"});
        }
    };
    check("start.rotor_thrust_n", start.rotor_thrust_n, robot.rotors.positions_m.size(), "one for each rotor");
    check("start.controller_memory", start.controller_memory,
          static_cast<std::size_t>(controllers::memory_size(controllers::flown_law(robot.controller.law))),
          "as many as robot.controller remembers");
    return errors;
}

std::vector<KeyError> further_errors(const ProblemCheck& check, WrongKeys wrong) {
    const Problem& problem = check.problem();
    std::vector<KeyError> errors = value_errors(problem_parameters(), problem, "", wrong);
    append(errors, further_robot_errors(problem.robot, wrong, "robot."));
    append(errors, run_checks(std::span<const Check<ProblemCheck>>(checks), check, "", wrong));
    append(errors, run_checks(goal_checks(), check, "", wrong));
    return errors;
}

std::shared_ptr<const FlightModel> model_of(const ProblemCheck& check) {
    const Problem& problem = check.problem();
    return std::make_shared<const FlightModel>(problem.robot, problem.plane, check.scene(), problem.aero,
                                               problem.planner.collision_checker);
}

std::vector<KeyError> further_problem_errors(const Problem& problem, WrongKeys wrong) {
    return further_errors(ProblemCheck(problem), std::move(wrong));
}

std::vector<Goal> goals_of(const Problem& problem) {
    std::vector<Goal> goals = problem.targets.empty() ? problem.goals_before : problem.targets;
    if (problem.targets.empty()) {
        goals.push_back(problem.goal);
    }
    if (problem.return_to) {
        goals.push_back(*problem.return_to);
    }
    return goals;
}

std::vector<KeyError> problem_errors(const Problem& problem) {
    return further_problem_errors(problem, {});
}

PlannableProblem plannable(Problem problem) {
    const ProblemCheck check(problem);
    if (std::vector<KeyError> errors = further_errors(check, {}); !errors.empty()) {
        throw InputError(std::move(errors));
    }
    auto model = model_of(check);
    return {with_touches(std::move(problem)), std::move(model)};
}

}  // namespace downwash

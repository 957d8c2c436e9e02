#include "downwash/planner/remedies.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>
#include <variant>

#include "downwash/base/key_error.hpp"
#include "downwash/planner/solve.hpp"
#include "downwash/planner/stopwatch.hpp"
#include "downwash/simulation/world_parameters.hpp"

namespace downwash {
namespace {

/// Calls `change(goal)` with the goal, every stop and every target. The place to return to stays.
template <class Change>
void change_goals(Problem& problem, const Change& change) {
    std::ranges::for_each(problem.goals_before, change);
    std::ranges::for_each(problem.targets, change);
    change(problem.goal);
}

void raise_goals(Problem& problem, double by_m) {
    change_goals(problem, [by_m](Goal& goal) { raise_goal(goal, by_m); });
}

void widen_tolerances(Problem& problem) {
    change_goals(problem, [](Goal& goal) { widen_goal(goal, 1.5); });
}

/// Time scaled by 2: the same ways at half the speed.
void slow_down(Problem& problem) {
    MotionLimits& motion = problem.motion;
    motion.max_speed_m_s /= 2;
    motion.max_arm_rate_rad_s /= 2;
    motion.max_acceleration_m_s2 /= 4;
    motion.max_jerk_m_s3 /= 8;
    motion.max_arm_acceleration_rad_s2 /= 4;
    if (motion.max_thrust_ratio) {
        *motion.max_thrust_ratio = 1 + (*motion.max_thrust_ratio - 1) / 4;
    }
    if (motion.max_pitch_rate_rad_s) {
        *motion.max_pitch_rate_rad_s /= 2;
    }
}

/// Time of the position loop is scaled by one over this.
constexpr double faster = 1.15;

void stiffen(ModelInversion& law) {
    const auto stiffen_loop = [](double& kp, double& kd, double& ki) {
        kp *= faster * faster;
        kd *= faster;
        ki *= faster * faster * faster;
    };
    ModelInversion::AxisGains height = law.axis_gains(1);
    stiffen_loop(height.kp, height.kd, height.ki);
    stiffen_loop(law.position_kp, law.position_kd, law.position_ki);
    law.height_kp = height.kp;
    law.height_kd = height.kd;
    law.height_ki = height.ki;
}

void stiffen(CascadedPid& law) {
    for (double* per_time : {&law.horizontal_position_kp, &law.horizontal_velocity_kp, &law.vertical_position_kp,
                             &law.vertical_velocity_kp}) {
        *per_time *= faster;
    }
    law.horizontal_velocity_ki *= faster * faster;
    law.vertical_velocity_ki *= faster * faster;
}

void stiffen(PlanarLyapunov& law) {
    for (double* per_time : {&law.horizontal_k, &law.horizontal_k_rate, &law.vertical_k, &law.vertical_k_rate}) {
        *per_time *= faster;
    }
}

/// Other laws stay as they are.
template <class Law>
void stiffen(Law& /*law*/) {}

void stiffen_law(Problem& problem) {
    std::visit([](auto& law) { stiffen(law); }, problem.robot.controller.law);
}

/// All spreads half as wide, around the nominal number.
void know_better(Problem& problem) {
    for (const UncertaintyKey& key : uncertainty_keys()) {
        if (key.spread == nullptr) {
            continue;
        }
        Spread& spread = (*problem.uncertainty).*key.spread;
        double middle = 0;
        if (spread.form == Spread::Form::sd) {
            spread.high *= 0.5;
            continue;
        }
        if (spread.form == Spread::Form::factor) {
            middle = 1;
        } else if (spread.form == Spread::Form::range && key.nominal != nullptr) {
            middle = key.nominal(problem.robot);
        }
        spread.low = 0.5 * (middle + spread.low);
        spread.high = 0.5 * (middle + spread.high);
    }
}

struct Change {
    std::string_view name;
    void (*make)(Problem&);
    std::string_view name_of_several = name;  ///< name where there are several goals
};

constexpr Change changes[] = {
    {"the goal 0.1 m lower", [](Problem& problem) { raise_goals(problem, -0.1); }, "all goals 0.1 m lower"},
    {"the goal 0.2 m lower", [](Problem& problem) { raise_goals(problem, -0.2); }, "all goals 0.2 m lower"},
    {"the goal 0.2 m higher", [](Problem& problem) { raise_goals(problem, 0.2); }, "all goals 0.2 m higher"},
    {"1.5 times the goal's tolerance", widen_tolerances, "1.5 times the tolerance of all goals"},
    {"0.1 m more margin", [](Problem& problem) { problem.planner.safety_margin_m += 0.1; }},
    {"half the speed", slow_down},
    {"a position loop that is 15 % faster", stiffen_law},
    {"all that is uncertain known twice as well", know_better},
};

Remedy tried(const Change& change, Problem problem, SolveOptions options) {
    Remedy remedy;
    remedy.change = goals_of(problem).size() == 1 ? change.name : change.name_of_several;
    change.make(problem);
    try {
        const Solution solution = solve(problem, options);
        remedy.helps = solution.certificate && solution.certificate->is_given;
        remedy.certificate = solution.certificate;
        if (solution.obstruction && solution.obstruction->cause == "closed_plane") {
            remedy.closed_by = solution.obstruction->obstacles;
        }
        remedy.stopped_by = solution.planning.stopped_by;
        remedy.cost = solution.cost;
        remedy.wall_s = solution.planning.wall_s;
    } catch (const InputError& error) {
        const KeyError& first = error.errors().front();
        remedy.error = first.key.empty() ? first.message : first.key + " " + first.message;
    }
    return remedy;
}

}  // namespace

std::vector<Remedy> try_remedies(const Problem& problem, const SolveOptions& options, double limit_s,
                                 const std::function<void(const Remedy&)>& on_tried) {
    constexpr double most_over_one_goal = 1.5;
    double left_s = most_over_one_goal * limit_s * static_cast<double>(std::size(changes));
    const double longest_s = limit_s * static_cast<double>(goals_of(problem).size());
    Problem limited = problem;
    SolveOptions until_first = options;
    until_first.stop_at_first_solution = true;
    until_first.keep_tree = false;
    std::vector<Remedy> remedies;
    for (const Change& change : changes) {
        if (options.stop.stop_requested()) {
            break;
        }
        const planning::Stopwatch clock;
        limited.planner.time_limit_s =
            std::min(longest_s, left_s / static_cast<double>(std::size(changes) - remedies.size()));
        remedies.push_back(tried(change, limited, until_first));
        left_s -= clock.seconds();
        if (on_tried) {
            on_tried(remedies.back());
        }
    }
    return remedies;
}

}  // namespace downwash

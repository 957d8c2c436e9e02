#include "downwash/problems/space_hover_warnings.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <variant>

#include "downwash/base/text.hpp"
#include "downwash/problems/space_goal_parameters.hpp"
#include "downwash/problems/space_problem_model.hpp"
#include "downwash/simulation/goal.hpp"
#include "downwash/simulation/space_goal_sampler.hpp"
#include "downwash/simulation/space_place.hpp"
#include "downwash/simulation/space_pool.hpp"
#include "downwash/simulation/space_world_parameters.hpp"

namespace downwash {
namespace {

constexpr std::uint64_t few_worlds = 64, many_worlds = 512;
constexpr double hover_s = 8;  ///< integral parts and the observer have settled

/// What a goal leaves to errors, so that goals alike are asked once.
struct Tolerances {
    using All = std::vector<double>;

    All operator()(const SpaceEndEffectorGoal& goal) const {
        return {0, goal.tolerance_m, goal.direction ? goal.direction_tolerance_rad : HUGE_VAL};
    }
    All operator()(const SpacePoseGoal& goal) const { return {1, goal.tolerance_m, goal.tolerance_rad}; }
    All operator()(const SpaceCameraGoal& goal) const {
        return {2, goal.farthest_m - goal.nearest_m, goal.farthest_m, goal.view_cone_rad, goal.aim_tolerance_rad};
    }
    All operator()(const SpaceConfigurationGoal& goal) const { return {3, goal.tolerance_m, goal.tolerance_rad}; }
    All operator()(const SpaceContactGoal& /*goal*/) const { return {}; }
};

/// Hovers of one vehicle in the worlds of a problem.
class HoversInWorlds {
 public:
    explicit HoversInWorlds(const SpaceProblem& problem)
        : problem_(problem),
          scene_(std::make_shared<const Scene>(problem.obstacles)),
          checker_(scene_, shape_of(problem.robot), problem.planner.collision_checker) {}

    /// Whether so many of some worlds miss are more than three times what is allowed, chance apart.
    [[nodiscard]] bool are_too_many(std::uint64_t misses, std::uint64_t worlds) const {
        const double allowed = problem_.planner.max_failure_probability * static_cast<double>(worlds);
        return static_cast<double>(misses) > 3 * allowed + 3;
    }

    /// In how many of the first worlds the vehicle misses a goal while it hovers there; nothing without a place.
    [[nodiscard]] std::optional<std::uint64_t> misses(const SpaceGoal& goal, std::uint64_t worlds) const {
        const SpaceGoalSampler sampler(problem_.robot, problem_.bounds, scene_, checker_,
                                       problem_.planner.safety_margin_m, goal);
        Random random(1);
        const std::optional<SpaceGoalPlace> place = sampler.sample(random, 0).place;
        if (!place) {
            return std::nullopt;
        }
        const SpaceGoalRule rule(problem_.robot, scene_, {goal});
        SpacePoolSetup setup{problem_.robot};
        setup.goal = &rule;
        SpacePool pool(setup);
        const double tick_s = 1 / problem_.robot.controller.rate_hz;
        const SpacePoint here = at_rest(place->at);
        const SpaceSegment hover(here, here, std::llround(hover_s / tick_s), tick_s);
        std::vector<SpaceWorld> drawn;
        for (std::uint64_t i = 1; i <= worlds; ++i) {
            drawn.push_back(draw_space_world(*problem_.uncertainty, problem_.robot, problem_.planner.seed, i));
        }
        std::vector<SpaceFlightJob> jobs;
        for (const SpaceWorld& world : drawn) {
            jobs.push_back({pool.state_at(resting_at(place->at), &world), {{hover}}, &world});
            jobs.back().judged_ticks = std::llround(goal_settling_s / tick_s);
        }
        pool.fly(jobs);
        return static_cast<std::uint64_t>(std::count_if(jobs.begin(), jobs.end(), [](const SpaceFlightJob& job) {
            return job.rejection() == Rejection::goal_missed;
        }));
    }

 private:
    const SpaceProblem& problem_;
    std::shared_ptr<const Scene> scene_;
    SpaceChecker checker_;
};

}  // namespace

std::vector<KeyError> space_hover_warnings(const SpaceProblem& problem) {
    std::vector<KeyError> warnings;
    if (!problem.uncertainty || !problem.planner.certify || problem.robot.joints() > max_joints) {
        return warnings;
    }
    const HoversInWorlds hovers(problem);
    std::set<std::vector<double>> asked;
    for_each_goal(problem, [&](const SpaceGoal& goal, const std::string& key) {
        std::vector<double> tolerances = std::visit(Tolerances{}, goal.kind);
        if (tolerances.empty() || !asked.insert(std::move(tolerances)).second) {
            return;
        }
        std::optional<std::uint64_t> misses = hovers.misses(goal, few_worlds);
        if (!misses || *misses < 3) {
            return;
        }
        misses = hovers.misses(goal, many_worlds);
        if (hovers.are_too_many(*misses, many_worlds)) {
            warnings.push_back(
                {key, "is missed in " + std::to_string(*misses) + " of " + std::to_string(many_worlds) +
                          " worlds by a vehicle that hovers in its middle in free air, so hardly any plan gets a "
                          "certificate (planner.max_failure_probability: " +
                          to_text(problem.planner.max_failure_probability, 3) +
                          "); widen its tolerances, or lessen the uncertainty"});
        }
    });
    return warnings;
}

}  // namespace downwash

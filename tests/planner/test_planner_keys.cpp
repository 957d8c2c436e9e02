#include <catch2/catch.hpp>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "../support/same_bytes.hpp"
#include "../support/test_problem.hpp"
#include "downwash/planner/solve.hpp"
#include "downwash/problems/algorithms.hpp"
#include "downwash/problems/problem_parameters.hpp"
#include "downwash/problems/problem_reader.hpp"

// No planner key is silently ignored, whatever the variant and the algorithm.

using namespace downwash;

namespace {

/// What a search did, as far as settings may change it.
bool is_same(const Solution& a, const Solution& b) {
    const auto plan_of = [](const Solution& s) { return s.plan.value_or(Plan{}); };
    const auto improvements = [](const Solution& s) {
        std::vector<std::pair<double, bool>> found;
        for (const Improvement& each : s.planning.improvements) {
            found.emplace_back(each.cost, each.flown_cost.has_value());
        }
        return found;
    };
    const auto certificate = [](const Solution& s) {
        const Certificate c = s.certificate.value_or(Certificate{});
        return std::tuple(s.certificate.has_value(), c.worlds, c.failures, c.failure_probability.high);
    };
    return a.status == b.status && a.cost == b.cost && a.execution_cost == b.execution_cost &&
           a.planning.iterations == b.planning.iterations && a.planning.states_checked == b.planning.states_checked &&
           a.planning.simulated_s == b.planning.simulated_s && improvements(a) == improvements(b) &&
           a.planning.candidates.checked == b.planning.candidates.checked && certificate(a) == certificate(b) &&
           a.plan.has_value() == b.plan.has_value() && test::same_bytes(plan_of(a), plan_of(b));
}

/// Another value than the default of every key that all algorithms have.
const std::map<std::string, std::string, std::less<>> other_values{
    {"planner.objective", "time"},
    {"planner.max_iterations", "1"},
    {"planner.seed", "5"},
    {"planner.safety_margin_m", "0.1"},
    {"planner.max_saturation", "3"},
    {"planner.max_pitch_rate_deg_s", "3"},
    {"planner.worlds", "2"},
    {"planner.certify", "false"},
    {"planner.check_execution", "false"},
    {"planner.max_failure_probability", "0.15"},
    {"planner.confidence", "0.6"},
};

Problem asked(Variant variant, std::string_view algorithm) {
    Problem problem = test::uncertain_problem();
    problem.start = Start::resting_at({1.6, 3.2, -test::quarter_turn});  // from where every algorithm finds a plan soon
    problem.planner.variant = variant;
    problem.planner.algorithm = algorithm;
    problem.planner.worlds = plans_flights(variant) ? 3 : PlannerSettings{}.worlds;
    problem.planner.max_failure_probability = 0.3;
    problem.planner.max_iterations = algorithm == "rrt-star" ? 40 : 600;
    return problem;
}

/// The same with a joint that can hardly carry the arm, so that some flights ask it for more.
Problem with_weak_joint(Problem problem) {
    const ArmParameters& arm = problem.robot.arm;
    problem.robot.arm.max_torque_nm = 1.02 * arm.mass_kg * standard_gravity_m_s2 * arm.center_of_mass_m;
    problem.planner.max_iterations = 150;
    return problem;
}

}  // namespace

TEST_CASE("every planner key changes something with every algorithm, or is refused") {
    for (const Variant variant : {Variant::mp_arm, Variant::mp_arm_ada}) {  // which have all algorithms
        for (const AlgorithmInfo& algorithm : algorithms()) {
            if (!algorithm.plans_for(variant)) {
                continue;
            }
            const Problem usual = asked(variant, algorithm.name);
            const Solution of_usual = solve(usual);
            const Problem weak = with_weak_joint(usual);
            const Solution of_weak = solve(weak);
            for (const auto& [key, value] : other_values) {
                CAPTURE(name_of(variant), algorithm.name, key);
                const bool is_about_demand = key == "planner.max_saturation";
                Problem changed = is_about_demand ? weak : usual;
                set_parameter(changed, key, value);
                std::optional<Solution> after;
                try {
                    after = solve(changed);
                } catch (const InputError& error) {
                    CHECK(error.errors().front().key == key);
                    CHECK(!plans_flights(variant));
                }
                CHECK_FALSE((after && is_same(is_about_demand ? of_weak : of_usual, *after)));
            }
        }
    }
}

TEST_CASE("every planner key that all algorithms have is among those that are tried") {
    std::vector<std::string> untried;
    for (const Parameter<Problem>& info : problem_parameters().rows()) {
        const bool is_tried = other_values.contains(info.path);
        const bool is_of_planner = info.path.starts_with("planner.") && info.kind != ParameterKind::group;
        const bool is_of_algorithm = info.path.starts_with("planner.parameters");
        const bool is_choice_of_algorithm = info.path == "planner.variant" || info.path == "planner.algorithm";
        const bool is_of_scene = info.path == "planner.collision_checker";  // test_collision_checkers.cpp
        const bool is_wall_time = info.path == "planner.time_limit_s";  // every search asks the clock: test_solve.cpp
        const bool is_weight = info.path.starts_with("planner.objective.");
        if (is_of_planner && !is_tried && !is_of_algorithm && !is_choice_of_algorithm && !is_wall_time && !is_weight &&
            !is_of_scene) {
            untried.push_back(info.path);
        }
    }
    CHECK(untried == std::vector<std::string>{});
}

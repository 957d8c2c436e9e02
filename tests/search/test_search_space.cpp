#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <optional>
#include <vector>

#include "../support/random.hpp"
#include "../support/test_problem.hpp"
#include "downwash/planner/solve.hpp"
#include "downwash/search/free_air_cost.hpp"
#include "downwash/search/search_space.hpp"

using namespace downwash;

namespace {

constexpr double pi = 3.141592653589793;

struct Fixture {
    explicit Fixture(Problem given) : problem(std::move(given)) {}

    Problem problem;
    std::shared_ptr<const FlightModel> model = make_flight_model(problem);
    planning::SearchSpace space{problem, *model};
};

Problem with_configuration_goal() {
    Problem problem = test::with_place(2, 3);
    test::configuration(problem.goal).tolerance_m = 0.5;
    return problem;
}

}  // namespace

TEST_CASE(
    "moved into the goal's middle the arm keeps its angle, into its tolerance a configuration stays as near as it "
    "allows") {
    const Fixture f(test::ceiling_problem());  // the tip to (3, 4.8), an arm of 1.2 m
    const Configuration up = f.space.moved_into_goal({1, 1, -pi / 2}, 0);
    CHECK(up[plane::x] == Approx(3));
    CHECK(up[plane::z] == Approx(3.6));
    CHECK(up[plane::arm] == -pi / 2);
    const Configuration forward = f.space.moved_into_goal({1, 1, 0}, 0);
    CHECK(forward[plane::x] == Approx(1.8));
    CHECK(forward[plane::z] == Approx(4.8));
    const Fixture wide(with_configuration_goal());  // (2, 3) within 0.5 m, any arm
    const Configuration c = wide.space.moved_into_goal({2, 7, 1.25}, 0.5);
    CHECK(c[plane::x] == Approx(2));
    CHECK(c[plane::z] == Approx(3.25));
    CHECK(c[plane::arm] == 1.25);
    const Configuration inside = wide.space.moved_into_goal({2.1, 3.1, 1.25}, 0.5);
    CHECK(inside[plane::x] == Approx(2.1));
    CHECK(inside[plane::z] == Approx(3.1));
}

TEST_CASE("an arm that does not move is at its angle in every sample, and distances are those of the vehicle") {
    Problem problem = with_configuration_goal();
    problem.robot.arm.is_limited = true;
    problem.robot.arm.lower_limit_rad = problem.robot.arm.upper_limit_rad = problem.start.at[plane::arm];
    const Fixture f(problem);
    planning::Random random(3);
    for (int i = 0; i < 100; ++i) {
        const Configuration any = f.space.sample(random);
        const Configuration near = f.space.sample_near(any, 1, random);
        const std::optional<Configuration> goal = f.space.sample_goal(random);
        REQUIRE(goal);
        for (const Configuration& c : {any, near, *goal, f.space.steered(any, *goal, 0.5)}) {
            CHECK(c[plane::arm] == Approx(problem.start.at[plane::arm]).margin(1e-12));
        }
        CHECK(f.space.distance_m(any, near) ==
              Approx(std::hypot(any[plane::x] - near[plane::x], any[plane::z] - near[plane::z])));
        CHECK(f.space.is_near_goal(*goal));
    }
    Configuration turned = problem.start.at;
    turned[plane::arm] += 1e-3;
    CHECK(f.space.rejection_at(problem.start.at) == Rejection::none);
    CHECK(f.space.rejection_at(turned) == Rejection::arm_limits);
}

TEST_CASE("an arm that turns more than once reaches a direction by the shorter turn") {
    Problem problem = test::ceiling_problem();
    test::limit_arm(problem.robot, -200 * pi / 180, 300 * pi / 180);
    test::end_effector(problem.goal).direction_rad = 250 * pi / 180;
    const Fixture f(problem);
    const double once = 250 * pi / 180, before = -110 * pi / 180;
    CHECK(f.space.moved_into_goal({0, 2, 280 * pi / 180}, 0)[plane::arm] == Approx(once));
    CHECK(f.space.moved_into_goal({0, 2, -150 * pi / 180}, 0)[plane::arm] == Approx(before));
    planning::Random random(1);
    int high = 0, low = 0;
    for (int i = 0; i < 200; ++i) {
        if (const auto c = f.space.sample_goal(random)) {
            CHECK(f.space.is_inside(*c));
            ++((*c)[plane::arm] > 0 ? high : low);
        }
    }
    CHECK(high > 20);
    CHECK(low > 20);
}

TEST_CASE("the wanted direction of the arm is taken on to within the tolerance") {
    Problem problem = test::ceiling_problem();
    test::end_effector(problem.goal).direction_rad = -pi / 2;
    test::end_effector(problem.goal).direction_tolerance_rad = 0.2;
    const Fixture f(problem);
    CHECK(f.space.moved_into_goal({0, 2, 0}, 0)[plane::arm] == Approx(-pi / 2));
    CHECK(f.space.moved_into_goal({0, 2, 0}, 1)[plane::arm] == Approx(-pi / 2 + 0.2));
    CHECK(f.space.moved_into_goal({0, 2, pi}, 1)[plane::arm] == Approx(-pi / 2 - 0.2));
    CHECK(f.space.moved_into_goal({0, 2, -1.6}, 1)[plane::arm] == Approx(-1.6));
}

namespace {

Goal random_goal(planning::Random& random) {
    const auto some = [&](double low, double high) {
        return random.chance(0.5) ? std::optional(random.uniform(low, high)) : std::nullopt;
    };
    Goal goal;
    if (random.chance(0.5)) {
        EndEffectorGoal& tip = goal.kind.emplace<EndEffectorGoal>();
        tip.x_m = random.uniform(-3, 3);
        tip.z_m = random.uniform(2, 4);
        tip.tolerance_m = random.uniform(0.01, 0.5);
        tip.tolerance_x_m = some(0.01, 1);
        tip.tolerance_z_m = some(0.01, 1);
        tip.direction_rad = some(-pi, pi);
        return goal;
    }
    ConfigurationGoal& pose = goal.kind.emplace<ConfigurationGoal>();
    pose.x_m = some(-3, 3);
    pose.z_m = some(2, 4);
    pose.arm_rad = pose.x_m || pose.z_m ? some(-pi, pi) : random.uniform(-pi, pi);
    pose.tolerance_m = random.uniform(0.01, 0.5);
    pose.tolerance_x_m = pose.x_m ? some(0.01, 1) : std::nullopt;
    pose.tolerance_z_m = pose.z_m ? some(0.01, 1) : std::nullopt;
    return goal;
}

/// The rules of the documentation once more, in other words: within (times a share) the tolerances or not.
bool lies_within(const Goal& goal, const Configuration& c, double share) {
    const auto is_within = [share](const auto& to, double dx, double dz, double turn, double turn_tolerance_rad) {
        if (std::abs(std::remainder(turn, 2 * pi)) > share * turn_tolerance_rad) {
            return false;
        }
        if (!to.tolerance_x_m && !to.tolerance_z_m) {
            return dx * dx + dz * dz <= share * share * to.tolerance_m * to.tolerance_m;
        }
        return std::abs(dx) <= share * to.tolerance_x_m.value_or(to.tolerance_m) &&
               std::abs(dz) <= share * to.tolerance_z_m.value_or(to.tolerance_m);
    };
    if (const auto* tip = std::get_if<EndEffectorGoal>(&goal.kind)) {
        return is_within(*tip, c[plane::x] + 1.2 * std::cos(c[plane::arm]) - tip->x_m,
                         c[plane::z] - 1.2 * std::sin(c[plane::arm]) - tip->z_m,
                         c[plane::arm] - tip->direction_rad.value_or(c[plane::arm]), tip->direction_tolerance_rad);
    }
    const ConfigurationGoal& pose = test::configuration(goal);
    return is_within(pose, c[plane::x] - pose.x_m.value_or(c[plane::x]), c[plane::z] - pose.z_m.value_or(c[plane::z]),
                     c[plane::arm] - pose.arm_rad.value_or(c[plane::arm]), pose.tolerance_rad);
}

}  // namespace

TEST_CASE("samples, distances and verdicts agree on where a goal is, whatever its tolerances") {
    planning::Random random(11);
    int samples = 0;
    int near = 0;
    int met = 0;
    for (int k = 0; k < 300; ++k) {
        Problem problem = test::ceiling_problem();
        std::vector<Goal> goals{random_goal(random)};
        problem.goal = goals[0];
        if (random.chance(0.3)) {
            goals.push_back(random_goal(random));
            problem.goal = {};
            problem.goal.any_of = goals;
        }
        const Fixture f(problem);
        const auto is_within = [&](const Configuration& c, double share) {
            return std::any_of(goals.begin(), goals.end(), [&](const Goal& g) { return lies_within(g, c, share); });
        };
        for (int i = 0; i < 10; ++i) {
            const auto sample = f.space.sample_goal(random);
            if (!sample) {
                continue;
            }
            ++samples;
            CHECK(f.space.is_near_goal(*sample));
            CHECK(is_within(*sample, usable_tolerance_share + 1e-6));
            CHECK(f.space.goal_distance_m(*sample) == 0);
            // Beside it the verdicts are those of the documentation, up to the rim.
            const Configuration beside = f.space.sample_near(*sample, 0.6, random);
            if (is_within(beside, 0.899) == is_within(beside, 0.901)) {
                CHECK(f.space.is_near_goal(beside) == is_within(beside, usable_tolerance_share));
                near += f.space.is_near_goal(beside) ? 1 : 0;
            }
            if (is_within(beside, 0.999) == is_within(beside, 1.001)) {
                CHECK(is_met(f.space.error(beside)) == is_within(beside, 1));
                met += is_met(f.space.error(beside)) ? 1 : 0;
            }
            CHECK((f.space.goal_distance_m(beside) == 0) == f.space.is_near_goal(beside));
            CHECK(f.space.is_near_goal(f.space.moved_into_goal(beside, usable_tolerance_share)));
            CHECK(is_within(f.space.moved_into_goal(beside, 0), 1e-6));
        }
    }
    CHECK(samples > 1500);
    CHECK(near > 200);
    CHECK(met > near);
    CHECK(met < samples - 500);
}

TEST_CASE("samples of several goals come to all of them") {
    Problem problem = test::ceiling_problem();
    Goal left = problem.goal;
    test::end_effector(left).x_m = -3;
    problem.goal.any_of = {problem.goal, left};
    const Fixture f(problem);
    planning::Random random(5);
    int at_left = 0;
    for (int i = 0; i < 400; ++i) {
        const auto sample = f.space.sample_goal(random);
        REQUIRE(sample);
        at_left += lies_within(left, *sample, 1) ? 1 : 0;
        // Beside a place at one goal it stays with that goal.
        const auto beside = f.space.sample_goal_near(*sample, 0.2, random);
        CHECK((!beside || lies_within(left, *beside, 1) == lies_within(left, *sample, 1)));
    }
    CHECK(at_left > 150);
    CHECK(at_left < 250);
}

TEST_CASE("no motion is cheaper than the least that is said of it, however it is divided, nor a way to the goal") {
    for (const Objective objective : all_objectives) {
        CAPTURE(name_of(objective));
        Problem turned = with_configuration_goal();
        test::configuration(turned.goal).arm_rad = 1;
        for (Problem problem : {test::ceiling_problem(), with_configuration_goal(), turned}) {
            problem.planner.objective = objective;
            const Fixture f(problem);
            const planning::SearchTask task(f.problem, *f.model, nullptr);
            const planning::FreeAirCost cost(task);
            planning::Random random(5);
            const bool counts_every_way =
                objective == Objective::energy || objective == Objective::time || objective == Objective::length;
            double tightest = 0;
            for (int i = 0; i < 200; ++i) {
                const Configuration a = f.space.sample(random);
                const Configuration b = f.space.sample(random);
                const Configuration c = f.space.sample(random);
                const double least = cost.min_cost_of_motion(a, c);
                CHECK(least <= cost.of_motion(a, c) * (1 + 1e-12));
                CHECK(least <= (cost.of_motion(a, b) + cost.of_motion(b, c)) * (1 + 1e-12));
                CHECK(least <= cost.min_cost_of_motion(a, b) + cost.min_cost_of_motion(b, c) + 1e-9);
                const auto goal = f.space.sample_goal(random);
                REQUIRE(goal);
                const double way = cost.of_motion(a, *goal) + cost.of_hold(*goal, problem.goal.hold_s);
                CHECK(cost.min_cost_to_goal(a) <= way * (1 + 1e-12));
                tightest = std::max(tightest, cost.min_cost_to_goal(a) / way);
            }
            CHECK((!counts_every_way || tightest > 0.5));
        }
    }
}

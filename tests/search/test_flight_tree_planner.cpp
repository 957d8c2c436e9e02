#include <ompl/geometric/PathGeometric.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <utility>
#include <vector>

#include "../support/test_problem.hpp"
#include "downwash/planner/solve.hpp"
#include "downwash/search/flight_space.hpp"
#include "downwash/search/flight_tree_planner.hpp"
#include "downwash/search/quiet_ompl.hpp"

using namespace downwash;

namespace {

/// The ceiling problem with a wall under the ceiling, between start and goal: to be flown around below.
Problem with_wall() {
    Problem problem = test::ceiling_problem();
    problem.obstacles.push_back(test::box("wall", {0.3, 8, 2.5}, {0, 0, 4}));
    return problem;
}

/// The planner as somebody else's program uses it: all that the contract of ompl::base::Planner offers, nothing else.
struct AsPlanner {
    explicit AsPlanner(Problem given = test::ceiling_problem(), int threads = 1)
        : problem(std::move(given)), planner(ompl.information, task, threads) {
        planner.setProblemDefinition(ompl.definition);
    }
    /// After so many evaluations of its termination condition the search is over.
    ompl::base::PlannerStatus solve(int looks) {
        return planner.solve(ompl::base::PlannerTerminationCondition([&looks] { return --looks < 0; }));
    }
    [[nodiscard]] std::size_t vertices() const {
        ompl::base::PlannerData data(planner.getSpaceInformation());
        planner.getPlannerData(data);
        return data.numVertices();
    }

    Problem problem;
    std::shared_ptr<const FlightModel> model = make_flight_model(problem);
    std::shared_ptr<const AeroMap> map = model->make_map(problem.bounds);
    planning::SearchTask task{problem, *model, map.get()};
    planning::Random random{1};
    planning::OmplTask ompl{task, random};
    planning::FlightTreePlanner planner;
};

/// Searches a problem, asking `survives` about every better plan.
struct Search : AsPlanner {
    explicit Search(
        std::uint64_t iterations, std::function<bool(const planning::Candidate&)> survives = accept_all,
        Problem searched = test::ceiling_problem(), int threads = 1,
        const std::function<bool()>& is_over = [] { return false; })
        : AsPlanner(std::move(searched), threads) {
        planner.search().set_hooks({std::move(survives), {}});
        planner.search().set_max_iterations(iterations);
        static_cast<void>(planner.solve(::ompl::base::PlannerTerminationCondition(is_over)));
    }
    static bool accept_all(const planning::Candidate& /*candidate*/) { return true; }
    [[nodiscard]] const planning::FlightTree& tree() const { return planner.search().growth().tree(); }
};

}  // namespace

TEST_CASE("a rejected plan is counted and discarded, and the search goes on to another while there is one") {
    int asked = 0;
    const Search search(300, [&asked](const planning::Candidate&) { return ++asked > 3; });
    CHECK(asked > 3);
    CHECK(search.planner.search().statistics().rejected.at("direct_flight") == 3);
    REQUIRE(search.planner.search().best());
    CHECK(search.planner.search().iterations() == 300);
    const Search without(60, [](const planning::Candidate&) { return false; });
    CHECK(without.planner.search().statistics().rejected.at("direct_flight") > 1);
    CHECK_FALSE(without.planner.search().best());
}

TEST_CASE("what is rejected does not depend on threads, nor does what comes of it") {
    const auto asked_with = [](int threads) {
        std::vector<double> asked;
        const auto every_third = [&asked](const planning::Candidate& candidate) {
            asked.push_back(candidate.cost);
            return asked.size() % 3 == 0;
        };
        const Search search(1600, every_third, with_wall(), threads);
        REQUIRE(search.planner.search().best());
        asked.push_back(search.planner.search().best()->cost);
        asked.push_back(static_cast<double>(search.planner.search().statistics().ticks));
        return asked;
    };
    const std::vector<double> alone = asked_with(1);
    CHECK(alone.size() > 6);
    CHECK(asked_with(2) == alone);
    CHECK(asked_with(5) == alone);
}

TEST_CASE(
    "a plan found with the last iterations counts as well, and no plan of the tree is cheaper than the best plan") {
    int with_plan = 0;
    for (std::uint64_t iterations = 1; iterations <= 120; iterations += iterations < 40 ? 1 : 20) {
        CAPTURE(iterations);
        const Search search(iterations, Search::accept_all, with_wall());
        const auto& holds = search.tree().holds();
        REQUIRE(search.planner.search().best().has_value() == !holds.empty());
        with_plan += holds.empty() ? 0 : 1;
        for (const auto* hold : holds) {
            CHECK(search.planner.search().best()->cost <= hold->cost * (1 + 1e-6));
        }
    }
    CHECK(with_plan > 10);
    CHECK(with_plan < 44);  // there were searches without
}

TEST_CASE("a plan that was accepted stays, although cheaper ones are rejected") {
    int asked = 0;
    double accepted = 0;
    const auto only_the_first = [&](const planning::Candidate& candidate) {
        accepted = ++asked == 1 ? candidate.cost : accepted;
        return asked == 1;
    };
    const Search search(200, only_the_first);
    REQUIRE(asked > 1);
    REQUIRE(search.planner.search().best());
    CHECK(search.planner.search().best()->cost == accepted);
}

TEST_CASE("a search whose time is over flies a few plans more, not all that it found") {
    int asked = 0;
    int asked_in_time = 0;
    int looks = 0;
    const Search search(
        1'000'000,
        [&asked](const planning::Candidate&) {
            ++asked;
            return false;
        },
        test::ceiling_problem(), 1,
        [&] {
            const bool is_over = ++looks > 20000;  // flights ask too
            asked_in_time = is_over ? asked_in_time : asked;
            return is_over;
        });
    CHECK_FALSE(search.planner.search().best());
    CHECK(asked > asked_in_time);
    CHECK(asked - asked_in_time <= 5);  // one of them in the round that was under way
    const auto& holds = search.tree().holds();
    CHECK(std::count_if(holds.begin(), holds.end(), [](const auto* hold) { return !hold->is_discarded; }) > 5);
}

TEST_CASE("the tree can be read as OMPL's planner data") {
    const Search search(40);
    ompl::base::PlannerData data(search.planner.getSpaceInformation());
    search.planner.getPlannerData(data);
    CHECK(data.numVertices() == search.tree().size());
    CHECK(data.numEdges() == search.tree().size() - 1);
    CHECK(data.numStartVertices() == 1);
}

TEST_CASE("where nothing is in the way every flight begins at the start") {
    // Every edge ends at rest, so that a stop on a straight way costs time and energy: where no obstacle or surface
    // asks for a detour the start is the best parent of every node, but for flights that a bound stops.
    Problem open = test::ceiling_problem();
    open.obstacles.clear();
    const Search search(300, Search::accept_all, open);
    const auto& nodes = search.tree().nodes();
    const auto from_start = std::count_if(nodes.begin(), nodes.end(), [&](const planning::FlightNode* node) {
        return node->parent == nodes.front() || node == nodes.front();
    });
    REQUIRE(nodes.size() > 30);
    CHECK(10 * from_start >= static_cast<std::ptrdiff_t>(9 * nodes.size()));
}

TEST_CASE("a solution is handed to the problem definition with its cost, every moment of it on the way") {
    AsPlanner search;
    REQUIRE(search.solve(3000) == ompl::base::PlannerStatus::EXACT_SOLUTION);
    REQUIRE(search.ompl.definition->hasExactSolution());
    auto* path = search.ompl.definition->getSolutionPath()->as<ompl::geometric::PathGeometric>();
    REQUIRE(path->getStateCount() >= 3);
    CHECK(planning::is_same_moment(planning::point_of(path->getState(0)), planning::start_point(search.task)));
    CHECK(path->cost(search.ompl.definition->getOptimizationObjective()).value() ==
          Approx(search.planner.search().best()->cost).epsilon(1e-12));
    CHECK(search.ompl.definition->getGoal()->isSatisfied(path->getStates().back()));
    CHECK(path->check());
    std::vector<planning::FlightPoint> moments;
    for (const ompl::base::State* state : path->getStates()) {
        moments.push_back(planning::point_of(state));
    }
    CHECK_NOTHROW(planning::PlannedFlights(search.task).verify(moments));
}

TEST_CASE("a search that is over before it found a plan says how near it came") {
    AsPlanner search(with_wall());
    REQUIRE(search.solve(6) == ompl::base::PlannerStatus::APPROXIMATE_SOLUTION);
    CHECK_FALSE(search.ompl.definition->hasExactSolution());
    CHECK(search.ompl.definition->hasApproximateSolution());
    CHECK(search.ompl.definition->getSolutionDifference() == search.planner.search().growth().nearest_distance_m());
}

TEST_CASE("a search that is resumed keeps its tree and its best plan") {
    AsPlanner search;
    REQUIRE(search.solve(2000) == ompl::base::PlannerStatus::EXACT_SOLUTION);
    const double cost = search.planner.search().best()->cost;
    const std::size_t vertices = search.vertices();
    const std::uint64_t iterations = search.planner.search().iterations();
    REQUIRE(search.solve(4000) == ompl::base::PlannerStatus::EXACT_SOLUTION);
    CHECK(search.planner.search().best()->cost < cost);
    CHECK(search.vertices() > vertices);
    CHECK(search.planner.search().iterations() > iterations);
}

TEST_CASE("after clear() a planner does again what it did the first time") {
    AsPlanner search;
    search.planner.search().set_max_iterations(200);
    const auto run = [&search] {
        search.planner.solve(ompl::base::plannerNonTerminatingCondition());
        return std::vector<double>{search.planner.search().best()->cost, static_cast<double>(search.vertices()),
                                   static_cast<double>(search.planner.search().statistics().ticks)};
    };
    const std::vector<double> first = run();
    search.planner.clear();
    CHECK(search.vertices() == 0);
    CHECK_FALSE(search.planner.search().best());
    CHECK(search.planner.search().statistics().ticks == 0);
    search.ompl.definition->clearSolutionPaths();
    CHECK(run() == first);
}

namespace {

/// A goal that gives no samples.
class Unsampled : public ompl::base::Goal {
 public:
    using Goal::Goal;
    bool isSatisfied(const ompl::base::State*) const override { return false; }
};

}  // namespace

TEST_CASE("a definition without the task's start or goal is no problem for this planner") {
    AsPlanner search;
    const planning::QuietOmpl quiet;
    SECTION("a goal of another kind") {
        search.ompl.definition->setGoal(std::make_shared<Unsampled>(search.ompl.information));
        CHECK(search.solve(100) == ompl::base::PlannerStatus::UNRECOGNIZED_GOAL_TYPE);
    }
    SECTION("the goal of another task") {
        AsPlanner other;
        search.ompl.definition->setGoal(other.ompl.definition->getGoal());
        CHECK(search.solve(100) == ompl::base::PlannerStatus::UNRECOGNIZED_GOAL_TYPE);
    }
    SECTION("no valid start") {
        planning::point_of(search.ompl.definition->getStartState(0)).is_valid = false;
        CHECK(search.solve(100) == ompl::base::PlannerStatus::INVALID_START);
    }
}

TEST_CASE("the planner's parameters are those of the algorithm, can be set, and are checked by setup()") {
    Problem problem = test::ceiling_problem();
    problem.planner.parameters["goal_bias"] = 0.25;
    AsPlanner search(problem);
    std::map<std::string, std::string> values;
    search.planner.params().getParams(values);
    const auto known = algorithm_parameters(problem.planner);
    REQUIRE(values.size() == known.size());
    for (const AlgorithmParameter& parameter : known) {
        CAPTURE(parameter.name);
        const double expected = parameter.name == "goal_bias" ? 0.25 : parameter.value;
        CHECK(std::stod(values.at(std::string(parameter.name))) == Approx(expected));
    }
    search.planner.params().setParam("batch_size", "0");
    CHECK_THROWS_WITH(search.planner.setup(), Catch::Contains("batch_size is 0: expected a number from 1"));
    search.planner.params().setParam("batch_size", "8");
    CHECK_NOTHROW(search.planner.setup());
}

TEST_CASE("a parameter changes the search, and its default does not") {
    const auto ticks_with = [](std::map<std::string, double, std::less<>> parameters) {
        Problem problem = test::ceiling_problem();
        problem.planner.parameters = std::move(parameters);
        AsPlanner search(problem);
        search.planner.search().set_max_iterations(150);
        search.planner.solve(ompl::base::plannerNonTerminatingCondition());
        return search.planner.search().statistics().ticks;
    };
    const std::uint64_t usual = ticks_with({});
    CHECK(ticks_with({{"batch_size", 32}, {"optimism", 0.9}}) == usual);
    CHECK(ticks_with({{"batch_size", 8}}) != usual);
    CHECK(ticks_with({{"first_goal_bias", 0.1}}) != usual);
}

// OMPL's own planners and benchmark on the closed-loop flights of Downwash, with our planner beside them.
// Usage: flights_with_ompl PROBLEM.yaml [seconds per search, default 2] [runs, default 3]

#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <memory>

#include <ompl/control/planners/kpiece/KPIECE1.h>
#include <ompl/control/planners/rrt/RRT.h>
#include <ompl/tools/benchmark/Benchmark.h>
#include <ompl/util/Console.h>
#include <ompl/util/RandomNumbers.h>

#include <downwash/ompl/flight_setup.hpp>
#include <downwash/problems/problem_model.hpp>
#include <downwash/problems/problem_reader.hpp>
#include <downwash/simulation/execution.hpp>

namespace {

/// Flies a plan in worlds that no search has seen, and prints in how many of them it fails.
void print_certificate(downwash::FlightSetup& flights, const downwash::Plan& plan) {
    const downwash::Certificate certificate = flights.certify(plan);
    std::printf("%-12s certificate %s: %zu of %zu worlds fail\n", "", certificate.is_given ? "given" : "not given",
                static_cast<std::size_t>(certificate.failures), static_cast<std::size_t>(certificate.worlds));
}

/// Solves once with a planner, executes the plan with direct aerodynamics, and prints what came of it.
bool plan_and_execute(downwash::FlightSetup& flights, const ompl::base::PlannerPtr& planner, double limit_s) {
    const ompl::control::SimpleSetupPtr& setup = flights.simple_setup();
    setup->clear();
    setup->setPlanner(planner);
    setup->solve(limit_s);
    if (!setup->haveExactSolutionPath()) {
        std::printf("%-12s found no plan in %.1f s\n", planner->getName().c_str(), limit_s);
        return false;
    }
    const auto plan = flights.plan_of(*setup->getProblemDefinition()->getSolutionPath());
    if (!plan) {
        std::printf("%-12s found a plan that does not close\n", planner->getName().c_str());
        return false;
    }
    const downwash::Problem& problem = flights.problem();
    const downwash::Execution execution =
        downwash::execute(flights.model(), downwash::start_state(flights.model(), problem.start), plan->reference,
                          downwash::goals_of(problem), true);
    std::printf("%-12s %6.1f s %8.0f J  %s\n", planner->getName().c_str(), execution.duration_s, execution.energy_j,
                execution.outcome == downwash::Outcome::ok ? "holds at the goal" : "failed when executed");
    if (problem.uncertainty) {
        print_certificate(flights, *plan);
    }
    return execution.outcome == downwash::Outcome::ok;
}

}  // namespace

int main(int count, char** words) {
    if (count < 2) {
        std::fprintf(stderr, "usage: %s PROBLEM.yaml [seconds] [runs]\n", words[0]);
        return 2;
    }
    const double limit_s = count > 2 ? std::atof(words[2]) : 2;
    const unsigned int runs = count > 3 ? static_cast<unsigned int>(std::atoi(words[3])) : 3;
    ompl::msg::setLogLevel(ompl::msg::LOG_WARN);
    ompl::RNG::setSeed(1);  // of OMPL's planners; the samplers' numbers come from the problem's seed

    downwash::Problem problem = downwash::read_problem(words[1]);
    problem.planner.certify = false;  // our planner would ask for certificates while it searches, OMPL's do not
    const auto map = downwash::make_flight_model(problem)->make_map(problem.bounds);
    downwash::FlightSetup flights(problem, map);
    const auto information = flights.simple_setup()->getSpaceInformation();

    plan_and_execute(flights, std::make_shared<ompl::control::RRT>(information), limit_s);
    const bool is_good = plan_and_execute(flights, flights.make_flight_tree_planner(), limit_s);

    flights.simple_setup()->clear();
    ompl::tools::Benchmark benchmark(*flights.simple_setup(), problem.name);
    benchmark.addPlanner(std::make_shared<ompl::control::RRT>(information));
    benchmark.addPlanner(std::make_shared<ompl::control::KPIECE1>(information));
    benchmark.addPlanner(flights.make_flight_tree_planner());
    ompl::tools::Benchmark::Request request(limit_s, 4096, runs);
    request.displayProgress = false;
    benchmark.benchmark(request);
    std::printf("\n%-20s %s\n", "planner", "solved");
    for (const auto& planner : benchmark.getRecordedExperimentData().planners) {
        unsigned int solved = 0;
        for (const auto& run : planner.runs) {
            const bool is_exact = run.at("solved BOOLEAN") == "1" && run.at("approximate solution BOOLEAN") == "0";
            solved += is_exact ? 1 : 0;
        }
        std::printf("%-20s %u of %zu\n", planner.name.c_str(), solved, planner.runs.size());
    }
    benchmark.saveResultsToFile("flights.log");
    return is_good ? 0 : 1;
}

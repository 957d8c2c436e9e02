// The time of a query for the nearest nodes of a tree: our scan, OMPL's linear scan and OMPL's GNAT. Prints Markdown.

#include <fmt/core.h>
#include <ompl/datastructures/NearestNeighborsLinear.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "../support/measuring.hpp"
#include "downwash/bench/machine.hpp"
#include "downwash/problems/problem_model.hpp"
#include "downwash/problems/problem_reader.hpp"
#include "downwash/search/nearest_places.hpp"

using namespace downwash;

namespace {

constexpr std::size_t scans = 1'000'000'000;  ///< more places than there are: no index

struct Queries {
    std::vector<Configuration> at;
    std::size_t count;  ///< neighbours that each asks for, as the tree does

    /// Processor time of one query [us]. @param ask answers one, and gives some number of the answer
    template <class Ask>
    [[nodiscard]] double time_us(const Ask& ask) const {
        const double all_s = bench::best_of(5, [&] {
            double sum = 0;
            for (const Configuration& place : at) {
                sum += static_cast<double>(ask(place));
            }
            bench::keep(sum);
        });
        return 1e6 * all_s / static_cast<double>(at.size());
    }
};

void run(const std::string& file) {
    const Problem problem = read_problem(file);
    const auto model = make_flight_model(problem);
    const planning::SearchSpace space(problem, *model);
    fmt::print(
        "# Nearest neighbours\n\nCommit {}; {}; places drawn all over {}. Processor time of a query for as many "
        "neighbours as the tree asks for at that size, best of 5 rounds. Our scan and OMPL's GNAT are those of "
        "`planner/search/nearest_places.hpp`, which goes over to GNAT at {} nodes. `bench/nearest_places.sh` writes "
        "this page.\n\n| nodes | neighbours | our scan | OMPL, linear | OMPL, GNAT |\n| --: | --: | --: | --: | --: "
        "|\n",
        bench::source_commit(), bench::processor(), problem.name, planning::NearestPlaces::default_indexed_from);
    for (const std::size_t nodes : {300U, 1000U, 3000U, 10000U, 20000U, 30000U, 100000U}) {
        planning::Random random(nodes);
        planning::NearestPlaces scan(space, scans);
        planning::NearestPlaces gnat(space, 1);
        ompl::NearestNeighborsLinear<const Configuration*> linear;
        linear.setDistanceFunction(
            [&space](const Configuration* a, const Configuration* b) { return space.distance_m(*a, *b); });
        std::vector<Configuration> places;
        for (std::size_t i = 0; i < nodes; ++i) {
            places.push_back(space.sample(random));
        }
        for (const Configuration& place : places) {
            scan.add(place);
            gnat.add(place);
            linear.add(&place);
        }
        // As RRT* asks: k > e (1 + 1/d) log n.
        Queries queries;
        queries.count = static_cast<std::size_t>(
            std::ceil(std::numbers::e * (1 + 1.0 / 3) * std::log(static_cast<double>(nodes + 1))));
        for (int i = 0; i < 200; ++i) {
            queries.at.push_back(space.sample(random));
        }
        std::vector<const Configuration*> found;
        const double scan_us =
            queries.time_us([&](const Configuration& to) { return scan.nearest(to, queries.count).front(); });
        const double gnat_us =
            queries.time_us([&](const Configuration& to) { return gnat.nearest(to, queries.count).front(); });
        const double linear_us = queries.time_us([&](const Configuration& to) {
            linear.nearestK(&to, queries.count, found);
            return found.size();
        });
        fmt::print("| {} | {} | {:.1f} us | {:.1f} us | {:.1f} us |\n", nodes, queries.count, scan_us, linear_us,
                   gnat_us);
    }
}

}  // namespace

int main(int argc, char** argv) {
    std::string problem;
    CLI::App program("The time of queries for nearest neighbours, as Markdown");
    program.add_option("PROBLEM", problem, "problem file")->required();
    return bench::run_program(program, argc, argv, [&problem] { run(problem); });
}

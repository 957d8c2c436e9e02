// What the legs between the targets of a problem in space cost, each planned as a problem of its own. Prints a table of
// numbers: a row for each target and one for the start, and in it a column for each target and one for the place to
// return to; `inf` where no flight was found, `nan` where there is no leg.

#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "../support/measuring.hpp"
#include "downwash/base/parallel.hpp"
#include "downwash/planner/space_solve.hpp"
#include "downwash/problems/space_problem_reader.hpp"

using namespace downwash;
using namespace downwash::bench;

namespace {

struct Options {
    std::string problem;
    std::uint64_t iterations = 60;
    unsigned searches = 2;
    int jobs = 2;
};

/// Plans legs in the nominal world.
class Legs {
 public:
    explicit Legs(const Options& options) : options_(options), problem_(read_space_problem(options.problem)) {
        problem_.in_any_order = false;
        problem_.energy_budget_j.reset();
        problem_.uncertainty.reset();
        problem_.planner.time_limit_s.reset();
        problem_.planner.max_iterations = options.iterations;
        ends_ = problem_.goals;
        targets_ = ends_.size();
        if (problem_.return_to) {
            ends_.push_back(*problem_.return_to);
            problem_.return_to.reset();
        }
        problem_.goals.resize(1);
        how_.map = make_volumes(SpaceProblemModel(problem_));
    }

    /// The costs of a table, with nan on its diagonal.
    [[nodiscard]] std::vector<std::vector<double>> costs() const {
        std::vector<SpaceStart> starts(ends_.size(), problem_.start);
        std::vector<std::vector<double>> rows(targets_ + 1, std::vector<double>(ends_.size(), std::nan("")));
        run_parallel(ends_.size(), options_.jobs,
                     [&](std::size_t to) { rows.back()[to] = cost(problem_.start, to, &starts[to]); });
        run_parallel(targets_, options_.jobs, [&](std::size_t from) {
            for (std::size_t to = 0; to < ends_.size(); ++to) {
                if (to != from) {
                    rows[from][to] = cost(starts[from], to, nullptr);
                }
            }
            fmt::print(stderr, "legs from {} of {}\n", from + 1, targets_);
        });
        return rows;
    }

 private:
    /// The cheapest flight of some searches, or of more where these find none.
    /// @param[out] end the vehicle at its end
    [[nodiscard]] double cost(const SpaceStart& start, std::size_t to, SpaceStart* end) const {
        SpaceProblem leg = problem_;
        leg.start = start;
        leg.goals.front() = ends_[to];
        double least = std::numeric_limits<double>::infinity();
        for (unsigned seed = 1; seed <= (std::isinf(least) ? 5 : 1) * options_.searches; ++seed) {
            leg.planner.seed = seed;
            const SpaceSearchResult found = solve(std::make_shared<const SpaceProblemModel>(leg), how_);
            if (found.status != Status::solved) {
                continue;
            }
            const double executed = cost_of(*found.execution, problem_.planner.objective);
            if (executed >= least) {
                continue;
            }
            least = executed;
            if (end != nullptr) {
                const SpacePoint& at = found.plan->reference.back().point;
                end->position_m = {at.position[0], at.position[1], at.position[2]};
                end->yaw_rad = at.position[space::yaw];
                for (std::size_t i = 0; i < end->joints_rad.size(); ++i) {
                    end->joints_rad[i] = at.position[space::first_joint + i];
                }
            }
        }
        return least;
    }

    Options options_;
    SpaceProblem problem_;
    std::vector<SpaceGoal> ends_;  ///< the targets, and the place to return to
    std::size_t targets_ = 0;
    SpaceSolveOptions how_;
};

}  // namespace

int main(int argc, char** argv) {
    Options options;
    CLI::App app("Costs of all legs between the targets of a problem in space");
    app.add_option("problem", options.problem, "problem file with targets in any order")->required();
    app.add_option("--iterations", options.iterations, "of each search")->check(CLI::PositiveNumber);
    app.add_option("--searches", options.searches, "for each leg")->check(CLI::PositiveNumber);
    app.add_option("-j,--jobs", options.jobs, "legs at a time")->check(CLI::PositiveNumber);
    return run_program(app, argc, argv, [&options] {
        for (const std::vector<double>& row : Legs(options).costs()) {
            for (std::size_t to = 0; to < row.size(); ++to) {
                fmt::print("{}{:.6g}", to == 0 ? "" : " ", row[to]);
            }
            fmt::print("\n");
        }
    });
}

// Whether hovers that the analysis calls unstable grow in flight, and those it calls stable decay: random places and
// arm angles in shipped problems and among random obstacles. Prints Markdown; every flight counts, disagreements are
// listed.

#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "../../tests/support/random.hpp"
#include "../support/disturbed_hover.hpp"
#include "../support/measuring.hpp"
#include "../support/scenes.hpp"
#include "downwash/bench/machine.hpp"
#include "downwash/bench/statistics.hpp"
#include "downwash/problems/problem_model.hpp"
#include "downwash/problems/problem_reader.hpp"
#include "downwash/simulation/hover_analysis.hpp"

using namespace downwash;
using namespace downwash::bench;

namespace {

/// Hovers whose growth rate is nearer to zero than this are all flown [1/s]: there a verdict is hardest.
constexpr double critical_rate_1_s = 0.05;
/// One in so many of the hovers that are stable by more is flown.
constexpr int clear_ones = 50;
/// Places looked at per row: where few hovers are unstable, fewer are flown.
constexpr int max_places = 30000;

struct Options {
    std::vector<std::string> problems;
    std::size_t flights = 150;
    std::uint64_t seed = 1;
};

/// One row of the table.
struct Count {
    std::string problem, robot;
    Disturbance disturbance;
    std::size_t unstable = 0, grew = 0, stable = 0, decayed = 0;
    std::size_t critical = 0;  ///< hovers of either kind with a growth rate near zero
    std::size_t unknown = 0;   ///< places passed over
};

class VerdictFlights {
 public:
    explicit VerdictFlights(const Options& options) : options_(options), random_(options.seed) {}

    /// Adds flights at random places of one problem to a row, until half of so many were called unstable and half
    /// stable, or so many places were looked at.
    void fly(const Problem& problem, std::size_t until, int places, Count& count) {
        const auto model = make_flight_model(problem);
        const Bounds& bounds = problem.bounds;
        for (int place = 0; place < places && count.unstable + count.stable < until; ++place) {
            const double x_m = random_.uniform(bounds.x_low_m, bounds.x_high_m);
            const double z_m = random_.uniform(bounds.z_low_m, bounds.z_high_m);
            const double arm_rad = random_.uniform(-3.14, 3.14);
            const HoverAnalysis hover = analyse_hover(*model, x_m, z_m, arm_rad);
            count.unknown += hover.verdict == HoldVerdict::unknown ? 1 : 0;
            const bool is_unstable = hover.verdict == HoldVerdict::unstable;
            const bool is_stable = hover.verdict == HoldVerdict::stable;
            const double rate_1_s = hover.stability.growth_rate_1_s;
            const bool is_wanted = is_unstable
                                       ? 2 * count.unstable < until
                                       : is_stable && 2 * count.stable < until &&
                                             (rate_1_s > -critical_rate_1_s || random_.integer(1, clear_ones) == 1);
            if (!is_wanted) {
                continue;
            }
            const auto [grew, end_m] = fly_disturbed(*model, hover.trim, count.disturbance, random_);
            (is_unstable ? count.unstable : count.stable) += 1;
            count.critical += std::abs(rate_1_s) < critical_rate_1_s ? 1 : 0;
            count.grew += is_unstable && grew ? 1 : 0;
            count.decayed += is_stable && !grew ? 1 : 0;
            if (grew != is_unstable) {
                disagreements_.push_back(fmt::format(
                    "{}, {}, up to {:g}: called {}, {} to {:.2g}; growth rate {:.5f} 1/s at x {:.17g}, z {:.17g}, arm "
                    "{:.17g}",
                    problem.name, count.robot, count.disturbance.size, name_of(hover.verdict),
                    grew ? "grew" : "decayed", end_m, rate_1_s, x_m, z_m, arm_rad));
            }
        }
    }

    void run() {
        const auto lagging = [](Problem problem) {
            problem.robot.rotors.time_constant_s = 0.02;
            return problem;
        };
        std::vector<Problem> problems;
        for (const std::string& file : options_.problems) {
            problems.push_back(read_problem(file));
        }
        for (const Problem& problem : problems) {
            add_row({problem.name, "shipped", {}}, {problem});
            add_row({problem.name, "20 ms rotor lag", {}}, {lagging(problem)});
        }
        add_row({problems.front().name, "shipped", {1e-2, 0.25}}, {problems.front()});
        std::vector<Problem> random_scenes;
        for (unsigned seed = 1; seed <= 15; ++seed) {
            random_scenes.push_back(with_random_primitives(problems.front(), seed));
            random_scenes.back().name = "random scene " + std::to_string(seed);
        }
        add_row({"15 random scenes", "shipped", {}}, random_scenes);
        std::transform(random_scenes.begin(), random_scenes.end(), random_scenes.begin(), lagging);
        add_row({"15 random scenes", "20 ms rotor lag", {}}, random_scenes);
    }

    void print() const {
        fmt::print(
            "# Hover verdicts against flights\n\nCommit {}, g++ {}, {}, seed {}. `bench/hover_flights.sh` writes this "
            "page.\n\n"
            "Random places and arm angles with verdict `unstable` or `stable`, half of each as far as {} places hold "
            "so "
            "many; of the stable ones with a growth\nrate below -{} 1/s one in {} is taken. Each is disturbed by up "
            "to the given size in every coordinate (m, rad) and rate (per s), and flown for\n{} s with direct "
            "aerodynamics. It grew when it left the given distance; or when it was farther away in the last quarter "
            "than in the one before, or\nas far (a limit cycle) and farther than it began.\nShares with 95 % Wilson "
            "intervals; every flight counts. `critical`: flights with a growth "
            "rate "
            "within {} 1/s of zero. `unknown`: places passed over\nbecause the model ends there.\n\n"
            "| problem | robot | disturbance, leaving | called unstable: grew | called stable: decayed | critical | "
            "unknown "
            "|\n|---|---|---|---|---|---|---|\n",
            source_commit(), __VERSION__, DOWNWASH_BUILD_TYPE, options_.seed, max_places, critical_rate_1_s, clear_ones,
            disturbed_flight_s, critical_rate_1_s);
        Count all{"all", "", {}};
        for (const Count& c : rows_) {
            print_row(c, fmt::format("{:g}, {:g}", c.disturbance.size, c.disturbance.leaving));
            all.unstable += c.unstable;
            all.grew += c.grew;
            all.stable += c.stable;
            all.decayed += c.decayed;
            all.critical += c.critical;
            all.unknown += c.unknown;
        }
        print_row(all, "");
        fmt::print("\n{} of {} flights disagree with their verdict{}\n", disagreements_.size(),
                   all.unstable + all.stable, disagreements_.empty() ? "." : ":\n");
        for (const std::string& disagreement : disagreements_) {
            fmt::print("- {}\n", disagreement);
        }
    }

 private:
    void add_row(Count row, const std::vector<Problem>& problems) {
        for (std::size_t i = 0; i < problems.size(); ++i) {
            const std::size_t until = options_.flights * (i + 1) / problems.size();
            fly(problems[i], until, max_places / static_cast<int>(problems.size()), row);
        }
        fmt::print(stderr, "{}, {}: {} flights\n", row.problem, row.robot, row.unstable + row.stable);
        rows_.push_back(row);
    }

    static std::string share(std::size_t hits, std::size_t n) {
        if (n == 0) {
            return "none";
        }
        const Share found = share_of(hits, n);
        return fmt::format("{}/{} [{:.1f}, {:.1f} %]", hits, n, 100 * found.low, 100 * found.high);
    }
    static void print_row(const Count& c, const std::string& disturbance) {
        fmt::print("| {} | {} | {} | {} | {} | {} | {} |\n", c.problem, c.robot, disturbance, share(c.grew, c.unstable),
                   share(c.decayed, c.stable), c.critical, c.unknown);
    }

    const Options& options_;
    test::Random random_;
    std::vector<Count> rows_;
    std::vector<std::string> disagreements_;
};

}  // namespace

int main(int argc, char** argv) {
    Options options;
    CLI::App app("Verdicts of the hover analysis against flights, as Markdown");
    app.add_option("problems", options.problems, "problem files; random scenes have the bounds of the first")
        ->required();
    app.add_option("--flights", options.flights, "flights per row")->check(CLI::PositiveNumber);
    app.add_option("--seed", options.seed, "of places and disturbances");
    return run_program(app, argc, argv, [&options] {
        VerdictFlights flights(options);
        flights.run();
        flights.print();
    });
}

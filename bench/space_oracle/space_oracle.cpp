// The shipped planar robot, flown along plans of planar problems by the planar closed loop and by the one in space.
// Prints Markdown; every flight counts.

#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "../support/measuring.hpp"
#include "downwash/bench/machine.hpp"
#include "downwash/problems/problem_reader.hpp"
#include "downwash/problems/space_problem_reader.hpp"
#include "downwash/simulation/world_parameters.hpp"
#include "twin_flights.hpp"

using namespace downwash;
using namespace downwash::bench;

namespace {

constexpr double most_apart_m = 1e-6;
constexpr double flight_s = 20;

struct Options {
    std::string robot;
    std::vector<std::string> problems;
    std::uint32_t plans = 3;
    std::uint64_t iterations = 300;
    std::uint64_t worlds = 50;
    std::uint64_t seed = 1;
};

/// The greatest of some flights.
struct Row {
    int flights = 0;  ///< without a clipped demand, as all that follows
    Apart apart;
    int clipped = 0;               ///< flights with one
    double before_clipping_m = 0;  ///< in those
    double clipped_m = 0;          ///< in those, over the whole flight

    void add(const Apart& one) {
        if (one.clipped_ticks > 0) {
            ++clipped;
            before_clipping_m = std::max(before_clipping_m, one.before_clipping_m);
            clipped_m = std::max(clipped_m, one.place_m);
            return;
        }
        ++flights;
        for (double Apart::*number :
             {&Apart::place_m, &Apart::beside_m, &Apart::attitude_rad, &Apart::joint_rad, &Apart::energy_j}) {
            apart.*number = std::max(apart.*number, one.*number);
        }
    }
};

class Comparison {
 public:
    explicit Comparison(const Options& options) : options_(options), robot_(read_space_robot(options.robot)) {}

    void print_page() {
        fmt::print(
            "# The planar robot in the plane and in space\n\nCommit {}, g++ {}, {}, {}, seed {}. "
            "`bench/space_oracle.sh` writes this page.\n\n"
            "The shipped planar robot flies by the planar closed loop and, as {}, by the one in space, at the place "
            "and "
            "the heading of each\nproblem. Both follow the same references for {:.0f} s: the plans of {} searches of "
            "{} "
            "iterations in the nominal world, then a hover at\ntheir end. Both take one Runge-Kutta step a tick and "
            "evaluate surfaces directly. They fly in the nominal world and in {} drawn worlds for\neach plan, with the "
            "problem's own uncertainty. What a world has beside the plane is 0, and two rotors that differ only in "
            "their distance from the plane\nshare the mean of their scales. Noise and gusts are the same numbers in "
            "both.\n\n"
            "Beyond a limit the laws differ on purpose ([model.md 5.11](../../docs/model.md#511-rotors-in-space)): the "
            "planar law clips each rotor for itself, and the one in\nspace gives up yaw torque first, then lift, last "
            "roll and pitch torque. Flights in which either clips a demand stand apart.\n\n"
            "| problem | world | flights | distance, m | from the plane, m | attitude, rad | joint, rad | energy, J | "
            "clipped flights | distance before, m | in all, m |\n|---|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|\n",
            source_commit(), __VERSION__, DOWNWASH_BUILD_TYPE, processor(), options_.seed, robot_.name, flight_s,
            options_.plans, options_.iterations, options_.worlds);
        for (const std::string& file : options_.problems) {
            fly(read_problem(file));
        }
        print_row("all", "nominal", all_[0]);
        print_row("all", "drawn", all_[1]);
        Row all = all_[0];
        all.apart.place_m = std::max(all.apart.place_m, all_[1].apart.place_m);
        all.before_clipping_m = std::max(all.before_clipping_m, all_[1].before_clipping_m);
        fmt::print("\n| bound | found | |\n| --- | --- | --- |\n");
        print_bound(fmt::format("without a clipped demand at most {:.0e} m apart", most_apart_m),
                    fmt::format("{:.1e} m", all.apart.place_m), all.apart.place_m <= most_apart_m);
        print_bound(fmt::format("else at most {:.0e} m apart up to the first one", most_apart_m),
                    fmt::format("{:.1e} m", all.before_clipping_m), all.before_clipping_m <= most_apart_m);
        fmt::print("\nFlights with a clipped demand: {}{}\n", clipped_.size(), clipped_.empty() ? "." : "\n");
        for (const std::string& flight : clipped_) {
            fmt::print("- {}\n", flight);
        }
    }

 private:
    void fly(const Problem& problem) {
        const TwinFlights twins(problem, robot_);
        const auto ticks = std::llround(flight_s * problem.robot.controller.rate_hz);
        Row rows[2];
        for (std::uint32_t seed = 1; seed <= options_.plans; ++seed) {
            const Plan plan = nominal_plan(problem, seed, options_.iterations);
            for (std::uint64_t index = 0; index <= options_.worlds; ++index) {  // 0: the nominal one
                const World drawn =
                    draw_world(problem.uncertainty.value_or(Uncertainty{}), problem.robot, options_.seed, index);
                const Apart apart = twins.fly(plan, in_plane(drawn, problem.robot), ticks);
                const std::size_t is_drawn = index > 0 ? 1 : 0;
                rows[is_drawn].add(apart);
                all_[is_drawn].add(apart);
                if (apart.clipped_ticks > 0) {
                    clipped_.push_back(fmt::format(
                        "{}, plan {}, world {}: {} clipped ticks; {:.1e} m apart before the first, {:.1e} m in all",
                        problem.name, seed, index, apart.clipped_ticks, apart.before_clipping_m, apart.place_m));
                }
            }
        }
        print_row(problem.name, "nominal", rows[0]);
        print_row(problem.name, "drawn", rows[1]);
        fmt::print(stderr, "{}: {} flights in drawn worlds, at most {:.1e} m apart\n", problem.name, rows[1].flights,
                   rows[1].apart.place_m);
    }

    static void print_row(const std::string& problem, const char* world, const Row& row) {
        const Apart& apart = row.apart;
        fmt::print("| {} | {} | {} | {:.1e} | {:.1e} | {:.1e} | {:.1e} | {:.1e} | {} |", problem, world, row.flights,
                   apart.place_m, apart.beside_m, apart.attitude_rad, apart.joint_rad, apart.energy_j, row.clipped);
        if (row.clipped > 0) {
            fmt::print(" {:.1e} | {:.1e} |\n", row.before_clipping_m, row.clipped_m);
        } else {
            fmt::print(" | |\n");
        }
    }

    const Options& options_;
    SpaceRobot robot_;
    Row all_[2];
    std::vector<std::string> clipped_;
};

}  // namespace

int main(int argc, char** argv) {
    Options options;
    CLI::App app("The planar robot in the plane and in space, as Markdown");
    app.add_option("robot", options.robot, "the planar robot as one in space")->required();
    app.add_option("problems", options.problems, "planar problems of the planar one")->required();
    app.add_option("--plans", options.plans, "of each problem")->check(CLI::PositiveNumber);
    app.add_option("--iterations", options.iterations, "of each search")->check(CLI::PositiveNumber);
    app.add_option("--worlds", options.worlds, "drawn for each plan, besides the nominal one");
    app.add_option("--seed", options.seed, "of the worlds");
    return run_program(app, argc, argv, [&options] { Comparison(options).print_page(); });
}

// How near to a wide ceiling and to a wide floor each control law can hover, with and without observer and
// feed-forward, the map right and wrong. By the hover analysis, each limit tried by two flights. Prints Markdown.

#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "../../tests/support/random.hpp"
#include "../support/disturbed_hover.hpp"
#include "../support/measuring.hpp"
#include "downwash/bench/machine.hpp"
#include "downwash/problems/problem_model.hpp"
#include "downwash/problems/problem_reader.hpp"
#include "downwash/simulation/hover_analysis.hpp"

using namespace downwash;
using namespace downwash::bench;

namespace {

constexpr double farthest_m = 1.5;  ///< here every law hovers, or none of its distances counts
constexpr double step_m = 1e-3;
constexpr double beside_m = 0.02;  ///< so far on either side of a limit the flights are
constexpr double offsets_m[] = {0, 0.01, 0.03, 0.05, -0.01, -0.03, -0.05};

struct Surface {
    const char* name;
    bool is_above;
    double arm_rad;  ///< away from it
};
constexpr Surface surfaces[] = {{"ceiling, the arm hanging", true, std::numbers::pi / 2},
                                {"floor, the arm up", false, -std::numbers::pi / 2}};

/// The first stands for the law of the robot file.
constexpr std::string_view laws[] = {ModelInversion::name, CascadedPid::name, PlanarLyapunov::name};

/// What a law has beside its loops.
struct Beside {
    std::string_view name;
    double observer_1_s;  ///< 0: none
    bool reads;
};
constexpr Beside all_beside[] = {{"", 0, false},
                                 {"+ observer, 3 1/s", 3, false},
                                 {"+ observer, 10 1/s", 10, false},
                                 {"+ feed-forward", 0, true},
                                 {"+ feed-forward, observer 3 1/s", 3, true},
                                 {"+ feed-forward, observer 10 1/s", 10, true}};

/// The law of a robot file, or another with its defaults, with what stands beside it.
Robot equipped(Robot robot, std::string_view law_name, const Beside& beside, double offset_z_m) {
    const double rotor_lead = std::visit([](const auto& own) { return own.rotor_lead; }, robot.controller.law);
    if (law_name == CascadedPid::name) {
        robot.controller.law = CascadedPid{};
    } else if (law_name == PlanarLyapunov::name) {
        robot.controller.law = PlanarLyapunov{};
    }
    std::visit([&](auto& law) { law.rotor_lead = rotor_lead; }, robot.controller.law);
    std::visit(
        [&](auto& law) {
            law.aids = {};
            if (beside.observer_1_s > 0) {
                law.aids.observer = controllers::DisturbanceObserver{beside.observer_1_s};
            }
            if (beside.reads) {
                law.aids.feed_forward = controllers::FeedForward{0, offset_z_m};
            }
        },
        robot.controller.law);
    return robot;
}

/// A robot beside one wide surface at z = 0.
class Place {
 public:
    Place(const Problem& problem, const Robot& robot, const Surface& surface)
        : surface_(surface), model_(model_of(problem, robot, surface)) {
        hub_z_m_ = robot.rotors.positions_m.front()[2];
    }

    [[nodiscard]] const FlightModel& model() const { return *model_; }
    /// Hover with the rotors so far from the surface.
    [[nodiscard]] HoverAnalysis hover(double gap_m) const {
        const double z_m = surface_.is_above ? -gap_m - hub_z_m_ : gap_m - hub_z_m_;
        return analyse_hover(*model_, 0, z_m, surface_.arm_rad);
    }

    /// The least distance such that this and all greater ones can be held [m]; empty: not even the farthest.
    [[nodiscard]] std::optional<double> limit_m() const {
        std::optional<double> held_m;
        for (double gap_m = farthest_m; gap_m > 0; gap_m -= step_m) {
            const HoldVerdict verdict = hover(gap_m).verdict;
            if (verdict != HoldVerdict::stable) {
                return held_m;
            }
            held_m = gap_m;
        }
        return held_m;
    }

 private:
    static std::shared_ptr<const FlightModel> model_of(Problem problem, const Robot& robot, const Surface& surface) {
        problem.robot = robot;
        problem.plane = {};
        problem.obstacles = {{"slab", Box{{40, 40, 1}}, {0, 0, surface.is_above ? 0.5 : -0.5}, {}}};
        return make_flight_model(problem);
    }

    const Surface& surface_;
    std::shared_ptr<const FlightModel> model_;
    double hub_z_m_;
};

/// Flights that the limits were tried by.
struct Trials {
    test::Random random{1};
    int held = 0, held_decayed = 0, lost = 0, lost_grew = 0;
    std::vector<std::string> disagreements;

    void fly(const Place& place, double limit_m, const std::string& of) {
        const HoverAnalysis outside = place.hover(limit_m + beside_m);
        if (outside.verdict == HoldVerdict::stable) {
            ++held;
            const auto [grew, end_m] = fly_disturbed(place.model(), outside.trim, {}, random);
            held_decayed += grew ? 0 : 1;
            note(grew, of, "stable, grew", outside, end_m);
        }
        const HoverAnalysis inside = place.hover(limit_m - beside_m);
        if (inside.verdict == HoldVerdict::unstable) {
            ++lost;
            const auto [grew, end_m] = fly_disturbed(place.model(), inside.trim, {}, random);
            lost_grew += grew ? 1 : 0;
            note(!grew, of, "unstable, did not grow", inside, end_m);
        }
    }

    void note(bool disagrees, const std::string& of, const char* how, const HoverAnalysis& hover, double end_m) {
        if (disagrees) {
            disagreements.push_back(fmt::format("{}: called {}; growth rate {:.4f} 1/s, {:.4f} m away after the flight",
                                                of, how, hover.stability.growth_rate_1_s, end_m));
        }
    }
};

/// "0.154", or what ends it there: the map's edge (m) or nothing stable at all (-).
std::string limit_text(const Place& place, const std::string& of, Trials& trials) {
    const std::optional<double> limit_m = place.limit_m();
    if (!limit_m) {
        return "-";
    }
    trials.fly(place, *limit_m, of);
    const HoldVerdict next = place.hover(*limit_m - step_m).verdict;
    const char* mark = next == HoldVerdict::unstable         ? ""
                       : next == HoldVerdict::no_equilibrium ? " e"
                       : next == HoldVerdict::unknown        ? " u"
                                                             : " *";
    return fmt::format("{:.3f}{}", *limit_m, mark);
}

void print_table(const Problem& problem, Robot robot, const Surface& surface, double lag_s, Trials& trials) {
    robot.rotors.time_constant_s = lag_s;
    fmt::print("\n## {}, {}, rotor lag {:.0f} ms\n\n", robot.name, surface.name, 1e3 * lag_s);
    fmt::print("| law | right | 1 cm far | 3 cm far | 5 cm far | 1 cm near | 3 cm near | 5 cm near |\n");
    fmt::print("|---|---:|---:|---:|---:|---:|---:|---:|\n");
    for (const std::string_view law : laws) {
        for (const Beside& beside : all_beside) {
            const std::string_view name = beside.name.empty() ? law : beside.name;
            fmt::print("| {} |", name);
            for (const double offset_m : offsets_m) {
                if (offset_m != 0 && !beside.reads) {
                    fmt::print(" |");
                    continue;
                }
                const double offset_z_m = surface.is_above ? offset_m : -offset_m;
                const std::string of =
                    fmt::format("{}, {}, lag {} s, {}, offset {} m", robot.name, surface.name, lag_s, name, offset_m);
                const Place place(problem, equipped(robot, law, beside, offset_z_m), surface);
                fmt::print(" {} |", limit_text(place, of, trials));
            }
            fmt::print("\n");
        }
    }
}

void print_all(const std::string& file, const std::vector<std::string>& robots) {
    const Problem problem = read_problem(file);
    fmt::print(
        "# How near to surfaces each control law can hover\n\nCommit {}, g++ {}, {}. `bench/law_limits.sh` writes this "
        "page.\n\n"
        "Least distance [m] between rotors and one wide, flat surface from which on a hover is `stable` at every "
        "millimetre "
        "up to {} m, by the hover\nanalysis ([hold.md](../../docs/hold.md)). *Far*, *near*: the map of a feed-forward "
        "has the "
        "surface so much farther from the vehicle, or nearer,\nthan it is. What ends a row's distances is instability, "
        "or, where "
        "marked, the flyable area (\\*), a missing equilibrium (e) or the model's end (u);\n-: no distance. Laws as in "
        "the robot's "
        "file, the cascaded PID with its defaults and the file's `rotor_lead`.\n",
        source_commit(), __VERSION__, DOWNWASH_BUILD_TYPE, farthest_m);
    Trials trials;
    for (const std::string& path : robots) {
        const Robot robot = read_robot(path);
        for (const Surface& surface : surfaces) {
            for (const double lag_s : {0.0, 0.05}) {
                print_table(problem, robot, surface, lag_s, trials);
            }
        }
    }
    fmt::print(
        "\nEach limit was tried by flights of {:.0f} s with direct aerodynamics, disturbed by up to 1 mm, 1 mm/s, 1 "
        "mrad and 1 "
        "mrad/s: {:.0f} cm farther away {} of {} decayed,\n{:.0f} cm nearer {} of {} grew.\n\n",
        disturbed_flight_s, 100 * beside_m, trials.held_decayed, trials.held, 100 * beside_m, trials.lost_grew,
        trials.lost);
    for (const std::string& disagreement : trials.disagreements) {
        fmt::print("- {}\n", disagreement);
    }
}

}  // namespace

int main(int argc, char** argv) {
    std::string problem;
    std::vector<std::string> robots;
    CLI::App app("How near to surfaces each control law can hover, as Markdown");
    app.add_option("problem", problem, "problem file whose surface effects count")->required();
    app.add_option("--robot", robots, "robot files")->required();
    return run_program(app, argc, argv, [&] { print_all(problem, robots); });
}

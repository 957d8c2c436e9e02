// Missions of docs/examples/offboard in which the link has faults: how far the vehicle is from its plan, and how
// flights end whose link falls silent.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <random>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "../../docs/examples/offboard/obstacles.hpp"
#include "../../docs/examples/offboard/px4.hpp"
#include "../../docs/examples/offboard/rehearsal.hpp"
#include "../support/measuring.hpp"
#include "downwash/base/infinity.hpp"
#include "downwash/base/parallel.hpp"
#include "downwash/base/quantile.hpp"
#include "downwash/simulation/space_world_parameters.hpp"

using namespace downwash;
using namespace downwash::bench;

namespace {

constexpr double max_distance_m = 0.05;  ///< from the plan
constexpr double before_offboard_s = 1.2;

struct Given {
    std::string file, obstacle;
    double lower_m = 0.05;
    int missions = 500, plans = 5, tracked = 20, threads = 2;
    std::uint64_t iterations = 200;
};

struct Planned {
    SpaceProblem problem;
    SpacePlan plan;
};

/// What happens to the link of a mission.
struct Kind {
    std::string_view name;
    bool falls_silent;  ///< for good
    bool comes_back;    ///< after 0.6 to 3 s
    bool replans;       ///< since the obstacle turns out lower
};
constexpr std::array kinds{
    Kind{"silent for good", true, false, false}, Kind{"silent for 0.6 to 3 s", true, true, false},
    Kind{"the same, and the obstacle is lower: replanned", true, false, true},
    Kind{"30 % lost, up to 0.05 s late", false, false, false},
    Kind{"30 % lost, up to 0.05 s late, and the obstacle is lower: replanned", false, false, true}};

class Missions {
 public:
    explicit Missions(const Given& given) : given_(given) {
        for (int seed = 1; seed <= given.plans; ++seed) {
            SpaceProblem drawing = read_px4_problem(given.file);
            drawing.planner.seed = static_cast<std::uint32_t>(seed);
            drawing.planner.max_iterations = given.iterations;
            drawing.planner.time_limit_s.reset();
            Streamer streamer(drawing, {.max_iterations = given.iterations, .is_quiet = true});
            if (streamer.plan()) {
                plans_.push_back({streamer.problem(), streamer.flown_plan()});
            }
        }
        if (plans_.empty()) {
            throw std::runtime_error("no plan is safe in silence");
        }
    }

    [[nodiscard]] const std::vector<Planned>& plans() const { return plans_; }

    /// @param world of the problem's uncertainty; 0: the nominal one
    [[nodiscard]] Rehearsal fly(int number, const LinkFaults& faults, bool replans, std::uint64_t world) const {
        const Planned& planned = plan_of(number);
        SpaceProblem truth = planned.problem;
        StreamerOptions options{.max_iterations = given_.iterations / 4, .is_quiet = true};
        if (replans) {
            options.lower = given_.obstacle;
            options.lower_m = given_.lower_m;
            box_in(truth, given_.obstacle).center_world_m[2] -= given_.lower_m;
        }
        Streamer streamer(planned.problem, options);
        streamer.adopt(planned.problem, planned.plan);
        OffboardVehicle vehicle(truth, draw_space_world(*truth.uncertainty, truth.robot, 1, world));
        FaultyLink link(faults, static_cast<unsigned>(number + 1));
        return rehearse(streamer, vehicle, link);
    }

    /// A mission of a kind, with faults at a moment drawn from its number.
    [[nodiscard]] Rehearsal fly(int number, const Kind& kind) const {
        std::mt19937 random(static_cast<unsigned>(number));
        const auto share = [&] { return static_cast<double>(random()) / 4294967296.0; };
        LinkFaults faults{.loss = 0.02, .jitter_s = 0.02};
        if (kind.falls_silent) {
            faults.silent_from_s = before_offboard_s + share() * plan_of(number).plan.duration_s();
            if (kind.comes_back) {
                faults.silent_until_s = faults.silent_from_s + 0.6 + 2.4 * share();
            }
        } else {
            faults.loss = 0.3;
            faults.jitter_s = 0.05;
        }
        return fly(number, faults, kind.replans, static_cast<std::uint64_t>(number + 1));
    }

 private:
    [[nodiscard]] const Planned& plan_of(int number) const {
        return plans_[static_cast<std::size_t>(number) % plans_.size()];
    }

    Given given_;
    std::vector<Planned> plans_;
};

void print_plans(const Missions& missions, const Given& given) {
    std::vector<double> durations_s, speeds_m_s;
    for (const Planned& planned : missions.plans()) {
        durations_s.push_back(planned.plan.duration_s());
        speeds_m_s.push_back(planned.problem.motion.max_speed_m_s);
    }
    fmt::print(
        "`{}`: with {} seeds, {} plans were found that are safe in silence, of {:.1f} to {:.1f} s at up to {:.2f} to "
        "{:.2f} m/s.\n\n",
        missions.plans().front().problem.name, given.plans, missions.plans().size(), quantile(durations_s, 0),
        quantile(durations_s, 1), quantile(speeds_m_s, 0), quantile(speeds_m_s, 1));
}

/// Missions 0 to count - 1, in this order whatever the number of threads.
template <class Fly>
std::vector<Rehearsal> all_of(int count, int threads, const Fly& fly) {
    std::vector<Rehearsal> all(static_cast<std::size_t>(count));
    run_parallel(all.size(), threads, [&](std::size_t i) { all[i] = fly(static_cast<int>(i)); });
    return all;
}

/// Set-points at 50 Hz of which 2 % are lost, up to 10 ms late.
double print_tracking(const Missions& missions, const Given& given) {
    fmt::print(
        "Set-points at 50 Hz, 2 % lost, up to 0.01 s late. Distance of the vehicle from the plan, the greatest of a "
        "flight:\n\n"
        "| world | flights | median [m] | greatest [m] | arrived |\n| --- | ---: | ---: | ---: | ---: |\n");
    double nominal_m = 0;
    for (const bool is_nominal : {true, false}) {
        std::vector<double> distances_m;
        int arrived = 0;
        for (const Rehearsal& flown : all_of(given.tracked, given.threads, [&](int i) {
                 const std::uint64_t world = is_nominal ? 0 : static_cast<std::uint64_t>(i + 1);
                 return missions.fly(i, {.loss = 0.02, .jitter_s = 0.01}, false, world);
             })) {
            distances_m.push_back(flown.max_distance_m);
            arrived += flown.has_arrived ? 1 : 0;
        }
        fmt::print("| {} | {} | {:.3f} | {:.3f} | {} |\n", is_nominal ? "nominal" : "drawn", given.tracked,
                   quantile(distances_m, 0.5), quantile(distances_m, 1), arrived);
        nominal_m = is_nominal ? quantile(distances_m, 1) : nominal_m;
    }
    return nominal_m;
}

/// What missions came to.
struct Count {
    std::array<int, all_outcomes.size()> outcomes{};
    int missions = 0, hover = 0, failsafe = 0, arrived = 0;
    double min_clearance_m = infinity;

    void add(const Rehearsal& flown) {
        ++missions;
        ++outcomes[static_cast<std::size_t>(flown.outcome)];
        hover += flown.hovers ? 1 : 0;
        failsafe += flown.hovers && flown.is_in_failsafe ? 1 : 0;
        arrived += flown.has_arrived ? 1 : 0;
        min_clearance_m = std::min(min_clearance_m, flown.min_clearance_m);
    }
    [[nodiscard]] int of(Outcome outcome) const { return outcomes[static_cast<std::size_t>(outcome)]; }
};

/// Missions with faults. @return of all kinds
Count print_missions(const Missions& missions, const Given& given) {
    fmt::print(
        "\nMissions with faults, each in a world of its own. The link falls silent at a moment drawn evenly from the "
        "flight.\n\n"
        "| the link | missions | hover | of these in failsafe | collision | left the flyable area | unstable | arrived "
        "| least clearance [m] |\n"
        "| --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |\n");
    Count all;
    std::string failed;
    const int each = given.missions / static_cast<int>(kinds.size());
    for (std::size_t k = 0; k < kinds.size(); ++k) {
        const int first = static_cast<int>(k) * each;
        const auto flights = all_of(each, given.threads, [&](int i) { return missions.fly(first + i, kinds[k]); });
        Count count;
        for (int i = 0; i < each; ++i) {
            const Rehearsal& flown = flights[static_cast<std::size_t>(i)];
            count.add(flown);
            all.add(flown);
            if (!flown.hovers) {
                failed += fmt::format("- mission {}, {}: {} after {:.1f} s, least clearance {:.3f} m\n", first + i,
                                      kinds[k].name, name_of(flown.outcome), flown.duration_s, flown.min_clearance_m);
            }
        }
        fmt::print("| {} | {} | {} | {} | {} | {} | {} | {} | {:.3f} |\n", kinds[k].name, each, count.hover,
                   count.failsafe, count.of(Outcome::collision), count.of(Outcome::left_flyable_area),
                   count.of(Outcome::unstable), count.arrived, count.min_clearance_m);
    }
    if (!failed.empty()) {
        fmt::print("\nThose that do not end in a hover:\n\n{}", failed);
    }
    return all;
}

void run(const Given& given) {
    const Missions missions(given);
    print_plans(missions, given);
    const double nominal_m = print_tracking(missions, given);
    const Count all = print_missions(missions, given);
    fmt::print("\n| bound | found | |\n| --- | --- | --- |\n");
    print_bound("the vehicle within 5 cm of the plan at 50 Hz with 2 % lost, in the nominal world",
                fmt::format("{:.3f} m", nominal_m), nominal_m < max_distance_m);
    print_bound("every mission with faults ends in a hover", fmt::format("{} of {}", all.hover, all.missions),
                all.hover == all.missions);
    const int touch = all.of(Outcome::collision);
    print_bound("none touches anything", fmt::format("{} of {}", touch, all.missions), touch == 0);
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App program("Flies missions by MAVLink over a link with faults.");
    Given given;
    program.add_option("problem", given.file, "problem file")->required();
    program.add_option("obstacle", given.obstacle, "that turns out lower")->required();
    program.add_option("--missions", given.missions, "with faults, in all");
    program.add_option("--plans", given.plans, "seeds to plan with");
    program.add_option("--tracked", given.tracked, "flights per world kind without silence");
    program.add_option("--threads", given.threads, "that fly, on which nothing else depends");
    program.add_option("--iterations", given.iterations, "of the search before a flight; a quarter of it in flight");
    return run_program(program, argc, argv, [&] { run(given); });
}

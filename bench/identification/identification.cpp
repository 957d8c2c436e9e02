// How well flights of the judge tell the vehicle that flew: numbers of random vehicles identified from one flight each,
// and how often the truth is within the 95 % interval. Prints Markdown; every flight counts.

#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <fstream>
#include <iomanip>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "../../tests/support/judged_logs.hpp"
#include "../support/measuring.hpp"
#include "downwash/base/parallel.hpp"
#include "downwash/base/quantile.hpp"
#include "downwash/bench/machine.hpp"
#include "downwash/bench/statistics.hpp"
#include "downwash/identification/held_back.hpp"
#include "downwash/identification/identification.hpp"
#include "downwash/planner/space_solve.hpp"
#include "downwash/problems/space_problem_model.hpp"
#include "downwash/problems/space_problem_reader.hpp"
#include "downwash/simulation/noise.hpp"
#include "downwash/simulation/space_world_parameters.hpp"

using namespace downwash;
using namespace downwash::bench;

namespace {

struct Options {
    std::string robot;
    int vehicles = 200;
    int flights = 1;
    double length_s = 10;
    std::uint64_t seed = 1;
    int threads = 1;
    bool shows_each = false;
    test::LogNoise log_noise;
    int held_back_worlds = 0;  ///< 0: no flight is held back
    std::string logs;          ///< folder for the logs as CSV; empty: none
    std::string problem;       ///< empty: no plans
    std::uint64_t iterations = 400, worlds = 400;
};

/// A vehicle as it truly is.
struct Vehicle {
    SpaceRobot robot;  ///< with its true drag
    SpaceWorld world;  ///< its other differences, and the wind of its first flight
    double drag = 0;   ///< over that of the robot file, less 1
};

Vehicle vehicle_of(const SpaceRobot& robot, std::uint64_t seed, std::uint64_t index) {
    Vehicle vehicle{robot, draw_space_world(robot.uncertainty.value_or(Uncertainty{}), robot, seed, index)};
    test::Random random(simulation::mixed(seed) ^ index);
    vehicle.drag = Spread::of_sd(IdentifySettings{}.drag_sd).difference(random.uniform(0, 1), 0, false);
    vehicle.robot.plant.drag.linear_n_s_m *= 1 + vehicle.drag;
    vehicle.robot.plant.drag.quadratic_n_s2_m2 *= 1 + vehicle.drag;
    return vehicle;
}

/// The world of a flight: the vehicle's, in other air.
SpaceWorld world_of_flight(const SpaceRobot& robot, const Vehicle& vehicle, std::uint64_t seed, int flight) {
    SpaceWorld world = vehicle.world;
    if (flight > 0) {
        const SpaceWorld other = draw_space_world(Uncertainty{}, robot, seed + 1000003U * static_cast<unsigned>(flight),
                                                  1 + vehicle.world.tape % 1000);
        world.wind_m_s = other.wind_m_s;
        world.tape = other.tape;
    }
    return world;
}

/// A log as `downwash identify` reads it.
void write_csv(const LoggedFlight& log, const SpaceRobot& robot, const std::string& file) {
    std::ofstream out(file);
    const auto numbered = [&](std::size_t count, const char* before, const char* after) {
        for (std::size_t i = 1; i <= count; ++i) {
            out << ',' << before << i << after;
        }
    };
    const std::size_t joints = robot.links.size(), rotors = robot.plant.rotors.size();
    out << "t_s,x_m,y_m,z_m,qw,qx,qy,qz,vx_m_s,vy_m_s,vz_m_s,wx_rad_s,wy_rad_s,wz_rad_s,ref_x_m,ref_y_m,ref_z_m";
    numbered(joints, "joint_", "_rad");
    numbered(joints, "joint_", "_rate_rad_s");
    numbered(joints, "joint_", "_torque_nm");
    numbered(rotors, "rotor_", "_cmd_n");
    out << '\n' << std::setprecision(17);
    for (const LoggedTick& tick : log.ticks) {
        out << tick.t_s;
        const auto write = [&](const auto& numbers, std::size_t count) {
            for (std::size_t i = 0; i < count; ++i) {
                out << ',' << numbers[i];
            }
        };
        write(tick.seen.position_m, 3);
        write(tick.seen.attitude, 4);
        write(tick.seen.velocity_m_s, 3);
        write(tick.seen.body_rates_rad_s, 3);
        write(tick.reference.position, 3);
        write(tick.seen.joints_rad, joints);
        write(tick.seen.joint_rates_rad_s, joints);
        write(tick.joint_torque_nm, joints);
        write(tick.rotor_command_n, rotors);
        out << '\n';
    }
}

struct Studied {
    Vehicle vehicle;
    std::vector<SpaceWorld> worlds;
    std::optional<Identification> found;            ///< empty: a flight did not end
    std::optional<HeldBackCoverage> before, after;  ///< of a flight held back
};

/// The log of a flight of a vehicle. @return nothing if it did not end
std::optional<LoggedFlight> flown_log(const SpaceRobot& robot, const Options& options, const Vehicle& vehicle,
                                      const SpaceWorld& world, const std::string& name, test::Random& random) {
    const SpacePlan plan = test::identification_reference(robot, options.length_s, random);
    const judge::SpaceJudgedFlight flight = test::fly_for_log(vehicle.robot, world, plan);
    if (flight.outcome != judge::Outcome::ok) {
        return std::nullopt;
    }
    LoggedFlight log = test::log_of(flight, name);
    test::add_noise(options.log_noise, robot.joints(), random, log);
    return log;
}

Studied study(const SpaceRobot& robot, const Options& options, std::uint64_t index) {
    Studied studied{vehicle_of(robot, options.seed, index), {}, {}, {}, {}};
    test::Random random(simulation::mixed(options.seed + 77) ^ index);
    std::vector<LoggedFlight> logs;
    for (int i = 0; i < options.flights; ++i) {
        studied.worlds.push_back(world_of_flight(robot, studied.vehicle, options.seed, i));
        std::optional<LoggedFlight> log =
            flown_log(robot, options, studied.vehicle, studied.worlds.back(), fmt::format("flight {}", i + 1), random);
        if (!log) {
            return studied;
        }
        logs.push_back(std::move(*log));
        if (!options.logs.empty()) {
            write_csv(logs.back(), robot, fmt::format("{}/log_{}_{}.csv", options.logs, index, i + 1));
        }
    }
    studied.found = identify(robot, logs);
    if (options.held_back_worlds > 0) {
        const SpaceWorld world = world_of_flight(robot, studied.vehicle, options.seed, options.flights);
        if (const auto log = flown_log(robot, options, studied.vehicle, world, "held back", random)) {
            const auto coverage = [&](const SpaceRobot& of) {
                return held_back_coverage(of, *log, Uncertainty{}, options.held_back_worlds, options.seed + index);
            };
            studied.before = coverage(robot);
            studied.after = coverage(learned_robot(robot, *studied.found));
        }
    }
    return studied;
}

/// Estimates of one number over all vehicles.
struct Tally {
    std::size_t learned = 0, within = 0, all = 0;
    std::vector<double> shares;  ///< sd after over sd before
    std::vector<double> errors;  ///< of learned ones, in sd
};

void add(Tally& tally, double truth, double value, double sd, double before_sd, bool is_learned) {
    ++tally.all;
    tally.shares.push_back(before_sd > 0 ? sd / before_sd : 0);
    if (is_learned) {
        constexpr double of_95_percent = 1.959963984540054;
        ++tally.learned;
        tally.within += std::abs(value - truth) <= of_95_percent * sd ? 1 : 0;
        tally.errors.push_back((value - truth) / sd);
    }
}

void add(std::vector<std::pair<std::string, Tally>>& tallies, const SpaceRobot& robot, const Studied& studied) {
    const auto tally_of = [&](const std::string& name) -> Tally& {
        const auto found = std::ranges::find(tallies, name, &std::pair<std::string, Tally>::first);
        return found != tallies.end() ? found->second : tallies.emplace_back(name, Tally{}).second;
    };
    const auto parameters = space_world_parameters_of(robot);
    for (const IdentifiedNumber& number : studied.found->numbers) {
        double truth = studied.vehicle.drag;
        for (const SpaceWorldParameter* parameter : parameters) {
            if (parameter->name == number.name) {
                truth = parameter->of(studied.vehicle.world);
            }
        }
        add(tally_of(number.name), truth, number.value, number.sd, number.before_sd, number.is_learned);
    }
    for (std::size_t flight = 0; flight < studied.worlds.size(); ++flight) {
        const IdentifiedWind& wind = studied.found->winds[flight];
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double before = axis == 2 ? 0.1 : 0.5;
            add(tally_of(fmt::format("wind {}", "xyz"[axis])), studied.worlds[flight].wind_m_s[axis],
                wind.wind_m_s[axis], wind.sd_m_s[axis], before, wind.sd_m_s[axis] <= 0.8 * before);
        }
    }
    const SpaceWorld& world = studied.vehicle.world;
    for (const IdentifiedNoise& noise : studied.found->noise) {
        const double truth = noise.name == "sensing.position_noise_m"     ? world.position_noise_m
                             : noise.name == "sensing.velocity_noise_m_s" ? world.velocity_noise_m_s
                             : noise.name == "sensing.gyro_noise_rad_s"   ? world.gyro_noise_rad_s
                                                                          : 0;
        if (truth > 0) {
            add(tally_of(noise.name), truth, noise.sd, noise.sd_of_sd, 0, true);
        }
    }
}

void print(const std::vector<std::pair<std::string, Tally>>& tallies) {
    fmt::print("| number | learned | sd, of that before | truth within 95 % interval | error over sd: mean, sd |\n");
    fmt::print("| --- | ---: | ---: | ---: | ---: |\n");
    for (const auto& [name, tally] : tallies) {
        double mean = 0, square = 0;
        for (const double error : tally.errors) {
            mean += error / static_cast<double>(tally.errors.size());
            square += error * error / static_cast<double>(tally.errors.size());
        }
        const Share share = share_of(tally.within, tally.learned);
        fmt::print(
            "| `{}` | {} of {} | {:.2g} | {} | {} |\n", name, tally.learned, tally.all, quantile(tally.shares, 0.5),
            tally.learned > 0
                ? fmt::format("{:.1f} % ({:.1f} to {:.1f} %)",
                              100.0 * static_cast<double>(share.hits) / static_cast<double>(share.attempts),
                              100 * share.low, 100 * share.high)
                : std::string("-"),
            tally.learned > 1 ? fmt::format("{:+.2f}, {:.2f}", mean, std::sqrt(std::max(0.0, square - mean * mean)))
                              : std::string("-"));
    }
}

/// Whether the truth is within intervals as often as they say.
void print_bounds(const std::vector<std::pair<std::string, Tally>>& tallies) {
    double least = 1, most = 0;
    for (const auto& [name, tally] : tallies) {
        if (tally.learned > 0) {
            const double share = static_cast<double>(tally.within) / static_cast<double>(tally.learned);
            least = std::min(least, share);
            most = std::max(most, share);
        }
    }
    const bool is_kept = least >= 0.9 && most <= 0.99;
    fmt::print("\n| bound | found | |\n| --- | --- | --- |\n");
    fmt::print(
        "| the truth within the 95 % interval in 90 to 99 % of the vehicles, for each number | {:.1f} to {:.1f} % | {} "
        "|\n",
        100 * least, 100 * most, is_kept ? "kept" : "**not kept**");
}

/// How far flights that were held back are within worlds, before and after.
void print_held_back(const std::vector<Studied>& all, int worlds) {
    fmt::print(
        "\nFlights held back, in {} worlds: the share of their samples where a flight in one more world is with 95 %, "
        "and "
        "how wide that is.\n\n",
        worlds);
    fmt::print("| worlds | flights | x, y, z within | least of a flight | width along x, y, z [cm] |\n");
    fmt::print("| --- | ---: | ---: | ---: | ---: |\n");
    for (const auto& [name, of] : {std::pair("before", &Studied::before), std::pair("after", &Studied::after)}) {
        std::vector<HeldBackCoverage> coverages;
        for (const Studied& studied : all) {
            if (studied.*of) {
                coverages.push_back(*(studied.*of));
            }
        }
        Vector3 within{}, width_m{};
        double least = 1;
        for (const HeldBackCoverage& coverage : coverages) {
            const double share = 1 / static_cast<double>(coverages.size());
            within = within + share * coverage.share_within;
            width_m = width_m + share * coverage.width_m;
            least = std::min(least, *std::ranges::min_element(coverage.share_within));
        }
        fmt::print("| {} | {} | {:.1f}, {:.1f}, {:.1f} % | {:.1f} % | {:.2f}, {:.2f}, {:.2f} |\n", name,
                   coverages.size(), 100 * within[0], 100 * within[1], 100 * within[2], 100 * least, 100 * width_m[0],
                   100 * width_m[1], 100 * width_m[2]);
    }
}

/// A plan for a learned vehicle, flown in the true one.
struct Planned {
    bool is_certified = false;
    double learned_cost = 0, known_cost = 0;  ///< planned energy, with what was learned and with what was known before
    bool is_known_certified = false;
    std::uint64_t flights = 0, failures = 0;
};

/// Worlds of the true vehicle: its own differences, and drawn surfaces and air.
std::vector<SpaceWorld> true_worlds(const Vehicle& vehicle, const SpaceProblem& problem, std::uint64_t count) {
    std::vector<SpaceWorld> worlds;
    for (std::uint64_t i = 1; i <= count; ++i) {
        SpaceWorld world = draw_space_world(*problem.uncertainty, problem.robot, 4242, i);
        for (const SpaceWorldParameter* parameter : space_world_parameters_of(problem.robot)) {
            if (parameter->name.starts_with("vehicle.") || parameter->name.starts_with("sensing.")) {
                parameter->place(world, parameter->number) = parameter->of(vehicle.world);
            }
        }
        world.position_noise_m = vehicle.world.position_noise_m;
        world.velocity_noise_m_s = vehicle.world.velocity_noise_m_s;
        world.gyro_noise_rad_s = vehicle.world.gyro_noise_rad_s;
        worlds.push_back(world);
    }
    return worlds;
}

SpaceSearchResult plan_for(SpaceProblem problem, const SpaceRobot& robot, const Options& options) {
    problem.robot = robot;
    problem.uncertainty = robot.uncertainty.value_or(Uncertainty{});
    problem.planner.max_iterations = options.iterations;
    problem.planner.time_limit_s = 600;
    problem.planner.seed = 1;
    return solve(std::make_shared<const SpaceProblemModel>(std::move(problem)));
}

Planned plan_and_fly(const SpaceProblem& problem, const Studied& studied, const Options& options) {
    Planned planned;
    const SpaceRobot learned = learned_robot(problem.robot, *studied.found);
    const SpaceSearchResult found = plan_for(problem, learned, options);
    const SpaceSearchResult known = plan_for(problem, problem.robot, options);
    planned.is_known_certified = known.certificate && known.certificate->is_given;
    planned.known_cost = known.cost;
    planned.is_certified = found.certificate && found.certificate->is_given;
    planned.learned_cost = found.cost;
    if (planned.is_certified) {
        SpaceProblem truth = problem;
        truth.robot = studied.vehicle.robot;
        const auto model = std::make_shared<const SpaceProblemModel>(std::move(truth));
        const std::vector<SpaceWorld> worlds = true_worlds(studied.vehicle, problem, options.worlds);
        for (const WorldSample& sample : fly_in_worlds(model, make_volumes(*model), *found.plan, worlds, {})) {
            ++planned.flights;
            planned.failures += sample.outcome == Outcome::ok ? 0 : 1;
        }
    }
    return planned;
}

void measure_plans(const SpaceProblem& problem, const std::vector<Studied>& all, const Options& options) {
    fmt::print(
        "\n## Plans\n\nPlans for `{}` from what {} flights of {} s told of each of {} vehicles (seed {}), {} "
        "iterations each, flown "
        "in {} worlds of the true vehicle.\n\n",
        problem.name, options.flights, options.length_s, options.vehicles, options.seed, options.iterations,
        options.worlds);
    fmt::print(
        "| vehicle | certified | failures in its true worlds | planned cost, over that with what was known before |\n");
    fmt::print("| ---: | --- | ---: | ---: |\n");
    std::uint64_t flights = 0, failures = 0, certified = 0, above = 0, vehicles = 0;
    for (std::size_t i = 0; i < all.size(); ++i) {
        if (!all[i].found) {
            continue;
        }
        ++vehicles;
        const Planned planned = plan_and_fly(problem, all[i], options);
        certified += planned.is_certified ? 1 : 0;
        flights += planned.flights;
        failures += planned.failures;
        above += planned.flights > 0 && 100 * planned.failures >= planned.flights ? 1 : 0;
        const bool both = planned.is_certified && planned.is_known_certified;
        fmt::print("| {} | {} | {} of {} | {} |\n", i + 1, planned.is_certified ? "yes" : "no", planned.failures,
                   planned.flights, both ? fmt::format("{:.3f}", planned.learned_cost / planned.known_cost) : "-");
    }
    fmt::print("\n{} of {} plans are certified.\n\n| bound | found | |\n| --- | --- | --- |\n", certified, vehicles);
    fmt::print(
        "| certified plans fail in less than 1 % of the worlds of each true vehicle | {} of {} in all, {} vehicles "
        "reach 1 % | {} |\n",
        failures, flights, above, flights > 0 && above == 0 ? "kept" : "**not kept**");
}

void measure(const Options& options) {
    const SpaceRobot robot = read_space_robot(options.robot);
    std::vector<Studied> all(static_cast<std::size_t>(options.vehicles));
    run_parallel(all.size(), options.threads, [&](std::size_t i) { all[i] = study(robot, options, i + 1); });
    std::vector<std::pair<std::string, Tally>> tallies;
    std::size_t lost = 0, open = 0;
    for (const Studied& studied : all) {
        if (!studied.found) {
            ++lost;
            continue;
        }
        open += studied.found->is_converged ? 0 : 1;
        add(tallies, robot, studied);
        if (options.shows_each) {
            for (const IdentifiedNumber& number : studied.found->numbers) {
                fmt::print("<!-- {} {} {} {} {} -->\n", number.name, number.value, number.sd, number.before_sd,
                           number.reason);
            }
            for (const IdentifiedNoise& noise : studied.found->noise) {
                fmt::print("<!-- {} {} {} -->\n", noise.name, noise.sd, noise.sd_of_sd);
            }
            fmt::print("<!-- rounds {} fit {} -->\n", studied.found->iterations, studied.found->fit);
            if (studied.after) {
                const HeldBackCoverage &before = *studied.before, &after = *studied.after;
                fmt::print("<!-- held back: {:.3f} {:.3f} {:.3f} -> {:.3f} {:.3f} {:.3f} -->\n", before.share_within[0],
                           before.share_within[1], before.share_within[2], after.share_within[0], after.share_within[1],
                           after.share_within[2]);
            }
        }
    }
    if (!options.problem.empty()) {
        SpaceProblem problem = read_space_problem(options.problem);
        problem.robot = robot;
        measure_plans(problem, all, options);
        return;
    }
    fmt::print(
        "Each vehicle is a draw of the default uncertainty, and of its drag with a standard deviation of 30 %. The "
        "judge flies "
        "it along a reference in free air, in wind and gusts, and\nrecords what its controller saw and commanded. "
        "[docs/identification.md](../../docs/identification.md) has the method.\n\nStandard deviations are this small "
        "because the judge's vehicle is the model's, but for the numbers that are sought. `thrust_scale` and "
        "`rotor_thrust_scale` enter a flight only by their\nproduct; what was known before tells them apart. The wind "
        "is "
        "learned as far as gusts that last as long as the flight let it.\n");
    fmt::print(
        "\n## {}\n\n{} vehicles, {} flight{} of {} s each, seed {}. {} flights did not end, {} searches came to no "
        "rest.\n\n",
        robot.name, options.vehicles, options.flights, options.flights > 1 ? "s" : "", options.length_s, options.seed,
        lost, open);
    print(tallies);
    print_bounds(tallies);
    if (options.held_back_worlds > 0) {
        print_held_back(all, options.held_back_worlds);
    }
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App program("Identifies random vehicles from flights of the judge");
    Options options;
    program.add_option("ROBOT", options.robot, "robot file in space")->required();
    program.add_option("--vehicles", options.vehicles, "how many")->check(CLI::Range(1, 100000));
    program.add_option("--flights", options.flights, "of each vehicle")->check(CLI::Range(1, 20));
    program.add_option("--length", options.length_s, "of a flight [s]")->check(CLI::Range(3.0, 600.0));
    program.add_option("--seed", options.seed, "of vehicles and references");
    program.add_option("--threads", options.threads, "vehicles side by side")->check(CLI::Range(1, 64));
    program.add_option("--logs", options.logs, "a folder for the logs of all flights");
    program.add_option("--problem", options.problem, "a problem in space to plan for the learned vehicles");
    program.add_option("--iterations", options.iterations, "of each search");
    program.add_option("--worlds", options.worlds, "of the true vehicle in which a plan is flown");
    program.add_flag("--each", options.shows_each, "show every vehicle");
    program.add_option("--held-back", options.held_back_worlds, "worlds for a further flight; 0: none");
    double attitude_deg = 0.05, joint_deg = 0.02;
    options.log_noise.joint_rate_rad_s = 0.01;
    program.add_option("--attitude-noise", attitude_deg, "of a log [degrees], a standard deviation");
    program.add_option("--joint-noise", joint_deg, "the same of joints");
    program.add_option("--joint-rate-noise", options.log_noise.joint_rate_rad_s, "the same of their rates [rad/s]");
    return run_program(program, argc, argv, [&] {
        constexpr double degree = 0.017453292519943295;
        options.log_noise.attitude_rad = attitude_deg * degree;
        options.log_noise.joint_rad = joint_deg * degree;
        measure(options);
    });
}

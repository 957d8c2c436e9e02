// Writes the shards of an invented campaign: searches of about a second with many improvements, as real ones have them.

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <random>
#include <string>

#include "downwash/bench/campaign_runs.hpp"
#include "downwash/bench/campaign_schema.hpp"
#include "downwash/bench/campaign_shards.hpp"

namespace {

using namespace downwash;         // NOLINT(google-build-using-namespace): a program
using namespace downwash::bench;  // NOLINT(google-build-using-namespace): a program

constexpr std::size_t experiment_count = 8, planner_count = 5;

CampaignPlan plan_for(std::uint32_t runs, std::uint64_t shards) {
    CampaignPlan plan;
    for (std::size_t i = 1; i <= experiment_count; ++i) {
        plan.experiments.push_back({"problem_" + std::to_string(i), "energy"});
    }
    plan.planners = {{Variant::mp_arm_ada, "rrt-star"},
                     {Variant::mp_arm_da, "rrt-star"},
                     {Variant::mp_arm, "rrt-star"},
                     {Variant::mp_arm_ada, "sst"},
                     {Variant::mp_arm, "sst"}};
    for (std::uint32_t seed = 1; seed <= runs / (experiment_count * planner_count); ++seed) {
        plan.seeds.push_back(seed);
    }
    plan.time_limit_s = 1;
    plan.shards = ShardPlan{shards, {}};
    plan.settings = {{"campaign", "invented"},
                     {"description", "Not flown: rows as searches write them."},
                     {"version", "0"},
                     {"commit", "none"},
                     {"jobs", "1"},
                     {"max_iterations", "none"},
                     {"seeds", seeds_text(plan.seeds)},
                     {"shards", std::to_string(shards)}};
    return plan;
}

/// A run of about as many rows as a search of a second has.
Run run_of(std::size_t experiment, std::size_t planner, std::uint32_t seed) {
    std::mt19937_64 random(seed + 1000003 * (planner + planner_count * experiment));
    const auto share = [&random] { return static_cast<double>(random() >> 11U) * 0x1p-53; };
    Run run;
    run.experiment = experiment;
    run.planner = planner;
    run.seed = seed;
    run.wall_s = 1 + 0.1 * share();
    run.iterations = 20000 + random() % 1000;
    run.edges_simulated = 30000;
    run.states_checked = 1000000;
    run.simulated_s = 20000;
    run.rejections = {{"bounds", random() % 5000},
                      {"collision", random() % 9000},
                      {"flyable_area", random() % 900},
                      {"saturation", random() % 500},
                      {"tracking", random() % 700}};
    run.made_on = RunMachine{{"node " + std::to_string(seed % 50), "a processor", "avx2"}, 2 * share()};
    constexpr double unsolved = 0.02, failed = 0.1;
    if (share() < unsolved) {
        run.nearest_approach_m = share();
        return run;
    }
    run.status = RunStatus::solved;
    double wall_s = 0.01 * std::exp(2 * share()), cost = 20000;
    run.first_solution_s = wall_s;
    constexpr std::uint64_t min_improvements = 4, most_more = 13;
    for (std::uint64_t i = min_improvements + random() % most_more; i > 0; --i) {
        run.improvements.push_back({wall_s, 10 * i, cost, cost + 10});
        wall_s *= 1 + share();
        cost *= 1 - 0.1 * share();
    }
    run.cost = cost;
    const bool holds = planner % 3 == 0 || share() > failed;
    run.flight = FlightFigures{holds ? Outcome::ok : Outcome::collision, cost + 10, cost, 30, 15, 0.06, 0.02};
    run.certificate = CertificateFigures{holds, 300, holds ? 0U : 7U, 1};
    return run;
}

}  // namespace

int main(int argc, char** argv) {
    std::uint32_t runs = 1000000;
    std::uint64_t shards = 1000;
    std::string out;
    CLI::App program("Writes the shards of an invented campaign, those that are not there yet");
    program.add_option("--runs", runs, "how many runs, a multiple of 40");
    program.add_option("--shards", shards, "how many shards");
    program.add_option("DIR", out, "folder of the shards")->required();
    CLI11_PARSE(program, argc, argv);
    const CampaignPlan plan = plan_for(runs, shards);
    const ShardAssignment assignment(plan);
    for (std::uint64_t shard = 1; shard <= shards; ++shard) {
        const std::filesystem::path folder = std::filesystem::path(out) / shard_folder_name(shard, shards);
        std::filesystem::create_directories(folder);
        const Database database(folder / results_file, true);
        database.execute("PRAGMA synchronous = OFF");
        if (!is_new(database)) {
            continue;
        }
        Transaction all(database);
        write_plan(database, plan, shard);
        RunWriter writer(database);
        for (std::size_t s = 0; s < plan.seeds.size(); ++s) {
            for (std::size_t e = 0; e < experiment_count; ++e) {
                for (std::size_t p = 0; p < planner_count; ++p) {
                    if (assignment.shard_of(e, p, s) == shard) {
                        writer.add(run_of(e, p, plan.seeds[s]));
                    }
                }
            }
        }
        writer.count();
        all.commit();
    }
    return 0;
}

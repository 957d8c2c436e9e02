#include "downwash/bench/campaign_shards.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <queue>
#include <utility>

#include "downwash/base/sha256.hpp"
#include "downwash/bench/campaign_store.hpp"

namespace downwash::bench {
namespace {

/// The place of every element of a list, or -1 where another list does not have it.
template <class Element>
std::vector<std::ptrdiff_t> places(const std::vector<Element>& of, const std::vector<Element>& in) {
    std::vector<std::ptrdiff_t> found;
    for (const Element& element : of) {
        const auto place = std::find(in.begin(), in.end(), element);
        found.push_back(place != in.end() ? place - in.begin() : -1);
    }
    return found;
}

/// The mean time of a run of each experiment and planner [s]; 0 where the pilot has none.
std::vector<double> measured_s(const CampaignPlan& plan, const std::filesystem::path& pilot) {
    const std::size_t planners = plan.planners.size();
    std::vector<double> sums_s(plan.experiments.size() * planners), counts(sums_s.size());
    std::vector<std::ptrdiff_t> experiment_of, planner_of;
    read_runs(
        pilot,
        [&](const CampaignPlan& measured) {
            experiment_of = places(measured.experiments, plan.experiments);
            planner_of = places(measured.planners, plan.planners);
        },
        [&](const Run& run) {
            if (experiment_of[run.experiment] >= 0 && planner_of[run.planner] >= 0) {
                const auto cell = static_cast<std::size_t>(experiment_of[run.experiment]) * planners +
                                  static_cast<std::size_t>(planner_of[run.planner]);
                sums_s[cell] += run.wall_s;
                ++counts[cell];
            }
        });
    for (std::size_t cell = 0; cell < sums_s.size(); ++cell) {
        sums_s[cell] = counts[cell] > 0 ? sums_s[cell] / counts[cell] : 0;
    }
    return sums_s;
}

}  // namespace

ShardAssignment::ShardAssignment(const CampaignPlan& plan)
    : planners_(plan.planners.size()), seeds_(plan.seeds.size()), shards_(plan.run_count()) {
    const ShardPlan& shards = plan.shards.value();
    const std::size_t cells = plan.experiments.size() * planners_;
    const auto cost_us = [&](std::size_t cell) {
        return cell < shards.cell_costs_us.size() ? shards.cell_costs_us[cell] : std::uint64_t{1};
    };
    std::vector<std::size_t> slowest_first(cells);
    std::iota(slowest_first.begin(), slowest_first.end(), std::size_t{0});
    std::stable_sort(slowest_first.begin(), slowest_first.end(),
                     [&](std::size_t a, std::size_t b) { return cost_us(a) > cost_us(b); });
    using Load = std::pair<std::uint64_t, std::uint32_t>;  // time of all its runs [us], number
    std::priority_queue<Load, std::vector<Load>, std::greater<>> least_loaded;
    for (std::uint64_t number = 1; number <= shards.count; ++number) {
        least_loaded.emplace(0, static_cast<std::uint32_t>(number));
    }
    for (const std::size_t cell : slowest_first) {
        for (std::size_t seed = 0; seed < seeds_; ++seed) {
            auto [load_us, number] = least_loaded.top();
            least_loaded.pop();
            shards_[cell * seeds_ + seed] = number;
            least_loaded.emplace(load_us + cost_us(cell), number);
        }
    }
}

std::uint64_t ShardAssignment::shard_of(std::size_t experiment, std::size_t planner, std::size_t seed_place) const {
    return shards_[(experiment * planners_ + planner) * seeds_ + seed_place];
}

std::size_t ShardAssignment::run_count(std::uint64_t shard) const {
    return static_cast<std::size_t>(std::count(shards_.begin(), shards_.end(), shard));
}

ShardPlan shard_plan_of(const CampaignPlan& plan, const ShardRequest& request) {
    if (request.count > plan.run_count()) {
        throw CampaignError(fmt::format("{} shards are more than the campaign has runs: expected at most {}",
                                        request.count, plan.run_count()));
    }
    ShardPlan shards{request.count, {}};
    if (request.pilot.empty()) {
        return shards;
    }
    const std::vector<double> times_s = measured_s(plan, request.pilot);
    const auto known =
        static_cast<double>(std::count_if(times_s.begin(), times_s.end(), [](double t) { return t > 0; }));
    if (known == 0) {
        throw CampaignError(request.pilot.string() +
                            " has no run of the campaign's problems, objectives and planners: expected the results of "
                            "the same campaign with fewer seeds");
    }
    const double mean_s = std::accumulate(times_s.begin(), times_s.end(), 0.0) / known;
    for (const double time_s : times_s) {
        constexpr double us_per_s = 1e6;
        shards.cell_costs_us.push_back(
            static_cast<std::uint64_t>(std::max(1.0, std::round(us_per_s * (time_s > 0 ? time_s : mean_s)))));
    }
    return shards;
}

std::string costs_text(const ShardPlan& shards) {
    if (shards.cell_costs_us.empty()) {
        return "all runs take as long";
    }
    std::string text;
    for (const std::uint64_t cost_us : shards.cell_costs_us) {
        text += std::to_string(cost_us) + " ";
    }
    return sha256_hex(text);
}

std::string shard_folder_name(std::uint64_t number, std::uint64_t count) {
    const auto digits = static_cast<int>(std::max<std::size_t>(4, std::to_string(count).size()));
    return fmt::format("shard-{:0{}}-of-{:0{}}", number, digits, count, digits);
}

}  // namespace downwash::bench

#include "downwash/bench/run_figures.hpp"

#include <limits>

namespace downwash::bench {
namespace {

/// The value that is kept for a key; of equal keys it is the same one.
template <class Key, class Value>
std::shared_ptr<const Value> shared(std::map<Key, std::shared_ptr<const Value>>& kept, const Key& key,
                                    const Value& value) {
    const auto [found, is_new] = kept.emplace(key, nullptr);
    if (is_new) {
        found->second = std::make_shared<const Value>(value);
    }
    return found->second;
}

}  // namespace

RunFigures FiguresMaker::figures_of(const Run& run) {
    constexpr double infinite = std::numeric_limits<double>::infinity();
    RunFigures figures;
    figures.experiment = run.experiment;
    figures.planner = run.planner;
    figures.seed = run.seed;
    figures.status = run.status;
    figures.wall_s = run.wall_s;
    figures.first_solution_s = run.first_solution_s;
    figures.nearest_approach_m = run.nearest_approach_m.value_or(std::numeric_limits<double>::quiet_NaN());
    figures.first_certified_s = run.first_certified_s.value_or(infinite);
    figures.discarded = run.discarded;
    if (run.flight) {
        figures.outcome = run.flight->outcome;
        figures.flight_cost = run.flight->cost;
        figures.duration_s = run.flight->duration_s;
        figures.min_clearance_m = run.flight->min_clearance_m;
    }
    if (run.certificate) {
        figures.is_certified = run.certificate->is_given;
    }
    figures.steps.reserve(run.improvements.size());
    for (const Improvement& improvement : run.improvements) {
        figures.steps.push_back({improvement.wall_s, improvement.flown_cost.value_or(improvement.cost)});
    }
    if (run.in_worlds) {
        figures.worlds = run.in_worlds->worlds;
        figures.failures_in_worlds = run.in_worlds->failures;
        Alone alone;
        for (const ParameterFlights& of : run.in_worlds->alone) {
            alone.emplace_back(of.parameter, std::pair(of.fails_low, of.fails_high));
        }
        figures.alone = shared(alone_, alone, run.in_worlds->alone);
    }
    if (!run.error.empty()) {
        figures.error = shared(errors_, run.error, run.error);
    }
    if (run.made_on) {
        figures.machine = shared(machines_, run.made_on->machine, run.made_on->machine);
        figures.load = run.made_on->load;
    }
    return figures;
}

}  // namespace downwash::bench

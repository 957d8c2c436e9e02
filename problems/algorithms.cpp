#include "downwash/problems/algorithms.hpp"

#include <array>
#include <map>
#include <utility>

namespace downwash {
namespace {

constexpr AlgorithmParameter goal_bias{"goal_bias", 0.05, 0, 1, "share of the samples that lie in the goal region"};
constexpr AlgorithmParameter rewire_factor{"rewire_factor", 1.1, 1, 100,
                                           "neighbours, as a multiple of what the theory requires"};

constexpr std::array line_rrt_star{goal_bias, rewire_factor};
constexpr std::array line_rrt_connect{AlgorithmParameter{
    "intermediate_states", 0, 0, 1, "1: every step of an edge becomes a node; 0: its end only", true}};
constexpr std::array informed_rrt_star{goal_bias, rewire_factor};
constexpr std::array bit_star{
    AlgorithmParameter{"samples_per_batch", 100, 1, 100000, "configurations that a batch adds to the graph", true},
    rewire_factor};
constexpr std::array rrt{goal_bias,
                         AlgorithmParameter{"intermediate_states", 1, 0, 1,
                                            "1: every step of an edge becomes a node; 0: its end only", true}};
constexpr std::array sst{
    goal_bias,
    AlgorithmParameter{"selection_radius", 0.6, 0.001, 1000,
                       "radius around a sample; the cheapest node within it is extended [m]"},
    AlgorithmParameter{"pruning_radius", 0.3, 0.001, 1000, "radius within which only the cheapest node stays [m]"}};
constexpr std::array kpiece1{
    goal_bias, AlgorithmParameter{"border_fraction", 0.8, 0, 1, "share of the expansions that start at border cells"},
    AlgorithmParameter{"max_close_samples", 30, 1, 100000, "nodes near the goal that the goal bias draws from", true}};
constexpr std::array est{goal_bias};

/// Our own RRT*. Work is counted in control ticks of the edges.
constexpr std::array own_rrt_star{
    AlgorithmParameter{"first_goal_bias", 0.4, 0, 1, "share of the samples in the goal region before the first plan"},
    AlgorithmParameter{"goal_bias", 0.1, 0, 1, "share of the samples in the goal region after the first plan"},
    AlgorithmParameter{"local_bias", 0.5, 0, 1,
                       "share of the samples near a knot of the best plan (Akgun and Stilman 2011)"},
    AlgorithmParameter{"local_radius_m", 2.0, 0.001, 1000,
                       "largest distance of a sample of local_bias from its knot [m]"},
    AlgorithmParameter{"passage_share", 0, 0, 1,
                       "share of the samples in narrow passages, which are flown through at speed (bridge test, Hsu et "
                       "al. 2003)"},
    AlgorithmParameter{"way_share", 0.5, 0, 1,
                       "in space: share of the samples before the first plan along ways that the level vehicle fits "
                       "through (RRT-Connect)"},
    AlgorithmParameter{"range_share", 0.2, 0.001, 1, "longest edge, as a share of the space's extent"},
    AlgorithmParameter{"optimism", 0.9, 0.01, 1,
                       "an edge is simulated if it wins with this multiple of its cost in free air"},
    AlgorithmParameter{"max_detour", 1.15, 1, 100, "a node is kept up to this multiple of the best plan's cost"},
    AlgorithmParameter{"alternative_distance_m", 0.5, 0, 1000,
                       "the refiner takes a second plan that leads at least this far from the first [m]"},
    AlgorithmParameter{"worthwhile_gain", 0.02, 0, 1,
                       "relative gain from which a better plan is executed during the search"},
    AlgorithmParameter{"final_gain", 1e-6, 0, 1, "worthwhile_gain at the end of the search"},
    AlgorithmParameter{"batch_size", 32, 1, 10000, "samples whose edges are simulated side by side", true},
    AlgorithmParameter{"first_batch_size", 4, 1, 10000, "batch_size before the first plan", true},
    AlgorithmParameter{"round_work", 400000, 1000, 1e9, "ticks that tree and refiner each simulate in a round"},
    AlgorithmParameter{"max_round_work", 1000000, 1000, 1e9, "limit of a round in which a plan is executed"},
    AlgorithmParameter{"execution_tick_work", 150, 0, 1e6,
                       "simulated ticks that take as long as one tick of a plan's execution"},
    AlgorithmParameter{"sample_work", 200, 0, 1e6, "work of a sample apart from its edges"},
    AlgorithmParameter{"usual_sample_work", 1500, 1, 1e6, "work of a sample with its edges, on average"},
    AlgorithmParameter{"refine_work", 2000, 0, 1e6, "work of a refinement step apart from its edges"},
    AlgorithmParameter{"max_rejected_at_end", 4, 1, 1000,
                       "plans rejected by their execution after the end of the search, until it gives up", true},
};

constexpr std::array table{
    AlgorithmInfo{
        "rrt-star", "geometric (mp-arm), kinodynamic (mp-arm-da, mp-arm-ada); anytime",
        "RRT* with refinement, the same for all variants: edges are lines for mp-arm, closed-loop flights for "
        "mp-arm-da and mp-arm-ada",
        true, true, own_rrt_star, own_rrt_star},
    AlgorithmInfo{"ompl-rrt-star", "geometric (mp-arm); anytime", "OMPL's RRT*: straight edges", true, false,
                  line_rrt_star},
    AlgorithmInfo{"rrt-connect", "geometric (mp-arm); ends with the first plan",
                  "OMPL's RRT-Connect: trees of straight edges from start and goal", true, false, line_rrt_connect},
    AlgorithmInfo{"informed-rrt-star", "geometric (mp-arm); anytime",
                  "OMPL's Informed RRT*: like RRT*, but sampling only where a cheaper path may be", true, false,
                  informed_rrt_star},
    AlgorithmInfo{"bit-star", "geometric (mp-arm); anytime",
                  "OMPL's BIT*: heuristic search in batches of random samples", true, false, bit_star},
    AlgorithmInfo{"rrt",
                  "kinodynamic (mp-arm-da, mp-arm-ada); ends with the first plan",
                  "OMPL's RRT over controls: random reference velocities, flown in closed loop",
                  false,
                  true,
                  {},
                  rrt},
    AlgorithmInfo{"sst",
                  "kinodynamic (mp-arm-da, mp-arm-ada); anytime",
                  "OMPL's SST: as rrt, with the cheapest node of each neighbourhood kept",
                  false,
                  true,
                  {},
                  sst},
    AlgorithmInfo{"kpiece1",
                  "kinodynamic (mp-arm-da, mp-arm-ada); ends with the first plan",
                  "OMPL's KPIECE: as rrt, expanding where a grid over places is least covered",
                  false,
                  true,
                  {},
                  kpiece1},
    AlgorithmInfo{"est",
                  "kinodynamic (mp-arm-da, mp-arm-ada); ends with the first plan",
                  "OMPL's EST: as rrt, expanding where the tree is thin",
                  false,
                  true,
                  {},
                  est},
};

}  // namespace

std::span<const AlgorithmInfo> algorithms() {
    return table;
}

std::vector<std::string_view> algorithm_names() {
    std::vector<std::string_view> names;
    names.reserve(std::size(table));
    for (const AlgorithmInfo& algorithm : table) {
        names.push_back(algorithm.name);
    }
    return names;
}

const std::vector<KnownParameter>& known_parameters() {
    static const std::vector<KnownParameter> known = [] {
        std::map<std::string_view, KnownParameter> by_name;
        for (const AlgorithmInfo& algorithm : table) {
            for (const auto& parameters : {algorithm.line_parameters, algorithm.flight_parameters}) {
                for (const AlgorithmParameter& parameter : parameters) {
                    std::vector<std::string_view>& names =
                        by_name.try_emplace(parameter.name, KnownParameter{&parameter, {}}).first->second.algorithms;
                    if (names.empty() || names.back() != algorithm.name) {
                        names.push_back(algorithm.name);
                    }
                }
            }
        }
        std::vector<KnownParameter> all;
        all.reserve(by_name.size());
        for (auto& [name, parameter] : by_name) {
            all.push_back(std::move(parameter));
        }
        return all;
    }();
    return known;
}

std::span<const AlgorithmParameter> algorithm_parameters(const PlannerSettings& settings) {
    for (const AlgorithmInfo& algorithm : table) {
        if (algorithm.name == settings.algorithm) {
            return algorithm.parameters_for(settings.variant);
        }
    }
    return {};
}

const AlgorithmParameter* algorithm_parameter(const PlannerSettings& settings, std::string_view name) {
    for (const AlgorithmParameter& parameter : algorithm_parameters(settings)) {
        if (parameter.name == name) {
            return &parameter;
        }
    }
    return nullptr;
}

double parameter_value(const PlannerSettings& settings, std::string_view name) {
    if (const auto own = settings.parameters.find(name); own != settings.parameters.end()) {
        return own->second;
    }
    return algorithm_parameter(settings, name)->value;
}

}  // namespace downwash

#include <array>

#include "downwash/problems/algorithms.hpp"

namespace downwash {
namespace {

constexpr AlgorithmParameter goal_bias{"goal_bias", 0.05, "share of the samples that lie in the goal region"};
constexpr AlgorithmParameter rewire_factor{"rewire_factor", 1.1, "neighbours over the least that the theory asks for"};

constexpr std::array informed_rrt_star{goal_bias, rewire_factor};
constexpr std::array bit_star{
    AlgorithmParameter{"samples_per_batch", 100, "configurations that a batch adds to the graph"}, rewire_factor};
constexpr std::array rrt{goal_bias, AlgorithmParameter{"intermediate_states", 1,
                                                       "1: every step of an edge becomes a node; 0: its end only"}};
constexpr std::array sst{
    goal_bias,
    AlgorithmParameter{"selection_radius", 0.6, "of the cheapest node near a sample, which is flown on from [m]"},
    AlgorithmParameter{"pruning_radius", 0.3, "within which only the cheapest node stays [m]"}};
constexpr std::array kpiece1{
    goal_bias, AlgorithmParameter{"border_fraction", 0.8, "share of the expansions that start at border cells"},
    AlgorithmParameter{"max_close_samples", 30, "nodes near the goal that the goal bias draws from"}};
constexpr std::array est{goal_bias};

constexpr std::array table{
    AlgorithmInfo{"rrt-star", "geometric (mp-arm), kinodynamic (mp-arm-da, mp-arm-ada); anytime",
                  "RRT*: straight edges by OMPL for mp-arm; closed-loop flights as edges for mp-arm-da and mp-arm-ada, "
                  "parents chosen and nodes rewired by flown cost",
                  true, true},
    AlgorithmInfo{"rrt-connect", "geometric (mp-arm); ends with the first plan",
                  "OMPL's RRT-Connect: trees of straight edges from start and goal", true, false},
    AlgorithmInfo{"informed-rrt-star", "geometric (mp-arm); anytime",
                  "OMPL's Informed RRT*: like RRT*, but sampling only where a cheaper path may be", true, false,
                  informed_rrt_star},
    AlgorithmInfo{"bit-star", "geometric (mp-arm); anytime",
                  "OMPL's BIT*: heuristic search in batches of random samples", true, false, bit_star},
    AlgorithmInfo{"rrt", "kinodynamic (mp-arm-da, mp-arm-ada); ends with the first plan",
                  "OMPL's RRT over controls: random reference velocities, flown in closed loop", false, true, rrt},
    AlgorithmInfo{"sst", "kinodynamic (mp-arm-da, mp-arm-ada); anytime",
                  "OMPL's SST: as rrt, with the cheapest node of each neighbourhood kept", false, true, sst},
    AlgorithmInfo{"kpiece1", "kinodynamic (mp-arm-da, mp-arm-ada); ends with the first plan",
                  "OMPL's KPIECE: as rrt, expanding where a grid over places is least covered", false, true, kpiece1},
    AlgorithmInfo{"est", "kinodynamic (mp-arm-da, mp-arm-ada); ends with the first plan",
                  "OMPL's EST: as rrt, expanding where the tree is thin", false, true, est},
};

}  // namespace

std::span<const AlgorithmInfo> algorithms() {
    return table;
}

}  // namespace downwash

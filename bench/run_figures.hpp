#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "downwash/bench/campaign_data.hpp"

namespace downwash::bench {

/// The cost of the best plan from a moment of a search on.
struct CostStep {
    double wall_s = 0;
    double cost = 0;  ///< executed where the planner executes its plans, otherwise planned
};

/// What a report needs of a run: a million of them have a place in memory.
struct RunFigures {
    std::size_t experiment = 0, planner = 0;
    std::uint32_t seed = 0;
    RunStatus status = RunStatus::none;
    std::optional<Outcome> outcome;  ///< outcome of the executed flight of a solved run
    std::optional<bool> is_certified;
    double wall_s = 0;
    std::optional<double> first_solution_s;
    double flight_cost = 0, duration_s = 0, min_clearance_m = 0;  ///< figures of the executed flight, if there is one
    double nearest_approach_m = 0;                                ///< NaN with a plan
    double first_certified_s = 0;                                 ///< infinite without one
    std::uint64_t discarded = 0;
    std::vector<CostStep> steps;
    std::uint64_t worlds = 0, failures_in_worlds = 0;  ///< none: the plan was not flown in worlds
    std::shared_ptr<const std::vector<ParameterFlights>> alone;
    std::shared_ptr<const std::string> error;  ///< nullptr without one
    std::shared_ptr<const Machine> machine;    ///< nullptr if it was not recorded
    double load = 0;

    [[nodiscard]] bool holds() const { return status == RunStatus::solved && outcome == Outcome::ok; }
    [[nodiscard]] bool has_failed_flight() const {
        return status == RunStatus::solved && outcome && *outcome != Outcome::ok;
    }
};

/// Makes figures of runs. Runs share what is equal.
class FiguresMaker {
 public:
    [[nodiscard]] RunFigures figures_of(const Run& run);

 private:
    using Alone = std::vector<std::pair<std::string, std::pair<bool, bool>>>;

    std::map<Alone, std::shared_ptr<const std::vector<ParameterFlights>>> alone_;
    std::map<std::string, std::shared_ptr<const std::string>> errors_;
    std::map<Machine, std::shared_ptr<const Machine>> machines_;
};

}  // namespace downwash::bench

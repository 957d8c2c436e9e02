#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "downwash/planner/solution.hpp"
#include "downwash/problems/campaign.hpp"

namespace downwash::bench {

/// What all planners of a campaign are compared on: a problem under an objective.
struct Experiment {
    std::string problem;
    std::string objective;  ///< "energy", or a sum for people: "energy + 50 time"

    [[nodiscard]] std::string name() const;            ///< "bridge_inspection, energy"
    [[nodiscard]] std::string_view cost_unit() const;  ///< "J"; empty for a sum
    bool operator==(const Experiment&) const = default;
};

/// "goal_bias 0.2, range_share 0.3"; empty for none.
[[nodiscard]] std::string text_of(const ParameterValues& parameters);

/// One way to plan.
struct PlannerSetup {
    Variant variant = Variant::mp_arm_ada;
    std::string algorithm;
    std::optional<double> margin_m = {};  ///< empty: the problem's own
    ParameterValues parameters = {};      ///< over the problem's own

    [[nodiscard]] std::string name() const;  ///< "mp-arm-ada rrt-star, goal_bias 0.2, margin 0.1 m"
    bool operator==(const PlannerSetup&) const = default;
};

/// How the runs of a campaign are dealt out to shards; see ShardAssignment.
struct ShardPlan {
    std::uint64_t count = 1;
    /// Expected time of a run of each experiment and planner, experiments outermost [us]; empty: all runs take as long.
    std::vector<std::uint64_t> cell_costs_us = {};

    bool operator==(const ShardPlan&) const = default;
};

/// Everything that a campaign runs, and what the figures depend on.
struct CampaignPlan {
    /// A file of results can only be continued with the settings it was begun with: limits, hashes of problems,
    /// program, machine. Shards may run on any machine, and their settings name none.
    std::vector<std::pair<std::string, std::string>> settings;
    std::vector<Experiment> experiments;
    std::vector<PlannerSetup> planners;
    std::vector<std::uint32_t> seeds;
    std::vector<CampaignExpectation> expectations;
    std::vector<std::string> left_out;   ///< combinations that do not exist, and why
    std::optional<double> time_limit_s;  ///< time limit of one search; empty: none
    bool stop_at_first_solution = false;
    std::uint64_t evaluation_worlds = 0;   ///< in which each reported plan is flown
    std::optional<ShardPlan> shards = {};  ///< the shards of a campaign that is run in shards

    [[nodiscard]] std::size_t run_count() const { return experiments.size() * planners.size() * seeds.size(); }
};

/// The result of a run.
enum class RunStatus : std::uint8_t {
    none,         ///< no plan within the limits
    approximate,  ///< a plan that does not reach the goal
    solved,
    impossible,  ///< the problem cannot be planned with this setup: a start within the margin, ...
    error,       ///< the program failed
};
inline constexpr std::size_t run_status_count = 5;

/// "none", "approximate", "solved", "impossible", "error".
[[nodiscard]] std::string_view name_of(RunStatus status);

/// The flight of a reported plan with direct aerodynamics, hold included.
struct FlightFigures {
    Outcome outcome = Outcome::ok;
    double cost = 0;
    double energy_j = 0;
    double duration_s = 0;
    double length_m = 0;
    double min_clearance_m = 0;  ///< infinity without obstacles
    double goal_error_m = 0;
};

/// How a plan flies with one parameter of the worlds alone at either end of its spread, all else nominal.
struct ParameterFlights {
    std::string parameter;  ///< name of a WorldParameter
    bool fails_low = false, fails_high = false;

    bool operator==(const ParameterFlights&) const = default;
};

/// The flights of a reported plan in the evaluation worlds.
struct WorldFigures {
    std::uint64_t worlds = 0;
    std::uint64_t failures = 0;
    std::vector<ParameterFlights> alone;  ///< flights with each parameter alone that is not exact

    bool operator==(const WorldFigures&) const = default;
};

/// The certificate of a plan: see Certificate.
struct CertificateFigures {
    bool is_given = false;
    std::uint64_t worlds = 0;
    std::uint64_t failures = 0;
    std::uint64_t attempts = 0;

    bool operator==(const CertificateFigures&) const = default;
};

/// A computer.
struct Machine {
    std::string host;
    std::string processor;        ///< its model: "AMD EPYC 7B13"
    std::string instruction_set;  ///< the widest that our flights use there: "avx2"

    auto operator<=>(const Machine&) const = default;  // NOLINT(modernize-use-nullptr): clang-tidy 14 misreads it
};

/// Where a run was made.
struct RunMachine {
    Machine machine;
    double load = 0;  ///< processes that ran or waited to run, mean of the last minute before the run ended

    bool operator==(const RunMachine&) const = default;
};

/// One search and the flight of its plan.
struct Run {
    std::size_t experiment = 0;  ///< in the campaign's plan
    std::size_t planner = 0;
    std::uint32_t seed = 0;
    RunStatus status = RunStatus::none;
    double wall_s = 0;                       ///< from the parsed problem to the answer, flight included
    std::optional<double> first_solution_s;  ///< from the parsed problem to the first accepted plan
    std::optional<double> cost;              ///< the planner's own figure
    /// Without a plan: the nearest approach to the goal region [m].
    std::optional<double> nearest_approach_m;
    std::uint64_t iterations = 0;
    std::uint64_t edges_simulated = 0;
    std::uint64_t states_checked = 0;
    double simulated_s = 0;
    std::uint64_t discarded = 0;            ///< aware plans whose direct flight failed and that were not reported
    std::vector<Improvement> improvements;  ///< their times are from the parsed problem on, too
    std::map<std::string, std::uint64_t> rejections;  ///< edges by cause
    std::optional<FlightFigures> flight;              ///< figures of the flight of a solved run
    std::string error;                                ///< why it is impossible or failed
    std::optional<CertificateFigures> certificate =
        {};  ///< the certificate of its plan, where the problem has an uncertainty
    std::optional<double> first_certified_s = {};  ///< from the parsed problem; of a planner that asks for them
    std::optional<WorldFigures> in_worlds = {};  ///< flights of a solved run in worlds, if the campaign evaluates plans
    std::optional<RunMachine> made_on = {};      ///< empty before it is run

    [[nodiscard]] bool holds() const { return status == RunStatus::solved && flight && flight->outcome == Outcome::ok; }
};

/// Consecutive seeds, both ends included.
struct SeedRange {
    std::uint32_t first = 0, last = 0;
};

/// Seeds by their ranges, in the same order.
[[nodiscard]] std::vector<SeedRange> ranges_of(const std::vector<std::uint32_t>& seeds);

/// "1-200 300": consecutive seeds as one range.
[[nodiscard]] std::string seeds_text(const std::vector<std::uint32_t>& seeds);

}  // namespace downwash::bench

#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "downwash/cli/common_options.hpp"
#include "downwash/cli/exit_code.hpp"
#include "downwash/cli/interruption.hpp"
#include "downwash/cli/planner_options.hpp"
#include "downwash/problems/designed_robot.hpp"
#include "downwash/problems/space_problem.hpp"
#include "downwash/problems/space_problem_model.hpp"
#include "downwash/results/run_folder.hpp"
#include "downwash/results/space_solution_file.hpp"

// What commands do with robots and problems in space that have the same names in the plane.

namespace downwash::cli {

/// `aeromap hold`.
struct HoldInSpace {
    std::string problem;
    std::vector<std::array<double, 3>> places;
    std::vector<double> from, to;  ///< three numbers each, or none
    double step_m = 0.05;
    std::optional<double> yaw_deg;
    std::vector<double> joints_deg;
    int threads = default_threads();
    bool as_json = false;
};
[[nodiscard]] ExitCode hold_in_space(const HoldInSpace& given);

/// `solve`.
struct SolveInSpace {
    std::string problem;
    const PlannerOptions& planner;
    int threads = default_threads();
    std::optional<std::string> out;
    const CommandLimits& limits;
    bool stop_at_first = false, no_cache = false, is_quiet = false, as_json = false, force = false;
};
[[nodiscard]] ExitCode solve_in_space(const SolveInSpace& given);

/// A search in space, and what is done with its result.
struct SearchInSpace {
    std::string problem;  ///< file
    std::shared_ptr<const SpaceProblemModel> model;
    RunFolder& folder;
    std::vector<LocatedError> warnings;
    int threads;
    bool stop_at_first, no_cache, is_quiet, as_json;
    std::string announcement;
    std::optional<SpacePlan> known_plan = {};  ///< of an earlier plan, from which the new one takes over, and
    std::optional<Replanned> replanned = {};   ///< how
};
/// @param interruption made before anything that takes long
[[nodiscard]] ExitCode search_in_space(SearchInSpace given, Interruption& interruption);

/// A flight in space for people: a verdict and a table. @param before rows before those of the flight
/// @param after rows behind them
[[nodiscard]] std::string space_summary(const std::string& verdict, const SpaceSolution& solution,
                                        const std::string& before = {}, const std::string& after = {});

/// `margins`.
[[nodiscard]] ExitCode margins_in_space(const std::string& file, const std::vector<double>& joints_deg, bool as_json);

/// `margins --design`.
struct Design {
    std::string robot;
    SpaceBandwidths bandwidths;
    std::optional<std::string> law;
    bool as_json = false;
};
[[nodiscard]] ExitCode design_gains(const Design& given);

/// Joint angles of --joints-deg [rad]; `otherwise` without them. @throws UsageError beyond the limits of the arm, or
/// with another number of joints
[[nodiscard]] std::vector<double> joints_option(const std::vector<double>& joints_deg, const SpaceRobot& robot,
                                                const std::vector<double>& otherwise);

}  // namespace downwash::cli

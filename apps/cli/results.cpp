#include "downwash/cli/results.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <utility>
#include <vector>

#include "downwash/base/angles.hpp"
#include "downwash/base/text.hpp"
#include "downwash/cli/order_rows.hpp"
#include "downwash/cli/output.hpp"
#include "downwash/cli/run_folder.hpp"
#include "downwash/cli/search_rows.hpp"

namespace downwash::cli {
namespace {

/// The error of a visit beside what the goal allows, where that is one number.
std::string error_text(const Goal& goal, const GoalVisit& visit) {
    std::string error = "error " + millimetres(visit.error_m);
    if (!goal.any_of.empty() || asks_for_contact(goal)) {
        return error;
    }
    const GoalTolerance tolerance = tolerance_of(goal);
    return error + (tolerance.is_disc
                        ? fmt::format(", allowed {:g} m", tolerance.x_m)
                        : fmt::format(", allowed {:g} m in x, {:g} m in z", tolerance.x_m, tolerance.z_m));
}

/// A row for each touch.
std::string touch_rows(const std::optional<VisitOrder>& order, const Execution& flight) {
    std::string text;
    for (std::size_t i = 0; i < flight.goals.size(); ++i) {
        if (!flight.goals[i].touch) {
            continue;
        }
        const TouchRecord& touch = *flight.goals[i].touch;
        const std::string name = flight.goals.size() > 1 ? goal_name(order, i + 1) + ": " : "";
        text += table_row(
            text.empty() ? "contact" : "",
            name + (touch.touched_s > 0
                        ? fmt::format("{:.2f} N, off by {:.2f} N at most, {:.0f} W; from {:.2f} to {:.2f} s",
                                      touch.force_n, touch.force_error_n, touch.power_w, touch.touched_s, touch.left_s)
                        : "none: the surface was not found"));
    }
    return text;
}

/// Where a plan takes over from another one, and how the two join.
std::string flight_rows(const std::vector<Goal>& goals, const Solution& solution, const Execution& flight) {
    std::string text;
    const std::string_view symbol = unit_of(solution.objective);
    const std::string unit = symbol.empty() ? "" : " " + std::string(symbol);
    text += table_row("flight", fmt::format("{}, {}", name_of(flight.outcome),
                                            flight.aero ? "aerodynamics evaluated directly" : "without aerodynamics"));
    text += table_row(
        "cost", fmt::format("{:.6g}{} planned, {:.6g}{} executed", solution.cost, unit, solution.execution_cost, unit));
    text += table_row("duration", fmt::format("{:.2f} s", flight.duration_s));
    text += table_row("energy", fmt::format("{:.6g} J", flight.energy_j));
    text += table_row("goal error", millimetres(flight.goal_error_m));
    if (flight.lateral_m != 0) {
        text += table_row("beside plane", fmt::format("{} to the {}, as the obstacles of this world see it",
                                                      millimetres(std::abs(flight.lateral_m)),
                                                      flight.lateral_m > 0 ? "left" : "right"));
    }
    text += touch_rows(solution.order, flight);
    if (flight.goals.size() > 1 || (solution.order && !solution.order->left_out.empty())) {
        std::vector<bool> met;
        for (const GoalVisit& visit : flight.goals) {
            met.push_back(visit.is_met);
        }
        text += table_row("goals", met_goals_text(solution.order, met));
        for (std::size_t i = 0; i < flight.goals.size(); ++i) {
            if (!flight.goals[i].is_met) {
                text += table_row(
                    "", goal_name(solution.order, i + 1) + " missed: " + error_text(goals[i], flight.goals[i]));
            }
        }
    }
    if (flight.unseen_share && *flight.unseen_share > 0) {
        text += table_row("unseen space",
                          fmt::format("a part of the robot is in it for {:.1f} % of the flight; it counts as free",
                                      100 * *flight.unseen_share));
    }
    text += table_row("min. clearance",
                      std::isfinite(flight.min_clearance_m) ? millimetres(flight.min_clearance_m) : "no obstacles");
    return text;
}

}  // namespace

std::filesystem::path default_folder(const std::string& name, const PlannerSettings& planner) {
    return std::filesystem::path("downwash-out") /
           fmt::format("{}-{}-{}", name, name_of(planner.variant), planner.seed);
}

std::filesystem::path default_folder(const Problem& problem) {
    return default_folder(problem.name, problem.planner);
}

std::string millimetres(double length_m) {
    return !std::isfinite(length_m) ? "without limit" : to_fixed_text(length_m, 3) + " m";
}

std::string file_rows(const std::filesystem::path& folder, const std::string& names) {
    std::string text = table_row("files", (folder / "").string() + "{" + names + "}");
    if (std::error_code ignored; std::filesystem::exists(folder / run_page_name, ignored)) {
        text += table_row("page", (folder / run_page_name).string());
    }
    if (const std::string others = other_files_in(folder); !others.empty()) {
        text += table_row("kept", others + ": of before, not of this run");
    }
    return text;
}

std::string takeover_rows(const Replanned& from, const std::string& place, bool has_worlds, std::string_view unit) {
    std::string text = table_row("starts", fmt::format("at {:.2f} s of {}: {}", from.t_s, from.plan, place));
    text += table_row("", from.same_reference_s
                              ? fmt::format("with its reference, speed and acceleration; both plans are the same for "
                                            "{:.2f} s more",
                                            *from.same_reference_s)
                              : "no plan takes over");
    text +=
        table_row("earlier plan", fmt::format("its rest ends {} here{}, cost {:.6g}{}{}", name_of(from.rest_outcome),
                                              has_worlds ? ", in the nominal world" : "", from.rest_cost,
                                              unit.empty() ? "" : " ", unit));
    return text;
}

std::string most_stopping(const std::map<std::string, std::uint64_t>& stopped_by) {
    constexpr std::size_t most = 3;
    std::vector<std::pair<std::string, std::uint64_t>> all(stopped_by.begin(), stopped_by.end());
    std::ranges::stable_sort(all, std::ranges::greater(), [](const auto& each) { return each.second; });
    std::string text;
    for (std::size_t i = 0; i < std::min(most, all.size()); ++i) {
        text += fmt::format("{}{} {}", i > 0 ? ", " : "", all[i].first, all[i].second);
    }
    return text + (all.size() > most ? fmt::format(", and {} others", all.size() - most) : "");
}

std::string verdict_on_flight(const Execution& flight) {
    return verdict_on_outcome(flight.outcome, flight.aero, "reaches the goal and hovers there.");
}

std::string verdict_on_outcome(Outcome outcome, bool aero, const std::string& ok) {
    const std::string name = aero ? "The flight with direct aerodynamics " : "The flight in free air ";
    switch (outcome) {
        case Outcome::ok:
            return name + ok;
        case Outcome::collision:
            return name + "ends in a collision.";
        case Outcome::unstable:
            return name + "becomes unstable.";
        case Outcome::left_flyable_area:
            return name + "leaves the flyable area.";
        case Outcome::over_budget:
            return name + "takes more energy than it may.";
        case Outcome::goal_missed:
            break;
    }
    return name + "misses the goal.";
}

std::optional<LocatedError> unseen_warning(const Solution& solution, const std::string& problem) {
    const std::optional<double> share = solution.execution ? solution.execution->unseen_share : std::nullopt;
    if (!share || *share <= 0) {
        return std::nullopt;
    }
    return LocatedError{problem, 1, 1,
                        fmt::format("for {:.1f} % of its flight a part of the robot is in space of an octree that no "
                                    "sensor saw: it counts as free, but anything may stand there; `unknown: occupied` "
                                    "makes it solid",
                                    100 * *share)};
}

std::string summary_of(const std::string& verdict, const Problem& problem, const Solution& solution,
                       const std::filesystem::path& folder) {
    std::string text = verdict + "\n\n";
    text +=
        table_row("status", fmt::format("{} ({}, {}, {}, seed {})", name_of(solution.status), name_of(solution.variant),
                                        solution.algorithm, text_of(solution.objective), solution.seed));
    if (solution.execution_world) {
        text += table_row("world", fmt::format("{} of seed {}; the certificate and the search are those of the plan",
                                               solution.execution_world->index, solution.execution_world->seed));
    }
    if (solution.replanned) {
        const Start& start = problem.start;
        const double speed_m_s = std::hypot(start.velocity[plane::x], start.velocity[plane::z]);
        text += takeover_rows(*solution.replanned,
                              fmt::format("x {:.3f} m, z {:.3f} m, arm {:.1f} deg, {:.2f} m/s", start.at[plane::x],
                                          start.at[plane::z], start.at[plane::arm] * degrees_per_radian, speed_m_s),
                              problem.uncertainty.has_value(), unit_of(solution.objective));
    }
    if (solution.order) {
        text += order_rows(*solution.order, solution.plan.has_value(), problem.energy_budget_j);
    }
    if (solution.execution) {
        text += flight_rows(goals_of(in_order(problem, solution.order)), solution, *solution.execution);
    }
    text += search_rows(solution, folder);
    return text + file_rows(folder, "solution.json, trajectory.csv, tree.csv, effective.yaml");
}

ExitCode exit_code_of(const Solution& solution) {
    if (solution.status != Status::solved || !solution.execution) {
        return ExitCode::no_solution;
    }
    return solution.execution->outcome == Outcome::ok ? ExitCode::done : ExitCode::flight_failed;
}

}  // namespace downwash::cli

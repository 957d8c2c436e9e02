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
#include "downwash/problems/cut_off_goals.hpp"

namespace downwash::cli {
namespace {

std::string counted_cause(const std::pair<const std::string, std::uint64_t>& cause) {
    return fmt::format("{} {}", cause.first, cause.second);
}

std::string rejections(const SearchRecord& record) {
    std::string text;
    for (const auto& [cause, count] : record.rejected) {
        if (count > 0) {
            text += fmt::format("{}{} {}", text.empty() ? "" : ", ", cause, count);
        }
    }
    return text.empty() ? "none" : text;
}

/// The error of a visit beside what the goal allows, where that is one number.
std::string error_text(const Goal& goal, const GoalVisit& visit) {
    std::string error = "error " + millimetres(visit.error_m);
    if (!goal.any_of.empty()) {
        return error;
    }
    const GoalTolerance tolerance = tolerance_of(goal);
    return error + (tolerance.is_disc
                        ? fmt::format(", allowed {:g} m", tolerance.x_m)
                        : fmt::format(", allowed {:g} m in x, {:g} m in z", tolerance.x_m, tolerance.z_m));
}

/// The goal that the search did not get to.
std::string missed_goal(const Solution& solution) {
    return solution.missed_goal ? goal_name(solution.order, *solution.missed_goal) : "the goal";
}

std::string missed_region(const Solution& solution) {
    return solution.missed_goal ? "the region of " + missed_goal(solution) : "the goal region";
}

/// Whether what a solution says of worlds is of the way to a goal before the last.
bool is_about_part(const Solution& solution) {
    return solution.missed_goal && solution.execution && *solution.missed_goal < solution.execution->goals.size();
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
    if (flight.touch) {
        const TouchRecord& touch = *flight.touch;
        text += table_row(
            "contact",
            touch.touched_s > 0
                ? fmt::format("{:.2f} N, off by {:.2f} N at most, {:.0f} W; from {:.2f} to {:.2f} s", touch.force_n,
                              touch.force_error_n, touch.power_w, touch.touched_s, touch.left_s)
                : "none: the surface was not found");
    }
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

namespace {

/// @param is_of_part of a plan that ends before the last goal, which gets none
std::string certificate_rows(const Certificate& certificate, bool is_of_part, const std::filesystem::path& folder) {
    const auto& probability = certificate.failure_probability;
    const std::string name = is_of_part ? "screening" : "certificate";
    const std::string outcome = is_of_part ? "not passed" : certificate.is_given ? "given" : "not given";
    if (certificate.worlds == 0) {
        return table_row(name, outcome + ": the search ended before its first flights");
    }
    std::string text =
        table_row(name, fmt::format("{}: {} of {} worlds fail, failure probability {:.4f} to {:.4f} ({:g} %)", outcome,
                                    certificate.failures, certificate.worlds, probability.low, probability.high,
                                    100 * certificate.confidence)) +
        table_row("", "clearance " + millimetres(certificate.clearance_m.p01) + " or more in 99 % of the worlds, " +
                          millimetres(certificate.clearance_m.p50) + " in half of them");
    if (!certificate.causes.empty()) {
        text += table_row("", joined(certificate.causes, ", ", counted_cause) + "; to see one of them:");
        text +=
            table_row("", fmt::format("downwash execute {} --plan {} --world {}", shell_word(folder / "effective.yaml"),
                                      shell_word(folder), certificate.worst.front().world));
    }
    return text;
}

/// Whether the search never came to its goal, and nothing says that it cannot.
bool was_out_of_reach(const Solution& solution) {
    const auto& off_m = solution.nearest_approach_m;
    const bool is_closed = solution.obstruction && solution.obstruction->cause == "closed_plane";
    return solution.status != Status::solved && !solution.interrupted && off_m && *off_m > 0 && !is_closed &&
           solution.planning.candidates.checked == 0;
}

}  // namespace

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

std::string stops_row(double share_without) {
    return table_row("stops", share_without > 0
                                  ? fmt::format("none is known to be safe for {:.1f} % of the way", 100 * share_without)
                                  : "safe all along the way");
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

std::string verdict_on_search(const Solution& solution) {
    const std::string stopped = solution.interrupted ? "Interrupted. " : "";
    if (solution.status == Status::solved && solution.execution) {
        const bool is_good = solution.execution->outcome == Outcome::ok;
        return stopped + (is_good ? "Solved. " : "A plan was found, but it does not fly. ") +
               verdict_on_flight(*solution.execution);
    }
    if (solution.certificate && !solution.certificate->is_given) {
        const Certificate& certificate = *solution.certificate;
        const bool is_of_part = is_about_part(solution);
        if (!has_failed(certificate)) {
            const std::string what =
                is_of_part
                    ? fmt::format("A way to {} was found, but the search ended before it was flown in enough worlds",
                                  missed_goal(solution))
                    : "A plan was found, but the search ended before it was certified";
            return stopped +
                   fmt::format("{}: {} of {} worlds failed so far.", what, certificate.failures, certificate.worlds);
        }
        if (!is_of_part) {
            return stopped +
                   fmt::format("A plan was found, but in {} of {} worlds its flight fails: it is not certified.",
                               certificate.failures, certificate.worlds);
        }
    }
    if (solution.obstruction && solution.obstruction->cause == "closed_plane") {
        return stopped + fmt::format("No way leads to {} in this plane of motion: {} close{} it.",
                                     solution.order ? "the targets and back" : missed_goal(solution),
                                     quoted_labels(solution.obstruction->obstacles),
                                     solution.obstruction->obstacles.size() == 1 ? "s" : "");
    }
    if (solution.obstruction && solution.obstruction->cause == "certificate") {
        return stopped + fmt::format("No solution within the limits: every way to {} failed in too many worlds.",
                                     missed_goal(solution));
    }
    if (solution.obstruction && solution.obstruction->cause == unfinished_flight) {
        return stopped + fmt::format("A way to {} was found, but the time was over before its flight was.",
                                     missed_goal(solution));
    }
    if (solution.plan && !solution.execution) {
        return stopped + "There is a plan, but its flight was not finished.";
    }
    if (solution.order && !solution.order->left_out.empty() && solution.execution &&
        solution.execution->outcome == Outcome::ok) {
        return stopped + left_out_text(*solution.order);
    }
    if (solution.status == Status::approximate) {
        const auto& off_m = solution.nearest_approach_m;
        return stopped + "No solution within the limits; the nearest approach to " + missed_goal(solution) +
               (off_m ? fmt::format(", {:.3f} m from its region,", *off_m) : "") + " is reported.";
    }
    if (lacks_energy_for_all(solution.order)) {
        return stopped + "No solution: the energy budget is not enough for any target.";
    }
    return stopped + "No solution within the limits.";
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
    if (solution.certificate) {
        text += certificate_rows(*solution.certificate, is_about_part(solution), folder);
    }
    if (solution.safe_stops) {
        text += stops_row(solution.safe_stops->share_without);
    }
    const SearchRecord& record = solution.planning;
    text +=
        table_row("first solution",
                  record.first_solution_wall_s ? fmt::format("after {:.3f} s", *record.first_solution_wall_s) : "none");
    text += table_row("search", fmt::format("{} iterations in {:.2f} s", record.iterations, record.wall_s));
    text += table_row("rejected", rejections(record));
    if (!record.stopped_by.empty()) {
        text += table_row("collisions with", most_stopping(record.stopped_by));
    }
    if (const Candidates& plans = record.candidates; plans.rejected() + plans.unfinished > 0) {
        text += table_row(
            "candidates",
            fmt::format("{} plans were checked: {} failed when executed, {} got no certificate{}{}", plans.checked,
                        plans.failed_execution, plans.failed_certificate,
                        plans.worse_stops > 0 ? fmt::format(", {} had fewer safe stops", plans.worse_stops) : "",
                        plans.unfinished > 0 ? fmt::format(", {} not in time", plans.unfinished) : ""));
    }
    if (record.first_certified_wall_s) {
        text += table_row("first certified", fmt::format("after {:.3f} s", *record.first_certified_wall_s));
    }
    if (solution.nearest_approach_m) {
        text += table_row("nearest approach",
                          fmt::format("{:.3f} m from {}", *solution.nearest_approach_m, missed_region(solution)));
    }
    if (solution.obstruction) {
        const Obstruction& o = *solution.obstruction;
        const bool is_closed = o.cause == "closed_plane";
        if (is_closed) {
            text += table_row("closed by", quoted_labels(o.obstacles));
            text += table_row("", "At no pitch and no arm angle does the vehicle get past within the bounds.");
            text += table_row("", "Move the plane of motion, widen the bounds, or change the scene.");
        } else {
            const std::string link = o.cause == "collision" ? " with " : " near ";
            const std::string by = o.obstacles.empty() ? "" : link + quoted_labels(o.obstacles);
            text += table_row("stopped by",
                              fmt::format("{}{} at x {:.2f} m, z {:.2f} m, arm {:.0f} deg, {:.2f} m from {}", o.cause,
                                          by, o.at[plane::x], o.at[plane::z], o.at[plane::arm] * degrees_per_radian,
                                          o.goal_distance_m, missed_region(solution)));
        }
        if (o.cause == unfinished_certificate) {
            text +=
                table_row("", "The time was over before this plan was flown in enough worlds: give the search more.");
        } else if (o.cause == "certificate") {
            text += table_row("", "The planner discarded every plan: in worlds that the search had not seen");
            text += table_row("", "each failed too often. `downwash solve --remedies` tries what would help.");
        } else if (o.cause == unfinished_flight) {
            text +=
                table_row("", "A flight with direct aerodynamics takes long in this scene: give the search more time.");
        } else if (o.cause == "direct_flight") {
            text += table_row("", "The planner discarded every plan: executed with direct aerodynamics,");
            text += table_row("", "the last one failed or came nearer to an obstacle than the margin.");
        } else if (!is_closed && o.goal_distance_m <= 0) {
            text += table_row("", "The vehicle reached " + missed_region(solution) + " but could not hover there.");
            text += table_row("", "Run `downwash aeromap hold` to check whether a hover is stable.");
        }
    }
    if (was_out_of_reach(solution)) {
        text +=
            table_row("hint", "Nothing proves that no way leads there. Give the search more time (--time-limit) or");
        text += table_row("", "goals on the way (a list of goals); in narrow scenes, set");
        text += table_row("", "planner.parameters.passage_share to 0.3.");
    }
    return text + file_rows(folder, "solution.json, trajectory.csv, tree.csv, effective.yaml");
}

ExitCode exit_code_of(const Solution& solution) {
    if (solution.status != Status::solved || !solution.execution) {
        return ExitCode::no_solution;
    }
    return solution.execution->outcome == Outcome::ok ? ExitCode::done : ExitCode::flight_failed;
}

}  // namespace downwash::cli

#include "downwash/cli/search_rows.hpp"

#include <fmt/core.h>

#include <cstdint>
#include <utility>

#include "downwash/base/angles.hpp"
#include "downwash/base/text.hpp"
#include "downwash/cli/order_rows.hpp"
#include "downwash/cli/output.hpp"
#include "downwash/cli/results.hpp"
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

std::string place_text(const Configuration& at) {
    return fmt::format("x {:.2f} m, z {:.2f} m, arm {:.0f} deg", at[plane::x], at[plane::z],
                       at[plane::arm] * degrees_per_radian);
}
std::string place_text(const SpaceConfiguration& at) {
    return fmt::format("x {:.2f} m, y {:.2f} m, z {:.2f} m, yaw {:.0f} deg", at[space::x], at[space::y], at[space::z],
                       at[space::yaw] * degrees_per_radian);
}

/// The goal that the search did not get to.
template <class Found>
std::string missed_goal(const Found& found) {
    return found.missed_goal ? goal_name(found.order, *found.missed_goal) : "the goal";
}

template <class Found>
std::string missed_region(const Found& found) {
    return found.missed_goal ? "the region of " + missed_goal(found) : "the goal region";
}

/// Whether what a solution says of worlds is of the way to a goal before the last.
template <class Found>
bool is_about_part(const Found& found) {
    return found.missed_goal && found.execution && *found.missed_goal < found.execution->goals.size();
}

template <class Found>
bool is_cut_off(const Found& found) {
    return found.obstruction && found.obstruction->cause == "closed_plane";
}

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

std::string stops_row(double share_without) {
    return table_row("stops", share_without > 0
                                  ? fmt::format("none is known to be safe for {:.1f} % of the way", 100 * share_without)
                                  : "safe all along the way");
}

std::string record_rows(const SearchRecord& record) {
    std::string text =
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
    return text;
}

/// What an obstruction means, and what to do about it.
std::string advice_rows(const std::string& cause, bool is_at_goal, bool is_in_plane, const std::string& region) {
    if (cause == unfinished_certificate) {
        return table_row("", "The time was over before this plan was flown in enough worlds: give the search more.");
    }
    if (cause == "certificate") {
        return table_row("", "The planner discarded every plan: in worlds that the search had not seen") +
               table_row("", is_in_plane
                                 ? "each failed too often. `downwash solve --remedies` tries what would help."
                                 : "each failed too often. Wider tolerances of the goal, or less uncertainty, help.");
    }
    if (cause == unfinished_flight) {
        return table_row("", "A flight with direct aerodynamics takes long in this scene: give the search more time.");
    }
    if (cause == "direct_flight") {
        return table_row("", "The planner discarded every plan: executed with direct aerodynamics,") +
               table_row("", "the last one failed or came nearer to an obstacle than the margin.");
    }
    if (is_at_goal) {
        return table_row("", "The vehicle reached " + region + " but could not hover there.") +
               table_row("", "Run `downwash aeromap hold` to check whether a hover is stable.");
    }
    return {};
}

template <class Found>
std::string obstruction_rows(const Found& found, bool is_in_plane) {
    const auto& o = *found.obstruction;
    if (is_cut_off(found)) {
        return table_row("closed by", quoted_labels(o.obstacles)) +
               table_row("", "At no pitch and no arm angle does the vehicle get past within the bounds.") +
               table_row("", "Move the plane of motion, widen the bounds, or change the scene.");
    }
    const std::string link = o.cause == "collision" ? " with " : " near ";
    const std::string by = o.obstacles.empty() ? "" : link + quoted_labels(o.obstacles);
    return table_row("stopped by", fmt::format("{}{} at {}, {:.2f} m from {}", o.cause, by, place_text(o.at),
                                               o.goal_distance_m, missed_region(found))) +
           advice_rows(o.cause, o.goal_distance_m <= 0, is_in_plane, missed_region(found));
}

/// Whether the search never came to its goal, and nothing says that it cannot.
template <class Solution>
bool was_out_of_reach(const Solution& solution) {
    const auto& off_m = solution.nearest_approach_m;
    return solution.status != Status::solved && !solution.interrupted && off_m && *off_m > 0 && !is_cut_off(solution) &&
           solution.planning.candidates.checked == 0;
}

template <class Solution>
std::string rows_of(const Solution& solution, const std::filesystem::path& folder, bool is_in_plane) {
    std::string text;
    if (solution.certificate) {
        text += certificate_rows(*solution.certificate, is_about_part(solution), folder);
    }
    if (solution.safe_stops) {
        text += stops_row(solution.safe_stops->share_without);
    }
    text += record_rows(solution.planning);
    if (solution.nearest_approach_m) {
        text += table_row("nearest approach",
                          fmt::format("{:.3f} m from {}", *solution.nearest_approach_m, missed_region(solution)));
    }
    if (solution.obstruction) {
        text += obstruction_rows(solution, is_in_plane);
    }
    if (was_out_of_reach(solution)) {
        text +=
            table_row("hint", "Nothing proves that no way leads there. Give the search more time (--time-limit) or");
        text += table_row(
            "", std::string("goals on the way (a list of goals)") + (is_in_plane ? "; in narrow scenes, set" : "."));
        if (is_in_plane) {
            text += table_row("", "planner.parameters.passage_share to 0.3.");
        }
    }
    return text;
}

template <class Solution>
std::string verdict_on(const Solution& solution, bool aero) {
    const std::string stopped = solution.interrupted ? "Interrupted. " : "";
    if (solution.status == Status::solved && solution.execution) {
        const bool is_good = solution.execution->outcome == Outcome::ok;
        return stopped + (is_good ? "Solved. " : "A plan was found, but it does not fly. ") +
               verdict_on_outcome(solution.execution->outcome, aero, "reaches the goal and hovers there.");
    }
    if (solution.certificate && !solution.certificate->is_given) {
        const Certificate& certificate = *solution.certificate;
        const bool is_of_part = is_about_part(solution);
        if (!certificate.is_refused) {
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
    if (is_cut_off(solution)) {
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

}  // namespace

std::string verdict_on_search(const Solution& solution, bool aero) {
    return verdict_on(solution, aero);
}

std::string verdict_on_search(const SpaceSearchResult& solution, bool aero) {
    return verdict_on(solution, aero);
}

std::string search_rows(const Solution& solution, const std::filesystem::path& folder) {
    return rows_of(solution, folder, true);
}

std::string search_rows(const SpaceSearchResult& solution, const std::filesystem::path& folder) {
    return rows_of(solution, folder, false);
}

}  // namespace downwash::cli

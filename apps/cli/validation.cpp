#include "downwash/cli/validation.hpp"

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

#include "downwash/base/text.hpp"

namespace downwash::cli {
namespace {

constexpr std::size_t most_shown = 5;  ///< parameters and worst worlds in the table

Json json_of(const judge::Disagreement::Value& value) {
    return std::visit([](const auto& of) { return Json(of); }, value);
}

std::string text_of(const judge::Disagreement::Value& value) {
    if (const auto* number = std::get_if<double>(&value)) {
        return fmt::format("{:.6g}", *number);
    }
    return std::get<std::string>(value);
}

Json json_of(const judge::Probability& p) {
    return {{"estimate", p.estimate}, {"low", p.low}, {"high", p.high}};
}

Json quantiles(const std::array<double, 3>& values) {
    return {{"p50", finite(values[0])}, {"p90", finite(values[1])}, {"p99", finite(values[2])}};
}

void add_runs(Json& document, const judge::WorldRuns& worlds) {
    document["runs"] = worlds.runs.size();
    document["collisions"] = worlds.collisions;
    document["lateral_collisions"] = worlds.lateral_collisions;
    document["collision_probability"] = json_of(worlds.collision_probability);
    document["failures"] = worlds.failures;
    document["failure_probability"] = json_of(worlds.failure_probability);
    document["clearance_m"] = {{"p01", finite(worlds.clearance_p01_m)},
                               {"p10", finite(worlds.clearance_p10_m)},
                               {"p50", finite(worlds.clearance_p50_m)}};
    document["tracking_error_m"] = quantiles(worlds.tracking_error_m);
    document["run_energy_j"] = quantiles(worlds.energy_j);
    Json& sensitivity = document["sensitivity"] = Json::array();
    for (const judge::Sensitivity& each : worlds.sensitivity) {
        sensitivity.push_back(
            {{"parameter", each.parameter},
             {"rank_correlation", cli::json_of(each.rank_correlation)},
             {"failure_share_by_decile", each.failure_share_by_decile ? Json(*each.failure_share_by_decile) : Json()}});
    }
    Json& worst = document["worst"] = Json::array();
    for (const judge::WorldRun& run : worlds.worst) {
        worst.push_back({{"world", run.world},
                         {"outcome", name_of(run.outcome)},
                         {"min_clearance_m", finite(run.min_clearance_m)}});
    }
}

std::string metres(double value) {
    return std::isfinite(value) ? to_fixed_text(value, 3) + " m" : "no obstacles";
}

std::string verdict_of(const Validation& validation) {
    std::string text;
    switch (validation.flight.outcome) {
        case judge::Outcome::ok:
            text = "The flight reaches the goal and hovers there";
            break;
        case judge::Outcome::collision:
            text = validation.flight.is_lateral_collision ? "The flight ends in a collision beside its plane"
                   : validation.is_self_collision         ? "The flight ends in a collision of the robot with itself"
                                                          : "The flight ends in a collision";
            break;
        case judge::Outcome::unstable:
            text = "The flight becomes unstable";
            break;
        case judge::Outcome::left_flyable_area:
            text = "The flight leaves the flyable area";
            break;
        case judge::Outcome::over_budget:
            text = "The flight takes more energy than it may";
            break;
        case judge::Outcome::goal_missed:
            text = "The flight misses the goal";
            break;
    }
    const std::size_t count = validation.disagreements.size();
    if (count > 0) {
        text += fmt::format(", and the file is contradicted in {} place{}", count, count == 1 ? "" : "s");
    } else if (validation.has_flight_claims) {
        text += ", as the file says";
    }
    return (validation.is_valid() ? "Valid. " : "Not valid. ") + text + ".";
}

std::string interval(const char* what, std::size_t count, std::size_t runs, const judge::Probability& p) {
    return fmt::format("{} of {} {}: probability {:.4f}, 95 % interval {:.4f} to {:.4f}", count, runs, what, p.estimate,
                       p.low, p.high);
}

std::string text_of(const judge::WorldRuns& worlds, const std::string& fly_one) {
    const std::size_t runs = worlds.runs.size();
    std::string text;
    text += table_row("failures", interval("worlds", worlds.failures, runs, worlds.failure_probability));
    text += table_row("collisions", interval("worlds", worlds.collisions, runs, worlds.collision_probability));
    if (worlds.lateral_collisions > 0) {
        text += table_row(
            "", fmt::format("{} of them only because the vehicle is beside its plane", worlds.lateral_collisions));
    }
    text += table_row("clearance", fmt::format("p01 {}, p10 {}, p50 {}", metres(worlds.clearance_p01_m),
                                               metres(worlds.clearance_p10_m), metres(worlds.clearance_p50_m)));
    text += table_row("tracking error",
                      fmt::format("p50 {}, p90 {}, p99 {}", metres(worlds.tracking_error_m[0]),
                                  metres(worlds.tracking_error_m[1]), metres(worlds.tracking_error_m[2])));
    text += table_row("energy of runs", fmt::format("p50 {:.6g} J, p90 {:.6g} J, p99 {:.6g} J", worlds.energy_j[0],
                                                    worlds.energy_j[1], worlds.energy_j[2]));
    std::vector<judge::Sensitivity> ranked = worlds.sensitivity;
    std::stable_sort(ranked.begin(), ranked.end(), [](const judge::Sensitivity& a, const judge::Sensitivity& b) {
        return std::abs(a.rank_correlation.value_or(0)) > std::abs(b.rank_correlation.value_or(0));
    });
    for (std::size_t i = 0; i < std::min(most_shown, ranked.size()); ++i) {
        if (ranked[i].rank_correlation) {
            text +=
                table_row(i == 0 ? "matters most" : "", fmt::format("{:<28} rank correlation with clearance {:+.2f}",
                                                                    ranked[i].parameter, *ranked[i].rank_correlation));
        }
    }
    for (std::size_t i = 0; i < std::min(most_shown, worlds.worst.size()); ++i) {
        const judge::WorldRun& run = worlds.worst[i];
        text += table_row(i == 0 ? "worst worlds" : "", fmt::format("{:<8} {}, clearance {}", run.world,
                                                                    name_of(run.outcome), metres(run.min_clearance_m)));
    }
    text += table_row("see one", fmt::format("{} {}", fly_one, worlds.worst.front().world));
    return text;
}

}  // namespace

Json json_of(const Validation& validation) {
    const judge::JudgedFlight& flight = validation.flight;
    Json document;
    if (validation.world) {
        document["world"] = *validation.world;
    }
    document["outcome"] = name_of(flight.outcome);
    document["min_clearance_m"] = finite(flight.min_clearance_m);
    document["energy_j"] = finite(flight.energy_j);
    document["duration_s"] = flight.duration_s;
    document["goal_error_m"] = finite(flight.goal_error_m);
    Json& disagreements = document["disagreements"] = Json::array();
    for (const judge::Disagreement& each : validation.disagreements) {
        disagreements.push_back({{"what", each.what}, {"file", json_of(each.file)}, {"judge", json_of(each.judge)}});
    }
    if (validation.worlds) {
        add_runs(document, *validation.worlds);
    }
    return document;
}

std::string text_of(const Validation& validation, const std::string& fly_one) {
    const judge::JudgedFlight& flight = validation.flight;
    std::string text = verdict_of(validation) + "\n\n";
    if (validation.world) {
        text += table_row("world", std::to_string(*validation.world));
    }
    text += table_row("flight", std::string(name_of(flight.outcome)));
    text += table_row("duration", fmt::format("{:.2f} s", flight.duration_s));
    text += table_row("energy", fmt::format("{:.6g} J", flight.energy_j));
    text += table_row("goal error", metres(flight.goal_error_m));
    text += table_row("min. clearance", metres(flight.min_clearance_m));
    if (!validation.has_flight_claims) {
        text += table_row("file", "says nothing about a flight; only its plan was checked");
    }
    for (std::size_t i = 0; i < validation.disagreements.size(); ++i) {
        const judge::Disagreement& each = validation.disagreements[i];
        text +=
            table_row(i == 0 ? "disagreements" : "", fmt::format("{}: the file says {}, the judge finds {}", each.what,
                                                                 text_of(each.file), text_of(each.judge)));
    }
    if (validation.worlds) {
        text += text_of(*validation.worlds, fly_one);
    }
    return text;
}

}  // namespace downwash::cli

#include "downwash/cli/comparison_text.hpp"

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>

#include "downwash/base/angles.hpp"
#include "downwash/base/text.hpp"
#include "downwash/cli/results.hpp"

namespace downwash::cli {
namespace {

constexpr std::array axis_names{"x", "y", "z"};
constexpr std::size_t most_shown = 5;  ///< times outside the envelope in the table

Json json_of(const ErrorFigures& errors) {
    const auto by_axis = [](const std::array<double, 4>& numbers) {
        return Json{{"x", numbers[0]}, {"y", numbers[1]}, {"z", numbers[2]}, {"distance", numbers[3]}};
    };
    return {{"samples", errors.samples},
            {"mean_m", by_axis(errors.mean_m)},
            {"rms_m", by_axis(errors.rms_m)},
            {"max_m", by_axis(errors.max_m)},
            {"max_at_s", errors.max_at_s}};
}

Json json_of(const AngleFigures& angle) {
    return {{"samples", angle.samples}, {"rms_rad", angle.rms_rad}, {"max_rad", angle.max_rad}};
}

std::string angle_text(const AngleFigures& angle) {
    return fmt::format("rms {:.2f} deg, max {:.2f} deg", angle.rms_rad * degrees_per_radian,
                       angle.max_rad * degrees_per_radian);
}

Json json_of(const LeastClearance& least) {
    return {{"min_m", finite(least.clearance_m)},
            {"at_s", std::isfinite(least.clearance_m) ? Json(least.at_s) : Json()},
            {"obstacle", least.obstacle.empty() ? Json() : Json(least.obstacle)}};
}

Json json_of(const LogAlignment& alignment) {
    return {{"offset_s", alignment.offset_s},
            {"rate", alignment.rate},
            {"is_time_fitted", alignment.is_time_fitted},
            {"is_rate_fitted", alignment.is_rate_fitted},
            {"correlation", alignment.correlation},
            {"yaw_rad", alignment.yaw_rad},
            {"shift_m", alignment.shift_m},
            {"is_frame_fitted", alignment.is_frame_fitted},
            {"residual_m", finite(alignment.residual_m)},
            {"covered", alignment.covered}};
}

Json json_of(const EnvelopeFigures& figures) {
    auto outside = Json::array();
    for (const OutsideTime& time : figures.outside) {
        outside.push_back({{"begin_s", time.begin_s},
                           {"end_s", time.end_s},
                           {"axis", axis_names[time.axis]},
                           {"excess_m", time.excess_m}});
    }
    return {{"worlds", figures.envelope.flown},
            {"first_world", figures.envelope.first},
            {"seed", figures.envelope.seed},
            {"share_outside", figures.share},
            {"expected_axis_share", figures.expected_axis_share},
            {"outside", std::move(outside)}};
}

Json json_of(const LogJump& jump) {
    return {{"at_s", jump.t_s},
            {"what", name_of(jump.kind)},
            {"step_m", jump.step_m},
            {"turn_rad", jump.turn_rad},
            {"source", jump.source}};
}

std::string jump_text(const LogJump& jump) {
    std::string by;
    if (const double step_m = std::sqrt(dot(jump.step_m, jump.step_m)); step_m > 0) {
        by = " by " + millimetres(step_m);
    } else if (jump.turn_rad != 0) {
        by = fmt::format(" by {:.2f} deg", jump.turn_rad * degrees_per_radian);
    }
    return fmt::format("{:.2f} s: {}{} ({})", jump.t_s, name_of(jump.kind), by, excerpt(jump.source));
}

std::string_view source_text(AxesSource source) {
    return source == AxesSource::declared ? "declared" : source == AxesSource::format ? "by format" : "guessed";
}

std::string clearance_text(const LeastClearance& least) {
    if (!std::isfinite(least.clearance_m)) {
        return "no obstacles";
    }
    return fmt::format("{} at {:.2f} s{}", millimetres(least.clearance_m), least.at_s,
                       least.obstacle.empty() ? "" : ", from " + excerpt(least.obstacle));
}

std::string errors_text(const ErrorFigures& errors) {
    const auto mm = [](double metres) { return fmt::format("{:.0f}", 1000 * metres); };
    return errors.samples == 0
               ? "no samples"
               : fmt::format("rms {} mm (x {}, y {}, z {}), max {} mm (x {}, y {}, z {})", mm(errors.rms_m[3]),
                             mm(errors.rms_m[0]), mm(errors.rms_m[1]), mm(errors.rms_m[2]), mm(errors.max_m[3]),
                             mm(errors.max_m[0]), mm(errors.max_m[1]), mm(errors.max_m[2]));
}

std::string jump_rows(const LogComparison& comparison) {
    std::string text =
        table_row("jumps", "the log jumps in flight, as by a reset of the estimator. All errors here contain that");
    for (std::size_t i = 0; i < std::min(comparison.jumps.size(), most_shown); ++i) {
        text += table_row("", jump_text(comparison.jumps[i]));
    }
    if (comparison.jumps.size() > most_shown) {
        text += table_row("", fmt::format("and {} more", comparison.jumps.size() - most_shown));
    }
    return text + table_row("", fmt::format("tracking without {:.0f} s behind each: {}", after_jump_s,
                                            errors_text(comparison.tracking_apart)));
}

std::string thrust_rows(const ThrustFigures& thrust, RotorUnit unit) {
    std::string text =
        table_row("thrust", fmt::format("mean {:.3f} N in the log; planned {:.3f} N, in free air {:.3f} N",
                                        thrust.mean_logged_n, thrust.mean_planned_n, thrust.mean_free_air_n));
    text += table_row("", fmt::format("rms {:.3f} N from the planned flight, {:.3f} N from one in free air",
                                      thrust.rms_with_effects_n, thrust.rms_in_free_air_n));
    if (unit != RotorUnit::newton) {
        text += table_row("", fmt::format("the log has commands without a unit: 1 is fitted to be {:.3f} N for all "
                                          "rotors together",
                                          thrust.unit_n));
    }
    return text;
}

std::string envelope_rows(const EnvelopeFigures& figures) {
    std::string text = table_row(
        "envelope", fmt::format("outside {} worlds' places {:.1f} % of the time; along one axis, one more "
                                "world's flight is outside {:.1f} % of it on average",
                                figures.envelope.flown, 100 * figures.share, 100 * figures.expected_axis_share));
    std::vector<OutsideTime> worst = figures.outside;
    std::ranges::sort(worst, [](const OutsideTime& a, const OutsideTime& b) { return a.excess_m > b.excess_m; });
    worst.resize(std::min(worst.size(), most_shown));
    for (const OutsideTime& time : worst) {
        text += table_row("", fmt::format("{:.2f} to {:.2f} s: by up to {} along {}", time.begin_s, time.end_s,
                                          millimetres(time.excess_m), axis_names[time.axis]));
    }
    if (figures.outside.size() > most_shown) {
        text += table_row("", fmt::format("and {} more times", figures.outside.size() - most_shown));
    }
    return text;
}

}  // namespace

Json json_of(const FlightLog& log) {
    auto series = Json::array();
    for (const NamedSeries& each : named_series) {
        const LogSeries& of = log.*each.series;
        if (!of.empty()) {
            const double span_s = of.t_s.back() - of.t_s.front();
            series.push_back({{"signal", each.name},
                              {"source", of.source},
                              {"rows", of.rows()},
                              {"rate_hz", span_s > 0 ? Json(static_cast<double>(of.rows() - 1) / span_s) : Json()}});
        }
    }
    return {{"files", log.files},
            {"format", name_of(log.format)},
            {"start_s", log.start_s},
            {"duration_s", log.duration_s},
            {"series", std::move(series)}};
}

Json json_of(const ShownComparison& shown, const Json& log) {
    const LogComparison& comparison = shown.comparison;
    Json document{{"schema", "downwash/comparison/v1"}, {"problem", shown.problem}, {"plan", shown.plan}, {"log", log}};
    document["log"]["axes"] = shown.log.recorded_axes == LogAxes::down ? "ned" : "enu";
    document["log"]["axes_source"] = source_text(shown.log.axes_source);
    document["alignment"] = json_of(comparison.alignment);
    document["duration_s"] = comparison.duration_s;
    document["planned_outcome"] = comparison.planned_outcome;
    document["tracking"] = json_of(comparison.tracking);
    document["from_planned_flight"] = json_of(comparison.from_planned);
    Json& jumps = document["jumps"] = Json::array();
    for (const LogJump& jump : comparison.jumps) {
        jumps.push_back(json_of(jump));
    }
    document["tracking_apart_from_jumps"] = comparison.jumps.empty() ? Json() : json_of(comparison.tracking_apart);
    document["yaw"] = comparison.yaw ? json_of(*comparison.yaw) : Json();
    Json& joints = document["joints"] = Json::array();
    for (const AngleFigures& joint : comparison.joints) {
        joints.push_back(json_of(joint));
    }
    Json& phases = document["phases"] = Json::array();
    for (const PhaseFigures& phase : comparison.phases) {
        Json each{{"phase", name_of(phase.phase)},
                  {"duration_s", phase.duration_s},
                  {"min_clearance_m", finite(phase.min_clearance_m)}};
        each.update(json_of(phase.errors));
        phases.push_back(std::move(each));
    }
    document["clearance"] = {{"flown", json_of(comparison.clearance)},
                             {"planned", json_of(comparison.planned_clearance)},
                             {"safety_margin_m", shown.safety_margin_m},
                             {"attitude", comparison.has_attitude ? "log" : "reference"},
                             {"joints", comparison.has_joints ? "log" : "reference"}};
    document["thrust"] = nullptr;
    if (const auto& thrust = comparison.thrust) {
        document["thrust"] = {{"unit_n", thrust->unit_n},
                              {"samples", thrust->samples},
                              {"rms_from_planned_n", thrust->rms_with_effects_n},
                              {"rms_from_free_air_n", thrust->rms_in_free_air_n},
                              {"mean_logged_n", thrust->mean_logged_n},
                              {"mean_planned_n", thrust->mean_planned_n},
                              {"mean_free_air_n", thrust->mean_free_air_n}};
    }
    document["envelope"] = comparison.envelope ? json_of(*comparison.envelope) : Json();
    auto remarks = Json(shown.log.remarks);
    for (const std::string& remark : comparison.alignment.remarks) {
        remarks.push_back(remark);
    }
    document["remarks"] = std::move(remarks);
    return document;
}

std::string text_of(const ShownComparison& shown, const Json& log) {
    const LogComparison& comparison = shown.comparison;
    const LogAlignment& alignment = comparison.alignment;
    std::string text =
        fmt::format("The vehicle was {:.0f} mm from its reference (root mean square), {:.0f} mm at most.{}\n\n",
                    1000 * comparison.tracking.rms_m[3], 1000 * comparison.tracking.max_m[3],
                    comparison.jumps.empty() ? "" : " The log jumps meanwhile: see below.");
    text += table_row("log",
                      fmt::format("{}, {:.1f} s", log["format"].get<std::string>(), log["duration_s"].get<double>()));
    for (const Json& series : log["series"]) {
        text += table_row(
            "", fmt::format(
                    "{}: {}{}", series["signal"].get<std::string>(), excerpt(series["source"].get<std::string>()),
                    series["rate_hz"].is_null() ? "" : fmt::format(", {:.0f} Hz", series["rate_hz"].get<double>())));
    }
    text += table_row(
        "time",
        fmt::format("the plan begins at {:.3f} s of the log ({})", alignment.offset_s,
                    alignment.is_time_fitted ? fmt::format("correlation {:.3f}", alignment.correlation) : "as given"));
    if (alignment.is_rate_fitted) {
        text += table_row("", fmt::format("its clock runs at {:.6f} of the plan's", alignment.rate));
    }
    text +=
        table_row("frame", fmt::format("{} ({}); {}", shown.log.recorded_axes == LogAxes::down ? "NED" : "z up",
                                       source_text(shown.log.axes_source),
                                       alignment.is_frame_fitted
                                           ? fmt::format("turned by {:.2f} deg, moved by ({:.3f}, {:.3f}, {:.3f}) m",
                                                         alignment.yaw_rad * degrees_per_radian, alignment.shift_m[0],
                                                         alignment.shift_m[1], alignment.shift_m[2])
                                           : "taken as the problem's world"));
    text += table_row("", fmt::format("{} are left between the log and the planned flight (root mean square)",
                                      millimetres(alignment.residual_m)));
    text += table_row("covered",
                      fmt::format("{:.1f} % of the plan's {:.2f} s", 100 * alignment.covered, comparison.duration_s));
    text += table_row("tracking", errors_text(comparison.tracking));
    for (const PhaseFigures& phase : comparison.phases) {
        text += table_row("  " + std::string(name_of(phase.phase)), errors_text(phase.errors));
    }
    if (comparison.yaw) {
        text += table_row("  yaw", angle_text(*comparison.yaw));
    }
    for (std::size_t i = 0; i < comparison.joints.size(); ++i) {
        text += table_row(fmt::format("  joint {}", i + 1), angle_text(comparison.joints[i]));
    }
    text += table_row("planned flight", errors_text(comparison.from_planned));
    if (!comparison.jumps.empty()) {
        text += jump_rows(comparison);
    }
    text += table_row("clearance", clearance_text(comparison.clearance));
    text += table_row("  as planned", clearance_text(comparison.planned_clearance));
    if (std::isfinite(comparison.clearance.clearance_m) && (!comparison.has_attitude || !comparison.has_joints)) {
        text += table_row("", fmt::format("with {} of the reference, since the log has none",
                                          comparison.has_attitude ? "the joints"
                                          : comparison.has_joints ? "the attitude"
                                                                  : "attitude and joints"));
    }
    if (comparison.thrust) {
        text += thrust_rows(*comparison.thrust, shown.log.rotor_unit);
    }
    if (comparison.envelope) {
        text += envelope_rows(*comparison.envelope);
    }
    for (const std::vector<std::string>* remarks : {&shown.log.remarks, &alignment.remarks}) {
        for (const std::string& remark : *remarks) {
            text += table_row("note", remark);
        }
    }
    return text;
}

}  // namespace downwash::cli

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "downwash/base/text.hpp"
#include "downwash/cli/common_options.hpp"
#include "downwash/cli/fit_commands.hpp"
#include "downwash/cli/measured_data.hpp"
#include "downwash/cli/model_option.hpp"
#include "downwash/cli/output.hpp"
#include "downwash/cli/usage_error.hpp"
#include "downwash/fitting/effect_fit.hpp"
#include "downwash/fitting/tilt_fit.hpp"
#include "downwash/fitting/wall_fit.hpp"
#include "downwash/report/curve_figure.hpp"

namespace downwash::cli {
namespace {

Json fit_json(const EffectModelInfo& model, const EffectFit& fit, const std::vector<Measurement>& points) {
    auto values = Json::object();
    auto errors = Json::object();
    auto correlation = Json::array();
    auto fixed = Json::array();
    auto at_bound = Json::array();
    for (std::size_t i = 0; i < fit.parameters.size(); ++i) {
        const FittedParameter& parameter = fit.parameters[i];
        values[std::string(parameter.name)] = parameter.value;
        errors[std::string(parameter.name)] = json_of(parameter.standard_error);
        auto row = Json::array();
        for (std::size_t j = 0; j < fit.parameters.size(); ++j) {
            row.push_back(json_of(fit.correlation(i, j)));
        }
        correlation.push_back(std::move(row));
        if (parameter.is_fixed) {
            fixed.push_back(parameter.name);
        }
        if (parameter.is_at_bound) {
            at_bound.push_back(parameter.name);
        }
    }
    auto residuals = Json::array();
    for (std::size_t i = 0; i < points.size(); ++i) {
        residuals.push_back({{"z_over_r", points[i].z_over_r},
                             {"thrust_ratio", points[i].thrust_ratio},
                             {"residual", fit.residuals[i]},
                             {"line", points[i].line}});
    }
    return {{"model", model.name},
            {"parameters", std::move(values)},
            {"rmse", fit.rmse},
            {"n", points.size()},
            {"standard_errors", std::move(errors)},
            {"covariance", fit.covariance},
            {"correlation", std::move(correlation)},
            {"reduced_chi_squared", json_of(fit.reduced_chi_squared)},
            {"converged", fit.is_converged},
            {"fixed", std::move(fixed)},
            {"at_bound", std::move(at_bound)},
            {"undetermined", fit.undetermined},
            {"residuals", std::move(residuals)}};
}

constexpr char outside_remark[] = "  at the end of its range: the data ask for a value outside";

/// A remark to print after the value of a parameter.
std::string remark_on(const FittedParameter& parameter, const EffectFit& fit) {
    if (parameter.is_fixed) {
        return "  fixed";
    }
    if (parameter.is_at_bound) {
        return outside_remark;
    }
    for (const std::string_view name : fit.undetermined) {
        if (name == parameter.name) {
            return (parameter.standard_error ? " +- " + to_text(*parameter.standard_error, 3) : std::string()) +
                   "  not determined: other values fit as well";
        }
    }
    if (parameter.standard_error) {
        return " +- " + to_text(*parameter.standard_error, 3);
    }
    return fit.undetermined.empty() ? "  no standard error: as many parameters as measurements"
                                    : "  no standard error: another parameter is not determined";
}

/// The lines of a problem file for the fitted model, ready to be pasted.
std::string yaml_of(const EffectModelInfo& model, const EffectFit& fit, const std::string& surface) {
    std::string text = "aero:\n  " + surface + ": {model: " + std::string(model.name);
    for (const FittedParameter& parameter : fit.parameters) {
        text += ", " + std::string(parameter.name) + ": " + to_text(parameter.value, 7);
    }
    return text + "}\n";
}

/// @param is_doubtful whether the measurements are likely no thrust ratios
void print_fit(const FitArguments& given, const EffectModelInfo& model, const EffectFit& fit, bool is_doubtful) {
    fmt::print("{}: {}\n", model.name, model.source);
    for (const FittedParameter& parameter : fit.parameters) {
        fmt::print("{:>16} = {}{}\n", parameter.name, to_text(parameter.value, 7), remark_on(parameter, fit));
    }
    for (std::size_t i = 1; i < fit.parameters.size(); ++i) {
        if (const auto correlation = fit.correlation(i - 1, i)) {
            fmt::print("correlation of {} and {}: {:.3f}\n", fit.parameters[i - 1].name, fit.parameters[i].name,
                       *correlation);
        }
    }
    fmt::print("RMSE {} of {} measurements\n", to_text(fit.rmse, 4), fit.residuals.size());
    if (fit.reduced_chi_squared) {
        fmt::print("reduced chi squared {} (about 1 when model and sigmas are right)\n",
                   to_text(*fit.reduced_chi_squared, 4));
    }
    if (!fit.is_converged) {
        fmt::print("The search did not converge; the values are the best it found.\n");
    }
    if (!fit.undetermined.empty()) {
        fmt::print("Not determined by these measurements: {}. Keep a known value with --fix, or add other distances.\n",
                   joined(fit.undetermined, ", "));
    }
    if (is_doubtful || !fit.undetermined.empty()) {
        return;  // nothing to be pasted
    }
    const std::string surface = given.data.surface.empty() ? std::string(model.surface) : given.data.surface;
    if (surface == "ground" || surface == "ceiling") {
        fmt::print("\nFor a problem file:\n{}", yaml_of(model, fit, surface));
    }
}

/// Measurements with the fitted curve and the curve of the model's source; the residuals below.
std::array<CurveFigure, 2> figures_of(const EffectModelInfo& model, const EffectFit& fit,
                                      const std::vector<Measurement>& points, const RotorNeighbours& neighbours) {
    CurveFigure curves;
    curves.title = fmt::format("{} {} {} measurements", model.name, model.parameters.empty() ? "beside" : "fitted to",
                               points.size());
    for (const FittedParameter& parameter : fit.parameters) {
        curves.subtitle += std::string(parameter.name) + " " + to_text(parameter.value, 4) +
                           (parameter.standard_error ? " ± " + to_text(*parameter.standard_error, 2) : "") + ", ";
    }
    curves.subtitle += "RMSE " + to_text(fit.rmse, 4);
    curves.x_label = "z/R";
    curves.y_label = "thrust ratio K";
    curves.level = 1;
    CurveFigure rest;
    rest.x_label = curves.x_label;
    rest.y_label = "measured minus model";
    rest.level = 0;
    MeasuredPoints measured{"measured", {}, {}}, residuals{"residuals", {}, {}};
    double near = points.front().z_over_r, far = near, largest = 1;
    bool all_have_sigma = true;
    for (std::size_t i = 0; i < points.size(); ++i) {
        near = std::min(near, points[i].z_over_r);
        far = std::max(far, points[i].z_over_r);
        largest = std::max(largest, points[i].thrust_ratio);
        measured.points.push_back({points[i].z_over_r, points[i].thrust_ratio});
        residuals.points.push_back({points[i].z_over_r, fit.residuals[i]});
        measured.errors.push_back(points[i].sigma.value_or(0));
        all_have_sigma = all_have_sigma && points[i].sigma;
    }
    if (all_have_sigma) {
        residuals.errors = measured.errors;
    } else {
        measured.errors.clear();
    }
    const auto curve_of = [&](std::string name, const SurfaceEffect& effect) {
        constexpr int steps = 400;
        Curve curve{std::move(name), {}};
        for (int i = 0; i <= steps; ++i) {
            const double z_over_r = near + (far - near) * i / steps;
            const double factor = formula_factor(effect, z_over_r, neighbours);
            // A formula near its pole would dwarf everything else: the curve leaves the picture there.
            curve.points.push_back({z_over_r, factor <= 1.5 * largest ? factor : std::nan("")});
        }
        return curve;
    };
    curves.curves.push_back(curve_of(model.parameters.empty() ? "formula" : "fitted", fit.effect));
    if (!model.parameters.empty()) {
        curves.curves.push_back(curve_of("parameters of its source", model.model));
    }
    const double margin = 0.05 * std::max(far - near, 0.1 * far);
    curves.x_range = rest.x_range = AxisRange{std::max(0.0, near - margin), far + margin};
    curves.measurements.push_back(std::move(measured));
    rest.measurements.push_back(std::move(residuals));
    return {std::move(curves), std::move(rest)};
}

Json score_json(const TiltScore& score) {
    return {{"tilt_loss", score.tilt_loss},
            {"at_bound", score.is_at_bound},
            {"rmse", score.rmse},
            {"max_error", score.max_error},
            {"n", score.points}};
}

/// Refuses what goes with a model only.
void expect_no_model(const FitArguments& given, std::string_view instead) {
    if (!given.model.empty() || !given.fixed.empty() || given.is_weighted || !given.picture.empty() ||
        given.data.rotor_spacing) {
        throw UsageError("{} fits no model: expected neither --model nor --fix, --weighted, --rotor-spacing or --out",
                         instead);
    }
}

ExitCode fit_tilt(const FitArguments& given) {
    expect_no_model(given, "--tilt-loss");
    const TiltFit fit = fit_tilt_loss(given.data.read());
    if (given.as_json) {
        Json json = score_json(fit.fitted);
        json["standard_error"] = json_of(fit.standard_error);
        json["as_level"] = score_json(fit.as_level);
        json["left_out"] = Json::object();
        for (const auto& [source, score] : fit.left_out) {
            json["left_out"][source] = score_json(score);
        }
        print_json(json);
        return ExitCode::done;
    }
    const auto errors = [](const TiltScore& score) {
        return fmt::format("RMSE {:.4f}, largest error {:.4f}", score.rmse, score.max_error);
    };
    fmt::print("tilt_loss = {}{}\n{} of {} measurements with tilt\nas level: {}\n", to_text(fit.fitted.tilt_loss, 3),
               fit.fitted.is_at_bound ? outside_remark
               : fit.standard_error   ? " +- " + to_text(*fit.standard_error, 2)
                                      : "",
               errors(fit.fitted), fit.fitted.points, errors(fit.as_level));
    for (const auto& [source, score] : fit.left_out) {
        fmt::print("{}, fitted to the others: tilt_loss {}{}, {}\n", source, to_text(score.tilt_loss, 3),
                   score.is_at_bound ? " (at a bound)" : "", errors(score));
    }
    return ExitCode::done;
}

Json wall_json(const WallShares& fit) {
    const auto share = [](const WallShare& of) {
        return Json{{"value", of.value},
                    {"standard_error", json_of(of.standard_error)},
                    {"rmse", of.rmse},
                    {"largest", of.largest}};
    };
    return {{"force", share(fit.force)},
            {"moment", share(fit.moment)},
            {"decay_radii", fit.effect.decay_radii},
            {"n", fit.points}};
}

ExitCode fit_wall(const FitArguments& given) {
    expect_no_model(given, "--walls");
    const MeasuredData& data = given.data;
    if (given.of_tilt || !data.surface.empty() || !data.source.empty() || data.from || data.to) {
        throw UsageError("--walls takes all of DATA: expected neither --tilt-loss nor a selection");
    }
    const WallFit fit = fit_walls(read_wall_measurements(given.data.file).points);
    if (given.as_json) {
        Json json = wall_json(fit);
        json["at_bound"] = fit.is_decay_at_bound;
        json["by_facility"] = Json::object();
        for (const auto& [facility, own] : fit.by_facility) {
            json["by_facility"][facility] = wall_json(own);
        }
        print_json(json);
        return ExitCode::done;
    }
    const auto share = [](const WallShare& of) {
        return fmt::format("{:+.4f}{}, RMSE {:.4f}, largest measured {:.4f}", of.value,
                           of.standard_error ? fmt::format(" +- {:.4f}", *of.standard_error) : "", of.rmse, of.largest);
    };
    fmt::print("{} measurements beside a wall\ndecay_radii = {:.2f}{}\n", fit.points, fit.effect.decay_radii,
               fit.is_decay_at_bound ? outside_remark : "");
    fmt::print("force  = {}\nmoment = {}\n", share(fit.force), share(fit.moment));
    for (const auto& [facility, own] : fit.by_facility) {
        fmt::print("{} alone: force {}; moment {}\n", facility, share(own.force), share(own.moment));
    }
    return ExitCode::done;
}

}  // namespace

ExitCode fit_model(const FitArguments& given) {
    if (given.of_walls) {
        return fit_wall(given);
    }
    if (given.of_tilt) {
        return fit_tilt(given);
    }
    if (given.model.empty()) {
        throw UsageError("nothing to fit: expected --model NAME, --tilt-loss or --walls");
    }
    const EffectModelInfo& known = model_named(given.model);
    PictureSettings settings;
    if (!given.picture.empty()) {
        settings.format = picture_format("--out", given.picture);
    }
    FitOptions options;
    options.source = given.data.file;
    options.neighbours = given.data.neighbours();
    if (is_multirotor(known.model) && !given.data.rotor_spacing) {
        throw UsageError(
            "--model {} needs the other rotors: expected --rotor-spacing S, the distance of neighbouring "
            "axes of a square quadrotor in radii",
            known.name);
    }
    options.is_weighted = given.is_weighted;
    for (const std::string& text : given.fixed) {
        options.fixed.push_back(named_number("--fix", text));
    }
    Measurements measurements = given.data.read();
    const bool is_doubtful = given.data.warn_of(measurements);
    const std::size_t tilted =
        std::erase_if(measurements.points, [](const Measurement& point) { return point.tilt_deg != 0; });
    if (measurements.points.empty()) {
        throw UsageError(
            "{} has measurements of tilted rotors only, and the parameters of models are those of level ones",
            given.data.file);
    }
    if (tilted > 0) {
        print_error(
            fmt::format("downwash: {} measurements of tilted rotors are left out; --tilt-loss fits those\n", tilted));
    }
    if (given.data.surface.empty() && measurements.entries("surface").size() > 1) {
        print_error(
            fmt::format("downwash: {} holds several surfaces, and all are fitted together; --surface selects one\n",
                        given.data.file));
    }
    const EffectFit fit = fit_effect(known.model, measurements.points, options);
    if (!given.picture.empty()) {
        write_result(given.picture, draw(figures_of(known, fit, measurements.points, options.neighbours), settings),
                     "--out");
    }
    if (given.as_json) {
        print_json(fit_json(known, fit, measurements.points));
    } else {
        print_fit(given, known, fit, is_doubtful);
    }
    return ExitCode::done;
}

}  // namespace downwash::cli

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <numbers>
#include <utility>

#include "downwash/base/text.hpp"
#include "downwash/cli/measured_data.hpp"
#include "downwash/cli/model_option.hpp"
#include "downwash/cli/plot_request.hpp"
#include "downwash/cli/usage_error.hpp"
#include "downwash/effects/effect_curve.hpp"
#include "downwash/effects/measurements.hpp"
#include "downwash/effects/sided_factor.hpp"

namespace downwash::cli {
namespace {

AxisRange shown_range(const PlotRequest& request) {
    constexpr AxisRange usual{0, 4};
    constexpr double max_distance = 1000;
    if (request.z_over_r.empty()) {
        return usual;
    }
    const auto& given = request.z_over_r;
    if (given.size() != 2 || !(given[0] >= 0 && given[0] < given[1] && given[1] <= max_distance)) {
        throw UsageError("--z-over-r {}{}: expected LOW HIGH in radii, 0 <= LOW < HIGH <= {}", given[0],
                         given.size() > 1 ? fmt::format(" {}", given[1]) : "", max_distance);
    }
    return {given[0], given[1]};
}

/// The tilts that are shown. @throws UsageError
std::vector<double> shown_tilts(const PlotRequest& request) {
    for (const double tilt_deg : request.tilt_deg) {
        if (!(tilt_deg >= 0 && tilt_deg <= 90)) {
            throw UsageError("--tilt-deg {}: expected degrees from 0 to 90", tilt_deg);
        }
    }
    for (const std::string& name : request.models) {
        if (!request.tilt_deg.empty() && model_named(name).surface == "ceiling") {
            throw UsageError(
                "--tilt-deg: expected models of the ground; what tilt does under a ceiling was not measured");
        }
    }
    return request.tilt_deg.empty() ? std::vector<double>{0} : request.tilt_deg;
}

/// What a name says of a tilt.
std::string tilt_text(double tilt_deg) {
    return tilt_deg > 0 ? fmt::format(", {} degrees", to_text(tilt_deg)) : "";
}

Curve curve_of(const std::string& name, double tilt_deg, const PlotRequest& request, const AxisRange& range) {
    constexpr int intervals = 800;
    const EffectModelInfo& model = model_named(name);
    if (model.model == EffectModel::table) {
        throw UsageError(
            "--model table has no curve of its own; plot a problem that uses it, or give its CSV as --data");
    }
    ModelChoice choice;
    choice.name = name;
    choice.max_factor = request.max_factor;
    if (is_multirotor(model.model)) {
        choice.rotor_spacing = request.rotor_spacing;
    }
    const EffectCurve effect = curve_option(choice);
    const double sine = std::sin(tilt_deg * std::numbers::pi / 180);
    Curve curve{std::string(model.name) + tilt_text(tilt_deg), {}, AxisRange{model.valid_from, model.valid_to}};
    for (int i = 0; i <= intervals; ++i) {
        const double z_over_r = range.low + (range.high - range.low) * i / intervals;
        curve.points.push_back(
            {z_over_r, tilted<double>({effect(z_over_r), 1}, {default_ground_tilt_loss, 0}, sine).all});
    }
    return curve;
}

/// The points of one source and surface: one per distance, the mean of repeated ones. The error bars are their standard
/// deviations, or the sigma of a single point.
MeasuredPoints points_of(std::string name, const Measurements& measurements, const AxisRange& range) {
    std::map<double, std::vector<const Measurement*>> at;
    for (const Measurement& point : measurements.points) {
        if (point.z_over_r >= range.low && point.z_over_r <= range.high) {
            at[point.z_over_r].push_back(&point);
        }
    }
    MeasuredPoints shown{std::move(name), {}, {}};
    bool has_several = false;
    for (const auto& [z_over_r, points] : at) {
        const auto count = static_cast<double>(points.size());
        double sum = 0, squares = 0;
        for (const Measurement* point : points) {
            sum += point->thrust_ratio;
        }
        const double mean = sum / count;
        for (const Measurement* point : points) {
            squares += (point->thrust_ratio - mean) * (point->thrust_ratio - mean);
        }
        has_several = has_several || points.size() > 1;
        shown.points.push_back({z_over_r, mean});
        shown.errors.push_back(points.size() > 1 ? std::sqrt(squares / (count - 1)) : points[0]->sigma.value_or(0));
    }
    if (has_several) {
        shown.name += " (mean and standard deviation)";
    }
    if (std::all_of(shown.errors.begin(), shown.errors.end(), [](double error) { return error == 0; })) {
        shown.errors.clear();
    }
    return shown;
}

/// The entry that is selected, or all entries of a column; a single empty one stands for all rows without a column.
std::vector<std::string> groups(const Measurements& measurements, const std::string& file, const char* column,
                                const std::string& selected) {
    require_entry(measurements, file, column, selected);
    if (!selected.empty()) {
        return {selected};
    }
    return measurements.index(column) ? measurements.entries(column) : std::vector<std::string>{""};
}

void add_measurements(CurveFigure& figure, const std::vector<double>& tilts_deg, const PlotRequest& request,
                      const AxisRange& range) {
    const Measurements all = read_measurements(request.data);
    for (const std::string& source : groups(all, request.data, "source", request.source)) {
        const Measurements of_source = source.empty() ? all : all.with("source", source);
        for (const std::string& surface : groups(all, request.data, "surface", request.surface)) {
            const Measurements group = surface.empty() ? of_source : of_source.with("surface", surface);
            const std::string name = (source.empty() ? "measured" : source) + (surface.empty() ? "" : ", " + surface);
            for (const double tilt_deg : tilts_deg) {
                Measurements at_tilt{group.columns, {}};
                std::copy_if(group.points.begin(), group.points.end(), std::back_inserter(at_tilt.points),
                             [&](const Measurement& point) { return point.tilt_deg == tilt_deg; });
                MeasuredPoints points = points_of(name + tilt_text(tilt_deg), at_tilt, range);
                if (!points.points.empty()) {
                    figure.measurements.push_back(std::move(points));
                }
            }
        }
    }
    if (figure.measurements.empty()) {
        throw UsageError("--data {} has no measurement for z/R from {} to {} at {}", request.data, range.low,
                         range.high, request.tilt_deg.empty() ? "no tilt" : "these tilts");
    }
}

}  // namespace

CurveFigure model_figure(const PlotRequest& request) {
    CurveFigure figure;
    const AxisRange range = shown_range(request);
    figure.title = "Factor K on the thrust of a rotor near a wide flat surface";
    if (std::any_of(request.models.begin(), request.models.end(),
                    [](const std::string& name) { return is_multirotor(model_named(name).model); })) {
        figure.subtitle = fmt::format("multirotor models: square quadrotor, adjacent axes {} radii apart",
                                      to_text(request.rotor_spacing.value_or(usual_rotor_spacing), 4));
    }
    figure.x_label = "z/R, distance of the rotor from the surface in rotor radii [1]";
    figure.y_label = "K, thrust over that in free air [1]";
    figure.x_range = range;
    figure.level = 1;
    figure.dotted_name = "where the model was not shown to hold";
    const std::vector<double> tilts_deg = shown_tilts(request);
    for (const std::string& name : request.models) {
        for (const double tilt_deg : tilts_deg) {
            figure.curves.push_back(curve_of(name, tilt_deg, request, range));
        }
    }
    if (!request.data.empty()) {
        add_measurements(figure, tilts_deg, request, range);
    }
    return figure;
}

}  // namespace downwash::cli

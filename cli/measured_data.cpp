#include "downwash/cli/measured_data.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <string_view>
#include <vector>

#include "downwash/base/parameter.hpp"
#include "downwash/base/text.hpp"
#include "downwash/cli/completion.hpp"
#include "downwash/cli/usage_error.hpp"

namespace downwash::cli {
namespace {

/// The points with that entry in a column; all when no entry is asked for.
Measurements chosen(const Measurements& measurements, const std::string& file, const char* column,
                    const std::string& entry) {
    if (entry.empty()) {
        return measurements;
    }
    Measurements found = measurements.with(column, entry);
    if (found.points.empty()) {
        const std::vector<std::string> entries = measurements.entries(column);
        const std::vector<std::string_view> names(entries.begin(), entries.end());
        throw UsageError(fmt::format("--{} '{}' leaves no measurement of {}: {}", column, excerpt(entry), file,
                                     names.empty()
                                         ? fmt::format("there is no column {}", column)
                                         : "expected " + excerpt(joined_names(names)) + did_you_mean(entry, names)));
    }
    return found;
}

}  // namespace

void MeasuredData::add_options(CLI::App& command) {
    command
        .add_option(
            "DATA", file,
            "measurements as CSV: `#` comments, a header with z_over_r and thrust_ratio, perhaps surface, source "
            "and sigma, then rows")
        ->required();
    CLI::Option* at = command.add_option(
        "--surface", surface,
        "only rows with this surface, `ground` or `ceiling`; what all are made at when there is no such column");
    offer_words(*at->type_name("S"), measured_surfaces);
    command.add_option("--source", source, "only rows with this source")->type_name("NAME");
    command.add_option("--from", from, "only measurements at this z/R and beyond")->type_name("Z");
    command.add_option("--to", to, "only measurements up to this z/R")->type_name("Z");
    command
        .add_option(
            "--rotor-spacing", rotor_spacing,
            "the measured vehicle is a square quadrotor whose adjacent axes are so many radii apart; multirotor models "
            "need it")
        ->type_name("D");
}

Measurements MeasuredData::read() const {
    Measurements measurements = read_measurements(file);
    measurements = chosen(measurements, file, "source", source);
    if (measurements.index("surface")) {
        measurements = chosen(measurements, file, "surface", surface);
    } else if (!surface.empty()) {
        const std::vector<std::string_view> surfaces(measured_surfaces.begin(), measured_surfaces.end());
        if (std::find(surfaces.begin(), surfaces.end(), surface) == surfaces.end()) {
            throw UsageError("--surface '" + excerpt(surface) + "': expected ground or ceiling" +
                             did_you_mean(surface, surfaces));
        }
        measurements.columns.emplace_back("surface");
        for (Measurement& point : measurements.points) {
            point.cells.push_back(surface);
        }
    }
    std::vector<Measurement>& points = measurements.points;
    points.erase(std::remove_if(points.begin(), points.end(),
                                [this](const Measurement& point) {
                                    return !(point.z_over_r >= from.value_or(point.z_over_r) &&
                                             point.z_over_r <= to.value_or(point.z_over_r));
                                }),
                 points.end());
    if (points.empty()) {
        throw UsageError("--from and --to leave no measurement of " + file);
    }
    return measurements;
}

RotorNeighbours MeasuredData::neighbours() const {
    constexpr double most_spacing = 100;
    if (!rotor_spacing) {
        return {};
    }
    if (!(*rotor_spacing > 0 && *rotor_spacing <= most_spacing)) {
        throw UsageError(
            fmt::format("--rotor-spacing {}: expected radii, above 0 and at most {}", *rotor_spacing, most_spacing));
    }
    return square_quadrotor(*rotor_spacing);
}

}  // namespace downwash::cli

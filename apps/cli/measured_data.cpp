#include "downwash/cli/measured_data.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <string_view>
#include <vector>

#include "downwash/base/parameter.hpp"
#include "downwash/base/text.hpp"
#include "downwash/cli/common_options.hpp"
#include "downwash/cli/output.hpp"
#include "downwash/cli/usage_error.hpp"
#include "downwash/problems/data_facts.hpp"
#include "downwash/problems/located_error.hpp"

namespace downwash::cli {
namespace {

constexpr char data_description[] =
    "measurements as CSV: `#` comments, a header with z_over_r and thrust_ratio and optionally surface, source, "
    "tilt_deg and sigma, then rows";

/// The points with an entry in a column; all without one.
Measurements selected(const Measurements& measurements, const std::string& file, const char* column,
                      const std::string& entry) {
    require_entry(measurements, file, column, entry);
    return entry.empty() ? measurements : measurements.with(column, entry);
}

}  // namespace

void require_entry(const Measurements& measurements, const std::string& file, const char* column,
                   const std::string& entry) {
    const std::vector<std::string> entries = measurements.entries(column);
    if (entry.empty() || std::find(entries.begin(), entries.end(), entry) != entries.end()) {
        return;
    }
    const std::vector<std::string_view> names(entries.begin(), entries.end());
    throw UsageError("--{} '{}' leaves no measurement of {}: {}", column, excerpt(entry), file,
                     names.empty() ? fmt::format("there is no column {}", column)
                                   : "expected " + excerpt(joined_names(names)) + did_you_mean(entry, names));
}

void add_data_files(Command command, std::vector<std::string>& files) {
    command.add_option("DATA", files, std::string(data_description) + "; several files are taken together")
        .required()
        .offers_files({".csv", ".tsv"});
}

void MeasuredData::add_options(Command command) {
    command.add_option("DATA", file, data_description).required().offers_files({".csv", ".tsv"});
    add_selection(command);
}

void MeasuredData::add_selection(Command command) {
    Option at = command.add_option(
        "--surface S", surface,
        "only measurements at this surface, `ground` or `ceiling`; without such a column, the surface of all rows");
    at.offers(measured_surfaces);
    command.add_option("--source NAME", source, "only measurements of this source");
    command.add_option("--from Z", from, "only measurements at this z/R and beyond");
    command.add_option("--to Z", to, "only measurements up to this z/R");
    command.add_option(
        "--rotor-spacing D", rotor_spacing,
        "spacing of adjacent axes of a square quadrotor in radii; that of the measured vehicle, multirotor "
        "models need it");
}

Measurements MeasuredData::read() const {
    Measurements measurements = read_measurements(file);
    measurements = selected(measurements, file, "source", source);
    if (measurements.index("surface")) {
        measurements = selected(measurements, file, "surface", surface);
    } else if (!surface.empty()) {
        if (std::find(measured_surfaces.begin(), measured_surfaces.end(), surface) == measured_surfaces.end()) {
            reject_unknown("--surface", surface, {measured_surfaces.begin(), measured_surfaces.end()});
        }
        measurements.columns.emplace_back("surface");
        for (Measurement& point : measurements.points) {
            point.cells.push_back(surface);
        }
    }
    std::vector<Measurement>& points = measurements.points;
    std::erase_if(points, [this](const Measurement& point) {
        return !(point.z_over_r >= from.value_or(point.z_over_r) && point.z_over_r <= to.value_or(point.z_over_r));
    });
    if (points.empty()) {
        throw UsageError("--from and --to leave no measurement of " + file);
    }
    return measurements;
}

bool MeasuredData::warn_of(const Measurements& measurements) const {
    const std::vector<std::string> remarks = data_remarks({"", file, DataKind::measurements, measurements.csv});
    for (const std::string& remark : remarks) {
        print_warning({file, 1, 1, remark});
    }
    return !remarks.empty();
}

RotorNeighbours MeasuredData::neighbours() const {
    constexpr double max_spacing = 100;
    if (!rotor_spacing) {
        return {};
    }
    if (!(*rotor_spacing > 0 && *rotor_spacing <= max_spacing)) {
        throw UsageError("--rotor-spacing {}: expected radii, above 0 and at most {}", *rotor_spacing, max_spacing);
    }
    return square_quadrotor(*rotor_spacing);
}

}  // namespace downwash::cli

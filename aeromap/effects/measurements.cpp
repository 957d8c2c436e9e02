#include "downwash/effects/measurements.hpp"

#include <algorithm>
#include <set>
#include <utility>

#include "downwash/base/csv_reader.hpp"
#include "downwash/base/parameter.hpp"
#include "downwash/base/text.hpp"
#include "downwash/effects/effect_csv.hpp"

namespace downwash {

std::optional<std::size_t> Measurements::index(std::string_view column) const {
    return find_column(columns, column);
}

std::vector<std::string> Measurements::entries(std::string_view column) const {
    std::vector<std::string> found;
    if (const auto cell = index(column)) {
        std::set<std::string_view> seen;
        for (const Measurement& point : points) {
            if (seen.insert(point.cells[*cell]).second) {
                found.push_back(point.cells[*cell]);
            }
        }
    }
    return found;
}

Measurements Measurements::with(std::string_view column, std::string_view entry) const {
    Measurements chosen{columns, {}, csv};
    if (const auto cell = index(column)) {
        for (const Measurement& point : points) {
            if (point.cells[*cell] == entry) {
                chosen.points.push_back(point);
            }
        }
    }
    return chosen;
}

std::optional<std::string> surface_error(const std::string& surface) {
    const std::vector<std::string_view> known{"ground", "ceiling"};
    if (surface.empty() || std::find(known.begin(), known.end(), surface) != known.end()) {
        return std::nullopt;
    }
    return "has the surface '" + excerpt(surface) + "'; expected ground or ceiling" + did_you_mean(surface, known);
}

Measurements parse_measurements(std::string_view text, std::string_view name) {
    LineErrors errors{std::string(name)};
    CsvReader csv(text, errors, effect_csv_limits);
    constexpr auto expected = "z_over_r and thrust_ratio";
    const std::size_t z = csv.required("z_over_r", expected);
    const std::size_t ratio = csv.required("thrust_ratio", expected);
    errors.throw_any();
    const auto sigma = csv.find("sigma");
    const auto tilt = csv.find("tilt_deg");
    const auto surface = csv.find("surface");
    for (const auto column : {surface, csv.find("source")}) {
        if (column) {
            csv.use(*column);
        }
    }
    Measurements measurements{csv.names(), {}, {}};
    while (csv.next()) {
        Measurement point{0, 0, 0, std::nullopt, csv.line(), {}};
        point.z_over_r = csv.number(z, 1e-6, 1000).value_or(0);
        point.thrust_ratio = csv.number(ratio, 0, 100).value_or(0);
        if (sigma && !csv.cell(*sigma).empty()) {
            point.sigma = csv.number(*sigma, 1e-9, 100);
        }
        if (tilt && !csv.cell(*tilt).empty()) {
            point.tilt_deg = csv.number(*tilt, 0, 90).value_or(0);
        }
        if (surface) {
            if (const auto error = surface_error(std::string(csv.cell(*surface)))) {
                csv.add_error(*surface, *error);
            }
        }
        for (std::size_t column = 0; column < csv.names().size(); ++column) {
            point.cells.emplace_back(csv.cell(column));
        }
        measurements.points.push_back(std::move(point));
    }
    errors.throw_any();
    if (measurements.points.empty()) {
        errors.add(csv.header_line(), "no rows follow: expected measurements");
    }
    errors.throw_any();
    measurements.csv = csv.facts();
    return measurements;
}

Measurements read_measurements(const std::filesystem::path& file) {
    return parse_measurements(read_effect_csv(file), file.string());
}

}  // namespace downwash

#include "downwash/effects/wall_measurements.hpp"

#include <utility>

#include "downwash/effects/csv_table.hpp"

namespace downwash {

std::vector<WallMeasurement> parse_wall_measurements(std::string_view text, std::string_view name) {
    LineErrors errors{std::string(name)};
    const CsvTable csv = parse_csv(text, errors);
    const auto required = [&](const char* column) {
        const auto found = csv.find(column);
        if (!found) {
            errors.add(csv.header_line, std::string("has no column ") + column +
                                            "; expected distance_over_r, force_over_thrust and "
                                            "moment_over_thrust_radius");
        }
        return found.value_or(0);
    };
    const std::size_t distance = required("distance_over_r");
    const std::size_t force = required("force_over_thrust");
    const std::size_t moment = required("moment_over_thrust_radius");
    errors.throw_any();
    const auto facility = csv.find("facility");
    std::vector<WallMeasurement> measurements;
    for (const CsvTable::Row& row : csv.rows) {
        WallMeasurement point;
        point.facility = facility ? row.cells[*facility] : "";
        point.distance_over_r = number_in(csv, row, distance, 1, 1000, errors).value_or(1);
        point.force_over_thrust = number_in(csv, row, force, -10, 10, errors).value_or(0);
        point.moment_over_thrust_radius = number_in(csv, row, moment, -10, 10, errors).value_or(0);
        measurements.push_back(std::move(point));
    }
    if (csv.rows.empty()) {
        errors.add(csv.header_line, "no rows follow; expected measurements");
    }
    errors.throw_any();
    return measurements;
}

std::vector<WallMeasurement> read_wall_measurements(const std::filesystem::path& file) {
    return parse_wall_measurements(read_csv_text(file), file.string());
}

}  // namespace downwash

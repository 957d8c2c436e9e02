#include "downwash/effects/wall_measurements.hpp"

#include <utility>

#include "downwash/base/csv_reader.hpp"
#include "downwash/effects/effect_csv.hpp"

namespace downwash {

WallMeasurements parse_wall_measurements(std::string_view text, std::string_view name) {
    LineErrors errors{std::string(name)};
    CsvReader csv(text, errors, effect_csv_limits);
    constexpr auto expected = "distance_over_r, force_over_thrust and moment_over_thrust_radius";
    const std::size_t distance = csv.required("distance_over_r", expected);
    const std::size_t force = csv.required("force_over_thrust", expected);
    const std::size_t moment = csv.required("moment_over_thrust_radius", expected);
    errors.throw_any();
    const auto facility = csv.find("facility");
    std::vector<WallMeasurement> points;
    while (csv.next()) {
        WallMeasurement point;
        point.facility = facility ? csv.cell(*facility) : "";
        point.distance_over_r = csv.number(distance, 1, 1000).value_or(1);
        point.force_over_thrust = csv.number(force, -10, 10).value_or(0);
        point.moment_over_thrust_radius = csv.number(moment, -10, 10).value_or(0);
        points.push_back(std::move(point));
    }
    errors.throw_any();
    if (points.empty()) {
        errors.add(csv.header_line(), "no rows follow: expected measurements");
    }
    errors.throw_any();
    return {std::move(points), csv.facts()};
}

WallMeasurements read_wall_measurements(const std::filesystem::path& file) {
    return parse_wall_measurements(read_effect_csv(file), file.string());
}

}  // namespace downwash

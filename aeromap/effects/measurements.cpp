#include "downwash/effects/measurements.hpp"

#include <algorithm>
#include <set>
#include <utility>

#include "downwash/effects/csv_table.hpp"

namespace downwash {
namespace {

std::size_t required(const CsvTable& csv, const std::string& column, LineErrors& errors) {
    const auto found = csv.find(column);
    if (!found) {
        errors.add(csv.header_line, "has no column " + column + "; expected z_over_r and thrust_ratio");
    }
    return found.value_or(0);
}

}  // namespace

std::optional<std::size_t> Measurements::index(std::string_view column) const {
    return index_of(columns, column);
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
    Measurements chosen{columns, {}};
    if (const auto cell = index(column)) {
        for (const Measurement& point : points) {
            if (point.cells[*cell] == entry) {
                chosen.points.push_back(point);
            }
        }
    }
    return chosen;
}

Measurements parse_measurements(std::string_view text, std::string_view name) {
    LineErrors errors{std::string(name)};
    const CsvTable csv = parse_csv(text, errors);
    const std::size_t z = required(csv, "z_over_r", errors);
    const std::size_t ratio = required(csv, "thrust_ratio", errors);
    errors.throw_any();
    const auto sigma = csv.find("sigma");
    const auto tilt = csv.find("tilt_deg");
    Measurements measurements{csv.columns, {}};
    for (const CsvTable::Row& row : csv.rows) {
        Measurement point{0, 0, 0, std::nullopt, row.line, row.cells};
        point.z_over_r = number_in(csv, row, z, 1e-6, 1000, errors).value_or(0);
        point.thrust_ratio = number_in(csv, row, ratio, 0, 100, errors).value_or(0);
        if (sigma && !row.cells[*sigma].empty()) {
            point.sigma = number_in(csv, row, *sigma, 1e-9, 100, errors);
        }
        if (tilt && !row.cells[*tilt].empty()) {
            point.tilt_deg = number_in(csv, row, *tilt, 0, 90, errors).value_or(0);
        }
        measurements.points.push_back(std::move(point));
    }
    if (csv.rows.empty()) {
        errors.add(csv.header_line, "no rows follow; expected measurements");
    }
    errors.throw_any();
    return measurements;
}

Measurements read_measurements(const std::filesystem::path& file) {
    return parse_measurements(read_csv_text(file), file.string());
}

}  // namespace downwash

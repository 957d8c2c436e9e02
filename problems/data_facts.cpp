#include "downwash/problems/data_facts.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <initializer_list>
#include <stdexcept>

#include "downwash/base/csv_reader.hpp"
#include "downwash/base/files.hpp"
#include "downwash/base/line_errors.hpp"
#include "downwash/base/text.hpp"
#include "downwash/effects/effect_table.hpp"
#include "downwash/effects/measurements.hpp"
#include "downwash/effects/wall_measurements.hpp"
#include "downwash/grids/factor_grid_file.hpp"
#include "downwash/problems/robot_sources.hpp"

namespace downwash {
namespace {

constexpr std::array<std::string_view, 4> kind_names{"grid", "effect_table", "measurements", "wall_measurements"};

/// The kind of file that has such columns. @throws InputError for columns of no kind
DataKind kind_of(const std::string& bytes, const std::string& name) {
    constexpr std::size_t max_columns = 256;
    LineErrors errors(name);
    const CsvReader csv(bytes, errors, {1, max_columns});
    const bool has_z_over_r = csv.find("z_over_r").has_value();
    if (has_z_over_r && csv.find("factor")) {
        return DataKind::effect_table;
    }
    if (csv.find("factor")) {
        return DataKind::grid;
    }
    if (has_z_over_r && csv.find("thrust_ratio")) {
        return DataKind::measurements;
    }
    if (csv.find("distance_over_r")) {
        return DataKind::wall_measurements;
    }
    errors.add(
        csv.header_line(),
        "has the columns '" + excerpt(joined(csv.names(), ", ")) +
            "': expected those of a grid (x_m,z_m,factor), of an effect table (z_over_r,factor), of measurements "
            "(z_over_r,thrust_ratio) or of measurements beside walls (distance_over_r,force_over_thrust,"
            "moment_over_thrust_radius)" +
            (is_thrust_stand(joined(csv.names(), ",")) ? "; " + std::string(thrust_stand_keys)
                                                       : csv.remedy_without({"z_over_r", "factor", "thrust_ratio"})));
    errors.throw_any();
    throw std::logic_error("columns of no kind are an error");
}

CsvFacts facts_of(DataKind kind, const std::string& bytes, const std::string& name) {
    switch (kind) {
        case DataKind::grid:
            return parse_factor_grid(bytes, name).csv();
        case DataKind::effect_table:
            return parse_effect_table(bytes, name)->csv();
        case DataKind::measurements:
            return parse_measurements(bytes, name).csv;
        case DataKind::wall_measurements:
            break;
    }
    return parse_wall_measurements(bytes, name).csv;
}

const CsvColumn* column_named(const CsvFacts& csv, std::initializer_list<std::string_view> names) {
    for (const CsvColumn& column : csv.used) {
        const auto is_meant = [&column](std::string_view name) { return is_same_word(name, column.name); };
        if (column.has_numbers() && std::any_of(names.begin(), names.end(), is_meant)) {
            return &column;
        }
    }
    return nullptr;
}

/// "factor from 0.01 to 0.3"
std::string range_text(const CsvColumn& column) {
    constexpr int digits = 4;
    return excerpt(column.name) + " from " + to_text(column.low, digits) + " to " + to_text(column.high, digits);
}

bool ends_with(std::string_view name, std::string_view ending) {
    return name.size() >= ending.size() && is_same_word(name.substr(name.size() - ending.size()), ending);
}

}  // namespace

std::string_view name_of(DataKind kind) {
    return kind_names[static_cast<std::size_t>(kind)];
}

std::vector<DataFacts> data_facts(const Problem& problem) {
    std::vector<DataFacts> all;
    const AeroSettings& aero = problem.aero;
    if (aero.map) {
        all.push_back({"aero.map", aero.map_file.value_or(""), DataKind::grid, aero.map->csv()});
    }
    const auto add_table = [&all](const SurfaceEffect& side, const char* key) {
        const bool is_told =
            std::any_of(all.begin(), all.end(), [&](const DataFacts& o) { return o.file == side.file; });
        if (side.model == EffectModel::table && side.table && !is_told) {
            all.push_back({key, side.file, DataKind::effect_table, side.table->csv()});
        }
    };
    add_table(aero.ground, "aero.ground.file");
    add_table(aero.ceiling, "aero.ceiling.file");
    return all;
}

DataFacts read_data_file(const std::filesystem::path& file) {
    const std::string bytes = naming(file, [&] { return read_whole_file(file, max_grid_file_bytes); });
    const DataKind kind = kind_of(bytes, file.string());
    return {"", file.string(), kind, facts_of(kind, bytes, file.string())};
}

std::vector<std::string> data_remarks(const DataFacts& data, double max_factor) {
    constexpr double most_distance_radii = 4;  // beyond it surfaces change the thrust by less than half a percent
    const std::string has = "'" + data.file + "' has ";
    std::vector<std::string> remarks;
    if (const CsvColumn* ratio = column_named(data.csv, {"factor", "thrust_ratio"})) {
        constexpr const char* expected = "expected K = T / T_free, which is 1 far from surfaces";
        if (ratio->high < 1) {
            remarks.push_back(has + range_text(*ratio) + ", below 1 throughout: " + expected +
                              "; to gains add 1, percent divide by 100 before");
        } else if (ratio->high > 2 * max_factor) {
            remarks.push_back(has + range_text(*ratio) + ", far above the most that surfaces multiply thrust by, " +
                              to_text(max_factor) + ": " + expected + "; divide percent by 100, to gains add 1");
        }
    }
    if (const CsvColumn* distance = column_named(data.csv, {"z_over_r"});
        distance != nullptr && distance->low >= most_distance_radii) {
        remarks.push_back(has + range_text(*distance) +
                          ", all too far from a surface for its effect: expected distances over the rotor radius, "
                          "both in the same unit, from some 0.3 on");
    }
    if (!data.csv.others.empty() && (data.kind == DataKind::effect_table || data.kind == DataKind::grid)) {
        remarks.push_back(has + "columns that are not read: " + excerpt(joined(data.csv.others, ", ")));
    }
    return remarks;
}

std::string_view unit_of_column(std::string_view name) {
    const std::string_view points = "Points";  // as ParaView names coordinates
    return ends_with(name, "_over_r")                                                     ? "rotor radii"
           : ends_with(name, "_deg")                                                      ? "deg"
           : ends_with(name, "_m") || is_same_word(name.substr(0, points.size()), points) ? "m"
                                                                                          : "1";
}

}  // namespace downwash

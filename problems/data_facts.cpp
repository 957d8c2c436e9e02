#include "downwash/problems/data_facts.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
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
            (is_thrust_stand(joined(csv.names(), ",")) ? "; " + std::string(thrust_stand_keys) : ""));
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

std::string_view unit_of_column(std::string_view name) {
    const std::string_view points = "Points";  // as ParaView names coordinates
    return ends_with(name, "_over_r")                                                     ? "rotor radii"
           : ends_with(name, "_deg")                                                      ? "deg"
           : ends_with(name, "_m") || is_same_word(name.substr(0, points.size()), points) ? "m"
                                                                                          : "1";
}

}  // namespace downwash

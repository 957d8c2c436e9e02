#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "downwash/base/angles.hpp"
#include "downwash/cli/common_options.hpp"
#include "downwash/cli/output.hpp"
#include "downwash/grids/factor_grid_file.hpp"

namespace downwash::cli {
namespace {

Json axis_json(const GridAxis& axis) {
    return {{"low_m", axis.low_m}, {"high_m", axis.high_m}, {"step_m", axis.step_m()}, {"nodes", axis.count}};
}

/// Nodes at which a rotor may fly; all nodes of a grid that does not say.
std::size_t flyable_nodes(const FactorGrid& grid) {
    const std::vector<double>* flyable = grid.field("flyable");
    return flyable ? static_cast<std::size_t>(std::count(flyable->begin(), flyable->end(), 1)) : grid.nodes();
}

/// Minimum and maximum of a field where a rotor may fly; empty if it may not fly anywhere.
std::optional<std::pair<double, double>> flyable_range(const FactorGrid& grid, const GridField& field) {
    const std::vector<double>* flyable = grid.field("flyable");
    std::optional<std::pair<double, double>> range;
    for (std::size_t node = 0; node < field.values.size(); ++node) {
        if (flyable == nullptr || (*flyable)[node] == 1) {
            const double value = field.values[node];
            range = range ? std::pair(std::min(range->first, value), std::max(range->second, value))
                          : std::pair(value, value);
        }
    }
    return range;
}

Json json_of_grid(const std::string& file, const FactorGrid& grid) {
    auto fields = Json::array();
    for (const GridField& field : grid.fields()) {
        if (field.name != "flyable") {
            const auto range = flyable_range(grid, field);
            fields.push_back({{"name", field.name},
                              {"least", range ? Json(range->first) : Json()},
                              {"greatest", range ? Json(range->second) : Json()}});
        }
    }
    auto provenance = Json::array();
    for (const auto& [key, value] : grid.provenance()) {
        provenance.push_back({{"key", key}, {"value", value}});
    }
    return {{"file", file},
            {"kind", grid.is_planar() ? "planar" : "volume"},
            {"frame", {{"origin_m", grid.frame().origin_m()}, {"heading_rad", grid.frame().heading_rad()}}},
            {"x", axis_json(grid.x())},
            {"y", axis_json(grid.y())},
            {"z", axis_json(grid.z())},
            {"lateral_offsets_m", grid.lateral_offsets_m()},
            {"nodes", grid.nodes()},
            {"flyable_nodes", grid.field("flyable") ? Json(flyable_nodes(grid)) : Json()},
            {"fields", std::move(fields)},
            {"provenance", std::move(provenance)}};
}

void print_axis(const char* name, const GridAxis& axis) {
    if (axis.count > 1) {
        fmt::print("{:<12} {:.6g} to {:.6g} m, {} nodes {:.6g} m apart\n", name, axis.low_m, axis.high_m, axis.count,
                   axis.step_m());
    }
}

void print_text(const std::string& file, const FactorGrid& grid) {
    fmt::print("{}: {} grid, {} nodes\n", file, grid.is_planar() ? "planar" : "volume", grid.nodes());
    const Vector3& origin_m = grid.frame().origin_m();
    fmt::print("{:<12} origin ({:.6g}, {:.6g}, {:.6g}) m, heading {:.6g} deg\n", "frame", origin_m[0], origin_m[1],
               origin_m[2], grid.frame().heading_rad() * degrees_per_radian);
    print_axis("x", grid.x());
    print_axis("y", grid.y());
    print_axis("z", grid.z());
    for (const double lateral_m : grid.lateral_offsets_m()) {
        fmt::print("{:<12} {:.6g} m beside the plane\n", "layer", lateral_m);
    }
    const bool knows_flyable = grid.field("flyable") != nullptr;
    if (knows_flyable) {
        fmt::print("{:<12} {} of {} nodes\n", "flyable", flyable_nodes(grid), grid.nodes());
    }
    for (const GridField& field : grid.fields()) {
        if (field.name == "flyable") {
            continue;
        }
        if (const auto range = flyable_range(grid, field)) {
            fmt::print("{:<12} {:.6g} to {:.6g}{}\n", field.name, range->first, range->second,
                       knows_flyable ? " where flyable" : "");
        } else {
            fmt::print("{:<12} flyable nowhere\n", field.name);
        }
    }
    for (const auto& [key, value] : grid.provenance()) {
        fmt::print("{}: {}\n", key, value);
    }
}

struct InfoArguments {
    std::string file;
    bool as_json = false;
};

ExitCode run(const InfoArguments& given) {
    const FactorGrid grid = read_factor_grid(given.file);
    given.as_json ? print_json(json_of_grid(given.file, grid)) : print_text(given.file, grid);
    return ExitCode::done;
}

}  // namespace

void add_aeromap_info(Command aeromap, Action& action) {
    auto [command, given] =
        add_command<InfoArguments>(aeromap, action, "info", "Show what a grid file holds and how it was made", run);
    command.add_option("FILE", given.file, "CSV file of factors").required();
    add_json(command, given.as_json);
}

}  // namespace downwash::cli

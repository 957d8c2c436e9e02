#include "downwash/cli/input_lines.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <vector>

#include "downwash/base/angles.hpp"
#include "downwash/base/text.hpp"
#include "downwash/cli/output.hpp"

namespace downwash::cli {
namespace {

std::string rounded(double value) {
    return to_text(value, 3);
}

std::string counted(std::size_t count, const char* thing) {
    return fmt::format("{} {}{}", count, thing, count == 1 ? "" : "s");
}

std::string margins_text(const std::optional<LeastMargins>& margins) {
    if (!margins) {
        return "not stable in every hover";
    }
    const auto text = [](double margin, const char* unit) {
        return std::isfinite(margin) ? fmt::format("{} {}", rounded(margin), unit) : fmt::format("any {}", unit);
    };
    return "margins " + text(margins->gain_margin_db, "dB") + " and " +
           text(margins->phase_margin_rad * degrees_per_radian, "deg");
}

const char* words_for(DataKind kind) {
    switch (kind) {
        case DataKind::grid:
            return "grid";
        case DataKind::effect_table:
            return "effect table";
        case DataKind::measurements:
            return "measurements";
        case DataKind::wall_measurements:
            break;
    }
    return "measurements beside walls";
}

std::string dialect_text(const CsvFacts& csv) {
    const std::string separator = csv.separator == '\t'  ? "tabs"
                                  : csv.separator == ' ' ? "blanks"
                                                         : fmt::format("'{}'", csv.separator);
    return fmt::format("separated by {}, decimal {}", separator, csv.decimal_sign == ',' ? "commas" : "points");
}

std::string columns_text(const CsvFacts& csv) {
    const auto listed = [](const auto& names, const auto& text) {
        constexpr std::size_t most = 6;
        std::string list;
        for (std::size_t i = 0; i < std::min(most, names.size()); ++i) {
            list += (i > 0 ? ", " : "") + text(names[i]);
        }
        return names.size() > most ? list + fmt::format(" and {} more", names.size() - most) : list;
    };
    const auto with_range = [](const CsvColumn& column) {
        if (!column.has_numbers()) {
            return excerpt(column.name);
        }
        const std::string_view unit = unit_of_column(column.name);
        return fmt::format("{}{} {} to {}", excerpt(column.name), unit == "1" ? "" : fmt::format(" [{}]", unit),
                           rounded(column.low), rounded(column.high));
    };
    std::string text = listed(csv.used, with_range);
    if (!csv.others.empty()) {
        text += "; other columns: " + listed(csv.others, excerpt);
    }
    return text;
}

/// What of an octree no sensor has seen; nothing of a mesh.
std::string unseen_text(const GeometryInput& geometry) {
    if (geometry.is_mesh) {
        return "";
    }
    return geometry.unseen_share ? fmt::format(", {:.1f} % of its box unseen ({})", 100 * *geometry.unseen_share,
                                               name_of(geometry.unknown))
                                 : fmt::format(", no free leaves (unknown: {})", name_of(geometry.unknown));
}

/// One row for each, of at most six.
template <class Input>
std::string rows_of(const std::string& name, const std::vector<Input>& inputs) {
    constexpr std::size_t most = 6;
    std::string rows;
    for (std::size_t i = 0; i < std::min(most, inputs.size()); ++i) {
        rows += table_row(i == 0 ? name : "", text_of(inputs[i]));
    }
    if (inputs.size() > most) {
        rows += table_row("", fmt::format("and {} more: `downwash check` prints all", inputs.size() - most));
    }
    return rows;
}

}  // namespace

std::string text_of(const GeometryInput& geometry) {
    const GeometryFacts& facts = geometry.facts;
    const SurfaceFacts& surface = facts.surface;
    const BoundingBox& extent = facts.extent_world_m;
    const auto range = [&extent](std::size_t k) {
        return fmt::format("{} to {} m", to_text(extent.low_m[k], 6), to_text(extent.high_m[k], 6));
    };
    return fmt::format(
        "{}: {} of {}, {}, {}{}, x {}, y {}, z {} in the world",
        geometry.name.empty() ? geometry.key : excerpt(geometry.name), geometry.is_mesh ? "mesh" : "octree",
        counted(facts.element_count, geometry.is_mesh ? "triangle" : "cube"), counted(surface.pieces, "piece"),
        surface_name(surface), unseen_text(geometry), range(0), range(1), range(2));
}

std::string text_of(const RobotInput& robot) {
    const RobotFacts& facts = robot.facts;
    return fmt::format(
        "{}: {} kg, thrust {} times the weight, reach {} m, hover at {} % of the weakest rotor's thrust, {}",
        excerpt(robot.name), rounded(facts.mass_kg), rounded(facts.thrust_to_weight), rounded(facts.reach_m),
        rounded(100 * facts.hover_share), margins_text(facts.margins));
}

std::string text_of(const DataFacts& data) {
    return fmt::format("{}: {} of {}, {}; {}", excerpt(std::filesystem::path(data.file).filename().string()),
                       words_for(data.kind), counted(data.csv.rows, "row"), columns_text(data.csv),
                       dialect_text(data.csv));
}

std::string input_rows(const InputFacts& inputs) {
    return table_row("robot", text_of(inputs.robot)) + rows_of("geometry", inputs.geometry) +
           rows_of("data", inputs.data);
}

}  // namespace downwash::cli

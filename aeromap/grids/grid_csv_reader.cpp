#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "downwash/base/csv_lines.hpp"
#include "downwash/base/key_error.hpp"
#include "downwash/base/line_errors.hpp"
#include "downwash/base/text.hpp"
#include "downwash/grids/factor_grid_file.hpp"
#include "downwash/grids/provenance_line.hpp"

// Comment lines carry the frame and the provenance; then a line of column names and a row a node, in any order.

namespace downwash {
namespace {

constexpr std::size_t max_rows = max_grid_nodes;
constexpr std::size_t max_columns = 256;
/// How far a coordinate may be off its node, in steps.
constexpr double spacing_slack = 1e-6;

enum Column : std::size_t { x, lateral, y, z, first_field };
constexpr std::array<std::string_view, 8> column_names{"x_m",    "lateral_m", "y_m",     "z_m",
                                                       "factor", "ground",    "ceiling", "flyable"};

struct GridCsv {
    std::array<std::vector<double>, column_names.size()> columns;  ///< empty where the file has none
    std::vector<std::uint32_t> lines;                              ///< of each row
    std::optional<Vector3> frame_origin_m;
    std::optional<double> frame_heading_rad;
    Provenance provenance;

    [[nodiscard]] bool has(std::size_t column) const { return !columns[column].empty(); }
};

constexpr std::string_view xml_remedy =
    "VTK's XML is written by Downwash, not read: expected CSV (`downwash aeromap build PROBLEM -o FILE.csv`, or in "
    "ParaView: File, Save Data, as CSV with 17 digits)";

/// The index of a column's name, also of those by which ParaView saves the coordinates of points; past the names if it
/// is none of ours.
std::size_t role_of(std::string_view name) {
    if (name.size() > 1 && name.starts_with('"') && name.ends_with('"')) {
        name = name.substr(1, name.size() - 2);
    }
    for (const auto& [theirs, role] :
         {std::pair{"Points:0", Column::x}, std::pair{"Points:1", y}, std::pair{"Points:2", z}}) {
        if (name == theirs) {
            return role;
        }
    }
    return static_cast<std::size_t>(std::find(column_names.begin(), column_names.end(), name) - column_names.begin());
}

std::string text_number(std::string_view cell) {
    return "'" + excerpt(cell) + "'";
}

/// Reads lines into columns.
class CsvReader {
 public:
    CsvReader(std::string_view text, LineErrors& errors) : line_(text), errors_(errors) {}

    GridCsv read() {
        while (line_.next()) {
            if (line_.is_comment()) {
                read_comment(line_.comment());
            } else if (roles_.empty()) {
                read_header();
                errors_.throw_any();
            } else {
                read_row();
            }
        }
        if (roles_.empty()) {
            errors_.add(0, "holds no line of column names: expected x_m,z_m,factor or x_m,y_m,z_m,factor");
        } else if (csv_.lines.empty()) {
            errors_.add(0, "holds no row");
        }
        errors_.throw_any();
        return std::move(csv_);
    }

 private:
    void read_comment(std::string_view text) {
        auto [key, value] = provenance_entry(text);
        if (key == "frame_origin_m") {
            if (const auto numbers = numbers_in(value, 3); !numbers.empty()) {
                csv_.frame_origin_m = {numbers[0], numbers[1], numbers[2]};
            }
        } else if (key == "frame_heading_rad") {
            if (const auto numbers = numbers_in(value, 1); !numbers.empty()) {
                csv_.frame_heading_rad = numbers[0];
            }
        } else if (!value.empty() || key != "comment") {
            csv_.provenance.emplace_back(std::move(key), std::move(value));
        }
    }

    /// Exactly so many finite numbers, or an error and none.
    std::vector<double> numbers_in(std::string_view text, std::size_t count) {
        std::vector<double> numbers;
        std::string_view rest = text;
        for (std::string_view word = take_word(rest); !word.empty(); word = take_word(rest)) {
            const auto number = parse_number<double>(word);
            if (!number || numbers.size() == count) {
                numbers.clear();
                break;
            }
            numbers.push_back(*number);
        }
        if (numbers.size() == count) {
            return numbers;
        }
        errors_.add(
            line_.number(), 1,
            text_number(text) + ": expected " + std::to_string(count) + " finite number" + (count == 1 ? "" : "s"));
        return {};
    }

    void read_header() {
        if (line_.text().starts_with('<')) {
            errors_.add(line_.number(), 1, std::string(xml_remedy));
            return;
        }
        line_.for_each_cell([&](std::string_view cell, std::size_t column) {
            const std::size_t role = role_of(cell);
            if (role < column_names.size() && std::find(roles_.begin(), roles_.end(), role) != roles_.end()) {
                errors_.add(line_.number(), column, "column " + text_number(cell) + " occurs twice");
            }
            roles_.push_back(role);
        });
        const auto has = [&](std::size_t role) {
            return std::find(roles_.begin(), roles_.end(), role) != roles_.end();
        };
        for (const std::size_t needed : {std::size_t{Column::x}, std::size_t{Column::z}, std::size_t{first_field}}) {
            if (!has(needed)) {
                errors_.add(line_.number(), 1,
                            "column " + std::string(column_names[needed]) + " is missing in '" + excerpt(line_.text()) +
                                "': expected x_m,z_m,factor or x_m,y_m,z_m,factor, separated by commas");
            }
        }
        if (has(lateral) && has(y)) {
            errors_.add(line_.number(), 1, "expected lateral_m (layers beside the plane) or y_m (a volume), not both");
        }
        if (roles_.size() > max_columns) {
            errors_.add(line_.number(), 1, "has more than 256 columns");
        }
    }

    void read_row() {
        std::size_t index = 0;
        line_.for_each_cell([&](std::string_view cell, std::size_t column) {
            if (index < roles_.size() && roles_[index] < column_names.size()) {
                read_cell(cell, column, roles_[index]);
            }
            ++index;
        });
        if (index != roles_.size()) {
            errors_.add(line_.number(), 1,
                        "has " + std::to_string(index) + " cells: expected " + std::to_string(roles_.size()) +
                            " as in the line of column names");
        }
        csv_.lines.push_back(static_cast<std::uint32_t>(line_.number()));
        if (csv_.lines.size() > max_rows) {
            errors_.add(line_.number(), 1, "more than 2^24 rows: expected a larger step or a smaller extent");
            errors_.throw_any();
        }
    }

    void read_cell(std::string_view cell, std::size_t column, std::size_t role) {
        const auto number = parse_number<double>(cell);
        const bool is_coordinate = role < first_field;
        const double min = is_coordinate ? -1e6 : 0;
        const double max = is_coordinate ? 1e6 : (column_names[role] == "flyable" ? 1 : 100);
        if (!number || *number < min || *number > max) {
            errors_.add(line_.number(), column,
                        std::string(column_names[role]) + " is " + text_number(cell) + ": expected a number from " +
                            to_text(min) + " to " + to_text(max));
        }
        csv_.columns[role].push_back(number.value_or(0));
    }

    CsvLines line_;
    LineErrors& errors_;
    std::vector<std::size_t> roles_;  ///< of each column; past the names for columns that are not ours
    GridCsv csv_;
};

/// The distinct values of a column in rising order; what differs by rounding only counts once.
std::vector<double> distinct_values(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    const double slack = 1e-9 * (values.back() - values.front());
    std::vector<double> distinct;
    for (const double value : values) {
        if (distinct.empty() || value - distinct.back() > slack) {
            distinct.push_back(value);
        }
    }
    return distinct;
}

/// Puts rows to their nodes.
class NodeFinder {
 public:
    NodeFinder(const GridCsv& csv, LineErrors& errors) : csv_(csv), errors_(errors) {}

    void fill(FactorGridParts& parts) {
        parts.x = axis(Column::x);
        parts.z = axis(Column::z);
        if (csv_.has(y)) {
            parts.y = axis(y);
        }
        if (csv_.has(lateral)) {
            parts.lateral_offsets_m = distinct_values(csv_.columns[lateral]);
        }
        errors_.throw_any();
        const std::size_t layers = std::max<std::size_t>(1, parts.lateral_offsets_m.size());
        const double nodes = static_cast<double>(parts.x.count) * static_cast<double>(parts.y.count) *
                             static_cast<double>(parts.z.count) * static_cast<double>(layers);
        if (nodes > static_cast<double>(max_rows)) {
            errors_.add(0, "has " + std::to_string(csv_.lines.size()) + " rows for " + to_text(nodes) +
                               " combinations of its coordinates: expected one each");
            errors_.throw_any();
        }
        std::vector<std::uint32_t> row_of(static_cast<std::size_t>(nodes), no_row);
        for (std::size_t row = 0; row < csv_.lines.size(); ++row) {
            std::uint32_t& place = row_of[node_of(parts, row)];
            if (place != no_row) {
                errors_.add(csv_.lines[row], 1, "repeats the position of line " + std::to_string(csv_.lines[place]));
            }
            place = static_cast<std::uint32_t>(row);
        }
        errors_.throw_any();
        require_whole(parts, row_of);
        for (std::size_t column = first_field; column < column_names.size(); ++column) {
            if (csv_.has(column)) {
                GridField field{std::string(column_names[column]), {}};
                field.values.reserve(row_of.size());
                for (const std::uint32_t row : row_of) {
                    field.values.push_back(csv_.columns[column][row]);
                }
                parts.fields.push_back(std::move(field));
            }
        }
    }

 private:
    static constexpr std::uint32_t no_row = UINT32_MAX;

    GridAxis axis(std::size_t column) {
        const std::vector<double> values = distinct_values(csv_.columns[column]);
        if (values.size() < 2) {
            errors_.add(0, "column " + std::string(column_names[column]) + " holds " + to_text(values[0]) +
                               " only: expected two or more coordinates" +
                               (column == y ? ", or no such column for a planar grid" : ""));
        }
        return {values.front(), values.back(), values.size()};
    }

    /// Index along an axis.
    std::size_t index_of(const GridAxis& axis, std::size_t column, std::size_t row) {
        const double value = csv_.columns[column][row];
        const double steps = std::round((value - axis.low_m) / axis.step_m());
        const auto index = std::min(static_cast<std::size_t>(std::max(0.0, steps)), axis.count - 1);
        if (!(std::abs(value - axis.at(index)) <= spacing_slack * axis.step_m())) {
            errors_.add(csv_.lines[row], 1,
                        std::string(column_names[column]) + " is " + to_text(value) + ": expected " +
                            to_text(axis.at(index), 9) + ", as the " + std::to_string(axis.count) +
                            " coordinates from " + to_text(axis.low_m) + " to " + to_text(axis.high_m) + " are " +
                            to_text(axis.step_m(), 9) + " apart if they are equally spaced");
        }
        return index;
    }

    std::size_t node_of(const FactorGridParts& parts, std::size_t row) {
        std::size_t layer = 0;
        if (csv_.has(lateral)) {
            const std::vector<double>& offsets_m = parts.lateral_offsets_m;
            const auto above = std::upper_bound(offsets_m.begin(), offsets_m.end(), csv_.columns[lateral][row]);
            layer = static_cast<std::size_t>(above - offsets_m.begin()) - 1;
        }
        const std::size_t i = index_of(parts.x, Column::x, row);
        const std::size_t j = csv_.has(y) ? index_of(parts.y, y, row) : 0;
        const std::size_t k = index_of(parts.z, Column::z, row);
        return ((layer * parts.z.count + k) * parts.y.count + j) * parts.x.count + i;
    }

    void require_whole(const FactorGridParts& parts, const std::vector<std::uint32_t>& row_of) {
        const auto hole = std::find(row_of.begin(), row_of.end(), no_row);
        if (hole == row_of.end()) {
            return;
        }
        auto rest = static_cast<std::size_t>(hole - row_of.begin());
        const auto take = [&rest](std::size_t count) {
            const std::size_t index = rest % count;
            rest /= count;
            return index;
        };
        std::string place = "x_m " + to_text(parts.x.at(take(parts.x.count)));
        const std::size_t j = take(parts.y.count);
        place += csv_.has(y) ? ", y_m " + to_text(parts.y.at(j)) : "";
        place += ", z_m " + to_text(parts.z.at(take(parts.z.count)));
        place += csv_.has(lateral) ? ", lateral_m " + to_text(parts.lateral_offsets_m[rest]) : "";
        errors_.add(0, "there is no row at " + place + ", the first of " +
                           std::to_string(std::count(row_of.begin(), row_of.end(), no_row)) +
                           " holes: expected every combination of the coordinates");
        errors_.throw_any();
    }

    const GridCsv& csv_;
    LineErrors& errors_;
};

}  // namespace

FactorGrid parse_factor_grid(std::string_view bytes, const std::string& name, const PlaneOfMotion& plane) {
    LineErrors errors(name);
    GridCsv csv = CsvReader(bytes, errors).read();
    FactorGridParts parts;
    NodeFinder(csv, errors).fill(parts);
    parts.provenance = std::move(csv.provenance);
    const PlaneOfMotion otherwise = csv.has(y) ? PlaneOfMotion() : plane;
    parts.frame = PlaneOfMotion(csv.frame_origin_m.value_or(otherwise.origin_m()),
                                csv.frame_heading_rad.value_or(otherwise.heading_rad()));
    try {
        return FactorGrid(std::move(parts));
    } catch (const InputError& invalid) {
        for (const KeyError& error : invalid.errors()) {
            errors.add(0, error.key + (error.key.empty() ? "" : " ") + error.message);
        }
    }
    errors.throw_any();
    throw std::logic_error("a rejected grid has an error");
}

}  // namespace downwash

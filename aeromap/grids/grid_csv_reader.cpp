#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include "downwash/base/csv_dialect.hpp"
#include "downwash/base/csv_reader.hpp"
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
/// How far a coordinate may be off its node, in steps; farther if it is rounded, but not by more than the second.
constexpr double min_slack = 1e-6;
constexpr double max_slack = 0.05;

enum Column : std::size_t { x, lateral, y, z, first_field };
constexpr std::array<std::string_view, 8> column_names{"x_m",    "lateral_m", "y_m",     "z_m",
                                                       "factor", "ground",    "ceiling", "flyable"};

/// How finely a column of coordinates is written.
class WrittenUnit {
 public:
    void see(std::string_view number) {
        const WrittenDigits digits = written_digits(number);
        is_fixed_ = is_fixed_ && (significant_ == 0 || digits.decimals == decimals_);
        decimals_ = significant_ == 0 ? digits.decimals : std::max(decimals_, digits.decimals);
        significant_ = std::max({1, significant_, digits.significant});
    }

    /// The unit of the last digit of a coordinate: of a fixed number of decimals if all have as many, else of as many
    /// significant digits as the longest has. Trailing zeros may be missing, so there are at least five.
    [[nodiscard]] double of(double coordinate_m) const {
        constexpr int min_significant = 5;
        constexpr double float_unit = 0x1p-23;  // of flow solvers that write their single precision with more digits
        const double size_m = std::abs(coordinate_m);
        const double whole_digits = size_m > 0 ? std::floor(std::log10(size_m)) + 1 : -decimals_;
        const double decimals =
            is_fixed_ && decimals_ > 0 ? decimals_ : std::max(min_significant, significant_) - whole_digits;
        return std::max(std::pow(10, -decimals), float_unit * size_m);
    }

 private:
    bool is_fixed_ = true;
    int decimals_ = 0, significant_ = 0;
};

struct GridCsv {
    std::array<std::vector<double>, column_names.size()> columns;  ///< empty where the file has none
    std::array<WrittenUnit, first_field> units;                    ///< of the coordinates
    std::vector<std::uint32_t> lines;                              ///< of each row
    std::optional<Vector3> frame_origin_m;
    std::optional<double> frame_heading_rad;
    Provenance provenance;
    CsvFacts facts;

    [[nodiscard]] bool has(std::size_t column) const { return !columns[column].empty(); }
};

constexpr std::string_view xml_remedy =
    "VTK's XML is written by Downwash, not read: expected CSV (`downwash aeromap build PROBLEM -o FILE.csv`, or in "
    "ParaView: File, Save Data, as CSV)";
constexpr std::string_view expected_columns = "x_m,z_m,factor or x_m,y_m,z_m,factor";

/// The column of one of our names, or of the name by which ParaView saves that coordinate of points.
std::optional<std::size_t> column_of(const CsvReader& csv, std::size_t role) {
    auto column = csv.find(column_names[role]);
    if (role == Column::x || role == y || role == z) {
        const char index = static_cast<char>(role == Column::x ? '0' : role == y ? '1' : '2');
        for (const char* points : {"Points:", "Points_"}) {
            column = column ? column : csv.find(points + std::string(1, index));
        }
    }
    return column;
}

/// Reads lines into columns.
class GridCsvReader {
 public:
    GridCsvReader(std::string_view text, LineErrors& errors)
        : csv_(text, errors, {max_rows, max_columns}), errors_(errors) {}

    GridCsv read() {
        find_columns();
        errors_.throw_any();
        while (csv_.next()) {
            grid_.lines.push_back(static_cast<std::uint32_t>(csv_.line()));
            for (std::size_t role = 0; role < column_names.size(); ++role) {
                if (columns_[role]) {
                    read_cell(*columns_[role], role);
                }
            }
        }
        for (const CsvReader::Comment& comment : csv_.comments()) {
            read_comment(comment);
        }
        errors_.throw_any();
        if (grid_.lines.empty()) {
            errors_.add(0, "holds no row");
        }
        errors_.throw_any();
        grid_.facts = csv_.facts();
        return std::move(grid_);
    }

 private:
    void read_comment(const CsvReader::Comment& comment) {
        auto [key, value] = provenance_entry(comment.text);
        if (key == "frame_origin_m") {
            if (const auto numbers = numbers_in(value, 3, comment.line); !numbers.empty()) {
                grid_.frame_origin_m = {numbers[0], numbers[1], numbers[2]};
            }
        } else if (key == "frame_heading_rad") {
            if (const auto numbers = numbers_in(value, 1, comment.line); !numbers.empty()) {
                grid_.frame_heading_rad = numbers[0];
            }
        } else if (!value.empty() || key != "comment") {
            grid_.provenance.emplace_back(std::move(key), std::move(value));
        }
    }

    /// Exactly so many finite numbers, or an error and none.
    std::vector<double> numbers_in(std::string_view text, std::size_t count, std::size_t line) {
        std::vector<double> numbers;
        // Spreadsheets fill lines with separators.
        std::string_view rest = text.substr(0, text.find_last_not_of(",; \t") + 1);
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
            line, 1,
            "'" + excerpt(text) + "': expected " + std::to_string(count) + " finite number" + (count == 1 ? "" : "s"));
        return {};
    }

    void find_columns() {
        for (std::size_t role = 0; role < column_names.size(); ++role) {
            columns_[role] = column_of(csv_, role);
        }
        for (const std::size_t needed : {std::size_t{Column::x}, std::size_t{z}, std::size_t{first_field}}) {
            if (!columns_[needed]) {
                static_cast<void>(csv_.required(column_names[needed], expected_columns));
            }
        }
        if (columns_[lateral] && columns_[y]) {
            errors_.add(csv_.header_line(), "expected lateral_m (layers beside the plane) or y_m (a volume), not both");
        }
    }

    void read_cell(std::size_t column, std::size_t role) {
        const bool is_coordinate = role < first_field;
        const double min = is_coordinate ? -1e6 : 0;
        const double max = is_coordinate ? 1e6 : (column_names[role] == "flyable" ? 1 : 100);
        const auto number = csv_.number(column, min, max);
        grid_.columns[role].push_back(number.value_or(0));
        if (is_coordinate && number) {
            grid_.units[role].see(csv_.cell(column));
        }
    }

    CsvReader csv_;
    LineErrors& errors_;
    std::array<std::optional<std::size_t>, column_names.size()> columns_;
    GridCsv grid_;
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
        parts.edge_slack_m = {edge_slack_m(parts.x, Column::x), edge_slack_m(parts.y, y), edge_slack_m(parts.z, z)};
        parts.layer_slack_m = layer_slack_m(parts.lateral_offsets_m);
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

    /// Half a unit of the last digit of the ends of an axis, where its coordinates may have been before they were
    /// rounded.
    double edge_slack_m(const GridAxis& axis, std::size_t column) const {
        const double unit_m = std::max(csv_.units[column].of(axis.low_m), csv_.units[column].of(axis.high_m));
        return csv_.has(column) ? std::clamp(unit_m / 2, default_edge_slack_m, max_slack * axis.step_m())
                                : default_edge_slack_m;
    }

    double layer_slack_m(const std::vector<double>& offsets_m) const {
        double slack_m = default_layer_slack_m;
        double max_slack_m = std::numeric_limits<double>::infinity();
        for (std::size_t i = 0; i < offsets_m.size(); ++i) {
            slack_m = std::max(slack_m, csv_.units[lateral].of(offsets_m[i]) / 2);
            max_slack_m = i > 0 ? std::min(max_slack_m, max_slack * (offsets_m[i] - offsets_m[i - 1])) : max_slack_m;
        }
        return std::max(default_layer_slack_m, std::min(slack_m, max_slack_m));
    }

    /// How far a coordinate may be off its node. It is rounded, and so are the ends of the axis that place the nodes.
    double slack_m(const GridAxis& axis, std::size_t column, double value) const {
        const WrittenUnit& unit = csv_.units[column];
        const double rounding_m = (unit.of(value) + std::max(unit.of(axis.low_m), unit.of(axis.high_m))) / 2;
        return std::clamp(rounding_m, min_slack * axis.step_m(), max_slack * axis.step_m());
    }

    /// Index along an axis.
    std::size_t index_of(const GridAxis& axis, std::size_t column, std::size_t row) {
        const double value = csv_.columns[column][row];
        const double steps = std::round((value - axis.low_m) / axis.step_m());
        const auto index = std::min(static_cast<std::size_t>(std::max(0.0, steps)), axis.count - 1);
        const double offset_m = std::abs(value - axis.at(index));
        if (!(offset_m <= min_slack * axis.step_m() || offset_m <= slack_m(axis, column, value))) {
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
    if (trimmed(bytes.substr(0, bytes.find('>'))).starts_with('<')) {
        errors.add(1, 1, std::string(xml_remedy));
        errors.throw_any();
    }
    GridCsv csv = GridCsvReader(bytes, errors).read();
    FactorGridParts parts;
    NodeFinder(csv, errors).fill(parts);
    parts.provenance = std::move(csv.provenance);
    parts.csv = std::move(csv.facts);
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

#include "downwash/thrust_stand/stand_log.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "downwash/base/csv_dialect.hpp"
#include "downwash/base/text.hpp"

namespace downwash::thrust_stand {
namespace {

constexpr CsvReader::Limits limits{2'000'000, 256};

/// A cell as a number, which may end with a percent sign. NaN for an empty one, and with an error for no number.
double number_at(CsvReader& csv, std::size_t column) {
    constexpr double nothing = std::numeric_limits<double>::quiet_NaN();
    const std::string_view cell = csv.cell(column);
    if (cell.empty() || cell == "-" || is_same_word(cell, "nan") || is_same_word(cell, "n/a")) {
        return nothing;
    }
    if (cell.ends_with('%')) {
        const std::string_view digits = trimmed(cell.substr(0, cell.size() - 1));
        if (const auto number = decimal_number(digits, csv.facts().decimal_sign)) {
            return *number;
        }
    }
    constexpr double most = 1e15;  // time stamps in us, and squares of all else are finite
    return csv.number(column, -most, most).value_or(nothing);
}

/// Of several columns of one quantity, such as two speeds, the first that is ever above 0.
std::vector<FoundColumn> preferred(const std::vector<FoundColumn>& columns,
                                   const std::vector<std::vector<double>>& numbers) {
    std::vector<FoundColumn> chosen;
    for (std::size_t i = 0; i < columns.size(); ++i) {
        const bool is_moving = std::ranges::any_of(numbers[i], [](double x) { return std::abs(x) > 0; });
        const auto other = std::ranges::find(chosen, columns[i].quantity, &FoundColumn::quantity);
        if (other == chosen.end() && is_moving) {
            chosen.push_back(columns[i]);
        }
    }
    return chosen;
}

/// Whether most of a quantity's sum is below 0, as on a stand that is mounted the other way around.
void turn_signs(std::vector<StandRow>& rows, Quantity quantity, std::vector<std::string>& remarks,
                const std::string& file) {
    double sum = 0;
    for (const StandRow& row : rows) {
        sum += std::isfinite(row[quantity]) ? row[quantity] : 0;
    }
    if (sum >= 0) {
        return;
    }
    for (StandRow& row : rows) {
        row[quantity] = -row[quantity];
    }
    if (quantity == Quantity::thrust) {
        remarks.push_back(file + ": thrust is below 0, and its sign was turned");
    }
}

/// Thrust T = CT rho n^2 D^4 and shaft power P = CP rho n^3 D^5 of coefficients as propellers have them, with n in 1/s.
void add_from_coefficients(StandRow& row, const ThrustStandSettings& settings) {
    const double n = row[Quantity::speed] / (2 * std::numbers::pi), diameter_m = 2 * *settings.radius_m;
    const double square = settings.air_density_kg_m3 * n * n * std::pow(diameter_m, 4);
    row[Quantity::thrust] = row[Quantity::ct] * square;
    row[Quantity::shaft_power] = row[Quantity::cp] * square * n * diameter_m;
    row[Quantity::torque] = n > 0 ? row[Quantity::shaft_power] / row[Quantity::speed] : 0;
}

bool has(const std::vector<StandRow>& rows, Quantity quantity) {
    return std::ranges::any_of(rows, [quantity](const StandRow& row) { return std::isfinite(row[quantity]); });
}

void add_power(StandLog& log, std::vector<std::string>& remarks) {
    if (has(log.rows, Quantity::power)) {
        return;
    }
    if (has(log.rows, Quantity::voltage) && has(log.rows, Quantity::current)) {
        for (StandRow& row : log.rows) {
            row[Quantity::power] = row[Quantity::voltage] * row[Quantity::current];
        }
        remarks.push_back(log.facts.file + ": power is voltage times current");
        return;
    }
    if (!has(log.rows, Quantity::shaft_power) && has(log.rows, Quantity::torque) && has(log.rows, Quantity::speed)) {
        for (StandRow& row : log.rows) {
            row[Quantity::shaft_power] = std::abs(row[Quantity::torque]) * row[Quantity::speed];
        }
    }
    if (has(log.rows, Quantity::shaft_power)) {
        log.is_of_shaft_power = true;
        for (StandRow& row : log.rows) {
            row[Quantity::power] = row[Quantity::shaft_power];
        }
        remarks.push_back(log.facts.file +
                          ": there is no electrical power; taken is that of the shaft, without losses of the motor");
    }
}

}  // namespace

StandLog parse_stand_log(std::string_view text, const std::string& name, const ThrustStandSettings& settings,
                         std::vector<std::string>& remarks) {
    LineErrors errors(name);
    CsvReader csv(text, errors, limits);
    const std::vector<FoundColumn> columns = find_columns(csv, settings, errors);
    std::vector<std::vector<double>> numbers(columns.size());
    while (csv.next()) {
        for (std::size_t i = 0; i < columns.size(); ++i) {
            numbers[i].push_back(columns[i].factor * number_at(csv, columns[i].index));
        }
    }
    errors.throw_any();
    StandLog log;
    log.facts.file = name;
    log.facts.rows = csv.facts().rows;
    log.rows.resize(numbers[0].size());
    const std::vector<FoundColumn> chosen = preferred(columns, numbers);
    for (std::size_t i = 0; i < columns.size(); ++i) {
        const auto is_it = [&](const FoundColumn& column) { return column.index == columns[i].index; };
        if (!std::ranges::any_of(chosen, is_it)) {
            continue;
        }
        for (std::size_t row = 0; row < log.rows.size(); ++row) {
            log.rows[row][columns[i].quantity] = numbers[i][row];
        }
        log.facts.columns.push_back(
            {std::string(name_of(columns[i].quantity)), csv.names()[columns[i].index], columns[i].unit});
    }
    for (std::size_t i = 0; i < csv.names().size(); ++i) {
        const bool is_taken = std::ranges::any_of(chosen, [i](const FoundColumn& column) { return column.index == i; });
        if (!is_taken && !csv.names()[i].empty()) {
            log.facts.others.push_back(csv.names()[i]);
        }
    }
    if (has(log.rows, Quantity::ct) && !has(log.rows, Quantity::thrust)) {
        for (StandRow& row : log.rows) {
            add_from_coefficients(row, settings);
        }
    }
    if (!has(log.rows, Quantity::thrust)) {
        errors.add(csv.header_line(), "no thrust follows: expected rows with one above 0");
        errors.throw_any();
    }
    log.has_time = has(log.rows, Quantity::time);
    turn_signs(log.rows, Quantity::thrust, remarks, name);
    turn_signs(log.rows, Quantity::torque, remarks, name);
    turn_signs(log.rows, Quantity::speed, remarks, name);
    add_power(log, remarks);
    return log;
}

}  // namespace downwash::thrust_stand

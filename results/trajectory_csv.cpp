#include "downwash/results/trajectory_csv.hpp"

#include <charconv>
#include <cmath>
#include <iterator>
#include <sstream>
#include <vector>

namespace downwash {
namespace {

/// The names of all columns, separated by commas.
std::string header(const Execution& execution) {
    std::string names = "t_s,";
    for (const Axis& axis : planar_axes) {
        names += "ref_" + std::string(axis.position) + ',';
    }
    names +=
        "x_m,z_m,pitch_rad,arm_rad,vx_m_s,vz_m_s,pitch_rate_rad_s,arm_rate_rad_s,"
        "thrust_cmd_n,pitch_torque_cmd_nm,arm_torque_nm,thrust_n,pitch_torque_nm,aero_factor_min,aero_factor_max,"
        "clearance_m,ee_x_m,ee_z_m,power_w,energy_j";
    for (int i = 1; i <= execution.rotor_count; ++i) {
        const std::string rotor = ",rotor_" + std::to_string(i);
        names += rotor + "_cmd_n";
        names += rotor + "_aero_factor";
        if (execution.has_rotor_lag) {
            names += rotor + "_lag_n";
        }
    }
    return names + (has_touch(execution) ? ",contact_force_n" : "");
}
constexpr std::size_t clearance_column = 19;

/// The numbers of a row in the order of the columns.
std::vector<double> numbers_of(const Execution& execution, const FlightRow& row) {
    double min_factor = row.rotor_factor[0];
    double max_factor = min_factor;
    for (int i = 1; i < execution.rotor_count; ++i) {
        min_factor = std::fmin(min_factor, row.rotor_factor[i]);
        max_factor = std::fmax(max_factor, row.rotor_factor[i]);
    }
    const double* reference = row.reference.position;
    const double* q = row.q;
    const double* u = row.u;
    // clang-format off
    std::vector<double> numbers{
        row.t_s, reference[plane::x], reference[plane::z], reference[plane::arm],
        q[0], q[1], q[2], q[3], u[0], u[1], u[2], u[3],
        row.thrust_command_n, row.pitch_torque_command_nm, row.arm_torque_nm, row.thrust_n, row.pitch_torque_nm,
        min_factor, max_factor, std::isinf(row.clearance_m) ? NAN : row.clearance_m,
        row.end_effector_x_m, row.end_effector_z_m, row.power_w, row.energy_j};
    // clang-format on
    for (int i = 0; i < execution.rotor_count; ++i) {
        numbers.push_back(row.rotor_command_n[i]);
        numbers.push_back(row.rotor_factor[i]);
        if (execution.has_rotor_lag) {
            numbers.push_back(row.rotor_lag_n[i]);
        }
    }
    if (has_touch(execution)) {
        numbers.push_back(row.contact_force_n);
    }
    return numbers;
}

}  // namespace

NumberTable trajectory_table(const Execution& execution) {
    NumberTable table;
    std::istringstream names(header(execution));
    for (std::string name; std::getline(names, name, ',');) {
        table.names.push_back(name);
    }
    table.columns.resize(table.names.size());
    for (const FlightRow& row : execution.rows) {
        table.add_row(numbers_of(execution, row));
    }
    return table;
}

std::string trajectory_csv(const Execution& execution) {
    constexpr std::size_t typical_number = 20;
    const auto columns = 24 + 3 * static_cast<std::size_t>(execution.rotor_count);
    std::string text;
    text.reserve((execution.rows.size() + 1) * columns * typical_number);
    text += header(execution) + "\n";
    for (const FlightRow& row : execution.rows) {
        const std::vector<double> numbers = numbers_of(execution, row);
        for (std::size_t i = 0; i < numbers.size(); ++i) {
            char digits[32];
            const bool is_empty = i == clearance_column && std::isinf(row.clearance_m);
            text.append(digits, is_empty ? digits : std::to_chars(digits, std::end(digits), numbers[i]).ptr);
            text += i + 1 < numbers.size() ? ',' : '\n';
        }
    }
    return text;
}

}  // namespace downwash

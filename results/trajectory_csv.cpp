#include "downwash/results/trajectory_csv.hpp"

#include <charconv>
#include <cmath>
#include <string_view>

namespace downwash {
namespace {

constexpr std::string_view common_columns =
    "t_s,ref_x_m,ref_z_m,ref_arm_rad,x_m,z_m,pitch_rad,arm_rad,vx_m_s,vz_m_s,pitch_rate_rad_s,arm_rate_rad_s,"
    "thrust_cmd_n,pitch_torque_cmd_nm,arm_torque_nm,thrust_n,pitch_torque_nm,aero_factor_min,aero_factor_max,"
    "clearance_m,ee_x_m,ee_z_m,power_w,energy_j";

void append(std::string& text, double value) {
    char digits[32];
    const auto end = std::to_chars(std::begin(digits), std::end(digits), value).ptr;
    text.append(digits, end);
}

template <class... Numbers>
void append_columns(std::string& text, Numbers... numbers) {
    ((text.push_back(','), append(text, numbers)), ...);
}

void append_header(std::string& text, const Execution& execution) {
    text += common_columns;
    for (int i = 1; i <= execution.rotor_count; ++i) {
        const std::string rotor = ",rotor_" + std::to_string(i);
        text += rotor + "_cmd_n";
        text += rotor + "_aero_factor";
        if (execution.has_rotor_lag) {
            text += rotor + "_lag_n";
        }
    }
    text.push_back('\n');
}

void append_row(std::string& text, const Execution& execution, const FlightRow& row) {
    double least = row.rotor_factor[0];
    double greatest = least;
    for (int i = 1; i < execution.rotor_count; ++i) {
        least = std::fmin(least, row.rotor_factor[i]);
        greatest = std::fmax(greatest, row.rotor_factor[i]);
    }
    const double* reference = row.reference.position;
    append(text, row.t_s);
    append_columns(text, reference[0], reference[1], reference[2]);
    append_columns(text, row.q[0], row.q[1], row.q[2], row.q[3], row.u[0], row.u[1], row.u[2], row.u[3]);
    append_columns(text, row.thrust_command_n, row.pitch_torque_command_nm, row.arm_torque_nm);
    append_columns(text, row.thrust_n, row.pitch_torque_nm, least, greatest);
    if (std::isinf(row.clearance_m)) {
        text.push_back(',');
    } else {
        append_columns(text, row.clearance_m);
    }
    append_columns(text, row.end_effector_x_m, row.end_effector_z_m, row.power_w, row.energy_j);
    for (int i = 0; i < execution.rotor_count; ++i) {
        append_columns(text, row.rotor_command_n[i], row.rotor_factor[i]);
        if (execution.has_rotor_lag) {
            append_columns(text, row.rotor_lag_n[i]);
        }
    }
    text.push_back('\n');
}

}  // namespace

std::string trajectory_csv(const Execution& execution) {
    constexpr std::size_t typical_number = 20;
    const auto columns = 24 + 3 * static_cast<std::size_t>(execution.rotor_count);
    std::string text;
    text.reserve((execution.rows.size() + 1) * columns * typical_number);
    append_header(text, execution);
    for (const FlightRow& row : execution.rows) {
        append_row(text, execution, row);
    }
    return text;
}

}  // namespace downwash

#include "downwash/results/space_trajectory_csv.hpp"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <span>
#include <vector>

#include "downwash/controllers/space_axes.hpp"

namespace downwash {
namespace {

bool touches(const SpaceFlight& flight) {
    return std::ranges::any_of(flight.goals, [](const SpaceGoalVisit& visit) { return visit.touch.has_value(); });
}

std::vector<std::string> names_of(const SpaceFlight& flight) {
    const std::span<const Axis> axes = axes_in_space(flight.joints);
    const std::span<const Axis> joints = axes.subspan(space::first_joint);
    std::vector<std::string> names{"t_s"};
    for (const Axis& axis : axes) {
        names.push_back("ref_" + std::string(axis.position));
    }
    const auto add = [&names](std::initializer_list<const char*> more) {
        names.insert(names.end(), more.begin(), more.end());
    };
    add({"x_m", "y_m", "z_m", "qw", "qx", "qy", "qz"});
    for (const Axis& axis : joints) {
        names.emplace_back(axis.position);
    }
    add({"vx_m_s", "vy_m_s", "vz_m_s", "wx_rad_s", "wy_rad_s", "wz_rad_s"});
    for (const Axis& axis : joints) {
        names.emplace_back(axis.velocity);
    }
    for (int i = 1; i <= flight.joints; ++i) {
        names.push_back("joint_" + std::to_string(i) + "_torque_nm");
    }
    add({"aero_factor_min", "aero_factor_max", "clearance_m", "ee_x_m", "ee_y_m", "ee_z_m", "power_w", "energy_j"});
    for (int i = 1; i <= flight.rotor_count; ++i) {
        const std::string rotor = "rotor_" + std::to_string(i);
        names.push_back(rotor + "_cmd_n");
        if (flight.has_rotor_lag) {
            names.push_back(rotor + "_lag_n");
        }
        names.push_back(rotor + "_aero_factor");
    }
    if (touches(flight)) {
        names.emplace_back("contact_force_n");
    }
    return names;
}

/// The numbers of a row in the order of the columns.
std::vector<double> numbers_of(const SpaceFlight& flight, const SpaceFlightRow& row) {
    std::vector<double> numbers{row.t_s};
    const auto add = [&numbers](const double* from, int count) { numbers.insert(numbers.end(), from, from + count); };
    const SpaceMotion& motion = row.motion;
    add(row.reference.position, space::first_joint + flight.joints);
    add(motion.position_m.data(), 3);
    add(motion.attitude.data(), 4);
    add(motion.joints_rad.data(), flight.joints);
    add(motion.velocity_m_s.data(), 3);
    add(motion.body_rates_rad_s.data(), 3);
    add(motion.joint_rates_rad_s.data(), flight.joints);
    add(row.joint_torque_nm, flight.joints);
    const auto [min_factor, max_factor] = std::minmax_element(row.rotor_factor, row.rotor_factor + flight.rotor_count);
    numbers.push_back(*min_factor);
    numbers.push_back(*max_factor);
    numbers.push_back(std::isinf(row.clearance_m) ? NAN : row.clearance_m);
    add(row.end_effector_m.data(), 3);
    numbers.push_back(row.power_w);
    numbers.push_back(row.energy_j);
    for (int i = 0; i < flight.rotor_count; ++i) {
        numbers.push_back(row.rotor_command_n[i]);
        if (flight.has_rotor_lag) {
            numbers.push_back(row.rotor_lag_n[i]);
        }
        numbers.push_back(row.rotor_factor[i]);
    }
    if (touches(flight)) {
        numbers.push_back(row.contact_force_n);
    }
    return numbers;
}

}  // namespace

NumberTable trajectory_table(const SpaceFlight& flight) {
    NumberTable table;
    table.names = names_of(flight);
    table.columns.resize(table.names.size());
    for (const SpaceFlightRow& row : flight.rows) {
        table.add_row(numbers_of(flight, row));
    }
    return table;
}

std::string trajectory_csv(const SpaceFlight& flight) {
    return csv_text(trajectory_table(flight));
}

}  // namespace downwash

#include "downwash/logs/csv_columns.hpp"

#include <algorithm>
#include <array>
#include <filesystem>

#include "downwash/base/csv_reader.hpp"
#include "downwash/base/text.hpp"

namespace downwash::logs {
namespace {

/// A signal, and the names that programs give to its column: ours first, then PX4's (ulog2csv), those of ROS messages
/// (`rostopic echo -p` puts `field.` before them), then plain ones.
struct Signal {
    std::string_view name;
    std::array<std::string_view, 8> written;
};

constexpr std::array signals{
    Signal{"t", {"t_s", "time_s", "timestamp", "%time", "TimeUS", "t", "time", "stamp"}},
    Signal{"x", {"x_m", "pose.pose.position.x", "pose.position.x", "position.x", "position_x", "pos_x", "px", "x"}},
    Signal{"y", {"y_m", "pose.pose.position.y", "pose.position.y", "position.y", "position_y", "pos_y", "py", "y"}},
    Signal{"z", {"z_m", "pose.pose.position.z", "pose.position.z", "position.z", "position_z", "pos_z", "pz", "z"}},
    Signal{"vx", {"vx_m_s", "twist.twist.linear.x", "twist.linear.x", "velocity.x", "velocity_x", "vel_x", "vx"}},
    Signal{"vy", {"vy_m_s", "twist.twist.linear.y", "twist.linear.y", "velocity.y", "velocity_y", "vel_y", "vy"}},
    Signal{"vz", {"vz_m_s", "twist.twist.linear.z", "twist.linear.z", "velocity.z", "velocity_z", "vel_z", "vz"}},
    Signal{"qw",
           {"q[0]", "pose.pose.orientation.w", "pose.orientation.w", "orientation.w", "orientation_w", "q_w", "qw"}},
    Signal{"qx",
           {"q[1]", "pose.pose.orientation.x", "pose.orientation.x", "orientation.x", "orientation_x", "q_x", "qx"}},
    Signal{"qy",
           {"q[2]", "pose.pose.orientation.y", "pose.orientation.y", "orientation.y", "orientation_y", "q_y", "qy"}},
    Signal{"qz",
           {"q[3]", "pose.pose.orientation.z", "pose.orientation.z", "orientation.z", "orientation_z", "q_z", "qz"}},
    Signal{"roll", {"roll_rad", "roll_deg", "roll"}},
    Signal{"pitch", {"pitch_rad", "pitch_deg", "pitch"}},
    Signal{"yaw", {"yaw_rad", "yaw_deg", "yaw"}},
    Signal{"wx", {"wx_rad_s", "xyz[0]", "gyro_rad[0]", "angular_velocity.x", "angular_velocity_x", "rollspeed", "wx"}},
    Signal{"wy",
           {"wy_rad_s", "xyz[1]", "gyro_rad[1]", "angular_velocity.y", "angular_velocity_y", "pitchspeed",
            "pitch_rate_rad_s", "wy"}},
    Signal{"wz", {"wz_rad_s", "xyz[2]", "gyro_rad[2]", "angular_velocity.z", "angular_velocity_z", "yawspeed", "wz"}},
    Signal{"ax", {"accelerometer_m_s2[0]", "linear_acceleration.x", "linear_acceleration_x", "acc_x", "ax"}},
    Signal{"ay", {"accelerometer_m_s2[1]", "linear_acceleration.y", "linear_acceleration_y", "acc_y", "ay"}},
    Signal{"az", {"accelerometer_m_s2[2]", "linear_acceleration.z", "linear_acceleration_z", "acc_z", "az"}},
    Signal{"set_x", {"ref_x_m", "position[0]"}},
    Signal{"set_y", {"ref_y_m", "position[1]"}},
    Signal{"set_z", {"ref_z_m", "position[2]"}},
};

/// Signals with a number from 1; `{}` stands for it in what programs write, `{0}` for one that counts from 0.
struct NumberedSignal {
    std::string_view beginning;
    std::array<std::string_view, 4> written;
};

constexpr std::array numbered_signals{
    NumberedSignal{"joint_", {"joint_{}_rad", "joint_{}_deg", "joint_{}", "position{0}"}},
    NumberedSignal{"joint_rate_", {"joint_{}_rate_rad_s", "joint_rate_{}"}},
    NumberedSignal{"rotor_", {"rotor_{}_cmd_n", "control[{0}]", "output[{0}]", "rotor_{}"}},
};
constexpr int max_numbered = 32;

std::string with_number(std::string_view pattern, int number) {
    std::string text(pattern);
    const std::size_t one = text.find("{}"), zero = text.find("{0}");
    if (one != std::string::npos) {
        text.replace(one, 2, std::to_string(number));
    } else if (zero != std::string::npos) {
        text.replace(zero, 3, std::to_string(number - 1));
    }
    return text;
}

bool contains(std::string_view text, std::string_view part) {
    return text.find(part) != std::string_view::npos;
}

}  // namespace

CsvColumns::CsvColumns(const std::vector<std::string>& names,
                       std::span<const std::pair<std::string, std::string>> declared, const std::string& file)
    : names_(names), declared_(declared) {
    const std::string stem = std::filesystem::path(file).stem().string();
    is_of_ulog_ = contains(stem, "vehicle_") || contains(stem, "actuator_") || contains(stem, "trajectory_setpoint") ||
                  contains(stem, "sensor_combined");
    holds_setpoints_ = is_of_ulog_ && contains(stem, "setpoint");
}

std::optional<std::size_t> CsvColumns::column_named(std::string_view name) const {
    if (const auto found = find_column(names_, name)) {
        return found;
    }
    return find_column(names_, "field." + std::string(name));
}

std::optional<SignalColumn> CsvColumns::find(std::string_view name) const {
    for (const auto& [signal, column] : declared_) {
        if (signal == name) {
            const auto found = find_column(names_, column);
            return found ? std::optional(SignalColumn{*found, {}}) : std::nullopt;
        }
    }
    if (holds_setpoints_ && (name == "x" || name == "y" || name == "z")) {
        return std::nullopt;
    }
    if (holds_setpoints_ && name.starts_with("set_")) {
        if (const auto found = column_named(name.substr(4))) {
            return SignalColumn{*found, name.substr(4)};
        }
    }
    const auto signal = std::ranges::find(signals, name, &Signal::name);
    if (signal == signals.end()) {
        return std::nullopt;
    }
    for (const std::string_view written : signal->written) {
        if (written.starts_with("position[") && !is_of_ulog_) {
            continue;  // such as the joints of others
        }
        if (const auto found = written.empty() ? std::nullopt : column_named(written)) {
            return SignalColumn{*found, written};
        }
    }
    return std::nullopt;
}

std::vector<SignalColumn> CsvColumns::find_numbered(std::string_view beginning) const {
    std::vector<SignalColumn> found;
    for (int number = 1; number <= max_numbered; ++number) {
        const std::string name = std::string(beginning) + std::to_string(number);
        const auto declared = std::ranges::find(declared_, name, &std::pair<std::string, std::string>::first);
        if (declared == declared_.end()) {
            break;
        }
        if (const auto column = find_column(names_, declared->second)) {
            found.push_back({*column, {}});
        }
    }
    if (!found.empty()) {
        return found;
    }
    const auto signal = std::ranges::find(numbered_signals, beginning, &NumberedSignal::beginning);
    for (const std::string_view written : signal->written) {
        for (int number = 1; number <= max_numbered && !written.empty(); ++number) {
            const auto column = column_named(with_number(written, number));
            if (!column) {
                break;
            }
            found.push_back({*column, written});
        }
        if (!found.empty()) {
            return found;
        }
    }
    if (beginning != "rotor_") {
        const std::string_view arm = beginning == "joint_" ? "arm_rad" : "arm_rate_rad_s";
        if (const auto column = column_named(arm)) {
            found.push_back({*column, arm});
        }
    }
    return found;
}

bool CsvColumns::is_own() const {
    return find_column(names_, "t_s") && find_column(names_, "ref_x_m") && find_column(names_, "x_m");
}

std::optional<LogAxes> CsvColumns::axes() const {
    const auto x = find("x");
    if (is_of_ulog_) {
        return LogAxes::down;
    }
    if (is_own() || (x && contains(x->written, "pose."))) {
        return LogAxes::up;  // ROS: REP 103
    }
    return std::nullopt;
}

bool is_csv_signal(std::string_view name) {
    const std::vector<std::string> known = csv_signal_names();
    return std::ranges::find(known, name) != known.end();
}

}  // namespace downwash::logs

namespace downwash {

std::vector<std::string> csv_signal_names() {
    std::vector<std::string> names;
    names.reserve(logs::signals.size() + logs::numbered_signals.size() * logs::max_numbered);
    for (const logs::Signal& signal : logs::signals) {
        names.emplace_back(signal.name);
    }
    for (const logs::NumberedSignal& signal : logs::numbered_signals) {
        for (int number = 1; number <= logs::max_numbered; ++number) {
            names.push_back(std::string(signal.beginning) + std::to_string(number));
        }
    }
    return names;
}

}  // namespace downwash

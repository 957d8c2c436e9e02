#include "downwash/logs/csv_columns.hpp"

#include <algorithm>
#include <array>
#include <cctype>
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
    Signal{"set_x", {"ref_x_m", "ref_x", "set_x"}},
    Signal{"set_y", {"ref_y_m", "ref_y", "set_y"}},
    Signal{"set_z", {"ref_z_m", "ref_z", "set_z"}},
};

/// Signals with a number from 1; `{}` stands for it in what programs write, `{0}` for one that counts from 0.
struct NumberedSignal {
    std::string_view beginning;
    std::array<std::string_view, 7> written;
};

constexpr std::array numbered_signals{
    NumberedSignal{"joint_", {"joint_{}_rad", "joint_{}_deg", "joint_{}", "joint{}", "position{0}"}},
    NumberedSignal{"joint_rate_", {"joint_{}_rate_rad_s", "joint_{}_rate", "joint_rate_{}", "joint{}_rate"}},
    NumberedSignal{"joint_torque_", {"joint_{}_torque_nm", "joint_torque_{}", "joint{}_torque", "effort{0}"}},
    NumberedSignal{"rotor_",
                   {"rotor_{}_cmd_n", "control[{0}]", "output[{0}]", "rotor_{}", "rotor{}", "motor_{}", "motor{}"}},
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

/// The names of a direction, of places and of velocities.
struct Direction {
    std::array<std::string_view, 3> places;
    std::array<std::string_view, 2> velocities;
};
constexpr Direction north{{"north", "pn", "pos_n"}, {"vn", "vel_n"}}, east{{"east", "pe", "pos_e"}, {"ve", "vel_e"}},
    down{{"down", "pd", "pos_d"}, {"vd", "vel_d"}}, up{{"up", "pu", "pos_u"}, {"vu", "vel_u"}};

struct TopicName {
    std::string_view name;
    UlogTopic topic;
};
constexpr std::array topic_names{
    TopicName{"vehicle_local_position", UlogTopic::local_position},
    TopicName{"vehicle_odometry", UlogTopic::odometry},
    TopicName{"trajectory_setpoint", UlogTopic::setpoint},
    TopicName{"vehicle_local_position_setpoint", UlogTopic::setpoint},
    TopicName{"vehicle_attitude", UlogTopic::other},
    TopicName{"vehicle_angular_velocity", UlogTopic::other},
    TopicName{"vehicle_acceleration", UlogTopic::other},
    TopicName{"sensor_combined", UlogTopic::other},
    TopicName{"actuator_motors", UlogTopic::other},
    TopicName{"actuator_outputs", UlogTopic::other},
};

/// The topic in a name as ulog2csv writes it: "log_vehicle_attitude_0".
UlogTopic topic_by_name(std::string_view stem) {
    const std::size_t last = stem.rfind('_');
    const bool has_instance =
        last != std::string_view::npos && last + 1 < stem.size() &&
        std::ranges::all_of(stem.substr(last + 1), [](unsigned char c) { return std::isdigit(c) != 0; });
    if (!has_instance) {
        return UlogTopic::none;
    }
    const std::string_view name = stem.substr(0, last);
    const auto topic = std::ranges::find_if(topic_names, [name](const TopicName& each) {
        return name == each.name || (name.ends_with(each.name) && name[name.size() - each.name.size() - 1] == '_');
    });
    return topic == topic_names.end() ? UlogTopic::none : topic->topic;
}

/// What the numbers of a signal are of.
Dimension dimension_of(std::string_view signal) {
    if (signal == "t") {
        return Dimension::time;
    }
    if (signal == "x" || signal == "y" || signal == "z" || signal.starts_with("set_")) {
        return Dimension::length;
    }
    if (signal == "roll" || signal == "pitch" || signal == "yaw" || signal == "joint_") {
        return Dimension::angle;
    }
    if (signal.starts_with("w") || signal == "joint_rate_") {
        return Dimension::rate;
    }
    return signal.starts_with("v")   ? Dimension::speed
           : signal.starts_with("a") ? Dimension::acceleration
                                     : Dimension::none;
}

}  // namespace

CsvColumns::CsvColumns(const std::vector<std::string>& names,
                       std::span<const std::pair<std::string, std::string>> declared, const std::string& file)
    : names_(names), declared_(declared) {
    plain_.reserve(names.size());
    for (const std::string& name : names) {
        plain_.push_back(column_name(name));
    }
    topic_ = topic_by_columns();
    if (topic_ == UlogTopic::none && has("timestamp")) {
        topic_ = topic_by_name(std::filesystem::path(file).stem().string());
        is_topic_by_name_ = topic_ != UlogTopic::none;
    }
}

UlogTopic CsvColumns::topic_by_columns() const {
    const auto has_one_of = [this](std::initializer_list<std::string_view> some) {
        return std::ranges::any_of(some, [this](std::string_view name) { return has(name); });
    };
    if (!has("timestamp")) {
        return UlogTopic::none;
    }
    if (has("position[0]") && has("q[0]")) {
        return UlogTopic::odometry;
    }
    if (has("position[0]") && has_one_of({"velocity[0]", "acceleration[0]", "jerk[0]", "yawspeed"})) {
        return UlogTopic::setpoint;
    }
    if (has("x")) {
        return has_one_of({"xy_valid", "xy_reset_counter", "ref_timestamp"}) ? UlogTopic::local_position
               : has_one_of({"thrust[0]", "acceleration[0]"})                ? UlogTopic::setpoint
                                                                             : UlogTopic::none;
    }
    return has_one_of({"q[0]", "xyz[0]", "gyro_rad[0]", "accelerometer_m_s2[0]", "control[0]", "output[0]"})
               ? UlogTopic::other
               : UlogTopic::none;
}

std::optional<std::size_t> CsvColumns::column_named(std::string_view name) const {
    if (const auto found = find_column(names_, name)) {
        return found;
    }
    if (const auto found = find_column(names_, "field." + std::string(name))) {
        return found;
    }
    const auto plain = std::ranges::find(plain_, name, &ColumnName::plain);
    return plain == plain_.end() ? std::nullopt : std::optional(static_cast<std::size_t>(plain - plain_.begin()));
}

SignalColumn CsvColumns::column_of(std::string_view signal, std::size_t column, std::string_view written) const {
    SignalColumn found{column, written, Dimension::none, 1};
    const ColumnName& name = plain_[column];
    // The commands of rotors may be thrusts or pulses.
    const bool is_command =
        signal == "rotor_" && (name.dimension == Dimension::force || name.dimension == Dimension::time);
    if (name.dimension != Dimension::none && (is_command || name.dimension == dimension_of(signal))) {
        found.dimension = name.dimension;
        found.factor = name.factor;
    }
    return found;
}

std::optional<SignalColumn> CsvColumns::find(std::string_view name) const {
    for (const auto& [signal, column] : declared_) {
        if (signal == name) {
            const auto found = find_column(names_, column);
            return found ? std::optional(column_of(name, *found, {})) : std::nullopt;
        }
    }
    const bool is_place = name == "x" || name == "y" || name == "z";
    if (is_place && topic_ == UlogTopic::setpoint) {
        return std::nullopt;
    }
    const std::string in_array = "position[" + std::string(1, static_cast<char>('0' + (name.back() - 'x'))) + "]";
    if ((is_place && topic_ == UlogTopic::odometry) || (name.starts_with("set_") && topic_ == UlogTopic::setpoint)) {
        const std::string_view plain = name.starts_with("set_") ? name.substr(4) : name;
        const auto found = has(in_array) ? column_named(in_array) : column_named(plain);
        return found ? std::optional(column_of(name, *found, plain)) : std::nullopt;
    }
    const auto signal = std::ranges::find(signals, name, &Signal::name);
    if (signal == signals.end()) {
        return std::nullopt;
    }
    for (const std::string_view written : signal->written) {
        if (const auto found = written.empty() ? std::nullopt : column_named(written)) {
            return column_of(name, *found, written);
        }
    }
    return find_direction(name);
}

bool CsvColumns::has_directions(LogAxes axes) const {
    const Direction& vertical = axes == LogAxes::down ? down : up;
    return std::ranges::all_of(std::array{&north, &east, &vertical}, [this](const Direction* direction) {
        return std::ranges::any_of(direction->places, [this](std::string_view name) { return has(name); });
    });
}

std::optional<SignalColumn> CsvColumns::find_direction(std::string_view signal) const {
    const bool is_down = has_directions(LogAxes::down);
    if (!is_down && !has_directions(LogAxes::up)) {
        return std::nullopt;
    }
    const bool is_velocity = signal.size() == 2 && signal[0] == 'v';
    if (signal.size() != (is_velocity ? 2U : 1U) || signal == "t") {
        return std::nullopt;
    }
    const char axis = signal.back();
    const Direction& wanted = axis == 'z' ? (is_down ? down : up) : (axis == 'x') == is_down ? north : east;
    const auto first_of = [&](const auto& names) -> std::optional<SignalColumn> {
        for (const std::string_view name : names) {
            if (const auto found = column_named(name)) {
                return column_of(signal, *found, name);
            }
        }
        return std::nullopt;
    };
    return is_velocity ? first_of(wanted.velocities) : first_of(wanted.places);
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
            found.push_back(column_of(beginning, *column, {}));
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
            found.push_back(column_of(beginning, *column, written));
        }
        if (!found.empty()) {
            return found;
        }
    }
    if (beginning != "rotor_") {
        const std::string_view arm = beginning == "joint_" ? "arm_rad" : "arm_rate_rad_s";
        if (const auto column = column_named(arm)) {
            found.push_back(column_of(beginning, *column, arm));
        }
    }
    return found;
}

bool CsvColumns::is_own() const {
    return find_column(names_, "t_s") && find_column(names_, "ref_x_m") && find_column(names_, "x_m");
}

std::optional<LogAxes> CsvColumns::axes() const {
    if (topic_ != UlogTopic::none) {
        return LogAxes::down;
    }
    const auto x = find("x");
    if (is_own() || (x && x->written.find("pose.") != std::string_view::npos)) {
        return LogAxes::up;  // ROS: REP 103
    }
    const bool is_by_direction = x && (std::ranges::find(north.places, x->written) != north.places.end() ||
                                       std::ranges::find(east.places, x->written) != east.places.end());
    return is_by_direction ? std::optional(has_directions(LogAxes::down) ? LogAxes::down : LogAxes::up) : std::nullopt;
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

#include "downwash/logs/ros_message.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "downwash/base/byte_order.hpp"
#include "downwash/base/vector3.hpp"
#include "downwash/logs/rotation.hpp"

namespace downwash::logs {
namespace {

constexpr std::array types{
    std::string_view("nav_msgs/Odometry"),
    std::string_view("geometry_msgs/PoseStamped"),
    std::string_view("geometry_msgs/PoseWithCovarianceStamped"),
    std::string_view("geometry_msgs/TransformStamped"),
    std::string_view("sensor_msgs/Imu"),
    std::string_view("geometry_msgs/TwistStamped"),
    std::string_view("sensor_msgs/JointState"),
    std::string_view("mav_msgs/Actuators"),
};

/// The numbers of a message, one after the other; zeros behind its end.
class Numbers {
 public:
    explicit Numbers(std::string_view bytes) : bytes_(bytes) {}

    template <class Number>
    Number take() {
        if (bytes_.size() < sizeof(Number)) {
            bytes_ = {};
            is_whole_ = false;
            return Number{};
        }
        const auto number = number_at<Number>(bytes_.data());
        bytes_.remove_prefix(sizeof(Number));
        return number;
    }
    std::vector<double> take_doubles(std::size_t count) {
        if (count > bytes_.size() / sizeof(double)) {
            bytes_ = {};
            is_whole_ = false;
            return std::vector<double>(std::min<std::size_t>(count, 64), 0);
        }
        std::vector<double> numbers(count);
        std::ranges::generate(numbers, [this] { return take<double>(); });
        return numbers;
    }
    std::vector<double> take_list() { return take_doubles(take<std::uint32_t>()); }
    void skip(std::size_t count) {
        is_whole_ = is_whole_ && count <= bytes_.size();
        bytes_.remove_prefix(std::min(count, bytes_.size()));
    }
    void skip_text() { skip(take<std::uint32_t>()); }
    /// The stamp of a header [s].
    double take_header() {
        skip(sizeof(std::uint32_t));
        const double seconds = take<std::uint32_t>();
        const double stamp_s = seconds + 1e-9 * take<std::uint32_t>();
        skip_text();
        return stamp_s;
    }
    /// A quaternion of ROS has its scalar last.
    std::vector<double> take_quaternion() {
        const std::vector<double> q = take_doubles(4);
        return {q[3], q[0], q[1], q[2]};
    }
    [[nodiscard]] bool is_whole() const noexcept { return is_whole_; }

 private:
    std::string_view bytes_;
    bool is_whole_ = true;
};

constexpr std::size_t covariance_bytes = 36 * sizeof(double), small_covariance_bytes = 9 * sizeof(double);

void read_odometry(Numbers& numbers, RosMoment& moment) {
    numbers.skip_text();
    moment.rows.push_back({&FlightLog::position_m, numbers.take_doubles(3)});
    const std::vector<double> q = numbers.take_quaternion();
    moment.rows.push_back({&FlightLog::attitude, q});
    numbers.skip(covariance_bytes);
    const std::vector<double> v = numbers.take_doubles(3);  // in the frame of the body
    const Vector3 turned = rotated({q[0], q[1], q[2], q[3]}, {v[0], v[1], v[2]});
    moment.rows.push_back({&FlightLog::velocity_m_s, {turned.begin(), turned.end()}});
    moment.rows.push_back({&FlightLog::body_rates_rad_s, numbers.take_doubles(3)});
}

void read_imu(Numbers& numbers, RosMoment& moment) {
    const std::vector<double> q = numbers.take_quaternion();
    if (numbers.take<double>() != -1) {  // which says that there is no attitude
        moment.rows.push_back({&FlightLog::attitude, q});
    }
    numbers.skip(small_covariance_bytes - sizeof(double));
    moment.rows.push_back({&FlightLog::body_rates_rad_s, numbers.take_doubles(3)});
    numbers.skip(small_covariance_bytes);
    moment.rows.push_back({&FlightLog::specific_force_m_s2, numbers.take_doubles(3)});
}

void read_joints(Numbers& numbers, RosMoment& moment) {
    for (std::uint32_t left = numbers.take<std::uint32_t>(); left > 0 && numbers.is_whole(); --left) {
        numbers.skip_text();
    }
    moment.rows.push_back({&FlightLog::joints_rad, numbers.take_list()});
    moment.rows.push_back({&FlightLog::joint_rates_rad_s, numbers.take_list()});
}

}  // namespace

bool is_of_a_flight(std::string_view type) {
    return std::ranges::find(types, type) != types.end();
}

std::size_t rank_of(std::string_view type) {
    return static_cast<std::size_t>(std::ranges::find(types, type) - types.begin());
}

RosMoment read_ros_message(std::string_view type, std::string_view bytes) {
    Numbers numbers(bytes);
    RosMoment moment;
    moment.stamp_s = numbers.take_header();
    if (type == "nav_msgs/Odometry") {
        read_odometry(numbers, moment);
    } else if (type == "sensor_msgs/Imu") {
        read_imu(numbers, moment);
    } else if (type == "sensor_msgs/JointState") {
        read_joints(numbers, moment);
    } else if (type == "geometry_msgs/TwistStamped") {
        moment.rows.push_back({&FlightLog::velocity_m_s, numbers.take_doubles(3)});
    } else if (type == "mav_msgs/Actuators") {
        static_cast<void>(numbers.take_list());
        static_cast<void>(numbers.take_list());
        moment.rows.push_back({&FlightLog::rotor_commands, numbers.take_list()});
    } else {
        if (type == "geometry_msgs/TransformStamped") {
            numbers.skip_text();
        }
        moment.rows.push_back({&FlightLog::position_m, numbers.take_doubles(3)});
        moment.rows.push_back({&FlightLog::attitude, numbers.take_quaternion()});
    }
    std::erase_if(moment.rows, [](const RosMoment::Row& row) { return row.numbers.empty(); });
    moment.is_whole = numbers.is_whole();
    return moment;
}

}  // namespace downwash::logs

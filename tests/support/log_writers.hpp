#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "downwash/base/vector3.hpp"

// Flight logs as autopilots write them, by the published formats. Nothing of the readers is used here.

namespace downwash::test {

/// A moment of a flight in axes with z up.
struct LoggedMoment {
    double t_s = 0;
    Vector3 position_m{}, velocity_m_s{};
    std::array<double, 4> attitude{1, 0, 0, 0};  ///< (w, x, y, z), body x forward, y left, z up
    Vector3 body_rates_rad_s{};
    std::vector<double> joints_rad;
    std::vector<double> rotor_n;
};
using LoggedFlight = std::vector<LoggedMoment>;

/// Where the log's frame and clock are, seen from the flight.
struct LogFrame {
    double yaw_rad = 0;   ///< by which the log's axes have to be turned to get those of the flight
    Vector3 shift_m{};    ///< where the log's origin is in the flight's frame
    double offset_s = 0;  ///< time of the log at which the flight begins
    double rate = 1;      ///< seconds of the log in a second of the flight
};

/// The same flight in another frame and clock.
inline LoggedFlight in_frame(LoggedFlight flight, const LogFrame& frame) {
    const double c = std::cos(frame.yaw_rad), s = std::sin(frame.yaw_rad);
    const auto back = [c, s](const Vector3& v) { return Vector3{c * v[0] + s * v[1], -s * v[0] + c * v[1], v[2]}; };
    const double half_c = std::cos(frame.yaw_rad / 2), half_s = -std::sin(frame.yaw_rad / 2);
    for (LoggedMoment& moment : flight) {
        moment.t_s = frame.offset_s + frame.rate * moment.t_s;
        moment.position_m = back(moment.position_m - frame.shift_m);
        moment.velocity_m_s = back(moment.velocity_m_s);
        const auto q = moment.attitude;
        moment.attitude = {half_c * q[0] - half_s * q[3], half_c * q[1] - half_s * q[2], half_c * q[2] + half_s * q[1],
                           half_c * q[3] + half_s * q[0]};
    }
    return flight;
}

/// Bytes in little-endian order.
class Bytes {
 public:
    template <class Number>
    Bytes& add(std::type_identity_t<Number> number) {
        std::array<char, sizeof(Number)> own;
        std::memcpy(own.data(), &number, own.size());  // tests run on little-endian machines
        text.append(own.data(), own.size());
        return *this;
    }
    Bytes& add_text(std::string_view characters, std::size_t size) {
        text += characters;
        text.append(size - characters.size(), '\0');
        return *this;
    }

    std::string text;
};

/// ULog, version 1 (docs.px4.io, "ULog File Format").
class ULogWriter {
 public:
    explicit ULogWriter(std::uint8_t incompatible_flags = 0) {
        text = std::string("\x55\x4c\x6f\x67\x01\x12\x35\x01", 8);
        text += Bytes().add<std::uint64_t>(112574307).text;
        std::string flags(40, '\0');
        flags[8] = static_cast<char>(incompatible_flags);
        message('B', flags);
    }
    void message(char type, const std::string& body) {
        text += Bytes().add<std::uint16_t>(static_cast<std::uint16_t>(body.size())).text + type + body;
    }
    void format(const std::string& definition) { message('F', definition); }
    void subscribe(std::uint16_t id, const std::string& name, std::uint8_t instance = 0) {
        message('A', Bytes().add<std::uint8_t>(instance).add<std::uint16_t>(id).text + name);
    }
    void data(std::uint16_t id, const std::string& body) { message('D', Bytes().add<std::uint16_t>(id).text + body); }

    std::string text;
};

inline std::uint64_t microseconds(double t_s) {
    return static_cast<std::uint64_t>(std::llround(1e6 * t_s));
}

/// A flight as PX4 logs it: local position, attitude, rates, motors as shares of `full_n`.
inline std::string ulog_of(const LoggedFlight& flight, double full_n) {
    ULogWriter log;
    log.format(
        "vehicle_local_position:uint64_t timestamp;uint64_t timestamp_sample;bool xy_valid;bool z_valid;uint8_t[2] "
        "_padding0;float x;float y;float z;float vx;float vy;float vz;");
    log.format(
        "vehicle_attitude:uint64_t timestamp;uint64_t timestamp_sample;float[4] q;uint8_t quat_reset_counter;"
        "uint8_t[7] _padding0;");
    log.format("vehicle_angular_velocity:uint64_t timestamp;float[3] xyz;uint8_t[4] _padding0;");
    log.format("actuator_motors:uint64_t timestamp;float[12] control;");
    log.message('I', Bytes().add<std::uint8_t>(20).text + "char[5] ver_hw_subtype" + "hello");
    log.subscribe(3, "vehicle_local_position");
    log.subscribe(7, "vehicle_attitude");
    log.subscribe(8, "vehicle_angular_velocity");
    log.subscribe(9, "actuator_motors");
    log.subscribe(11, "vehicle_local_position", 1);
    for (const LoggedMoment& moment : flight) {
        const std::uint64_t t = microseconds(moment.t_s);
        const Vector3 &p = moment.position_m, &v = moment.velocity_m_s, &w = moment.body_rates_rad_s;
        const auto& q = moment.attitude;
        const auto f = [](double number) { return static_cast<float>(number); };
        Bytes place;
        place.add<std::uint64_t>(t + 900).add<std::uint64_t>(t).add<std::uint8_t>(1).add<std::uint8_t>(1);
        place.add<std::uint16_t>(0);
        place.add<float>(f(p[0])).add<float>(f(-p[1])).add<float>(f(-p[2]));
        place.add<float>(f(v[0])).add<float>(f(-v[1])).add<float>(f(-v[2]));
        log.data(3, place.text);
        std::string other = place.text;
        other[21] = '\x7f';  // the second estimator is far off
        log.data(11, other);
        Bytes attitude;
        attitude.add<std::uint64_t>(t + 200).add<std::uint64_t>(t);
        attitude.add<float>(f(q[0])).add<float>(f(q[1])).add<float>(f(-q[2])).add<float>(f(-q[3])).add<std::uint8_t>(0);
        log.data(7, attitude.text);
        Bytes rates;
        rates.add<std::uint64_t>(t).add<float>(f(w[0])).add<float>(f(-w[1])).add<float>(f(-w[2]));
        log.data(8, rates.text);
        if (!moment.rotor_n.empty()) {
            Bytes motors;
            motors.add<std::uint64_t>(t);
            for (std::size_t i = 0; i < 12; ++i) {
                motors.add<float>(i < moment.rotor_n.size() ? f(moment.rotor_n[i] / full_n) : NAN);
            }
            log.data(9, motors.text);
        }
    }
    return log.text;
}

/// ArduPilot's DataFlash (libraries/AP_Logger/LogStructure.h).
class DataFlashWriter {
 public:
    DataFlashWriter() { format(128, 89, "FMT", "BBnNZ", "Type,Length,Name,Format,Columns"); }
    void format(std::uint8_t type, std::uint8_t length, std::string_view name, std::string_view letters,
                std::string_view labels) {
        message(128, Bytes()
                         .add<std::uint8_t>(type)
                         .add<std::uint8_t>(length)
                         .add_text(name, 4)
                         .add_text(letters, 16)
                         .add_text(labels, 64)
                         .text);
    }
    void message(std::uint8_t type, const std::string& body) {
        text += "\xA3\x95" + std::string(1, static_cast<char>(type)) + body;
    }

    std::string text;
};

/// A flight as ArduPilot logs it: EKF3 on two cores, attitude in centidegrees, pulses of 1000 to 2000 us for up to
/// `full_n`, where motors 1 and 2 are on channels 2 and 1.
inline std::string dataflash_of(const LoggedFlight& flight, double full_n) {
    DataFlashWriter log;
    log.format(64, 31, "PARM", "QNf", "TimeUS,Name,Value");
    log.format(65, 48, "XKF1", "QBccCfffffffH", "TimeUS,C,Roll,Pitch,Yaw,VN,VE,VD,dPD,PN,PE,PD,OH");
    log.format(66, 21, "ATT", "QccccC", "TimeUS,DesRoll,Roll,DesPitch,Pitch,Yaw");
    log.format(67, 25, "RCOU", "QHHHHHHH", "TimeUS,C1,C2,C3,C4,C5,C6,C7");
    log.format(68, 24, "IMU", "QBfff", "TimeUS,I,GyrX,GyrY,GyrZ");
    const std::size_t rotors = flight.empty() ? 0 : flight.front().rotor_n.size();
    const auto channel_of = [](std::size_t motor) { return motor == 0 ? 1U : motor == 1 ? 0U : motor; };
    for (std::size_t motor = 0; motor < rotors; ++motor) {
        log.message(64, Bytes()
                            .add<std::uint64_t>(1)
                            .add_text("SERVO" + std::to_string(channel_of(motor) + 1) + "_FUNCTION", 16)
                            .add<float>(static_cast<float>(33 + motor))
                            .text);
    }
    for (const LoggedMoment& moment : flight) {
        const std::uint64_t t = microseconds(moment.t_s);
        const Vector3 &p = moment.position_m, &v = moment.velocity_m_s, &w = moment.body_rates_rad_s;
        const std::array<double, 4> q{moment.attitude[0], moment.attitude[1], -moment.attitude[2],
                                      -moment.attitude[3]};  // north, east, down
        const double roll = std::atan2(2 * (q[0] * q[1] + q[2] * q[3]), 1 - 2 * (q[1] * q[1] + q[2] * q[2]));
        const double pitch = std::asin(2 * (q[0] * q[2] - q[3] * q[1]));
        const double yaw = std::atan2(2 * (q[0] * q[3] + q[1] * q[2]), 1 - 2 * (q[2] * q[2] + q[3] * q[3]));
        const auto centidegrees = [](double rad) { return std::lround(rad * 18000 / 3.14159265358979323846); };
        const auto heading = static_cast<std::uint16_t>((centidegrees(yaw) + 36000) % 36000);
        for (const std::uint8_t core : {std::uint8_t{0}, std::uint8_t{1}}) {
            const float off = core == 0 ? 0 : 100;
            Bytes ekf;
            ekf.add<std::uint64_t>(t).add<std::uint8_t>(core);
            ekf.add<std::int16_t>(static_cast<std::int16_t>(centidegrees(roll)));
            ekf.add<std::int16_t>(static_cast<std::int16_t>(centidegrees(pitch))).add<std::uint16_t>(heading);
            for (const double number : {v[0], -v[1], -v[2], 0.0, p[0], -p[1], -p[2]}) {
                ekf.add<float>(static_cast<float>(number) + off);
            }
            log.message(65, ekf.add<std::uint16_t>(0).text);
            Bytes imu;
            imu.add<std::uint64_t>(t).add<std::uint8_t>(core);
            for (const double number : {w[0], -w[1], -w[2]}) {
                imu.add<float>(static_cast<float>(number) + off);
            }
            log.message(68, imu.text);
        }
        Bytes attitude;
        attitude.add<std::uint64_t>(t).add<std::int16_t>(0);
        attitude.add<std::int16_t>(static_cast<std::int16_t>(centidegrees(roll))).add<std::int16_t>(0);
        attitude.add<std::int16_t>(static_cast<std::int16_t>(centidegrees(pitch))).add<std::uint16_t>(heading);
        log.message(66, attitude.text);
        Bytes outputs;
        outputs.add<std::uint64_t>(t);
        std::array<std::uint16_t, 7> pulses{};
        for (std::size_t motor = 0; motor < rotors; ++motor) {
            pulses[channel_of(motor)] =
                static_cast<std::uint16_t>(std::lround(1000 + 1000 * moment.rotor_n[motor] / full_n));
        }
        for (const std::uint16_t pulse : pulses) {
            outputs.add<std::uint16_t>(pulse);
        }
        log.message(67, outputs.text);
    }
    return log.text;
}

/// The flight in ROS's axes as a table of pandas, with an index without a name.
inline std::string pandas_csv_of(const LoggedFlight& flight,
                                 std::string_view first_columns = ",time,x,y,z,qx,qy,qz,qw") {
    std::string text(first_columns);
    text += '\n';
    for (std::size_t i = 0; i < flight.size(); ++i) {
        const LoggedMoment& m = flight[i];
        text += std::to_string(i);
        for (const double number : {m.t_s, m.position_m[0], m.position_m[1], m.position_m[2], m.attitude[1],
                                    m.attitude[2], m.attitude[3], m.attitude[0]}) {
            text += ',' + std::to_string(number);
        }
        text += '\n';
    }
    return text;
}

/// vehicle_local_position_0.csv as ulog2csv writes it.
inline std::string ulog2csv_of(const LoggedFlight& flight) {
    std::string text = "timestamp,timestamp_sample,x,y,z,vx,vy,vz,xy_valid\n";
    for (const LoggedMoment& m : flight) {
        text += std::to_string(microseconds(m.t_s) + 900) + ',' + std::to_string(microseconds(m.t_s));
        for (const double number : {m.position_m[0], -m.position_m[1], -m.position_m[2], m.velocity_m_s[0],
                                    -m.velocity_m_s[1], -m.velocity_m_s[2]}) {
            text += ',' + std::to_string(number);
        }
        text += ",1\n";
    }
    return text;
}

/// A bag of ROS 1, format 2.0 (wiki.ros.org, "Bags/Format/2.0"): one chunk, not compressed.
class BagWriter {
 public:
    explicit BagWriter(std::string compression = "none") : compression_(std::move(compression)) {}

    void connect(std::uint32_t id, const std::string& topic, const std::string& type) {
        chunk_ += record(field("op", "\x07") + field("conn", number(id)) + field("topic", topic),
                         field("topic", topic) + field("type", type) + field("md5sum", std::string(32, '0')) +
                             field("message_definition", "float64 x"));
    }
    void message(std::uint32_t id, double t_s, const std::string& body) {
        chunk_ += record(field("op", "\x02") + field("conn", number(id)) + field("time", stamp(t_s)), body);
    }
    [[nodiscard]] std::string text() const {
        const std::string header = field("op", "\x03") + field("index_pos", std::string(8, '\0')) +
                                   field("conn_count", number(1)) + field("chunk_count", number(1));
        return "#ROSBAG V2.0\n" + record(header, std::string(4096 - 8 - header.size(), ' ')) +
               record(field("op", "\x05") + field("compression", compression_) +
                          field("size", number(static_cast<std::uint32_t>(chunk_.size()))),
                      chunk_) +
               record(field("op", "\x04") + field("ver", number(1)), std::string(12, 'x'));
    }

    static std::string number(std::uint32_t value) { return Bytes().add<std::uint32_t>(value).text; }
    static std::string stamp(double t_s) {
        const auto seconds = static_cast<std::uint32_t>(t_s);
        return number(seconds) + number(static_cast<std::uint32_t>(std::llround(1e9 * (t_s - seconds))));
    }
    static std::string field(const std::string& name, const std::string& value) {
        const std::string whole = name + '=' + value;
        return number(static_cast<std::uint32_t>(whole.size())) + whole;
    }
    static std::string record(const std::string& header, const std::string& data) {
        return number(static_cast<std::uint32_t>(header.size())) + header +
               number(static_cast<std::uint32_t>(data.size())) + data;
    }

 private:
    std::string compression_, chunk_;
};

/// A flight as a bag of nav_msgs/Odometry and, with joints, sensor_msgs/JointState.
inline std::string bag_of(const LoggedFlight& flight) {
    BagWriter bag;
    bag.connect(0, "/camera", "sensor_msgs/Image");
    bag.connect(1, "/odometry", "nav_msgs/Odometry");
    bag.connect(2, "/joint_states", "sensor_msgs/JointState");
    for (const LoggedMoment& moment : flight) {
        const auto& q = moment.attitude;
        const auto header = [&](const std::string& frame) {
            return BagWriter::number(7) + BagWriter::stamp(moment.t_s) +
                   BagWriter::number(static_cast<std::uint32_t>(frame.size())) + frame;
        };
        bag.message(0, moment.t_s + 0.3, "no image");
        Bytes odometry;
        odometry.text = header("map") + BagWriter::number(4) + "base";
        for (const double number : moment.position_m) {
            odometry.add<double>(number);
        }
        for (const double number : {q[1], q[2], q[3], q[0]}) {
            odometry.add<double>(number);
        }
        odometry.add_text("", 36 * 8);
        // In the body's axes: the inverse rotation, as a matrix.
        const Vector3& v = moment.velocity_m_s;
        const double w = q[0], x = q[1], y = q[2], z = q[3];
        odometry.add<double>((1 - 2 * (y * y + z * z)) * v[0] + 2 * (x * y + w * z) * v[1] +
                             2 * (x * z - w * y) * v[2]);
        odometry.add<double>(2 * (x * y - w * z) * v[0] + (1 - 2 * (x * x + z * z)) * v[1] +
                             2 * (y * z + w * x) * v[2]);
        odometry.add<double>(2 * (x * z + w * y) * v[0] + 2 * (y * z - w * x) * v[1] +
                             (1 - 2 * (x * x + y * y)) * v[2]);
        for (const double number : moment.body_rates_rad_s) {
            odometry.add<double>(number);
        }
        odometry.add_text("", 36 * 8);
        bag.message(1, moment.t_s + 0.3, odometry.text);
        if (!moment.joints_rad.empty()) {
            const auto count = static_cast<std::uint32_t>(moment.joints_rad.size());
            Bytes joints;
            joints.text = header("") + BagWriter::number(count);
            for (std::uint32_t i = 0; i < count; ++i) {
                joints.text += BagWriter::number(5) + "joint";
            }
            joints.text += BagWriter::number(count);
            for (const double number : moment.joints_rad) {
                joints.add<double>(number);
            }
            joints.text += BagWriter::number(0) + BagWriter::number(0);
            bag.message(2, moment.t_s + 0.3, joints.text);
        }
    }
    return bag.text();
}

}  // namespace downwash::test

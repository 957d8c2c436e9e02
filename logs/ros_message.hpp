#pragma once

// Private to logs/.

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "downwash/logs/flight_log.hpp"

namespace downwash::logs {

/// What a message of ROS says of a moment.
struct RosMoment {
    double stamp_s = 0;  ///< of its header; 0: it has none
    struct Row {
        LogSeries FlightLog::*series;
        std::vector<double> numbers;
    };
    std::vector<Row> rows;
    bool is_whole = true;  ///< false: the message ends before its type does
};

/// Whether messages of a type ("nav_msgs/Odometry") say something of a flight.
[[nodiscard]] bool is_of_a_flight(std::string_view type);

/// Reads a message (wiki.ros.org, "Message serialization": numbers in little-endian order, the length of a text or a
/// list before it). @pre is_of_a_flight(type)
[[nodiscard]] RosMoment read_ros_message(std::string_view type, std::string_view bytes);

/// How well a type says what a series is, from 0, the best.
[[nodiscard]] std::size_t rank_of(std::string_view type);

}  // namespace downwash::logs

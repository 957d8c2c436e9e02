#pragma once

#include <cmath>
#include <string>

#include "faulty_link.hpp"
#include "offboard_vehicle.hpp"
#include "streamer.hpp"

/// How a mission went.
struct Rehearsal {
    downwash::Outcome outcome = downwash::Outcome::ok;
    bool hovers = false;          ///< in Hold, slowly, when it is over
    bool is_in_failsafe = false;  ///< because set-points did not come
    bool has_arrived = false;     ///< at the goal
    double min_clearance_m = 0;
    double max_distance_m = 0;  ///< from the plan in offboard mode
    double duration_s = 0;
};

/// A mission in one process, without sockets: streamer, faulty link and vehicle in lock step.
inline Rehearsal rehearse(Streamer& streamer, OffboardVehicle& vehicle, FaultyLink& link) {
    constexpr double hover_at_end_s = 5, max_hover_speed_m_s = 0.05, longest_s = 600;
    double hold_since_s = 0;
    bool was_offboard = false;
    while (vehicle.outcome() == downwash::Outcome::ok && vehicle.time_s() - hold_since_s < hover_at_end_s &&
           vehicle.time_s() < longest_s) {
        if (const std::string answer = streamer.answer(vehicle.sent()); !answer.empty()) {
            link.put(vehicle.time_s(), answer);
        }
        for (const std::string& datagram : link.arrived(vehicle.time_s())) {
            vehicle.take(datagram);
        }
        was_offboard = was_offboard || vehicle.is_offboard();
        if (vehicle.is_offboard() || !(was_offboard || streamer.is_over())) {
            hold_since_s = vehicle.time_s();
        }
        vehicle.tick();
    }
    const auto& v = vehicle.motion().velocity_m_s;
    return {vehicle.outcome(),
            vehicle.outcome() == downwash::Outcome::ok && !vehicle.is_offboard() &&
                std::hypot(v[0], v[1], v[2]) < max_hover_speed_m_s,
            vehicle.is_in_failsafe(),
            streamer.has_arrived(),
            vehicle.min_clearance_m(),
            streamer.max_distance_m(),
            vehicle.time_s()};
}

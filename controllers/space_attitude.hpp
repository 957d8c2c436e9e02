#pragma once

#include "downwash/dynamics/lane_vector.hpp"

// Errors of the attitude, tilt and yaw apart: the reduced attitude, which is where the thrust points, and the turn
// about it that is left (D. Brescianini and R. D'Andrea, Tilt-prioritized quadrocopter attitude control, IEEE
// Transactions on Control Systems Technology, 2018). One template over the lane type.

namespace downwash::controllers {

/// The turn that takes a unit vector to another by the shortest way: its axis times its angle [rad], at most pi. Of two
/// opposite vectors all ways are equally short; then it is about an axis of choice.
/// @param c,d the vector and scalar product of the first and the other   @param if_opposite of length 1, across the
/// first
template <class T>
dynamics::LaneVector<T> shortest_turn(const dynamics::LaneVector<T>& c, const T& d,
                                      const dynamics::LaneVector<T>& if_opposite) {
    const T sine = lane::sqrt(dot(c, c));
    const T angle = lane::atan2(sine, d);
    const auto has_axis = sine > T(1e-12);
    const T scale = angle / lane::select(has_axis, sine, T(1));
    const T by_choice = lane::select(has_axis, T(0), lane::select(d < T(0), angle, T(0)));
    return scale * c + by_choice * if_opposite;
}

/// Where a force points, tilted no further than a limit and with a least vertical part.
template <class T>
struct LimitedDirection {
    dynamics::LaneVector<T> direction;  ///< world, of length 1
    T excess;                           ///< > 0 where a limit changed it
};

/// @param max_tilt_rad in (0, pi/2)   @param least_vertical > 0, in the unit of the force
template <class T>
LimitedDirection<T> limited_direction(const dynamics::LaneVector<T>& force, double max_tilt_rad,
                                      const T& least_vertical) {
    const lane::SinCos tilt = lane::sin_cos(max_tilt_rad);
    const T up = lane::max(force.z, least_vertical);
    const T sideways = lane::sqrt(force.x * force.x + force.y * force.y);
    const T most = T(tilt.sine / tilt.cosine) * up;
    const auto is_tilted_more = sideways > most;
    const T share = lane::select(is_tilted_more, most / lane::select(is_tilted_more, sideways, T(1)), T(1));
    const dynamics::LaneVector<T> kept{share * force.x, share * force.y, up};
    return {(T(1) / lane::sqrt(dot(kept, kept))) * kept, lane::max(sideways - most, least_vertical - force.z)};
}

/// Where the thrust of a vehicle points, and where it shall point.
template <class T>
struct ThrustDirections {
    dynamics::LaneVector<T> axis;    ///< the thrust axis in body axes, of length 1
    dynamics::LaneVector<T> wanted;  ///< where it shall point, world, of length 1
};

/// The tilt error: the turn in body axes [rad] that takes the thrust axis to where it shall point.
template <class T>
dynamics::LaneVector<T> tilt_error(const dynamics::LaneRotation<T>& attitude, const ThrustDirections<T>& thrust) {
    const dynamics::LaneVector<T> wanted = turned_back(attitude, thrust.wanted);
    return shortest_turn(cross(thrust.axis, wanted), dot(thrust.axis, wanted),
                         dynamics::LaneVector<T>{T(0), T(1), T(0)});
}

/// A heading: the direction of the yaw angle in the level plane, and the one across it to the left.
template <class T>
struct Heading {
    dynamics::LaneVector<T> ahead, left;
};

/// @pre |yaw_rad| <= 1e5
template <class T>
Heading<T> heading_at(const T& yaw_rad) {
    T sine, cosine;
    lane::sin_cos(yaw_rad, sine, cosine);
    return {{cosine, sine, T(0)}, {-sine, cosine, T(0)}};
}

/// What of the attitude error is left once the thrust points where it shall.
template <class T>
struct YawError {
    T angle_rad;    ///< about the wanted thrust direction, from the vehicle to the wanted heading, in [-pi, pi]
    T weight;       ///< (1 + cos tilt error) / 2: 1 when the thrust points right, 0 when it points the other way
    T across_size;  ///< sine of the angle between the wanted direction and the axis across the heading
    dynamics::LaneVector<T>
        side;  ///< second axis of the wanted attitude, world: `left` and `wanted` span it, of length 1
};

/// The yaw error. The wanted attitude has its first axis in the vertical plane of the heading: across `left`.
/// @pre the wanted direction points upward
template <class T>
YawError<T> yaw_error(const dynamics::LaneRotation<T>& attitude, const ThrustDirections<T>& thrust,
                      const Heading<T>& heading) {
    using dynamics::LaneVector;
    const LaneVector<T> at = attitude * thrust.axis;
    const LaneVector<T> c = cross(at, thrust.wanted);
    const T one_and_cosine = T(1) + dot(at, thrust.wanted);
    // The vehicle's first axis after the shortest turn (Rodrigues). Near the opposite the weight takes over.
    const LaneVector<T> swung = cross(c, attitude.first);
    const LaneVector<T> ahead = attitude.first + swung + (T(1) / lane::max(one_and_cosine, T(1e-6))) * cross(c, swung);
    const LaneVector<T> across = cross(heading.left, thrust.wanted);
    YawError<T> error;
    error.across_size = lane::sqrt(dot(across, across));
    error.side = (T(1) / error.across_size) * cross(thrust.wanted, across);
    error.angle_rad = lane::atan2(dot(cross(ahead, across), thrust.wanted), dot(ahead, across));
    error.weight = T(0.5) * one_and_cosine;
    return error;
}

/// How fast a wanted attitude turns about its thrust direction [rad/s] while the heading and the direction turn.
/// @param direction_rate of the wanted direction, world [rad/s]   @param yaw_rate [rad/s]
template <class T>
T yaw_feed_forward(const YawError<T>& error, const ThrustDirections<T>& thrust, const Heading<T>& heading,
                   const dynamics::LaneVector<T>& direction_rate, const T& yaw_rate) {
    // The first axis is left x wanted, but for its length; what of its change lies along `side` is the turn.
    const dynamics::LaneVector<T> change =
        cross(heading.left, cross(direction_rate, thrust.wanted)) - yaw_rate * cross(heading.ahead, thrust.wanted);
    return dot(change, error.side) / error.across_size;
}

/// A vector no longer than a limit.
template <class T>
dynamics::LaneVector<T> limited_length(const dynamics::LaneVector<T>& v, double most) {
    const T size = lane::sqrt(dot(v, v));
    const auto is_longer = size > T(most);
    return lane::select(is_longer, T(most) / lane::select(is_longer, size, T(1)), T(1)) * v;
}

}  // namespace downwash::controllers

#pragma once

#include <optional>

namespace downwash {

/// The position of the world frame on the Earth.
struct GeodeticOrigin {
    double latitude_deg = 0;   ///< WGS 84, -90 to 90
    double longitude_deg = 0;  ///< -180 to 180
    double altitude_m = 0;     ///< height of z = 0 above mean sea level
};

/// What a mission does after the plan.
enum class MissionEnd {
    hover,       ///< stays at the last goal
    land,        ///< lands below it
    return_home  ///< the autopilot's return: most climb first
};

/// Settings that a format may need besides the run.
struct ExportSettings {
    std::optional<double> rate_hz;  ///< rate of set-points; empty: the rate of the controller
    std::optional<GeodeticOrigin> origin;
    double bearing_deg = 0;  ///< compass direction of the world's x axis, clockwise from north, -360 to 360
    /// For ros: set-points in a map with x east and y north (REP 103 and 105) instead of the world of the problem.
    bool is_east_north_up = false;
    MissionEnd mission_end = MissionEnd::hover;
};

}  // namespace downwash

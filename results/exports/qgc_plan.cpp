#include <GeographicLib/LocalCartesian.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "downwash/base/angles.hpp"
#include "downwash/base/key_error.hpp"
#include "downwash/base/text.hpp"
#include "downwash/exports/formats.hpp"

// The file format of QGroundControl: docs.qgroundcontrol.com, "Plan File Format". Commands and their parameters are
// MAVLink's.

namespace downwash {
namespace {

using Json = nlohmann::ordered_json;

constexpr int waypoint_command = 16;       // MAV_CMD_NAV_WAYPOINT
constexpr int return_command = 20;         // MAV_CMD_NAV_RETURN_TO_LAUNCH
constexpr int land_command = 21;           // MAV_CMD_NAV_LAND
constexpr int takeoff_command = 22;        // MAV_CMD_NAV_TAKEOFF
constexpr int change_speed_command = 178;  // MAV_CMD_DO_CHANGE_SPEED
constexpr double ground_speed = 1;         // SPEED_TYPE_GROUNDSPEED
constexpr double same_throttle = -1;
constexpr int mission_frame = 2;            // MAV_FRAME_MISSION: a command without a place
constexpr int relative_altitude_frame = 3;  // MAV_FRAME_GLOBAL_RELATIVE_ALT
constexpr int relative_altitude_mode = 1;
constexpr int px4_firmware = 12;  // MAV_AUTOPILOT_PX4

/// MAV_TYPE of a multirotor.
int vehicle_type(std::size_t rotors) {
    switch (rotors) {
        case 3:
            return 15;  // MAV_TYPE_TRICOPTER
        case 4:
            return 2;  // MAV_TYPE_QUADROTOR
        case 6:
            return 13;  // MAV_TYPE_HEXAROTOR
        case 8:
            return 14;  // MAV_TYPE_OCTOROTOR
        case 10:
            return 35;  // MAV_TYPE_DECAROTOR
        case 12:
            return 29;  // MAV_TYPE_DODECAROTOR
        default:
            return 43;  // MAV_TYPE_GENERIC_MULTIROTOR
    }
}

struct Geodetic {
    double latitude_deg, longitude_deg, altitude_m;
};

/// Places of the world frame on the Earth.
class OnEarth {
 public:
    OnEarth(const GeodeticOrigin& origin, double bearing_deg)
        : local_(origin.latitude_deg, origin.longitude_deg, origin.altitude_m),
          sine_(std::sin(bearing_deg / degrees_per_radian)),
          cosine_(std::cos(bearing_deg / degrees_per_radian)),
          bearing_deg_(bearing_deg) {}

    [[nodiscard]] Geodetic at(const Vector3& world_m) const {
        const double east_m = world_m[0] * sine_ - world_m[1] * cosine_;
        const double north_m = world_m[0] * cosine_ + world_m[1] * sine_;
        Geodetic place{};
        local_.Reverse(east_m, north_m, world_m[2], place.latitude_deg, place.longitude_deg, place.altitude_m);
        return place;
    }

    /// Clockwise from north, 0 to 360.
    [[nodiscard]] double bearing_deg(double yaw_rad) const {
        const double bearing_deg = std::remainder(bearing_deg_ - yaw_rad * degrees_per_radian, 360.);
        return bearing_deg < 0 ? bearing_deg + 360 : bearing_deg;
    }

 private:
    GeographicLib::LocalCartesian local_;
    double sine_, cosine_, bearing_deg_;
};

void check(const GeodeticOrigin& origin, double bearing_deg) {
    const bool is_sound = std::abs(origin.latitude_deg) <= 90 && std::abs(origin.longitude_deg) <= 180 &&
                          std::abs(origin.altitude_m) <= 1e5 && std::abs(bearing_deg) <= max_bearing_deg;
    if (!is_sound) {
        throw_input_error("the origin is at latitude " + to_text(origin.latitude_deg) + ", longitude " +
                          to_text(origin.longitude_deg) + ", altitude " + to_text(origin.altitude_m) + " m, bearing " +
                          to_text(bearing_deg) + ": expected -90 to 90, -180 to 180, -1e5 to 1e5 and -360 to 360");
    }
}

/// A corner of the mission, and for how long it is held.
struct Corner {
    Vector3 place_m{};
    double yaw_rad = 0;
    double hold_s = 0;
};

Corner corner_at(const Setpoint& point) {
    return {point.position_m, point.yaw_rad};
}

double length_m(const Vector3& v) {
    return std::hypot(v[0], v[1], v[2]);
}

/// A mission flies straight from corner to corner: the corners that keep it on the plan's curves.
class Corners {
 public:
    explicit Corners(const WayInWorld& plan) : plan_(plan) {}

    /// The way of the plan from one time to another, both of which are corners, without the first.
    void add_way(double from_s, double to_s) {
        if (to_s - from_s > 2 * plan_.tick_s && bulge_m(from_s, to_s) > most_bulge_m) {
            const double middle_s = (from_s + to_s) / 2;
            add_way(from_s, middle_s);
            add_way(middle_s, to_s);
        } else {
            corners.push_back(corner_at(plan_.at(to_s)));
        }
    }

    std::vector<Corner> corners;

 private:
    static constexpr double most_bulge_m = 0.02;

    [[nodiscard]] Vector3 place_m(double t_s) const { return plan_.at(t_s).position_m; }

    /// How far the plan is from the straight line between its places at two times [m].
    [[nodiscard]] double bulge_m(double from_s, double to_s) const {
        constexpr int samples = 16;
        const Vector3 from_m = place_m(from_s), along_m = place_m(to_s) - from_m;
        const double length_2 = dot(along_m, along_m);
        double most_m = 0;
        for (int i = 1; i < samples; ++i) {
            const Vector3 here_m = place_m(from_s + (to_s - from_s) * i / samples) - from_m;
            const double share = length_2 > 0 ? std::clamp(dot(here_m, along_m) / length_2, 0., 1.) : 0;
            most_m = std::max(most_m, length_m(here_m - share * along_m));
        }
        return most_m;
    }

    const WayInWorld& plan_;
};

/// A plan holds at a goal between two knots at the same place, and at the last one until the flight ends.
std::vector<Corner> corners_of(const RunInWorld& run) {
    const WayInWorld& plan = plan_to_be_flown(run);
    Corners way(plan);
    way.corners.push_back(corner_at(plan.knots.front()));
    for (std::size_t i = 1; i < plan.knots.size(); ++i) {
        const Setpoint &from = plan.knots[i - 1], &to = plan.knots[i];
        if (from.position_m != to.position_m) {
            way.add_way(from.t_s, to.t_s);
        } else if (from.yaw_rad != to.yaw_rad) {
            way.corners.push_back(corner_at(to));
        } else {
            way.corners.back().hold_s += to.t_s - from.t_s;
        }
    }
    way.corners.back().hold_s += plan.end_s - plan.duration_s();
    return way.corners;
}

/// The items of a mission.
class Items {
 public:
    Items(const OnEarth& earth, double home_altitude_m) : earth_(earth), home_altitude_m_(home_altitude_m) {}

    /// @param parameters the first three
    void add_at(const Corner& corner, int command, const std::array<double, 3>& parameters) {
        const Geodetic place = earth_.at(corner.place_m);
        add_at(place, place.altitude_m - home_altitude_m_, corner.yaw_rad, command, parameters);
    }

    /// Below a place, at the altitude of home.
    void add_landing(const Corner& corner) {
        add_at(earth_.at(corner.place_m), 0, corner.yaw_rad, land_command, {0, 0, 0});
    }

    /// Without a place.
    void add(int command, const std::array<double, 7>& parameters) {
        items_.push_back({{"autoContinue", true},
                          {"command", command},
                          {"doJumpId", items_.size() + 1},
                          {"frame", mission_frame},
                          {"params", parameters},
                          {"type", "SimpleItem"}});
    }

    [[nodiscard]] Json take() { return std::move(items_); }

 private:
    void add_at(const Geodetic& place, double above_home_m, double yaw_rad, int command,
                const std::array<double, 3>& parameters) {
        items_.push_back({{"AMSLAltAboveTerrain", nullptr},
                          {"Altitude", above_home_m},
                          {"AltitudeMode", relative_altitude_mode},
                          {"autoContinue", true},
                          {"command", command},
                          {"doJumpId", items_.size() + 1},
                          {"frame", relative_altitude_frame},
                          {"params",
                           {parameters[0], parameters[1], parameters[2], earth_.bearing_deg(yaw_rad),
                            place.latitude_deg, place.longitude_deg, above_home_m}},
                          {"type", "SimpleItem"}});
    }

    const OnEarth& earth_;
    double home_altitude_m_;
    Json items_ = Json::array();
};

Json items_of(const RunInWorld& run, const OnEarth& earth, const ExportSettings& settings) {
    const std::vector<Corner> corners = corners_of(run);
    Items items(earth, settings.origin->altitude_m);
    items.add_at(corners.front(), takeoff_command, {0, 0, 0});
    // The hover speed of a mission only feeds estimates of its time.
    items.add(change_speed_command, {ground_speed, run.max_speed_m_s, same_throttle, 0, 0, 0, 0});
    for (std::size_t i = 0; i < corners.size(); ++i) {
        if (i > 0 || corners[i].hold_s > 0) {
            items.add_at(corners[i], waypoint_command, {corners[i].hold_s, acceptance_radius_m, 0});
        }
    }
    if (settings.mission_end == MissionEnd::land) {
        items.add_landing(corners.back());
    } else if (settings.mission_end == MissionEnd::return_home) {
        items.add(return_command, {});
    }
    return items.take();
}

}  // namespace

std::string qgc_plan(const RunInWorld& run, const ExportSettings& settings) {
    if (!settings.origin) {
        throw_input_error("a mission needs to know where the scene lies: give --origin LATITUDE LONGITUDE ALTITUDE");
    }
    check(*settings.origin, settings.bearing_deg);
    const GeodeticOrigin& home = *settings.origin;
    const Json plan{{"fileType", "Plan"},
                    {"geoFence", {{"circles", Json::array()}, {"polygons", Json::array()}, {"version", 2}}},
                    {"groundStation", "QGroundControl"},
                    {"mission",
                     {{"cruiseSpeed", run.max_speed_m_s},
                      {"firmwareType", px4_firmware},
                      {"globalPlanAltitudeMode", relative_altitude_mode},
                      {"hoverSpeed", run.max_speed_m_s},
                      {"items", items_of(run, OnEarth(home, settings.bearing_deg), settings)},
                      {"plannedHomePosition", {home.latitude_deg, home.longitude_deg, home.altitude_m}},
                      {"vehicleType", vehicle_type(run.rotors)},
                      {"version", 2}}},
                    {"rallyPoints", {{"points", Json::array()}, {"version", 2}}},
                    {"version", 1}};
    constexpr int indent = 4;
    return plan.dump(indent) + "\n";
}

}  // namespace downwash

#include <GeographicLib/LocalCartesian.hpp>
#include <algorithm>
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

constexpr int takeoff_command = 22;         // MAV_CMD_NAV_TAKEOFF
constexpr int waypoint_command = 16;        // MAV_CMD_NAV_WAYPOINT
constexpr int relative_altitude_frame = 3;  // MAV_FRAME_GLOBAL_RELATIVE_ALT
constexpr int relative_altitude_mode = 1;
constexpr int px4_firmware = 12;    // MAV_AUTOPILOT_PX4
constexpr int multirotor_type = 2;  // MAV_TYPE_QUADROTOR

struct Geodetic {
    double latitude_deg, longitude_deg, altitude_m;
};

/// Places of the world frame on the Earth.
class OnEarth {
 public:
    explicit OnEarth(const GeodeticOrigin& origin)
        : local_(origin.latitude_deg, origin.longitude_deg, origin.altitude_m),
          sine_(std::sin(origin.bearing_deg / degrees_per_radian)),
          cosine_(std::cos(origin.bearing_deg / degrees_per_radian)),
          bearing_deg_(origin.bearing_deg) {}

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

void check(const GeodeticOrigin& origin) {
    const bool is_sound = std::abs(origin.latitude_deg) <= 90 && std::abs(origin.longitude_deg) <= 180 &&
                          std::abs(origin.altitude_m) <= 1e5 && std::abs(origin.bearing_deg) <= 360;
    if (!is_sound) {
        throw_input_error("the origin is at latitude " + to_text(origin.latitude_deg) + ", longitude " +
                          to_text(origin.longitude_deg) + ", altitude " + to_text(origin.altitude_m) + " m, bearing " +
                          to_text(origin.bearing_deg) +
                          ": expected -90 to 90, -180 to 180, -1e5 to 1e5 and -360 to 360");
    }
}

/// A corner of the mission, and for how long it is held.
struct Corner {
    Configuration at;
    double hold_s = 0;
};

/// A mission flies straight from corner to corner: the corners that keep it on the plan's curves.
class Corners {
 public:
    explicit Corners(const Plan& plan) : plan_(plan) {}

    /// The way of the plan from one time to another, both of which are corners, without the first.
    void add_way(double from_s, double to_s) {
        if (to_s - from_s > 2 * plan_.tick_s && bulge_m(from_s, to_s) > most_bulge_m) {
            const double middle_s = (from_s + to_s) / 2;
            add_way(from_s, middle_s);
            add_way(middle_s, to_s);
        } else {
            corners.push_back({at(to_s)});
        }
    }

    std::vector<Corner> corners;

 private:
    static constexpr double most_bulge_m = 0.02;

    [[nodiscard]] Configuration at(double t_s) const { return configuration_of(plan_.at_time(t_s)); }

    /// How far the plan is from the straight line between its places at two times [m].
    [[nodiscard]] double bulge_m(double from_s, double to_s) const {
        constexpr int samples = 16;
        const Configuration from = at(from_s), to = at(to_s);
        const double along_x = to[plane::x] - from[plane::x], along_z = to[plane::z] - from[plane::z];
        const double length_2 = along_x * along_x + along_z * along_z;
        double most_m = 0;
        for (int i = 1; i < samples; ++i) {
            const Configuration here = at(from_s + (to_s - from_s) * i / samples);
            const double dx = here[plane::x] - from[plane::x], dz = here[plane::z] - from[plane::z];
            const double share = length_2 > 0 ? std::clamp((dx * along_x + dz * along_z) / length_2, 0., 1.) : 0;
            most_m = std::max(most_m, std::hypot(dx - share * along_x, dz - share * along_z));
        }
        return most_m;
    }

    const Plan& plan_;
};

/// A plan holds at a goal between two knots at the same place, and at the last one until the flight ends.
std::vector<Corner> corners_of(const RunRecord& run) {
    const Plan& plan = plan_to_be_flown(run);
    Corners way(plan);
    way.corners.push_back({configuration_of(plan.reference.front().point)});
    for (std::size_t i = 1; i < plan.reference.size(); ++i) {
        const ReferenceKnot &from = plan.reference[i - 1], &to = plan.reference[i];
        const Configuration begin = configuration_of(from.point), end = configuration_of(to.point);
        const double from_s = static_cast<double>(from.tick) * plan.tick_s;
        const double to_s = static_cast<double>(to.tick) * plan.tick_s;
        if (begin[plane::x] == end[plane::x] && begin[plane::z] == end[plane::z]) {
            way.corners.back().hold_s += to_s - from_s;
        } else {
            way.add_way(from_s, to_s);
        }
    }
    way.corners.back().hold_s += end_of_hover_s(run) - plan.duration_s();
    return way.corners;
}

}  // namespace

std::string qgc_plan(const RunRecord& run, const ExportSettings& settings) {
    if (!settings.origin) {
        throw_input_error("a mission needs to know where the scene lies: give --origin LATITUDE LONGITUDE ALTITUDE");
    }
    check(*settings.origin);
    const std::vector<Corner> corners = corners_of(run);
    const OnEarth earth(*settings.origin);
    const double bearing_deg = earth.bearing_deg(run.problem.plane.heading_rad());
    Json items = Json::array();
    for (const Corner& corner : corners) {
        const Vector3 world_m = run.problem.plane.to_world(corner.at[plane::x], 0, corner.at[plane::z]);
        const Geodetic place = earth.at(world_m);
        const double above_home_m = place.altitude_m - settings.origin->altitude_m;
        const auto add = [&](int command, double hold_s, double acceptance_radius_m) {
            items.push_back({{"AMSLAltAboveTerrain", nullptr},
                             {"Altitude", above_home_m},
                             {"AltitudeMode", relative_altitude_mode},
                             {"autoContinue", true},
                             {"command", command},
                             {"doJumpId", items.size() + 1},
                             {"frame", relative_altitude_frame},
                             {"params",
                              {hold_s, acceptance_radius_m, 0., bearing_deg, place.latitude_deg, place.longitude_deg,
                               above_home_m}},
                             {"type", "SimpleItem"}});
        };
        const bool is_first = items.empty();
        if (is_first) {
            add(takeoff_command, 0, 0);
        }
        if (!is_first || corner.hold_s > 0) {
            add(waypoint_command, corner.hold_s, 0.2);
        }
    }
    const GeodeticOrigin& home = *settings.origin;
    const Json plan{{"fileType", "Plan"},
                    {"geoFence", {{"circles", Json::array()}, {"polygons", Json::array()}, {"version", 2}}},
                    {"groundStation", "QGroundControl"},
                    {"mission",
                     {{"cruiseSpeed", run.problem.motion.max_speed_m_s},
                      {"firmwareType", px4_firmware},
                      {"globalPlanAltitudeMode", relative_altitude_mode},
                      {"hoverSpeed", run.problem.motion.max_speed_m_s},
                      {"items", std::move(items)},
                      {"plannedHomePosition", {home.latitude_deg, home.longitude_deg, home.altitude_m}},
                      {"vehicleType", multirotor_type},
                      {"version", 2}}},
                    {"rallyPoints", {{"points", Json::array()}, {"version", 2}}},
                    {"version", 1}};
    constexpr int indent = 4;
    return plan.dump(indent) + "\n";
}

}  // namespace downwash

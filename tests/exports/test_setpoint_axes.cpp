#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <complex>
#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "setpoint_plans.hpp"

// The axes of set-points, by a second formulation: quaternions as PX4 and MAVROS document them, instead of the axes'
// directions, and complex numbers for the ground.

using namespace downwash;
using namespace downwash::test;  // NOLINT(google-build-using-namespace): a test
using Json = nlohmann::json;

namespace {

constexpr double pi = 3.14159265358979323846;

/// w, x, y, z.
using Quaternion = std::array<double, 4>;

Quaternion times(const Quaternion& a, const Quaternion& b) {
    return {
        a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3], a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
        a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1], a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0]};
}

/// Of angles about fixed axes x, y and z, one after the other.
Quaternion of_rpy(double roll, double pitch, double yaw) {
    const Quaternion x{std::cos(roll / 2), std::sin(roll / 2), 0, 0}, y{std::cos(pitch / 2), 0, std::sin(pitch / 2), 0},
        z{std::cos(yaw / 2), 0, 0, std::sin(yaw / 2)};
    return times(z, times(y, x));
}

Vector3 turned(const Quaternion& q, const Vector3& v) {
    const Quaternion back{q[0], -q[1], -q[2], -q[3]};
    const Quaternion r = times(times(q, {0, v[0], v[1], v[2]}), back);
    return {r[1], r[2], r[3]};
}

/// From north, east and down to east, north and up, and back.
const Quaternion ned_to_enu = of_rpy(pi, 0, pi / 2);
/// Between bodies with axes forward, right, down and forward, left, up.
const Quaternion frd_to_flu = of_rpy(pi, 0, 0);

Vector3 list_of(const Json& list) {
    return {list[0], list[1], list[2]};
}

Vector3 xyz_of(const Json& group) {
    return {group["x"], group["y"], group["z"]};
}

void check_near(const Vector3& found, const Vector3& expected, double tolerance) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        REQUIRE(found[axis] == Approx(expected[axis]).margin(tolerance));
    }
}

/// A vector of the world in east, north and up.
Vector3 on_map(const Vector3& world, double bearing_deg) {
    const std::complex<double> ground =
        std::complex<double>(world[0], world[1]) * std::polar(1., (90 - bearing_deg) * pi / 180);
    return {ground.real(), ground.imag(), world[2]};
}

/// A number of one type at a byte.
template <class Number>
Number at(const std::string& bytes, std::size_t place) {
    Number number{};
    std::memcpy(&number, bytes.data() + place, sizeof(number));
    return number;
}

}  // namespace

TEST_CASE("Set-points of PX4, of a map of ROS and of the world are the same motion in other axes") {
    const double bearing_deg = GENERATE(30., 90., -100., 200.);
    const SpaceRunRecord run = space_run(11, 1);
    const Json px4 = Json::parse(written(run, "px4", 20, bearing_deg))["trajectory_setpoints"];
    const Json map = Json::parse(written(run, "ros", 20, bearing_deg))["multi_dof_joint_trajectory"];
    const Json world = Json::parse(written(run, "ros", 20))["multi_dof_joint_trajectory"];
    CHECK(map["header"]["frame_id"] == "map");
    CHECK(world["header"]["frame_id"] == "world");
    REQUIRE(px4.size() == map["points"].size());
    for (std::size_t i = 0; i < px4.size(); ++i) {
        const Json &p = px4[i], &m = map["points"][i], &w = world["points"][i];
        const Json &transform = m["transforms"][0], &twist = m["velocities"][0], &rates = m["accelerations"][0];
        check_near(turned(ned_to_enu, list_of(p["position"])), xyz_of(transform["translation"]), 1e-9);
        check_near(turned(ned_to_enu, list_of(p["velocity"])), xyz_of(twist["linear"]), 1e-9);
        check_near(turned(ned_to_enu, list_of(p["acceleration"])), xyz_of(rates["linear"]), 1e-9);
        check_near(turned(ned_to_enu, {0, 0, p["yawspeed"]}), xyz_of(twist["angular"]), 1e-9);

        // The attitude of one body frame in one world frame, against that of the others.
        const Quaternion attitude = times(times(ned_to_enu, of_rpy(0, 0, p["yaw"])), frd_to_flu);
        const Json& q = transform["rotation"];
        const Quaternion said{q["w"], q["x"], q["y"], q["z"]};
        const double cosine =
            attitude[0] * said[0] + attitude[1] * said[1] + attitude[2] * said[2] + attitude[3] * said[3];
        REQUIRE(std::abs(cosine) == Approx(1).margin(1e-12));

        check_near(on_map(xyz_of(w["transforms"][0]["translation"]), bearing_deg), xyz_of(transform["translation"]),
                   1e-9);
        check_near(on_map(xyz_of(w["velocities"][0]["linear"]), bearing_deg), xyz_of(twist["linear"]), 1e-9);
        const Json& from = w["transforms"][0]["rotation"];
        const Vector3 nose = turned({from["w"], from["x"], from["y"], from["z"]}, {1, 0, 0});
        check_near(on_map(nose, bearing_deg), turned(said, {1, 0, 0}), 1e-9);
    }
}

TEST_CASE("PX4's set-points are derivatives of each other, also where yaw jumps by a turn") {
    constexpr double rate_hz = 250;
    const Json points = Json::parse(written(space_run(13, 0), "px4", rate_hz, 30))["trajectory_setpoints"];
    int jumps = 0;
    for (std::size_t i = 1; i + 2 < points.size(); ++i) {  // the last one comes sooner
        const Json &before = points[i - 1], &now = points[i], &after = points[i + 1];
        const auto slope = [&](const char* key, std::size_t axis) {
            return (after[key][axis].get<double>() - before[key][axis].get<double>()) * rate_hz / 2;
        };
        for (std::size_t axis = 0; axis < 3; ++axis) {
            REQUIRE(now["velocity"][axis].get<double>() == Approx(slope("position", axis)).margin(2e-4));
            REQUIRE(now["acceleration"][axis].get<double>() == Approx(slope("velocity", axis)).margin(0.04));
        }
        const double turn = after["yaw"].get<double>() - before["yaw"].get<double>();
        REQUIRE(now["yawspeed"].get<double>() == Approx(std::remainder(turn, 2 * pi) * rate_hz / 2).margin(1e-3));
        jumps += std::abs(turn) > pi ? 1 : 0;
    }
    CHECK(jumps >= 2);  // two differences hold the same jump
}

TEST_CASE("The jerk of PX4's set-points is that of the plan between its knots") {
    SpaceRunRecord run = space_run(1, 0);
    run.plan->reference.resize(1);
    run.plan->reference.push_back({200, rest_at(run.plan->reference[0].point)});
    run.plan->reference[1].point.position[space::z] += 1;  // in 2 s, from rest to rest: 10 s^3 - 15 s^4 + 6 s^5
    const Json points = Json::parse(written(run, "px4", 20))["trajectory_setpoints"];
    for (std::size_t i = 0; i < points.size(); ++i) {
        const double t_s = static_cast<double>(i) / 20, s = t_s / 2;
        const double expected = t_s < 2 ? (60 - 360 * s + 360 * s * s) / 8 : 0;
        REQUIRE(points[i]["jerk"][2].get<double>() == Approx(-expected).margin(1e-9));
        REQUIRE(points[i]["jerk"][0].get<double>() == Approx(0).margin(1e-9));
    }
}

TEST_CASE("A table for PX4 has the numbers of its messages, and the arm") {
    const SpaceRunRecord run = space_run(17, 3);
    const Json document = Json::parse(written(run, "px4", 10, 45));
    std::istringstream table(written(run, "px4-csv", 10, 45));
    std::string line;
    std::getline(table, line);
    CHECK(line ==
          "timestamp,position[0],position[1],position[2],velocity[0],velocity[1],velocity[2],acceleration[0],"
          "acceleration[1],acceleration[2],yaw,yawspeed,jerk[0],jerk[1],jerk[2],joint_1_rad,joint_1_rate_rad_s,"
          "joint_1_acceleration_rad_s2,joint_2_rad,joint_2_rate_rad_s,joint_2_acceleration_rad_s2,joint_3_rad,"
          "joint_3_rate_rad_s,joint_3_acceleration_rad_s2");
    for (const Json& p : document["trajectory_setpoints"]) {
        REQUIRE(std::getline(table, line));
        std::vector<double> numbers;
        std::istringstream cells(line);
        for (std::string cell; std::getline(cells, cell, ',');) {
            numbers.push_back(std::stod(cell));
        }
        REQUIRE(numbers.size() == 24);
        REQUIRE(numbers[0] == p["timestamp"].get<double>());
        REQUIRE(numbers[3] == p["position"][2].get<double>());
        REQUIRE(numbers[8] == p["acceleration"][1].get<double>());
        REQUIRE(numbers[10] == p["yaw"].get<double>());
        REQUIRE(numbers[14] == p["jerk"][2].get<double>());
    }
}

TEST_CASE("A log of MAVLink has set-points at the bytes that the protocol says, and ignores nothing") {
    const SpaceRunRecord run = space_run(19, 1);
    const Json points = Json::parse(written(run, "px4", 50, 20))["trajectory_setpoints"];
    const std::string log = written(run, "mavlink", 50, 20);
    constexpr std::size_t head = 8 + 10, length = 53, entry = head + length + 2;
    REQUIRE(log.size() == entry * points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
        const std::string bytes = log.substr(i * entry, entry);
        std::uint64_t stamp_us = 0;
        for (std::size_t k = 0; k < 8; ++k) {
            stamp_us = stamp_us << 8U | static_cast<unsigned char>(bytes[k]);
        }
        REQUIRE(stamp_us == points[i]["timestamp"].get<std::uint64_t>());
        REQUIRE(at<std::uint8_t>(bytes, 8) == 0xfd);
        REQUIRE(at<std::uint8_t>(bytes, 9) == length);
        REQUIRE(at<std::uint8_t>(bytes, 12) == i % 256);
        REQUIRE(at<std::uint8_t>(bytes, 15) == 84);
        REQUIRE(at<std::uint32_t>(bytes, head) == stamp_us / 1000);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const auto number = [&](std::size_t first) { return at<float>(bytes, head + 4 * (first + axis)); };
            REQUIRE(number(1) == static_cast<float>(points[i]["position"][axis].get<double>()));
            REQUIRE(number(4) == static_cast<float>(points[i]["velocity"][axis].get<double>()));
            REQUIRE(number(7) == static_cast<float>(points[i]["acceleration"][axis].get<double>()));
        }
        REQUIRE(at<float>(bytes, head + 40) == static_cast<float>(points[i]["yaw"].get<double>()));
        REQUIRE(at<float>(bytes, head + 44) == static_cast<float>(points[i]["yawspeed"].get<double>()));
        REQUIRE(at<std::uint16_t>(bytes, head + 48) == 0);  // type_mask
        REQUIRE(at<std::uint8_t>(bytes, head + 50) == 1);   // target_system
        REQUIRE(at<std::uint8_t>(bytes, head + 51) == 1);   // target_component: the autopilot
        REQUIRE(at<std::uint8_t>(bytes, head + 52) == 1);   // coordinate_frame: MAV_FRAME_LOCAL_NED
    }
}

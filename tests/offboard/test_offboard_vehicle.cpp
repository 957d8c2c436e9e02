#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <string>

#include "../../docs/examples/offboard/offboard_vehicle.hpp"
#include "../../docs/examples/offboard/px4.hpp"
#include "downwash/problems/space_problem_reader.hpp"
#include "downwash/problems/space_problem_writer.hpp"

using namespace downwash;
using mavlink::CommandAck;
using mavlink::CommandLong;
using mavlink::SetPositionTargetLocalNed;

namespace {

SpaceProblem girder() {
    return read_px4_problem(DOWNWASH_EXAMPLE "/girder.yaml");
}

CommandLong request(float main_mode, float sub_mode = 0) {
    CommandLong command;
    command.command = CommandLong::do_set_mode;
    command.param1 = 1;
    command.param2 = main_mode;
    command.param3 = sub_mode;
    return command;
}

/// A vehicle and who talks to it.
struct Talk {
    SpaceProblem problem = girder();
    OffboardVehicle vehicle{problem, {}};
    mavlink::FrameWriter writer{1, 191};
    SpacePoint here = reference_at(problem.start);

    /// Flies for a while and says at 50 Hz where to be.
    void stream(double duration_s, const SpacePoint& at) {
        const double end_s = vehicle.time_s() + duration_s;
        while (vehicle.time_s() < end_s) {
            if (vehicle.is_telemetry_due()) {
                vehicle.take(writer.frame(setpoint_of(at, vehicle.time_s())));
            }
            vehicle.tick();
        }
    }
    void be_silent(double duration_s) {
        const double end_s = vehicle.time_s() + duration_s;
        while (vehicle.time_s() < end_s) {
            vehicle.tick();
        }
    }
    /// The answer to a command.
    int result_of(const CommandLong& command) {
        vehicle.take(writer.frame(command));
        for (const mavlink::Frame& frame : mavlink::FrameReader().take(vehicle.sent())) {
            if (const auto answer = mavlink::message_in<CommandAck>(frame)) {
                CHECK(answer->command == command.command);
                return answer->result;
            }
        }
        return -1;
    }
    [[nodiscard]] double speed_m_s() const {
        const auto& v = vehicle.motion().velocity_m_s;
        return std::hypot(v[0], v[1], v[2]);
    }
};

}  // namespace

TEST_CASE("the vehicle enters offboard mode after a second of set-points and not before") {
    Talk talk;
    CHECK(talk.result_of(request(6)) == CommandAck::temporarily_rejected);
    talk.stream(0.9, talk.here);
    CHECK(talk.result_of(request(6)) == CommandAck::temporarily_rejected);
    talk.be_silent(0.6);
    talk.stream(0.9, talk.here);
    CHECK(talk.result_of(request(6)) == CommandAck::temporarily_rejected);
    talk.stream(0.2, talk.here);
    CHECK(talk.result_of(request(6)) == CommandAck::accepted);
    CHECK(talk.vehicle.is_offboard());
    CHECK(talk.result_of(request(2)) == CommandAck::unsupported);
    CHECK(talk.result_of(request(std::numeric_limits<float>::quiet_NaN())) == CommandAck::unsupported);
    CommandLong other;
    other.command = 400;  // MAV_CMD_COMPONENT_ARM_DISARM
    CHECK(talk.result_of(other) == CommandAck::unsupported);
    CHECK(talk.vehicle.is_offboard());
}

TEST_CASE("the vehicle goes where set-points say, and its arm too") {
    Talk talk;
    talk.stream(1.1, talk.here);
    REQUIRE(talk.result_of(request(6)) == CommandAck::accepted);
    SpacePoint there = talk.here;
    there.position[space::x] += 0.3;
    there.position[space::y] -= 0.2;
    there.position[space::z] += 0.1;
    there.position[space::yaw] += 0.5;
    there.position[space::first_joint] += 0.4;
    for (int i = 0; i < 100; ++i) {
        talk.vehicle.take(talk.writer.frame(actuators_of(there, talk.problem.robot)));
        talk.stream(0.1, there);
    }
    const SpaceMotion motion = talk.vehicle.motion();
    CHECK(motion.position_m[0] == Approx(there.position[space::x]).margin(0.02));
    CHECK(motion.position_m[1] == Approx(there.position[space::y]).margin(0.02));
    CHECK(motion.position_m[2] == Approx(there.position[space::z]).margin(0.01));
    CHECK(2 * std::atan2(motion.attitude[3], motion.attitude[0]) == Approx(0.5).margin(0.02));
    CHECK(motion.joints_rad[0] == Approx(there.position[space::first_joint]).margin(0.02));
}

TEST_CASE("the vehicle is that of the shipped robot file but for its controller") {
    const SpaceRobot own = girder().robot;
    const SpaceRobot shipped = read_space_robot(DOWNWASH_PROBLEMS "/robots/hexa370_arm3.yaml");
    SpaceRobot same = own;
    same.name = shipped.name;
    same.controller = shipped.controller;
    CHECK(robot_yaml(same) == robot_yaml(shipped));
}

TEST_CASE("telemetry is where the vehicle is, in MAVLink's axes") {
    Talk talk;
    const auto frames = mavlink::FrameReader().take(talk.vehicle.sent());
    REQUIRE(frames.size() == 3);
    CHECK(mavlink::message_in<mavlink::Heartbeat>(frames[0]).value().custom_mode == mavlink::px4_hold_mode);
    const auto position = mavlink::message_in<mavlink::LocalPositionNed>(frames[2]).value();
    CHECK(position.time_boot_ms == 0);
    CHECK(position.x == Approx(0).margin(0.01));
    CHECK(position.y == Approx(1.2).margin(0.01));
    CHECK(position.z == Approx(-2.2).margin(0.01));
}

TEST_CASE("a vehicle whose set-points do not come holds after half a second, and stops where PX4 says") {
    Talk talk;
    talk.stream(1.1, talk.here);
    REQUIRE(talk.result_of(request(6)) == CommandAck::accepted);
    SpacePoint moving = talk.here;
    constexpr double speed_m_s = 0.3;
    for (int i = 0; i < 400; ++i) {
        moving.velocity[space::x] = speed_m_s;
        talk.stream(0.02, moving);
        moving.position[space::x] += 0.02 * speed_m_s;
    }
    const double last_x_m = talk.vehicle.motion().position_m[0];
    talk.be_silent(0.48);
    CHECK(talk.vehicle.is_offboard());
    talk.be_silent(0.04);
    CHECK_FALSE(talk.vehicle.is_offboard());
    CHECK(talk.vehicle.is_in_failsafe());
    talk.be_silent(6);
    CHECK(talk.vehicle.outcome() == Outcome::ok);
    CHECK(talk.speed_m_s() < 0.02);
    // v (v / 6 + 0.6 s) = 0.195 m from where Hold began, and at most 0.15 m before.
    const double on_m = talk.vehicle.motion().position_m[0] - last_x_m;
    CHECK(on_m > 0.195);
    CHECK(on_m < 0.195 + 0.15 + 0.02);
    // It stays there when set-points come again: offboard mode has to be asked for.
    talk.stream(2, talk.here);
    CHECK_FALSE(talk.vehicle.is_offboard());
    CHECK(talk.result_of(request(6)) == CommandAck::accepted);
}

TEST_CASE("set-points that are not numbers, or ask for what it cannot follow, keep nothing alive") {
    Talk talk;
    const auto changed = [&](auto change) {
        SetPositionTargetLocalNed setpoint = setpoint_of(talk.here, talk.vehicle.time_s());
        change(setpoint);
        talk.vehicle.take(talk.writer.frame(setpoint));
    };
    changed([](auto& setpoint) { setpoint.x = std::numeric_limits<float>::quiet_NaN(); });
    changed([](auto& setpoint) { setpoint.vz = std::numeric_limits<float>::infinity(); });
    changed([](auto& setpoint) { setpoint.type_mask = SetPositionTargetLocalNed::ignores_position; });
    changed([](auto& setpoint) { setpoint.type_mask = SetPositionTargetLocalNed::is_force; });
    changed([](auto& setpoint) { setpoint.coordinate_frame = 8; });
    talk.vehicle.take("garbage");
    talk.vehicle.take(std::string(300, '\xfd'));
    CHECK(talk.vehicle.setpoints() == 0);
    changed([](auto&) {});
    CHECK(talk.vehicle.setpoints() == 1);
}

TEST_CASE("a set-point and its reference are the same, whichever axes are ignored") {
    SpacePoint reference;
    for (int i = 0; i < 4; ++i) {
        reference.position[i] = 0.5 + i;
        reference.velocity[i] = -0.25 * i;
        reference.acceleration[i] = i < 3 ? 0.125 * i : 0;
    }
    SpacePoint before;
    before.position[space::yaw] = 2 * 3.14159265358979 + 3;
    auto setpoint = setpoint_of(reference, 1.5);
    CHECK(setpoint.time_boot_ms == 1500);
    CHECK(setpoint.z == -2.5F);
    const SpacePoint read = reference_of(setpoint, before);
    CHECK(read.position[space::yaw] == Approx(3.5 + 2 * 3.14159265358979));  // the turn next to the one before
    for (int i = 0; i < 3; ++i) {
        CHECK(read.position[i] == reference.position[i]);
        CHECK(read.velocity[i] == reference.velocity[i]);
        CHECK(read.acceleration[i] == reference.acceleration[i]);
    }
    CHECK(read.velocity[space::yaw] == reference.velocity[space::yaw]);
    setpoint.type_mask = SetPositionTargetLocalNed::ignores_velocity | SetPositionTargetLocalNed::ignores_acceleration |
                         SetPositionTargetLocalNed::ignores_yaw | SetPositionTargetLocalNed::ignores_yaw_rate;
    const SpacePoint position_only = reference_of(setpoint, before);
    CHECK(position_only.position[space::x] == reference.position[space::x]);
    CHECK(position_only.velocity[space::y] == 0);
    CHECK(position_only.acceleration[space::z] == 0);
    CHECK(position_only.position[space::yaw] == before.position[space::yaw]);
    CHECK(position_only.velocity[space::yaw] == 0);
}

#include "downwash/exports/setpoint_check.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "../support/solved_run.hpp"
#include "downwash/base/key_error.hpp"
#include "downwash/results/space_solution_file.hpp"
#include "setpoint_plans.hpp"

// Set-points that others wrote, or that were damaged, held against the plan.

using namespace downwash;
using namespace downwash::test;  // NOLINT(google-build-using-namespace): a test
using Catch::Contains;
using Catch::StartsWith;
using Json = nlohmann::json;

namespace {

constexpr double pi = 3.14159265358979323846;
const char* const all_formats[] = {"csv", "ros", "px4", "px4-csv", "mavlink"};

template <class Run>
void check_round_trip(const Run& run, bool has_joints, double rate_hz, double bearing_deg) {
    for (const std::string format : all_formats) {
        CAPTURE(format, rate_hz, bearing_deg);
        const bool is_single = format == "mavlink";  // precision
        const SetpointCheck check =
            check_setpoints(run, written(run, format, rate_hz, bearing_deg), format, bearing_deg);
        CHECK(check.format == format);
        CHECK(check.findings == std::vector<std::string>{});
        CHECK(check.has_arm == (!is_single || !has_joints));
        const SetpointDistance &place = check.distances.at(0), &yaw = check.distances.at(1);
        CHECK((place.name == "position" && yaw.name == "yaw"));
        CHECK(place.itself < (is_single ? 4e-6 : 1e-9));
        CHECK(place.rate_integrated.value() < (rate_hz > 20 ? 1e-4 : 2e-3));
        CHECK(place.acceleration_integrated.value() < (is_single ? 1e-6 : 1e-9));
        CHECK(yaw.itself < 1e-6);
    }
}

const SpaceRunRecord& turning_run() {
    static const SpaceRunRecord run = space_run(5, 2);
    return run;
}

/// The px4 file of that run at 20 Hz with a change to its messages.
SetpointCheck check_of_changed(const std::function<void(Json&)>& change, double bearing_deg = 0) {
    Json document = Json::parse(written(turning_run(), "px4", 20, 0));
    change(document);
    return check_setpoints(turning_run(), document.dump(1), "px4.json", bearing_deg);
}

/// The same with a change of every set-point.
SetpointCheck check_of_each(const std::function<void(Json& setpoint)>& change, double bearing_deg = 0) {
    return check_of_changed(
        [&](Json& document) {
            for (Json& setpoint : document["trajectory_setpoints"]) {
                change(setpoint);
            }
        },
        bearing_deg);
}

void check_error(const SpaceRunRecord& run, const std::string& text, const std::string& place,
                 const std::string& message) {
    CAPTURE(message);
    try {
        (void)check_setpoints(run, text, "file");
        FAIL("there is no error");
    } catch (const InputError& error) {
        CHECK_THAT(error.what(), Contains(place) && Contains(message));
    }
}

std::string with(std::string text, const std::string& part, const std::string& by) {
    const std::size_t place = text.find(part);
    REQUIRE(place != std::string::npos);
    return text.replace(place, part.size(), by);
}

}  // namespace

TEST_CASE("Set-points of every kind of plan are read back from every format, at every rate") {
    const double rate_hz = GENERATE(10., 50., 100., 250.);
    check_round_trip(planar_run(3), true, rate_hz, rate_hz > 60 ? 130 : 0);
    for (int joints = 0; joints <= 3; ++joints) {
        CAPTURE(joints);
        check_round_trip(space_run(static_cast<unsigned>(7 + joints), joints), joints > 0, rate_hz,
                         rate_hz > 60 ? -75 : 0);
    }
}

TEST_CASE("Set-points of found and shipped plans are read back, of one with two goals too") {
    static const RunRecord two_goals = [] {
        Problem problem = ceiling_problem();
        problem.goals_before = {configuration_goal(0, 2.5)};
        problem.goals_before[0].hold_s = 1;
        return read_run(SolvedRun(problem).folder());
    }();
    SpaceRunRecord shipped;
    shipped.problem = read_space_problem(DOWNWASH_PROBLEMS "/space/around_a_girder.yaml");
    shipped.plan = read_solution(DOWNWASH_PROBLEMS "/space/around_a_girder.json", shipped.problem).plan;
    const double rate_hz = GENERATE(10., 250.);
    check_round_trip(record(), true, rate_hz, 0);
    check_round_trip(two_goals, true, rate_hz, 40);
    check_round_trip(shipped, true, rate_hz, 200);
}

TEST_CASE("A check says which axes, signs and bearings set-points would fit with") {
    const auto swap_axes = [](Json& vector) { vector = Json{vector[1], vector[0], -vector[2].get<double>()}; };
    const SetpointCheck east_first = check_of_each([&](Json& p) { swap_axes(p["position"]); });
    REQUIRE(east_first.findings.size() == 1);
    CHECK_THAT(east_first.findings[0],
               StartsWith("px4.json:") &&
                   Contains("trajectory_setpoints[0]: position does not fit the plan from 0.000 s") &&
                   Contains("all would fit as (y, x, -z)"));
    const SetpointCheck upward = check_of_each([](Json& p) {
        p["velocity"][2] = -p["velocity"][2].get<double>();
        p["acceleration"][2] = -p["acceleration"][2].get<double>();
    });
    REQUIRE(upward.findings.size() == 2);
    CHECK_THAT(upward.findings[0], Contains("velocity, integrated from the start,") && Contains("as (x, y, -z)"));
    CHECK_THAT(upward.findings[1],
               Contains("acceleration, integrated twice over a second,") && Contains("as (x, y, -z)"));

    const SetpointCheck turned = check_of_each([](Json&) {}, 90);
    REQUIRE(turned.findings.size() == 4);  // place, speed, acceleration, yaw
    CHECK_THAT(turned.findings[0], Contains("turned by 90.0 degrees about z: is --bearing another one?"));
    CHECK_THAT(turned.findings[3], Contains("yaw does not fit") && Contains("turned by 90.0 degrees"));
    const SetpointCheck shifted =
        check_of_each([](Json& p) { p["position"][1] = p["position"][1].get<double>() - 1.5; });
    REQUIRE(shifted.findings.size() == 1);
    CHECK_THAT(shifted.findings[0], Contains("shifted by (0.00, 1.50, 0.00) m"));

    const SetpointCheck mirrored = check_of_each([](Json& p) {
        p["yaw"] = -p["yaw"].get<double>();
        p["yawspeed"] = -p["yawspeed"].get<double>();
    });
    REQUIRE(mirrored.findings.size() == 2);
    CHECK_THAT(mirrored.findings[0], Contains("yaw does not fit") && Contains("with the other sign"));
    CHECK_THAT(mirrored.findings[1], Contains("yaw rate, integrated") && Contains("with the other sign"));
    const SetpointCheck from_east = check_of_each([](Json& p) {
        p["yaw"] = std::remainder(pi / 2 - p["yaw"].get<double>(), 2 * pi);  // as ROS has it
    });
    REQUIRE(from_east.findings.size() == 1);
    CHECK_THAT(from_east.findings[0], Contains("with the other sign and turned by 90.0 degrees"));
    const SetpointCheck unwrapped = check_of_each([](Json& p) { p["yaw"] = p["yaw"].get<double>() - 2 * pi; });
    REQUIRE(unwrapped.findings.size() == 1);
    CHECK_THAT(unwrapped.findings[0], Contains("rad: expected -pi to pi"));
}

TEST_CASE("A check finds derivatives that do not fit, and where") {
    const SetpointCheck resting = check_of_each([](Json& p) { p["velocity"] = {0, 0, 0}; });
    REQUIRE(resting.findings.size() == 1);
    CHECK_THAT(resting.findings[0], Contains("velocity, integrated from the start, does not fit"));
    const SetpointCheck without = check_of_each([](Json& p) { p["acceleration"] = {0, 0, 0}; });
    REQUIRE(without.findings.size() == 1);
    CHECK_THAT(without.findings[0], Contains("acceleration, integrated twice"));
    CHECK(check_of_each([](Json& p) { p["yawspeed"] = 0; }).findings.size() == 1);

    // 2 cm at one set-point, and 2 degrees of one joint at another.
    const SetpointCheck kinked = check_of_changed([](Json& document) {
        Json& height = document["trajectory_setpoints"][40]["position"][2];
        height = height.get<double>() + 0.02;
        Json& angle = document["joint_trajectory"]["points"][60]["positions"][1];
        angle = angle.get<double>() + 2 * pi / 180;
    });
    REQUIRE(kinked.findings.size() == 2);
    CHECK_THAT(kinked.findings[0],
               Contains("trajectory_setpoints[40]: position does not fit the plan from 2.000 s on: 0.02 m"));
    CHECK_THAT(kinked.findings[1], Contains("[60]: joint_2 does not fit the plan from 3.000 s on: 2 degrees"));
    // What is less than 1 cm fits.
    CHECK(check_of_each([](Json& p) { p["position"][0] = p["position"][0].get<double>() + 0.009; }).fits());

    const std::string sparse = written(turning_run(), "px4", 0.3);
    CHECK_THAT(check_setpoints(turning_run(), sparse, "px4.json").findings.at(0),
               Contains("each fits at its own time: are they too far apart to be integrated?"));

    const SetpointCheck cut = check_of_changed([](Json& document) {
        for (Json* list : {&document["trajectory_setpoints"], &document["joint_trajectory"]["points"]}) {
            list->erase(list->begin() + 50, list->end());
        }
    });
    REQUIRE(cut.findings.size() == 1);
    CHECK_THAT(cut.findings[0], Contains("the set-points end at 2.450 s, but the plan at "));
}

TEST_CASE("Set-points without the arm are checked without it, and times may begin anywhere") {
    const SetpointCheck check = check_of_changed([](Json& document) {
        document.erase("joint_trajectory");
        for (Json& p : document["trajectory_setpoints"]) {
            p["timestamp"] = p["timestamp"].get<std::int64_t>() + 1'234'567'890;
            p.erase("jerk");
        }
    });
    CHECK(check.fits());
    CHECK_FALSE(check.has_arm);
    CHECK(check.distances.size() == 2);
}

TEST_CASE("Joints may stand in any order under their names, or in theirs under other names") {
    const auto swap_joints = [](Json& document) {
        for (Json& point : document["joint_trajectory"]["points"]) {
            for (const char* numbers : {"positions", "velocities", "accelerations"}) {
                std::swap(point[numbers][0], point[numbers][1]);
            }
        }
    };
    CHECK(check_of_changed([&](Json& document) {
              swap_joints(document);
              document["joint_trajectory"]["joint_names"] = {"joint_2", "joint_1"};
          }).fits());
    const SetpointCheck swapped = check_of_changed(swap_joints);
    REQUIRE(swapped.findings.size() >= 4);  // angles and rates of both
    CHECK_THAT(swapped.findings[0], Contains("joint_1 does not fit the plan"));
    CHECK(check_of_changed([](Json& document) {
              document["joint_trajectory"]["joint_names"] = {"shoulder", "elbow"};
          }).fits());
}

TEST_CASE("Broken messages are errors with their places") {
    const SpaceRunRecord& run = turning_run();
    const std::string px4 = written(run, "px4", 10), ros = written(run, "ros", 10);
    check_error(run, with(px4, "\"timestamp\": 200000", "\"timestamp\": 100000"), "trajectory_setpoints[2]",
                "the time does not rise: 0.1 s after 0.1 s");
    check_error(run, with(px4, "\"yawspeed\": 0.0", "\"yawspeed\": NaN"),
                "file:", "which has neither NaN nor infinity");
    check_error(run, with(px4, "\"yawspeed\": 0.0", "\"yawspeed\": null"), "trajectory_setpoints[0].yawspeed",
                "expected a number, found null");
    check_error(run, with(px4, "\"yawspeed\"", "\"yaw_speed\""), "trajectory_setpoints[0]", "'yawspeed' is missing");
    check_error(run, with(px4, "\"joint_2\"", "\"wrist\""), "joint_trajectory.joint_names[1]",
                "expected joint_1 or joint_2");
    check_error(run, with(px4, "\"joint_2\"", "\"joint_1\""), "joint_names[1]", "occurs twice");
    check_error(run, with(px4, "\"nanosec\": 300000000", "\"nanosec\": 310000000"), "joint_trajectory.points[3]",
                "expected the time of the vehicle's set-point, 0.3 s, found 0.31 s");
    check_error(run, with(ros, "\"w\": ", "\"w\": 1"), "points[0].transforms[0].rotation", "a quaternion of length 1");
    check_error(run, px4.substr(0, px4.size() / 2), "file:", "the file was cut off here");
    check_error(run, "{\"trajectory_setpoints\": []}", "file", "there are no set-points");
    check_error(run, "{\"points\": []}", "file:1:1", "expected trajectory_setpoints (px4)");
    check_error(run, "{\"trajectory_setpoints\": 3}", "trajectory_setpoints", "expected a list");
}

TEST_CASE("Broken tables are errors with their places") {
    const SpaceRunRecord& run = turning_run();
    const std::string csv = written(run, "csv", 10), px4 = written(run, "px4-csv", 10);
    CHECK_THAT(px4, StartsWith("timestamp,position[0],position[1],position[2],velocity[0],"));
    check_error(run, with(px4, "\n300000,", "\n200000,"), "file:5", "the time does not rise");
    check_error(run, with(csv, "\n0.3,", "\nnan,"), "file:5:1", "nan");
    check_error(run, with(csv, "\n0.3,", "\n,"), "file:5", "");
    check_error(run, with(csv, "vz_m_s", "vz"), "file:1", "vz_m_s");
    check_error(run, with(px4, "joint_2_rate_rad_s", "wrist"), "file:1", "joint_2_rate_rad_s");
    check_error(run, csv.substr(0, csv.find('\n') + 1), "file", "there are no set-points");
    check_error(run, "", "file", "");
}

TEST_CASE("Broken logs of MAVLink are errors at their bytes") {
    const SpaceRunRecord& run = turning_run();
    const std::string log = written(run, "mavlink", 10);
    constexpr std::size_t entry = 8 + 12 + 53;
    std::string flipped = log;
    flipped[entry + 30] = static_cast<char>(flipped[entry + 30] ^ 1);
    check_error(run, flipped, "file: byte " + std::to_string(entry + 8), "the frame is damaged");
    check_error(run, log.substr(0, log.size() - 5), "file: byte", "the file ends within a frame");
    std::string foreign = log;
    foreign[entry + 8] = 'x';
    check_error(run, foreign, "file: byte " + std::to_string(entry + 8), "expected a frame of MAVLink");
    std::string twice = log.substr(0, entry) + log;
    check_error(run, twice, "file: byte " + std::to_string(entry + 8), "the time does not rise");
}

TEST_CASE("A run without a plan to be flown has nothing to hold set-points against") {
    const std::string text = written(turning_run(), "px4", 10);
    SpaceRunRecord run = turning_run();
    run.plan.reset();
    CHECK_THROWS_AS(check_setpoints(run, text, "px4.json"), InputError);
    CHECK_THROWS_AS(check_setpoints(turning_run(), text, "px4.json", 400), InputError);
    CHECK_THROWS_WITH(written(turning_run(), "mavlink", 2000), Contains("at most 1000 Hz"));
}

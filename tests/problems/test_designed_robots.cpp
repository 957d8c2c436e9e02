#include <catch2/catch.hpp>
#include <filesystem>
#include <numbers>

#include "../support/random.hpp"
#include "../support/test_files.hpp"
#include "downwash/problems/designed_robot.hpp"
#include "downwash/simulation/space_hover.hpp"
#include "space_files.hpp"

using namespace downwash;
using namespace downwash::test;

namespace {

std::string without_controller(std::string_view robot) {
    return std::string(robot.substr(0, robot.find("controller:")));
}

}  // namespace

TEST_CASE("a robot in space without a controller gets one from bandwidths, which its file then has") {
    const TestFolder folder;
    folder.write("robot.yaml", without_controller(good_space_robot));
    CHECK_THAT(folder.errors_in([&] { return read_space_robot(folder / "robot.yaml"); }),
               Catch::Contains("1:1: controller is missing: expected a group of keys; `downwash margins ROBOT "
                               "--design` prints one for this "
                               "robot"));
    for (const std::string_view law : designed_laws) {
        CAPTURE(law);
        SpaceBandwidths bandwidths;
        bandwidths.translation_rad_s = 1.1;
        bandwidths.joint_rad_s = 3;
        const AnyRobot designed = read_robot_for_design(folder / "robot.yaml", bandwidths, std::string(law));
        const auto& robot = std::get<SpaceRobot>(designed);
        if (law == SpaceInversion::name) {
            const auto& gains = std::get<SpaceInversion>(robot.controller.law);
            CHECK(gains.horizontal.kp_1_s2 == 1.21);  // 1.2100000000000002 rounded
            CHECK(gains.horizontal.ki_1_s3 == 0.3727);
            CHECK(gains.joint.kp_1_s2 == 9);
        } else {
            CHECK(std::get<Px4Cascade>(robot.controller.law).velocity.kp_1_s == 2.2);
        }
        // The printed section makes the file complete, and the robot the same.
        folder.write("full.yaml", without_controller(good_space_robot) + controller_yaml(designed));
        const SpaceRobot full = read_space_robot(folder / "full.yaml");
        CHECK(controller_yaml(AnyRobot(full)) == controller_yaml(designed));
        CHECK(full.controller.law.index() == robot.controller.law.index());
    }
}

TEST_CASE("rate, delay and law of a controller are kept by a design, its gains are not") {
    const TestFolder folder;
    folder.write("robot.yaml", without_controller(good_space_robot) +
                                   "controller: {type: px4-cascade, rate_hz: 250, delay_s: 0.012, yaw_p_1_s: 9}\n");
    const AnyRobot designed = read_robot_for_design(folder / "robot.yaml", {});
    const SpaceController& controller = std::get<SpaceRobot>(designed).controller;
    CHECK(controller.rate_hz == 250);
    CHECK(controller.delay_s == 0.012);
    CHECK(std::get<Px4Cascade>(controller.law).yaw_p_1_s == 1.25);
}

TEST_CASE("a robot of a vertical plane gets the gains of its model inversion, another law has an error in its place") {
    const TestFolder folder;
    folder.write("robot.yaml", without_controller(good_robot));
    const AnyRobot designed = read_robot_for_design(folder / "robot.yaml", {});
    const auto& gains = std::get<ModelInversion>(std::get<Robot>(designed).controller.law);
    CHECK(gains.position_kp == 1.96);
    CHECK(gains.height_kp == 12.25);
    CHECK(gains.aids.observer.has_value());
    folder.write("full.yaml", without_controller(good_robot) + controller_yaml(designed));
    CHECK(controller_yaml(AnyRobot(read_robot(folder / "full.yaml"))) == controller_yaml(designed));

    folder.write("robot.yaml", without_controller(good_robot) + "controller: {type: cascaded-pid}\n");
    CHECK_THAT(folder.errors_in([&] { return read_robot_for_design(folder / "robot.yaml", {}); }),
               Catch::Contains("14:20: controller.type has no gains from bandwidths: expected model-inversion"));
    CHECK_NOTHROW(read_robot_for_design(folder / "robot.yaml", {}, "model-inversion"));
    CHECK_THAT(folder.errors_in([&] { return read_robot_for_design(folder / "robot.yaml", {}, "px4-cascade"); }),
               Catch::Contains("px4-cascade is for robots in space"));
}

TEST_CASE("what else is wrong with a robot stays an error in a design") {
    const TestFolder folder;
    std::string robot = without_controller(good_space_robot);
    robot.replace(robot.find("mass_kg: 2"), 10, "mass_kg: -2");
    folder.write("robot.yaml", robot);
    CHECK_THAT(folder.errors_in([&] { return read_robot_for_design(folder / "robot.yaml", {}); }),
               Catch::Contains("multirotor.mass_kg"));
}

TEST_CASE(
    "designed gains leave 6 dB and 30 deg to every loop of the shipped robots in space, wherever their arms are") {
    const std::filesystem::path robots(DOWNWASH_PROBLEMS "/robots");
    Random random(7);
    for (const char* name : {"hexa370_arm3", "hexa960_arm2", "snu_f550_arm2", "ars_lrm_space"}) {
        CAPTURE(name);
        const auto file = robots / (std::string(name) + ".yaml");
        const auto robot = std::get<SpaceRobot>(read_robot_for_design(file, {}, std::string(SpaceInversion::name)));
        std::vector<ExaminedPose> poses = examined_poses(robot);
        for (int i = 0; i < 8; ++i) {
            std::vector<double> joints_rad;
            for (const SpaceLinkLimits& link : robot.links) {
                joints_rad.push_back(random.uniform(link.lower_limit_rad, link.upper_limit_rad));
            }
            poses.push_back({"random", joints_rad});
        }
        for (const ExaminedPose& pose : poses) {
            const SpaceLoopMargins margins = space_loop_margins(robot, pose.joints_rad);
            for (std::size_t loop = 0; loop < margins.loops.size(); ++loop) {
                CAPTURE(pose.name, pose.joints_rad, space_loop_name(static_cast<int>(loop)));
                CHECK(margins.loops[loop].gain_margin_db > 6);
                CHECK(margins.loops[loop].phase_margin_rad > std::numbers::pi / 6);
            }
        }
    }
}

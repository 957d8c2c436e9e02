#include "downwash/report/robot_page.hpp"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <numeric>
#include <string>
#include <variant>

#include "downwash/problems/problem_reader.hpp"
#include "downwash/problems/space_problem_reader.hpp"
#include "downwash/report/run_page.hpp"
#include "downwash/simulation/robot_facts.hpp"
#include "downwash/simulation/space_statics.hpp"

using namespace downwash;
using Catch::Contains;
using nlohmann::json;

namespace {

std::string robot_file(const char* name) {
    return std::string(DOWNWASH_PROBLEMS "/robots/") + name;
}

double sum_of(const std::vector<double>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0);
}

}  // namespace

TEST_CASE("a robot in space hovers by thrusts that carry its weight and turn nothing, wherever its arm is") {
    const ShownRobot shown = shown_robot(read_space_robot(robot_file("hexa370_arm3.yaml")));
    const SpaceRobot& robot = shown.robot;
    CHECK_FALSE(shown.is_planar);
    for (const std::vector<double>& joints_rad : {std::vector{0.0, 0.0, 0.0}, {0.4, -0.7, 1.0}}) {
        const Vector3 at_m = center_of_mass_m(robot, arm_pose(robot, joints_rad));
        const std::vector<double> thrusts_n = shown.hover.at(at_m);
        CHECK(sum_of(thrusts_n) == Approx(robot.mass_kg() * 9.80665).epsilon(1e-9));
        double roll_nm = 0, pitch_nm = 0, yaw_nm = 0;
        for (std::size_t k = 0; k < thrusts_n.size(); ++k) {
            const SpaceRotor& rotor = robot.plant.rotors[k];
            roll_nm += (rotor.position_m[1] - at_m[1]) * thrusts_n[k];
            pitch_nm += (rotor.position_m[0] - at_m[0]) * thrusts_n[k];
            yaw_nm += rotor.spin * rotor.drag_torque_m * thrusts_n[k];
        }
        CHECK(roll_nm == Approx(0).margin(1e-9));
        CHECK(pitch_nm == Approx(0).margin(1e-9));
        CHECK(yaw_nm == Approx(0).margin(1e-9));
    }
}

TEST_CASE("a planar robot is shown with its arm about y, and hovers with the commands of its own controller") {
    const Robot planar = read_robot(robot_file("ars_lrm.yaml"));
    const ShownRobot shown = shown_robot(planar);
    CHECK(shown.is_planar);
    REQUIRE(shown.robot.joints() == 1);
    CHECK(shown.robot.plant.links[0].axis == Vector3{0, 1, 0});
    CHECK(shown.robot.mass_kg() == Approx(planar.mass_kg()));
    // A quarter turn points the arm down.
    const ArmPose down = arm_pose(shown.robot, {1.5707963267948966});
    CHECK(down.end_effector_m[0] == Approx(planar.arm.joint_x_m).margin(1e-12));
    CHECK(down.end_effector_m[2] == Approx(planar.arm.joint_z_m - planar.arm.length_m));
    for (const double arm_rad : {0.0, 1.0, -2.0}) {
        const Vector3 at_m = center_of_mass_m(shown.robot, arm_pose(shown.robot, {arm_rad}));
        const std::vector<double> thrusts_n = shown.hover.at(at_m);
        CHECK(sum_of(thrusts_n) == Approx(planar.mass_kg() * 9.80665).epsilon(1e-9));
        double pitch_nm = 0;
        for (std::size_t k = 0; k < thrusts_n.size(); ++k) {
            pitch_nm += (planar.rotors.positions_m[k][0] - at_m[0]) * thrusts_n[k];
        }
        CHECK(pitch_nm == Approx(0).margin(1e-9));
    }
    // The worst pose is that of the facts, and no pose that was looked at is worse.
    const RobotFacts facts = robot_facts(planar);
    const Vector3 worst_m = center_of_mass_m(shown.robot, arm_pose(shown.robot, shown.hover_joints_rad));
    CHECK(shown.hover.at(worst_m)[shown.hover_rotor] / planar.rotors.max_thrust_n ==
          Approx(facts.hover_share).epsilon(1e-9));
}

TEST_CASE("the data of a robot's page has what the page draws, with the robot's numbers") {
    const ShownRobot shown = shown_robot(read_space_robot(robot_file("hexa370_arm3.yaml")));
    const json page = json::parse(robot_page_data(shown, "hexa.yaml", {"odd <b>"}));
    CHECK(page.at("schema") == "downwash/robot-report/v1");
    CHECK(page.at("file") == "hexa.yaml");
    CHECK(page.at("is_planar") == false);
    CHECK(page.at("warnings") == json{"odd <b>"});
    const json& robot = page.at("robot");
    CHECK(robot.at("rotors").size() == 6);
    CHECK(robot.at("rotors")[0].at("spin").get<int>() == shown.robot.plant.rotors[0].spin);
    CHECK(robot.at("multirotor").at("mass_kg").get<double>() == shown.robot.plant.multirotor.mass_kg);
    CHECK(robot.at("links")[2].at("center_of_mass_m") == json(shown.robot.plant.links[2].center_of_mass_m));
    CHECK(page.at("hover").at("middle_n") == json(shown.hover.middle_n));
    CHECK(page.at("facts").at("reach_m").get<double>() == shown.reach_m);
    CHECK(page.at("pose").at("joints_rad") == json(shown.joints_rad));
    const json planar =
        json::parse(robot_page_data(shown_robot(read_robot(robot_file("ars_lrm.yaml"))), "ars_lrm.yaml"));
    CHECK(planar.at("robot").at("rotors")[0].at("spin") == 0);
    CHECK(planar.at("robot").at("multirotor").contains("pitch_inertia_kg_m2"));
    if (has_pages()) {
        CHECK_THAT(robot_page(shown, "hexa.yaml"),
                   Contains("downwash/robot-report/v1") && !Contains("{\"downwash\":\"nothing\"}"));
    }
}

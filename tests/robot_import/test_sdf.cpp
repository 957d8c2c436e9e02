#include <cmath>

#include "model_tests.hpp"

using namespace downwash;
using namespace downwash::test;
using Catch::Contains;

namespace {

const std::filesystem::path sdf_model = DOWNWASH_MODELS "/quad_arm1.sdf";

const std::vector<Eigen::Vector3d>& sdf_hubs_m() {
    static const std::vector<Eigen::Vector3d> hubs{
        {0.18, -0.2, 0.13}, {-0.18, 0.2, 0.13}, {0.18, 0.2, 0.13}, {-0.18, -0.2, 0.13}};
    return hubs;
}

/// In the axes of the model, which the base's are turned from.
HandBody sdf_multirotor() {
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    std::vector<HandBody> bodies{{1.5, {0.02, 0, 0.11}, diagonal(0.02, 0.022, 0.036), turn}};
    for (const Eigen::Vector3d& hub : sdf_hubs_m()) {
        bodies.push_back({0.016, hub, diagonal(1e-6, 2e-5, 2e-5)});
    }
    return joined(bodies);
}

const Eigen::Matrix3d sdf_arm_axes = Eigen::AngleAxisd(1.2, Eigen::Vector3d::UnitY()).toRotationMatrix();
const Eigen::Vector3d sdf_arm_origin(0, 0, 0.02), sdf_joint = sdf_arm_origin + sdf_arm_axes
                                                                                   * Eigen::Vector3d(-0.05, 0, 0);

HandBody sdf_arm() {
    return {0.2, sdf_arm_origin + sdf_arm_axes * Eigen::Vector3d(0.15, 0, 0), diagonal(0.00003, 0.0015, 0.0015),
            sdf_arm_axes};
}

std::string sdf_errors_of(const TextEdits& edits) {
    return errors_of(sdf_model, edits);
}

}  // namespace

TEST_CASE("an SDF with motor models of gz-sim becomes the robot that a hand computes from it, to 1e-9") {
    const ImportedRobot imported = import_robot(sdf_model);
    const SpaceRobot& robot = imported.robot;
    const HandBody body = sdf_multirotor();
    CHECK(robot.name == "quad_arm1");
    CHECK(robot.plant.multirotor.mass_kg == Approx(1.564).epsilon(1e-12));
    CHECK(are_close(eigen(robot.plant.multirotor.inertia_kg_m2), body.inertia_kg_m2));
    REQUIRE(robot.plant.rotors.size() == 4);
    for (std::size_t k = 0; k < 4; ++k) {
        CHECK(are_close(eigen(robot.plant.rotors[k].position_m), sdf_hubs_m()[k] - body.center_m));
        CHECK(robot.plant.rotors[k].spin == (k < 2 ? 1 : -1));
        CHECK(robot.max_thrust_n[k] == Approx(1.1e-5 * 800 * 800).epsilon(1e-12));
    }
    CHECK(robot.rotor_radius_m == 0.1);
    CHECK(robot.plant.time_constant_s == 0.0182);

    REQUIRE(robot.joints() == 1);
    const SpaceLink& link = robot.plant.links[0];
    CHECK(are_close(eigen(link.joint_m), sdf_joint - body.center_m));
    CHECK(are_close(eigen(link.axis), Eigen::Vector3d(0, 1, 0)));
    CHECK(are_close(eigen(link.center_of_mass_m), sdf_arm().center_m - sdf_joint));
    CHECK(are_close(eigen(link.body.inertia_kg_m2), joined({sdf_arm()}).inertia_kg_m2));
    CHECK(link.viscous_friction_nm_s == 0.01);
    CHECK(robot.links[0].max_torque_nm == 4);
    // The end of the tube, where no link stands.
    CHECK(are_close(eigen(robot.plant.end_effector_m), sdf_arm_axes * Eigen::Vector3d(0.35, 0, 0)));

    CHECK(space_robot_facts(robot).reach_m == Approx((sdf_joint - body.center_m).norm() + 0.35).margin(1e-9));
    check_hover(robot, sdf_hubs_m(), {0.016, 0.016, -0.016, -0.016}, joined({body, sdf_arm()}));
    // The box of the base, 0.3 by 0.2, is askew in the axes of the model: a cylinder around it is less than a box.
    const auto& cylinder = std::get<Cylinder>(robot.body[0].shape);
    CHECK(cylinder.radius_m == Approx(std::hypot(0.15, 0.1)).epsilon(1e-9));
    CHECK(cylinder.length_m == Approx(0.1).epsilon(1e-9));
    REQUIRE(imported.warnings.size() == 1);
    CHECK_THAT(imported.warnings[0].message, Contains("link 'base_link' has a box that is askew"));
}

TEST_CASE("an SDF that includes another model has its links, and its rotors from there") {
    const ScratchFolder folder;
    std::filesystem::create_directory(folder / "quad");
    std::filesystem::copy_file(sdf_model, folder / "quad" / "model.sdf");
    write_text(folder / "quad" / "model.config",
               "<model><name>quad</name><sdf version=\"1.9\">model.sdf</sdf></model>");
    write_text(folder / "robot.sdf",
               "<sdf version=\"1.9\"><model name=\"outer\"><include><uri>model://quad</uri></include>"
               "<link name=\"payload\"><inertial><mass>0.1</mass><inertia><ixx>1e-4</ixx><iyy>1e-4</iyy><izz>1e-4</izz>"
               "</inertia></inertial></link><joint name=\"mount\" type=\"fixed\"><parent>quad_arm1::base_link</parent>"
               "<child>payload</child></joint></model></sdf>");
    const SpaceRobot robot = import_robot(folder / "robot.sdf").robot;
    CHECK(robot.mass_kg() == Approx(1.864).epsilon(1e-12));
    CHECK(robot.plant.rotors.size() == 4);
    CHECK(robot.joints() == 1);
}

TEST_CASE("a broken SDF gets a message with its element and a remedy") {
    CHECK_THAT(sdf_errors_of({{"<child>arm_link</child>", "<child>arm</child>"}}), Contains("arm_joint"));
    CHECK_THAT(
        sdf_errors_of(
            {{"<limit><lower>-0.5</lower><upper>1.5</upper><effort>4</effort><velocity>2</velocity></limit>", ""}}),
        Contains("joint 'arm_joint' turns without end (revolute without <limit>)") &&
            Contains("--freeze arm_joint=DEG"));
    CHECK_THAT(sdf_errors_of({{"<effort>4</effort>", ""}}), Contains("joint 'arm_joint' has no torque"));
    CHECK_THAT(sdf_errors_of(
                   {{"<joint name=\"arm_joint\" type=\"revolute\">", "<joint name=\"arm_joint\" type=\"prismatic\">"}}),
               Contains("joint 'arm_joint' is prismatic") && Contains("--freeze arm_joint=M"));
    CHECK_THAT(sdf_errors_of({{"<mass>0.2</mass>", "<mass>0</mass>"}}), Contains("link 'arm_link' has a mass of 0 kg"));
    CHECK_THAT(sdf_errors_of({{"<iyy>0.0015</iyy>", "<iyy>0.05</iyy>"}}),
               Contains("link 'arm_link' has the principal moments") && Contains("at most the sum"));
    CHECK_THAT(sdf_errors_of({{"<linkName>rotor_1</linkName>", "<linkName>prop_1</linkName>"}}), Contains("'prop_1'"));
    CHECK_THAT(sdf_errors_of({{"<link name=\"arm_link\">",
                               "<include><uri>model://nowhere</uri></include><link name=\"arm_link\">"}}),
               Contains("nowhere"));
    CHECK_THAT(sdf_errors_of({{"</model>", ""}}), Contains("not well-formed XML"));
    CHECK_THAT(sdf_errors_of({{"<mass>0.2</mass>", "<mass>${m}</mass>"}}),
               Contains("is a macro of xacro") || Contains("mass"));
}

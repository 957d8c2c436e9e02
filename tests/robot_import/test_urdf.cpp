#include <cmath>
#include <numbers>

#include "downwash/problems/space_problem_reader.hpp"
#include "model_tests.hpp"

using namespace downwash;
using namespace downwash::test;
using Catch::Contains;

namespace {

const std::filesystem::path hexa_model = DOWNWASH_MODELS "/hexa_arm2.urdf";

/// Where rotors are, from the origin of base_link.
std::vector<Eigen::Vector3d> hexa_hubs_m() {
    std::vector<Eigen::Vector3d> hubs;
    for (int k = 0; k < 6; ++k) {
        const double angle = (30 + 60 * k) * std::numbers::pi / 180;
        hubs.emplace_back(0.28 * std::cos(angle), 0.28 * std::sin(angle), 0.06);
    }
    return hubs;
}

HandBody hexa_multirotor() {
    Eigen::Matrix3d base;
    base << 0.031, 0.0004, -0.0002, 0.0004, 0.033, 0.0001, -0.0002, 0.0001, 0.052;
    std::vector<HandBody> bodies{{2.4, {0.01, 0, 0.02}, base},
                                 {0.5, {-0.02, 0, -0.05}, diagonal(0.0013, 0.0004, 0.0014)}};  // x and y change places
    for (const Eigen::Vector3d& hub : hexa_hubs_m()) {
        bodies.push_back({0.01, hub, diagonal(1e-6, 4e-5, 4e-5)});
    }
    return joined(bodies);
}

// At zero the arm hangs: x of the upper link and y of the forearm point down.
HandBody upper() {
    return {0.2, {0.03, 0, -0.2}, diagonal(0.00068, 0.0007, 0.00004)};
}
HandBody forearm_and_gripper() {
    return joined({{0.12, {0.03, 0, -0.4}, diagonal(0.00029, 0.0003, 0.00002)},
                   {0.05, {0.03, 0, -0.5}, diagonal(0.00001, 0.00001, 0.00001)}});
}

SpaceRobot read_again(const std::string& yaml) {
    const ScratchFolder folder;
    write_text(folder / "robot.yaml", yaml);
    return read_space_robot(folder / "robot.yaml");
}

}  // namespace

TEST_CASE("a URDF becomes the robot that a hand computes from it, to 1e-9") {
    const ImportedRobot imported = import_robot(hexa_model);
    const SpaceRobot& robot = imported.robot;
    CHECK(robot.name == "hexa_arm2");
    const HandBody body = hexa_multirotor();
    CHECK(robot.plant.multirotor.mass_kg == Approx(2.96).epsilon(1e-12));
    CHECK(robot.mass_kg() == Approx(2.96 + 0.2 + 0.17).epsilon(1e-12));
    CHECK(are_close(eigen(robot.plant.multirotor.inertia_kg_m2), body.inertia_kg_m2));

    const std::vector<Eigen::Vector3d> hubs = hexa_hubs_m();
    REQUIRE(robot.plant.rotors.size() == 6);
    for (std::size_t k = 0; k < 6; ++k) {
        const SpaceRotor& rotor = robot.plant.rotors[k];
        CHECK(are_close(eigen(rotor.position_m), hubs[k] - body.center_m));
        CHECK(rotor.spin == (k % 2 == 0 ? 1 : -1));
        CHECK(rotor.drag_torque_m == 0.016);
        CHECK(robot.max_thrust_n[k] == Approx(1.2e-5 * 900 * 900).epsilon(1e-12));
    }
    CHECK(robot.rotor_radius_m == 0.127);
    CHECK(robot.plant.time_constant_s == 0.025);
    CHECK(robot.plant.thrust_coefficient_n_s2 == 1.2e-5);

    REQUIRE(robot.joints() == 2);
    const Eigen::Vector3d shoulder(0.03, 0, -0.1), elbow(0.03, 0, -0.32);
    const SpaceLink& first = robot.plant.links[0];
    CHECK(are_close(eigen(first.joint_m), shoulder - body.center_m));
    CHECK(are_close(eigen(first.axis), Eigen::Vector3d(0, 1, 0)));
    CHECK(are_close(eigen(first.center_of_mass_m), upper().center_m - shoulder));
    CHECK(are_close(eigen(first.body.inertia_kg_m2), upper().inertia_kg_m2));
    CHECK(first.viscous_friction_nm_s == 0.02);
    CHECK(first.coulomb_friction_nm == 0.03);
    const SpaceLink& second = robot.plant.links[1];
    CHECK(are_close(eigen(second.joint_m), elbow - shoulder));
    CHECK(are_close(eigen(second.axis), Eigen::Vector3d(0, -1, 0)));
    CHECK(second.body.mass_kg == Approx(0.17).epsilon(1e-12));
    CHECK(are_close(eigen(second.center_of_mass_m), forearm_and_gripper().center_m - elbow));
    CHECK(are_close(eigen(second.body.inertia_kg_m2), forearm_and_gripper().inertia_kg_m2));
    CHECK(robot.links[0].lower_limit_rad == -1.6);
    CHECK(robot.links[1].max_torque_nm == 1.5);
    CHECK(are_close(eigen(robot.plant.end_effector_m), Eigen::Vector3d(0, 0, -0.24)));
    CHECK(are_close(eigen(robot.tool_direction), Eigen::Vector3d(0, 0, -1)));
    CHECK(imported.warnings.empty());
}

TEST_CASE("reach and hover thrust of an imported URDF are those of a hand calculation, to 1e-9") {
    const SpaceRobot robot = import_robot(hexa_model).robot;
    const HandBody body = hexa_multirotor();
    // The straight arm points away from the centre of mass, which the shoulder's limits allow.
    const double reach_m = (Eigen::Vector3d(0.03, 0, -0.1) - body.center_m).norm() + 0.22 + 0.24;
    CHECK(space_robot_facts(robot).reach_m == Approx(reach_m).margin(1e-9));

    check_hover(robot, hexa_hubs_m(), {0.016, -0.016, 0.016, -0.016, 0.016, -0.016},
                joined({body, upper(), forearm_and_gripper()}));
}

TEST_CASE("the written file is a sound robot, the same as the imported one, and says where its numbers come from") {
    const ImportedRobot imported = import_robot(hexa_model);
    const SpaceRobot again = read_again(imported.yaml);
    CHECK(are_close(eigen(again.plant.multirotor.inertia_kg_m2), eigen(imported.robot.plant.multirotor.inertia_kg_m2),
                    1e-12));
    CHECK(are_close(eigen(again.plant.links[1].center_of_mass_m), eigen(imported.robot.plant.links[1].center_of_mass_m),
                    1e-12));
    CHECK(again.links[0].upper_limit_rad == Approx(1.6).epsilon(1e-11));
    CHECK(again.body.size() == 3);  // base, battery and the discs
    CHECK(again.links[0].body.size() == 1);
    CHECK_THAT(imported.yaml, Contains("# Imported from hexa_arm2.urdf (URDF)") &&
                                  Contains("# base_link 2.4 kg, battery 0.5 kg, rotor_0 0.01 kg") &&
                                  Contains("motorConstant 1.2e-05 N s2 at 900 rad/s") &&
                                  Contains("assumed: momentum theory") &&
                                  Contains("# joint shoulder, which turns at") && Contains("the origin of tool0"));
}

TEST_CASE("bodies stand where the shapes of a URDF do") {
    const SpaceRobot robot = import_robot(hexa_model).robot;
    const Eigen::Vector3d center = hexa_multirotor().center_m;
    CHECK(are_close(eigen(robot.body[0].center_m), -center));
    const auto& battery = std::get<Box>(robot.body[1].shape);
    CHECK(are_close(eigen(battery.size_m), Eigen::Vector3d(0.06, 0.16, 0.05)));  // turned by a quarter
    CHECK(are_close(eigen(robot.body[1].center_m), Eigen::Vector3d(-0.02, 0, -0.05) - center));
    const auto& discs = std::get<Cylinder>(robot.body[2].shape);
    CHECK(discs.radius_m >= 0.28 + 0.127 - 0.02);
    const auto& upper_link = std::get<Cylinder>(robot.links[0].body[0].shape);
    CHECK(are_close(eigen(upper_link.axis).cwiseAbs(), Eigen::Vector3d(0, 0, 1)));
    CHECK(are_close(eigen(robot.links[0].body[0].center_m), Eigen::Vector3d(0, 0, -0.11)));
}

TEST_CASE("a frozen joint makes its link part of what it hangs on") {
    ImportSettings settings;
    settings.frozen = {{"shoulder", 30}};
    const SpaceRobot robot = import_robot(hexa_model, settings).robot;
    REQUIRE(robot.joints() == 1);
    // The upper link, turned about +y by 30 degrees from hanging: it swings backward.
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(std::numbers::pi / 6, Eigen::Vector3d::UnitY()).toRotationMatrix();
    const Eigen::Vector3d shoulder(0.03, 0, -0.1);
    HandBody hanging = upper();
    hanging.center_m = shoulder + turn * (hanging.center_m - shoulder);
    hanging.axes = turn;
    const HandBody body = joined({hexa_multirotor(), hanging});
    CHECK(robot.plant.multirotor.mass_kg == Approx(3.16).epsilon(1e-12));
    CHECK(are_close(eigen(robot.plant.multirotor.inertia_kg_m2), body.inertia_kg_m2));
    CHECK(
        are_close(eigen(robot.plant.links[0].joint_m), shoulder + turn * Eigen::Vector3d(0, 0, -0.22) - body.center_m));
    CHECK(are_close(eigen(robot.plant.links[0].axis), Eigen::Vector3d(0, -1, 0)));
}

TEST_CASE("of two arms the one that is chosen moves, the other is held at zero") {
    const ScratchFolder folder;
    const std::string two_arms =
        edited(text_of(hexa_model), {{"<joint name=\"battery_joint\" type=\"fixed\">",
                                      "<joint name=\"battery_joint\" type=\"revolute\"><limit lower=\"-1\" upper=\"1\" "
                                      "effort=\"1\" velocity=\"1\"/>"}});
    write_text(folder / "robot.urdf", two_arms);
    ImportSettings settings;
    settings.arm_end = "tool0";
    const ImportedRobot imported = import_robot(folder / "robot.urdf", settings);
    CHECK(imported.robot.joints() == 2);
    CHECK(are_close(eigen(imported.robot.plant.multirotor.inertia_kg_m2), hexa_multirotor().inertia_kg_m2));
    CHECK_THAT(imported.yaml, Contains("# Held: joint battery_joint at 0 deg"));
}

TEST_CASE("a base with z down is turned") {
    const ScratchFolder folder;
    // The same vehicle below a base with x forward and z down.
    std::string text =
        edited(text_of(hexa_model), {{"<link name=\"tool0\"/>",
                                      "<link name=\"tool0\"/><link name=\"ned\"/><joint name=\"ned_joint\" "
                                      "type=\"fixed\"><origin rpy=\"3.141592653589793 0 0\"/><parent "
                                      "link=\"ned\"/><child link=\"base_link\"/></joint>"}});
    write_text(folder / "robot.urdf", text);
    CHECK_THROWS_WITH(import_robot(folder / "robot.urdf"), Contains("pushes downwards") && Contains("--up"));
    ImportSettings settings;
    settings.up = "-z";
    const SpaceRobot robot = import_robot(folder / "robot.urdf", settings).robot;
    const HandBody body = hexa_multirotor();
    CHECK(are_close(eigen(robot.plant.multirotor.inertia_kg_m2), body.inertia_kg_m2));
    CHECK(are_close(eigen(robot.plant.rotors[0].position_m), hexa_hubs_m()[0] - body.center_m));
    CHECK(are_close(eigen(robot.plant.links[1].axis), Eigen::Vector3d(0, -1, 0)));
}

TEST_CASE("rotors that are only named get the numbers that are given, and the file marks them") {
    const ScratchFolder folder;
    const std::string text = edited_all(text_of(hexa_model), "librotors_gazebo_motor_model.so", "libother.so");
    write_text(folder / "robot.urdf", text);
    ImportSettings settings;
    settings.rotors = "rotor_[0-9]";
    // What lacks is asked for at once, each number by its option.
    CHECK_THROWS_WITH(
        import_robot(folder / "robot.urdf", settings),
        Contains("--max-thrust-n") && Contains("--torque-ratio-m") && Contains("--rotor-lag-s") && Contains("--spin"));
    settings.max_thrust_n = 9.72;
    settings.torque_ratio_m = 0.016;
    settings.time_constant_s = 0.025;
    settings.spins = {1, -1, 1, -1, 1, -1};
    const ImportedRobot imported = import_robot(folder / "robot.urdf", settings);
    CHECK(imported.robot.max_thrust_n[3] == 9.72);
    CHECK(imported.robot.rotor_radius_m == 0.127);
    CHECK(are_close(eigen(imported.robot.plant.rotors[1].position_m), hexa_hubs_m()[1] - hexa_multirotor().center_m));
    CHECK_THAT(imported.yaml, Contains("max_thrust_n: 9.72  # given by --max-thrust-n") &&
                                  Contains("# given by --rotor-lag-s") && Contains("# given by --spin") &&
                                  Contains("from the shapes of rotor_0"));
    CHECK_NOTHROW(read_again(imported.yaml));
}

TEST_CASE("ArduPilot's plug-in and the lift of blades become rotors") {
    const ScratchFolder folder;
    std::string plugins = "<gazebo><plugin name=\"a\" filename=\"libArduPilotPlugin.so\">";
    for (int k = 0; k < 6; ++k) {
        const std::string rotor = "rotor_" + std::to_string(k);
        plugins += "<control channel=\"" + std::to_string(5 - k) + "\"><type>VELOCITY</type><jointName>hexa::" + rotor +
                   "_joint</jointName><multiplier>" + (k % 2 == 0 ? "838" : "-838") + "</multiplier></control>";
    }
    plugins += "</plugin>";
    for (int blade = 0; blade < 12; ++blade) {
        plugins += "<plugin name=\"b" + std::to_string(blade) +
                   "\" filename=\"libLiftDragPlugin.so\"><a0>0.3</a0><cla>4.25</cla><cda>0.1</cda><area>0.002</area>"
                   "<air_density>1.2041</air_density><cp>" +
                   (blade % 2 == 0 ? "0.084 0 0" : "-0.084 0 0") + "</cp><link_name>hexa::rotor_" +
                   std::to_string(blade / 2) + "</link_name></plugin>";
    }
    write_text(folder / "robot.urdf",
               edited(edited_all(text_of(hexa_model), "librotors_gazebo_motor_model.so", "libother.so"),
                      {{"</robot>", plugins + "</gazebo></robot>"}}));
    ImportSettings settings;
    settings.time_constant_s = 0.03;
    const ImportedRobot imported = import_robot(folder / "robot.urdf", settings);
    const SpaceRobot& robot = imported.robot;
    REQUIRE(robot.plant.rotors.size() == 6);
    // Two blades: 1/2 rho A v^2 cl each, at v = 838 rad/s * 0.084 m and cl = 4.25 * 0.3.
    const double thrust_n = 2 * 0.5 * 1.2041 * 0.002 * std::pow(838 * 0.084, 2) * 4.25 * 0.3;
    CHECK(robot.max_thrust_n[0] == Approx(thrust_n).epsilon(1e-12));
    CHECK(robot.plant.rotors[0].drag_torque_m == Approx(0.1 * 0.084 / 4.25).epsilon(1e-12));
    // Channels number the rotors: here backwards.
    CHECK(are_close(eigen(robot.plant.rotors[0].position_m), hexa_hubs_m()[5] - hexa_multirotor().center_m));
    CHECK(robot.plant.rotors[0].spin == -1);
}

TEST_CASE("a joint that mimics a frozen one is held where that puts it") {
    const ScratchFolder folder;
    write_text(folder / "robot.urdf",
               edited(text_of(hexa_model), {{"<limit lower=\"-2\" upper=\"2\" effort=\"1.5\" velocity=\"3\"/>",
                                             "<limit lower=\"-2\" upper=\"2\" effort=\"1.5\" velocity=\"3\"/><mimic "
                                             "joint=\"shoulder\" multiplier=\"-2\" offset=\"0.1\"/>"}}));
    ImportSettings settings;
    settings.frozen = {{"shoulder", 20}};
    const ImportedRobot imported = import_robot(folder / "robot.urdf", settings);
    CHECK(imported.robot.joints() == 0);
    CHECK_THAT(imported.yaml, Contains("joint elbow at -34.2704 deg"));  // 0.1 rad - 2 * 20 deg
}

TEST_CASE("the inertia of a hub for a whole vehicle, and one too large for its shapes, are warnings") {
    const ScratchFolder folder;
    const auto warnings_with = [&](const TextEdits& edits) {
        write_text(folder / "robot.urdf", edited(text_of(hexa_model), edits));
        std::string all;
        for (const LocatedError& warning : import_robot(folder / "robot.urdf").warnings) {
            all += to_text(warning) + "\n";
        }
        return all;
    };
    CHECK_THAT(
        warnings_with({{"ixx=\"0.031\" ixy=\"0.0004\" ixz=\"-0.0002\" iyy=\"0.033\" iyz=\"0.0001\" izz=\"0.052\"",
                        "ixx=\"0.0003\" ixy=\"0\" ixz=\"0\" iyy=\"0.0003\" iyz=\"0\" izz=\"0.0005\""}}),
        Contains("robot.urdf:5:5") && Contains("is it that of the hub alone?"));
    CHECK_THAT(warnings_with({{"ixx=\"0.0004\" ixy=\"0\" ixz=\"0\" iyy=\"0.0013\" iyz=\"0\" izz=\"0.0014\"",
                               "ixx=\"0.02\" ixy=\"0\" ixz=\"0\" iyy=\"0.02\" iyz=\"0\" izz=\"0.02\""}}),
               Contains("link 'battery' has more inertia than its whole mass at the farthest point"));
}

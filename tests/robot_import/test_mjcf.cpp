#include "model_tests.hpp"

using namespace downwash;
using namespace downwash::test;
using Catch::Contains;

namespace {

const std::filesystem::path mjcf_model = DOWNWASH_MODELS "/quad_arm1.xml";

const std::vector<Eigen::Vector3d>& mjcf_hubs_m() {
    static const std::vector<Eigen::Vector3d> hubs{
        {-0.14, -0.18, 0.05}, {-0.14, 0.18, 0.05}, {0.14, 0.18, 0.05}, {0.14, -0.18, 0.05}};
    return hubs;
}

HandBody mjcf_multirotor() {
    Eigen::Matrix3d base;
    base << 0.03, 0.001, 0, 0.001, 0.035, -0.0005, 0, -0.0005, 0.05;
    return joined({{1.3, {0.01, 0, 0.02}, base},
                   {0.4, {-0.03, 0, -0.04}, diagonal(0.0009, 0.0003, 0.001)}});  // turned by a quarter
}

const Eigen::Vector3d mjcf_joint(0.05, 0, -0.06);

HandBody mjcf_arm() {
    return {0.15, {0.05, 0, -0.17}, diagonal(0.0008, 0.0008, 0.00002)};
}

/// An MJCF has no radius of rotors.
ImportSettings with_radius() {
    ImportSettings settings;
    settings.rotor_radius_m = 0.1;
    return settings;
}

std::string mjcf_errors_of(const TextEdits& edits, const ImportSettings& settings = with_radius()) {
    return errors_of(mjcf_model, edits, settings);
}

}  // namespace

TEST_CASE("an MJCF becomes the robot that a hand computes from it, to 1e-9") {
    const ImportedRobot imported = import_robot(mjcf_model, with_radius());
    CHECK(imported.warnings.empty());
    const SpaceRobot& robot = imported.robot;
    const HandBody body = mjcf_multirotor();
    CHECK(robot.name == "quad_arm1");
    CHECK(robot.plant.multirotor.mass_kg == Approx(1.7).epsilon(1e-12));
    CHECK(are_close(eigen(robot.plant.multirotor.inertia_kg_m2), body.inertia_kg_m2));
    REQUIRE(robot.plant.rotors.size() == 4);
    for (std::size_t k = 0; k < 4; ++k) {
        CHECK(are_close(eigen(robot.plant.rotors[k].position_m), mjcf_hubs_m()[k] - body.center_m));
        CHECK(robot.plant.rotors[k].spin == (k % 2 == 0 ? 1 : -1));
        CHECK(robot.plant.rotors[k].drag_torque_m == Approx(0.017).epsilon(1e-12));
        CHECK(robot.max_thrust_n[k] == 11);
    }
    CHECK(robot.plant.time_constant_s == 0.03);

    REQUIRE(robot.joints() == 1);
    const SpaceLink& link = robot.plant.links[0];
    CHECK(are_close(eigen(link.joint_m), mjcf_joint - body.center_m));
    CHECK(are_close(eigen(link.axis), Eigen::Vector3d(0, 1, 0)));
    CHECK(are_close(eigen(link.center_of_mass_m), mjcf_arm().center_m - mjcf_joint));
    CHECK(are_close(eigen(link.body.inertia_kg_m2), mjcf_arm().inertia_kg_m2));
    CHECK(link.viscous_friction_nm_s == 0.03);
    CHECK(link.coulomb_friction_nm == 0.04);
    CHECK(robot.links[0].lower_limit_rad == Approx(-1.0471975511965976).epsilon(1e-12));
    CHECK(robot.links[0].max_torque_nm == 3);
    CHECK(are_close(eigen(robot.plant.end_effector_m), Eigen::Vector3d(0, 0, -0.25)));  // the site "tool"

    CHECK(space_robot_facts(robot).reach_m == Approx((mjcf_joint - body.center_m).norm() + 0.25).margin(1e-9));
    check_hover(robot, mjcf_hubs_m(), {0.017, -0.017, 0.017, -0.017}, joined({body, mjcf_arm()}));
    // Hull, battery and rotor discs; the floor of the world is none of it.
    CHECK(robot.body.size() == 3);
    CHECK(std::holds_alternative<Capsule>(robot.links[0].body[0].shape));
}

TEST_CASE("a broken MJCF gets a message with its element and a remedy") {
    CHECK_THAT(mjcf_errors_of({}, {}),
               Contains("robot.xml:28:5: rotors 'thrust1', 'thrust2', 'thrust3', 'thrust4' lack a radius") &&
                   Contains("--rotor-radius-m"));
    CHECK_THAT(mjcf_errors_of({{"limited=\"true\" range=\"-60 80\" ", ""}}),
               Contains("joint 'shoulder' turns without end (hinge without range)"));
    CHECK_THAT(mjcf_errors_of({{"type=\"hinge\" axis", "type=\"slide\" axis"}}),
               Contains("joint 'shoulder' is slide") && Contains("--freeze shoulder=M"));
    CHECK_THAT(mjcf_errors_of({{" forcelimited=\"true\" forcerange=\"-3 3\"", ""}}),
               Contains("joint 'shoulder' has no torque"));
    CHECK_THAT(mjcf_errors_of({{"mass=\"0.15\"", "mass=\"0\""}}),
               Contains("robot.xml:18:1: MuJoCo does not compile this model") && Contains("arm"));
    CHECK_THAT(mjcf_errors_of({{"diaginertia=\"0.0003 0.0009 0.001\"", "diaginertia=\"0.0003 0.0009 0.01\""}}),
               Contains("MuJoCo does not compile this model") && Contains("nertia"));
    CHECK_THAT(mjcf_errors_of({{"<geom name=\"cells\"", "<geom type=\"mesh\" mesh=\"m\"/><geom name=\"cells\""}}),
               Contains("MuJoCo does not compile this model"));
    CHECK_THAT(
        mjcf_errors_of({{"<freejoint/>", ""}, {"<body name=\"quad\"", "<body name=\"post\"/><body name=\"quad\""}}),
        Contains("expected <freejoint/>"));
    CHECK_THAT(mjcf_errors_of({{"</worldbody>", ""}}), Contains("not well-formed XML"));
}

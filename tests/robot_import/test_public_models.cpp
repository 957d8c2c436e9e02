#include <cmath>
#include <numbers>

#include "model_tests.hpp"

// Models that others publish, held against their published numbers by hand. The files here were written anew in the
// same form; each names its source.

using namespace downwash;
using namespace downwash::test;
using Catch::Contains;

namespace {

std::filesystem::path public_model(const char* file) {
    return std::filesystem::path(DOWNWASH_MODELS "/public") / file;
}

std::string warnings_of(const ImportedRobot& imported) {
    std::string all;
    for (const LocatedError& warning : imported.warnings) {
        all += warning.message + "\n";
    }
    return all;
}

/// The rotors of a robot against what the model says, all alike but for their places and spins.
struct HandRotors {
    std::vector<Eigen::Vector3d> hubs_m;  ///< from the origin of the hand calculation
    std::vector<int> spins;
    double max_thrust_n, torque_ratio_m, time_constant_s, radius_m;

    [[nodiscard]] std::vector<double> spin_torques_m() const {
        std::vector<double> torques;
        for (const int spin : spins) {
            torques.push_back(spin * torque_ratio_m);
        }
        return torques;
    }
};

void check_rotors(const SpaceRobot& robot, const HandRotors& rotors, const HandBody& body) {
    REQUIRE(robot.plant.rotors.size() == rotors.hubs_m.size());
    for (std::size_t k = 0; k < rotors.hubs_m.size(); ++k) {
        CHECK(are_close(eigen(robot.plant.rotors[k].position_m), rotors.hubs_m[k] - body.center_m));
        CHECK(are_close(eigen(robot.plant.rotors[k].axis), Eigen::Vector3d(0, 0, 1)));
        CHECK(robot.plant.rotors[k].spin == rotors.spins[k]);
        CHECK(robot.plant.rotors[k].drag_torque_m == Approx(rotors.torque_ratio_m).epsilon(1e-12));
        CHECK(robot.max_thrust_n[k] == Approx(rotors.max_thrust_n).epsilon(1e-12));
        CHECK(robot.min_thrust_n[k] == 0);
    }
    CHECK(robot.plant.time_constant_s == rotors.time_constant_s);
    CHECK(robot.rotor_radius_m == Approx(rotors.radius_m).epsilon(1e-12));
}

void check_multirotor(const SpaceRobot& robot, const HandBody& body) {
    CHECK(robot.plant.multirotor.mass_kg == Approx(body.mass_kg).epsilon(1e-12));
    CHECK(are_close(eigen(robot.plant.multirotor.inertia_kg_m2), body.inertia_kg_m2));
}

// PX4's X500.

HandRotors x500_rotors() {
    return {{{0.174, -0.174, 0.06}, {-0.174, 0.174, 0.06}, {0.174, 0.174, 0.06}, {-0.174, -0.174, 0.06}},
            {1, 1, -1, -1},
            8.54858e-06 * 1000 * 1000,
            0.016,
            0.025,
            0.2792307692307692 / 2};
}

std::vector<HandBody> x500_bodies() {
    std::vector<HandBody> bodies{{2.0, {0, 0, 0}, diagonal(0.02166666666666667, 0.02166666666666667, 0.04)}};
    for (const Eigen::Vector3d& hub : x500_rotors().hubs_m) {
        bodies.push_back({0.016076923076923075, hub,
                          diagonal(3.8464910483993325e-07, 2.6115851691700804e-05, 2.649858234714004e-05)});
    }
    return bodies;
}

// RotorS' Hummingbird.

HandRotors hummingbird_rotors() {
    return {{{0.17, 0, 0.01}, {0, 0.17, 0.01}, {-0.17, 0, 0.01}, {0, -0.17, 0.01}},
            {-1, 1, -1, 1},
            8.54858e-06 * 838 * 838,
            0.016,
            0.025,
            0.1};
}

std::vector<HandBody> hummingbird_bodies() {
    std::vector<HandBody> bodies{{0.68, {0, 0, 0}, diagonal(0.007, 0.007, 0.012)}};
    // A blade of 0.1 by 0.015 by 0.003 m with ten times its mass, which the simulation slows down as much.
    const double twelfth = 0.0833333 * 0.09;
    for (const Eigen::Vector3d& hub : hummingbird_rotors().hubs_m) {
        bodies.push_back({0.009, hub,
                          diagonal(twelfth * (0.015 * 0.015 + 0.003 * 0.003), twelfth * (0.1 * 0.1 + 0.003 * 0.003),
                                   twelfth * (0.1 * 0.1 + 0.015 * 0.015))});
    }
    return bodies;
}

}  // namespace

TEST_CASE("PX4's X500, which merges its base and has its motors elsewhere, is the robot of its published numbers") {
    const ImportedRobot imported = import_robot(public_model("x500/model.sdf"));
    const SpaceRobot& robot = imported.robot;
    const HandBody body = joined(x500_bodies());
    CHECK(robot.name == "x500");
    CHECK(body.mass_kg == Approx(2.0643076923076924));
    check_multirotor(robot, body);
    check_rotors(robot, x500_rotors(), body);
    check_hover(robot, x500_rotors().hubs_m, x500_rotors().spin_torques_m(), body);
    CHECK(robot.joints() == 0);
    // Its thrust over weight: four times 8.54858 N over 2.0643 kg.
    CHECK(space_robot_facts(robot).thrust_to_weight ==
          Approx(4 * 8.54858 / (2.0643076923076924 * 9.80665)).margin(1e-9));
    // Five collision boxes and the discs. The legs are askew: what is around them is thinner than the boxes there.
    CHECK(robot.body.size() == 6);
    CHECK_THAT(warnings_of(imported), Contains("has a box that is askew: taken is the c"));
}

TEST_CASE("PX4's X500 with its gimbal is a vehicle with an arm of one joint once the endless yaw is held") {
    const std::filesystem::path file = public_model("x500_gimbal/model.sdf");
    ImportSettings settings;
    settings.skips_meshes = true;
    CHECK_THROWS_WITH(import_robot(file, settings), Contains("joint 'cgo3_vertical_arm_joint' turns without end") &&
                                                        Contains("--freeze cgo3_vertical_arm_joint=DEG"));
    settings.frozen = {{"cgo3_vertical_arm_joint", 0}};
    const ImportedRobot imported = import_robot(file, settings);
    const SpaceRobot& robot = imported.robot;

    // The X500 stands 0.24 m, the gimbal 0.26 m above the origin; the latter looks back, by 3.14 rad.
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(3.14, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    const Eigen::Vector3d mount(0, 0, 0.26 - 0.24);
    const auto part = [&](double x, double z) {
        return HandBody{0.001, mount + turn * Eigen::Vector3d(x, 0, z), diagonal(0.001, 0.001, 0.001), turn};
    };
    std::vector<HandBody> bodies = x500_bodies();
    bodies.insert(bodies.end(), {part(-0.02552, -0.08136), part(0, -0.1283), part(-0.0213, -0.162)});
    const HandBody body = joined(bodies), camera = part(-0.0412, -0.162);
    check_multirotor(robot, body);
    check_rotors(robot, x500_rotors(), body);
    REQUIRE(robot.joints() == 1);
    const SpaceLink& link = robot.plant.links[0];
    CHECK(link.body.mass_kg == 0.001);
    CHECK(are_close(eigen(link.joint_m), mount - body.center_m));
    CHECK(are_close(eigen(link.axis), turn * Eigen::Vector3d(0, -1, 0)));
    CHECK(are_close(eigen(link.center_of_mass_m), camera.center_m - mount));
    CHECK(are_close(eigen(link.body.inertia_kg_m2), joined({camera}).inertia_kg_m2));
    CHECK(link.viscous_friction_nm_s == 0.1);
    CHECK(robot.links[0].lower_limit_rad == Approx(-2.35619).epsilon(1e-12));
    CHECK(robot.links[0].upper_limit_rad == Approx(0.7854).epsilon(1e-12));
    CHECK(robot.links[0].max_torque_nm == 100);
    check_hover(robot, x500_rotors().hubs_m, x500_rotors().spin_torques_m(), joined({body, camera}));
    // Nothing of the camera has a shape that is there: it ends at its centre of mass. The farthest that this gets from
    // the multirotor's, over the joint's range.
    double reach_m = 0;
    for (int i = 0; i <= 100'000; ++i) {
        const double angle = -2.35619 + (0.7854 + 2.35619) * i / 100'000;
        const Eigen::Matrix3d turned = Eigen::AngleAxisd(angle, turn * Eigen::Vector3d(0, -1, 0)).toRotationMatrix();
        reach_m = std::max(reach_m, (mount - body.center_m + turned * (camera.center_m - mount)).norm());
    }
    CHECK(space_robot_facts(robot).reach_m == Approx(reach_m).margin(1e-9));
}

TEST_CASE(
    "ArduPilot's Iris, with blades for motors and a joint that cannot move, is the robot of its published numbers") {
    ImportSettings settings;
    CHECK_THROWS_WITH(import_robot(public_model("iris_with_ardupilot/model.sdf")), Contains("--rotor-lag-s S"));
    settings.time_constant_s = 0.02;
    const ImportedRobot imported = import_robot(public_model("iris_with_ardupilot/model.sdf"), settings);
    const SpaceRobot& robot = imported.robot;
    // Two blades of 0.002 m2 at 0.084 m and 838 rad/s, with a lift of 4.25 * 0.3 and a drag of 0.1 * 0.3.
    const double speed = 838 * 0.084, lift_n = 2 * 0.5 * 1.2041 * 0.002 * speed * speed * 4.25 * 0.3;
    const HandRotors rotors{{{0.13, -0.22, 0.023}, {-0.13, 0.2, 0.023}, {0.13, 0.22, 0.023}, {-0.13, -0.2, 0.023}},
                            {1, 1, -1, -1},
                            lift_n,
                            0.1 * 0.084 / 4.25,
                            0.02,
                            0.1};
    std::vector<HandBody> bodies{{1.5, {0, 0, 0}, diagonal(0.008, 0.015, 0.017)},
                                 {0.15, {0, 0, 0}, diagonal(0.00001, 0.00002, 0.00002)}};
    for (const Eigen::Vector3d& hub : rotors.hubs_m) {
        bodies.push_back({0.025, hub, diagonal(9.75e-06, 0.000166704, 0.000167604)});
    }
    const HandBody body = joined(bodies);
    CHECK(body.mass_kg == Approx(1.75));
    check_multirotor(robot, body);
    check_rotors(robot, rotors, body);
    check_hover(robot, rotors.hubs_m, rotors.spin_torques_m(), body);
    CHECK_THAT(imported.yaml, Contains("# Held: joint iris_with_standoffs::imu_joint at 0 deg"));
}

TEST_CASE("RotorS' Hummingbird is the robot of its published numbers") {
    const ImportedRobot imported = import_robot(public_model("hummingbird.urdf"));
    const HandBody body = joined(hummingbird_bodies());
    CHECK(imported.robot.mass_kg() == Approx(0.716).epsilon(1e-12));
    check_multirotor(imported.robot, body);
    check_rotors(imported.robot, hummingbird_rotors(), body);
    check_hover(imported.robot, hummingbird_rotors().hubs_m, hummingbird_rotors().spin_torques_m(), body);
    // Symmetric: each rotor carries a quarter.
    CHECK(space_robot_facts(imported.robot).hover_share ==
          Approx(0.716 * 9.80665 / 4 / (8.54858e-06 * 838 * 838)).margin(1e-9));
}

TEST_CASE("RotorS' Firefly is rejected, since no body has its published inertia") {
    // 0.0347563 + 0.0458929 < 0.0977
    CHECK_THROWS_WITH(import_robot(public_model("firefly.urdf")),
                      Contains("link 'base_link_inertia' has the principal moments 0.03476, 0.04589 and 0.0977 kg m2, "
                               "which no body has") &&
                          Contains("at most the sum of the others, 0.08065"));
}

TEST_CASE("an aerial manipulator of RotorS' Hummingbird and LARICS' arm is the robot of their published numbers") {
    const std::filesystem::path file = public_model("hummingbird_wp3rx.urdf");
    ImportSettings settings;
    settings.tool = "end_effector_base";
    CHECK_THROWS_WITH(import_robot(file, settings), Contains("link 'link3': the mesh") && Contains("--skip-meshes"));
    settings.skips_meshes = true;
    // The published torques of 1e7 Nm say nothing; a user has to.
    CHECK_THROWS_WITH(import_robot(file, settings),
                      Contains("joint 'joint1': arm.links[0].max_torque_nm") && Contains("from 1e-06 to 100000"));
    const ScratchFolder folder;
    write_text(folder / "robot.urdf", edited_all(text_of(file), "effort=\"10000000\"", "effort=\"2\""));
    const ImportedRobot imported = import_robot(folder / "robot.urdf", settings);
    const SpaceRobot& robot = imported.robot;

    // A chain of tubes of 3 cm radius, 30 g for 136.5 mm, that hangs straight at zero.
    constexpr double a2 = 0.1365, a3 = 0.075511, a4 = 0.072489, d5 = 0.04526, radius = 0.03;
    const auto tube = [](double top, double length) {
        const double mass = 0.03 * length / a2, across = mass / 12 * (3 * radius * radius + length * length);
        return HandBody{mass, {0, 0, top - length / 2}, diagonal(across, across, mass * radius * radius / 2)};
    };
    std::vector<HandBody> bodies = hummingbird_bodies();
    bodies.push_back(tube(-0.06, a2));
    const HandBody body = joined(bodies);
    const double first = -0.06 - a2, second = first - a3, third = second - a4, tip = third - d5;
    const HandBody end{0.00001, {0, 0, tip}, diagonal(1e-5, 1e-5, 1e-5)};
    const std::vector<HandBody> arm{tube(first, a3), tube(second, a4), joined({tube(third, d5), end})};
    const std::vector<double> joints{first, second, third};
    check_multirotor(robot, body);
    check_rotors(robot, hummingbird_rotors(), body);
    REQUIRE(robot.joints() == 3);
    for (std::size_t i = 0; i < 3; ++i) {
        const SpaceLink& link = robot.plant.links[i];
        const double before = i == 0 ? body.center_m.z() : joints[i - 1];
        CHECK(link.body.mass_kg == Approx(arm[i].mass_kg).epsilon(1e-12));
        CHECK(are_close(eigen(link.joint_m), Eigen::Vector3d(0, 0, joints[i] - before)));
        CHECK(are_close(eigen(link.axis), Eigen::Vector3d(0, 1, 0)));
        CHECK(are_close(eigen(link.center_of_mass_m), arm[i].center_m - Eigen::Vector3d(0, 0, joints[i])));
        CHECK(are_close(eigen(link.body.inertia_kg_m2), arm[i].inertia_kg_m2));
    }
    CHECK(robot.links[2].upper_limit_rad == Approx(2.3).epsilon(1e-12));
    CHECK(are_close(eigen(robot.plant.end_effector_m), Eigen::Vector3d(0, 0, -d5)));
    // Straight down it reaches farthest, away from a centre of mass above it.
    CHECK(space_robot_facts(robot).reach_m == Approx(body.center_m.z() - tip).margin(1e-9));
    check_hover(robot, hummingbird_rotors().hubs_m, hummingbird_rotors().spin_torques_m(),
                joined({body, arm[0], arm[1], arm[2]}));
    // A tip of 10 mg with the inertia of a disc of metres.
    CHECK_THAT(warnings_of(imported), Contains("link 'end_effector_base' has more inertia than its whole mass"));
}

TEST_CASE("MuJoCo Menagerie's Skydio X2, with classes and masses of shapes, is the robot of its published numbers") {
    ImportSettings settings;
    settings.rotor_radius_m = 0.13;
    CHECK_THROWS_WITH(import_robot(public_model("x2.xml"), settings), Contains("--rotor-lag-s S"));
    settings.time_constant_s = 0;
    // Its gears turn both rotors on the left one way and both on the right the other.
    CHECK_THROWS_WITH(import_robot(public_model("x2.xml"), settings),
                      Contains("rotors.spin") && Contains("cannot turn the vehicle in yaw without turning it in roll"));
    settings.spins = {1, -1, 1, -1};
    const ImportedRobot imported = import_robot(public_model("x2.xml"), settings);
    const SpaceRobot& robot = imported.robot;
    const HandRotors rotors{{{-0.14, -0.18, 0.05}, {-0.14, 0.18, 0.05}, {0.14, 0.18, 0.08}, {0.14, -0.18, 0.08}},
                            {1, -1, 1, -1},
                            13,
                            0.0201,
                            0,
                            0.13};
    // Solid ellipsoids: m / 5 of the squares of the half axes.
    const auto ellipsoid = [](double mass, const Eigen::Vector3d& at, double a, double b, double c) {
        return HandBody{mass, at, mass / 5 * diagonal(b * b + c * c, a * a + c * c, a * a + b * b)};
    };
    std::vector<HandBody> bodies{ellipsoid(0.325, {0, 0, 0.02}, 0.16, 0.04, 0.02)};
    for (const Eigen::Vector3d& hub : rotors.hubs_m) {
        bodies.push_back(ellipsoid(0.25, hub, 0.13, 0.13, 0.01));
    }
    const HandBody body = joined(bodies);
    CHECK(body.mass_kg == Approx(1.325));
    check_multirotor(robot, body);
    check_rotors(robot, rotors, body);
    check_hover(robot, rotors.hubs_m, rotors.spin_torques_m(), body);
    // Its key frame hovers with 3.2495625 N a rotor, with g = 9.81 m/s2.
    const std::vector<double> shares = thrust_shares(robot.plant, {});
    for (const double share : shares) {
        CHECK(share * robot.mass_kg() * 9.81 == Approx(3.2495625).margin(1e-9));
    }
}

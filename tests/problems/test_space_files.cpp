#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>
#include <vector>

#include "downwash/dynamics/plant_model.hpp"
#include "downwash/problems/key_reference.hpp"
#include "downwash/problems/space_problem_model.hpp"
#include "downwash/problems/space_problem_parameters.hpp"
#include "downwash/problems/space_problem_reader.hpp"
#include "downwash/problems/space_problem_writer.hpp"
#include "downwash/simulation/space_robot_facts.hpp"
#include "space_files.hpp"

using namespace downwash;
using namespace downwash::test;

namespace {

namespace fs = std::filesystem;

constexpr double degree = std::numbers::pi / 180;

SpaceRobot shipped(const char* name) {
    return read_space_robot(fs::path(DOWNWASH_PROBLEMS) / "robots" / (std::string(name) + ".yaml"));
}

fs::path dynobench(const char* name) {
    return fs::path(DOWNWASH_PROBLEMS) / "../bench/dynobench" / name;
}

double hover_n(const SpaceRobot& robot) {
    return robot.mass_kg() * standard_gravity_m_s2 / static_cast<double>(robot.plant.rotors.size());
}

/// What a problem becomes when it is written and read again.
SpaceProblem read_again(const TestFolder& folder, const SpaceProblem& problem) {
    folder.write("again.yaml", effective_yaml(problem, folder / "."));
    return read_space_problem(folder / "again.yaml");
}

}  // namespace

TEST_CASE("the files of a problem in space and of its robot give their values") {
    const TestFolder folder;
    const SpaceProblem problem = read_good_space_problem(folder);
    CHECK(problem.bounds.low_m == Vector3{-6, -5, 0.5});
    CHECK(problem.bounds.high_m == Vector3{6, 5, 5});
    CHECK(problem.start.position_m == Vector3{-4, 1, 2});
    CHECK(problem.start.yaw_rad == Approx(30 * degree));
    REQUIRE(problem.start.joints_rad.size() == 2);
    CHECK(problem.start.joints_rad[1] == Approx(-10 * degree));
    REQUIRE(problem.goals.size() == 1);
    const auto& goal = std::get<SpaceEndEffectorGoal>(problem.goals[0].kind);
    CHECK(goal.position_m == Vector3{3, -2, 2.5});
    CHECK(*goal.direction == Vector3{0, 0, 1});
    CHECK(problem.motion.max_speed_m_s == 2);
    CHECK(problem.motion.yaw.mode == YawMode::free);

    const SpaceRobot& robot = problem.robot;
    CHECK(robot.joints() == 2);
    CHECK(robot.mass_kg() == Approx(2.3));
    CHECK(robot.plant.multirotor.inertia_kg_m2 == Matrix3{{{0.02, 0, 0}, {0, 0.03, 0}, {0, 0, 0.04}}});
    CHECK(robot.plant.links[1].body.inertia_kg_m2[1][2] == 0.00005);
    CHECK(robot.plant.links[1].axis == Vector3{0, 0, 1});
    CHECK(robot.links[0].upper_limit_rad == Approx(120 * degree));
    CHECK(robot.plant.rotors[1].axis == Vector3{0, 0, 1});
    CHECK(robot.plant.rotors[1].spin == -1);
    CHECK(robot.plant.rotors[3].drag_torque_m == 0.02);  // one number for all
    CHECK(robot.min_thrust_n == std::vector<double>(4, 0));
    CHECK(robot.max_thrust_n == std::vector<double>(4, 12));
    REQUIRE(robot.links[1].body.size() == 1);
    CHECK(std::get<Capsule>(robot.links[1].body[0].shape).to_m == Vector3{0.3, 0, 0});
    CHECK(std::get<SpaceInversion>(robot.controller.law).height.kp_1_s2 == 12);
}

TEST_CASE("every kind of goal, in lists, as alternatives and in any order, is read as it was written") {
    const TestFolder folder;
    SpaceProblem problem = read_good_space_problem(folder);
    const SpaceGoal configuration{SpaceConfigurationGoal{{}, 1.0 / 3, {}, 0.1, {0.1, -0.2}, 0.05, 0.03}, 2, {}};
    const SpaceGoal point{SpaceEndEffectorGoal{{1.0 / 7, 2, 3}, 0.02, Vector3{0, 0.1, 1}, 0.3}, 3, {}};
    const SpaceGoal pose{SpacePoseGoal{{1, 1, 2}, {0.1, 0.2, 0.3}, 0.2, 0.1}, 5, {}};
    const SpaceGoal camera{SpaceCameraGoal{{0, 0, 3}, 0.5, 1.5, Vector3{1, 0, 0}, 0.4, 0.1, false}, 5, {}};
    const SpaceGoal contact{
        SpaceContactGoal{"pole", 4, TouchingPart::frame, Vector3{4, 2.8, 2}, 0.2, 0.5, 0.2, 0.05}, 6, {}};
    const SpaceGoal choice{{}, 5, {point, camera, configuration, pose, contact}};
    for (const bool in_any_order : {false, true}) {
        problem.goals = {configuration, point, pose, camera, contact, choice};
        problem.in_any_order = in_any_order;
        if (in_any_order) {
            problem.return_to = SpaceGoal{SpaceConfigurationGoal{-0.1, {}, 2.0 / 3, 0.2, {}, 0.07, 0.04}, 3, {}};
            problem.energy_budget_j = 1e5 / 3;
        }
        problem.start.attitude = {1, 0, 0, 0.2};
        problem.motion.yaw.mode = YawMode::toward;
        problem.motion.yaw.target_m = {1, 1.0 / 3};
        const SpaceProblem again = read_again(folder, problem);
        CHECK(again.in_any_order == in_any_order);
        CHECK(again.energy_budget_j == problem.energy_budget_j);
        REQUIRE(again.return_to.has_value() == in_any_order);
        if (in_any_order) {
            const auto& place = std::get<SpaceConfigurationGoal>(again.return_to->kind);
            CHECK(place.z_m == 2.0 / 3);
            CHECK_FALSE(place.y_m);
            CHECK(place.tolerance_m == 0.07);
            CHECK(again.return_to->hold_s == 3);
        }
        REQUIRE(again.goals.size() == 6);
        const auto& free = std::get<SpaceConfigurationGoal>(again.goals[0].kind);
        CHECK_FALSE(free.x_m.has_value());
        CHECK(*free.y_m == 1.0 / 3);
        CHECK(free.joints_rad == std::vector{0.1, -0.2});
        CHECK(std::get<SpacePoseGoal>(again.goals[2].kind).rpy_rad == Vector3{0.1, 0.2, 0.3});
        CHECK_FALSE(std::get<SpaceCameraGoal>(again.goals[3].kind).sees);
        CHECK(*std::get<SpaceContactGoal>(again.goals[4].kind).position_m == Vector3{4, 2.8, 2});
        REQUIRE(again.goals[5].any_of.size() == 5);
        CHECK(std::get<SpaceContactGoal>(again.goals[5].any_of[4].kind).force_n == 4);
        CHECK(std::get<SpaceEndEffectorGoal>(again.goals[5].any_of[0].kind).position_m[0] == 1.0 / 7);
        CHECK(again.motion.yaw.target_m[1] == 1.0 / 3);
        CHECK(effective_yaml(again, folder / ".") == effective_yaml(problem, folder / "."));
        CHECK(problem_sha256(again) == problem_sha256(problem));
    }
    const std::string before = problem_sha256(problem);
    problem.robot.links[1].max_torque_nm *= 1.000001;
    CHECK(problem_sha256(problem) != before);
}

TEST_CASE("the start of a vehicle in flight in space is read as it was written") {
    const TestFolder folder;
    SpaceProblem problem = read_good_space_problem(folder);
    const SpaceProblemModel model(problem);
    AnySpaceState flying = start_state(model, problem.start);
    const std::array attitude = normalised({1, 0.05, -1.0 / 30, 0.2});
    std::copy(attitude.begin(), attitude.end(), flying.plant.q + 3);
    for (int i = 0; i < 8; ++i) {
        flying.plant.u[i] = 0.1 / (i + 3);
    }
    flying.plant.thrust_n[1] = 20.0 / 3;
    flying.memory.number[5] = 1.0 / 7;
    SpacePoint reference = reference_at(problem.start);
    reference.velocity[0] = 1.0 / 3;
    reference.acceleration[5] = 1e-9 / 3;
    problem.start = start_of(model, flying, reference);
    CHECK(space_problem_errors(problem).empty());
    CHECK_FALSE(is_at_rest(problem.start));
    const SpaceStart again = read_again(folder, problem).start;
    CHECK(start_motion(again) == start_motion(problem.start));
    CHECK(reference_at(again) == reference);
    CHECK(again.carry.rotor_thrust_n[1] == 20.0 / 3);
    CHECK(again.carry.controller_memory == problem.start.carry.controller_memory);
    CHECK(is_same(start_state(model, again), start_state(model, problem.start)));
    CHECK(start_state(model, again).memory.number[5] == 1.0 / 7);
    // What the vehicle carries alone says that it is in flight.
    SpaceStart still = read_good_space_problem(folder).start;
    CHECK(is_at_rest(still));
    still.carry.controller_memory = again.carry.controller_memory;
    CHECK_FALSE(is_at_rest(still));
}

TEST_CASE("a start in space at which the robot touches itself is an error") {
    SpaceProblem problem = read_space_problem(fs::path(DOWNWASH_PROBLEMS) / "space/girder_bay.yaml");
    CHECK(space_problem_errors(problem).empty());
    problem.start.joints_rad = {-90 * degree, -150 * degree};  // link 2 dips into the rotor discs
    const auto errors = space_problem_errors(problem);
    REQUIRE(errors.size() == 1);
    CHECK(errors[0].key == "start.joints_deg");
    CHECK(errors[0].message ==
          "makes link 2 touch the multirotor: expected angles at which the robot does not touch itself");
}

TEST_CASE("a law in space that takes up the force of a touch slowly is an error") {
    const TestFolder folder;
    SpaceProblem problem = read_good_space_problem(folder);
    SpaceContactGoal contact;
    contact.obstacle = "pole";
    problem.goals = {SpaceGoal{contact, 3, {}}};
    CHECK(space_problem_errors(problem).empty());
    std::get<SpaceInversion>(problem.robot.controller.law).height.kp_1_s2 = 0.04;
    const auto errors = space_problem_errors(problem);
    REQUIRE(errors.size() == 1);
    CHECK(errors[0].key == "robot.controller");
    CHECK_THAT(errors[0].message, Catch::Matchers::Contains("settle for more than 60 s"));
    problem.goals = {SpaceGoal{SpaceEndEffectorGoal{{3, -2, 2.5}, 0.1, {}, 1}, 3, {}}};
    CHECK(space_problem_errors(problem).empty());
}

TEST_CASE("a robot in space is read as it was written") {
    const TestFolder folder;
    SpaceRobot robot = read_good_space_problem(folder).robot;
    robot.plant.rotors[0].axis = {0.1, 0, 1};
    robot.plant.rotors[2].drag_torque_m = 0.019;
    robot.min_thrust_n = {0, 0.1, 0.2, 1.0 / 3};
    robot.plant.links[0].viscous_friction_nm_s = 0.01;
    robot.plant.links[0].drag.quadratic_n_s2_m2 = 0.02;
    robot.plant.wash = WashParameters{0.9};
    robot.links[0].is_limited = false;
    robot.links[0].lower_limit_rad = robot.links[0].upper_limit_rad = 0;
    Px4Cascade law;
    law.position_p_1_s = 1.1;
    law.height_p_1_s = 1.2;
    law.attitude_p_1_s = 6.1;
    law.yaw_weight = 0.3;
    law.joint = {3, 4, 5, 6};
    robot.controller.law = law;
    folder.write("written.yaml", robot_yaml(robot));
    const SpaceRobot again = read_space_robot(folder / "written.yaml");
    CHECK(robot_yaml(again) == robot_yaml(robot));
    CHECK(again.plant.rotors[0].axis == Vector3{0.1, 0, 1});
    CHECK(again.plant.rotors[2].drag_torque_m == 0.019);
    CHECK(again.min_thrust_n == robot.min_thrust_n);
    CHECK(again.plant.wash == robot.plant.wash);
    CHECK_FALSE(again.links[0].is_limited);
    CHECK(std::get<Px4Cascade>(again.controller.law).yaw_weight == 0.3);
    CHECK(std::get<Px4Cascade>(again.controller.law).joint.ki_1_s3 == 5);
}

TEST_CASE("robots of published numbers have their masses and hover with the thrusts that follow by hand") {
    const SpaceRobot hexa = shipped("hexa370_arm3");
    CHECK(hexa.mass_kg() == Approx(1.9828 + 6 * 0.005 + 0.27973 + 0.12284 + 0.11474 + 0.030904).margin(1e-9));
    CHECK(hover_n(hexa) == Approx(4.1858).epsilon(1e-4));  // 25.115 N on six rotors
    CHECK(space_robot_facts(hexa).thrust_to_weight == Approx(124.2 / 25.115).epsilon(1e-4));

    const SpaceRobot snu = shipped("snu_f550_arm2");
    CHECK(snu.mass_kg() == Approx(2.153 + 0.1852 + 0.0821 + 0.05723).margin(1e-9));
    CHECK(hover_n(snu) == Approx(4.0494).epsilon(1e-4));  // 24.296 N on six rotors
    // Both links upright: joint, 0.25 m and 0.30 m.
    CHECK(space_robot_facts(snu).reach_m > 0.05 + 0.25 + 0.3);

    const SpaceRobot large = shipped("hexa960_arm2");
    CHECK(large.mass_kg() == Approx(4.0 + 6 * 0.015 + 0.25 + 0.148 + 0.16).margin(1e-9));
    CHECK(hover_n(large) == Approx(7.597).epsilon(1e-4));  // 45.58 N on six rotors
    // Base, rotors and mount about their common centre of mass, 0.00873 m above the base's.
    const double up_m = (0.09 * 0.06 + 0.25 * 0.13) / 4.34;
    const double tilt_kg_m2 = 0.18 + 4 * up_m * up_m + 0.09 * (0.5 * 0.48 * 0.48 + (0.06 - up_m) * (0.06 - up_m)) +
                              0.25 * (0.13 - up_m) * (0.13 - up_m);
    CHECK(large.plant.multirotor.inertia_kg_m2[0][0] == Approx(tilt_kg_m2).margin(1e-4));
    CHECK(large.plant.multirotor.inertia_kg_m2[2][2] == Approx(0.3 + 0.09 * 0.48 * 0.48).margin(1e-4));
    // The level arm reaches 0.34 m past the rotor discs.
    CHECK(large.plant.links[1].joint_m[2] + large.plant.end_effector_m[2] - (0.48 + 0.229) == Approx(0.341));

    const SpaceRobot neo = shipped("neo11_arm5");
    CHECK(neo.mass_kg() == Approx(3.42 + 6 * 0.005 + 0.667).margin(1e-4));
    CHECK(hover_n(neo) == Approx(6.729).epsilon(1e-4));  // 40.374 N on six rotors, tilt aside
    for (const SpaceRotor& rotor : neo.plant.rotors) {
        CHECK(std::acos(rotor.axis[2] / std::sqrt(dot(rotor.axis, rotor.axis))) == Approx(5 * degree).epsilon(1e-4));
        // Tilt and drag turn the vehicle the same way in yaw.
        const double by_tilt = cross(rotor.position_m, rotor.axis)[2];
        CHECK(by_tilt * rotor.spin < 0);
    }
}

TEST_CASE("ARS-LRM in space is the planar robot with what motion out of its plane needs") {
    const SpaceRobot space = shipped("ars_lrm_space");
    const Robot plane = read_robot(fs::path(DOWNWASH_PROBLEMS) / "robots/ars_lrm.yaml");
    CHECK(space.mass_kg() == plane.mass_kg());
    CHECK(space.plant.multirotor.inertia_kg_m2[1][1] == plane.multirotor.pitch_inertia_kg_m2);
    CHECK(space.plant.links[0].body.inertia_kg_m2[1][1] == plane.arm.inertia_kg_m2);
    CHECK(space.plant.links[0].center_of_mass_m == Vector3{plane.arm.center_of_mass_m, 0, 0});
    CHECK(space.plant.links[0].drag.quadratic_n_s2_m2 == plane.arm.drag.quadratic_n_s2_m2);
    CHECK(space.plant.end_effector_m == Vector3{plane.arm.length_m, 0, 0});
    CHECK(space.plant.drag.linear_n_s_m == plane.multirotor.drag.linear_n_s_m);
    CHECK(space.plant.time_constant_s == plane.rotors.time_constant_s);
    CHECK(space.plant.power_coefficient_w_n1p5 == plane.rotors.power_coefficient_w_n1p5);
    CHECK(space.controller.delay_s == plane.controller.delay_s);
    REQUIRE(space.plant.rotors.size() == plane.rotors.positions_m.size());
    for (std::size_t k = 0; k < space.plant.rotors.size(); ++k) {
        CHECK(space.plant.rotors[k].position_m == plane.rotors.positions_m[k]);
        CHECK(space.max_thrust_n[k] == plane.rotors.max_thrust_n);
    }
}

TEST_CASE("rotors of dynobench's quadrotors have its mixer") {
    const double g = 9.81;
    const SpaceRobot v0 = read_space_robot(dynobench("quadrotor_v0.yaml"));
    CHECK(v0.mass_kg() == 0.034);
    const double a = 0.046 / std::sqrt(2.0);
    const double roll[] = {-a, -a, a, a}, pitch[] = {-a, a, a, -a}, yaw[] = {-0.006, 0.006, -0.006, 0.006};
    for (std::size_t k = 0; k < 4; ++k) {
        const SpaceRotor& rotor = v0.plant.rotors[k];
        const Vector3 lever = cross(rotor.position_m, rotor.axis);
        CHECK(lever[0] == Approx(roll[k]).epsilon(1e-8));
        CHECK(lever[1] == Approx(pitch[k]).epsilon(1e-8));
        CHECK(-rotor.spin * rotor.drag_torque_m == Approx(yaw[k]));
        CHECK(v0.max_thrust_n[k] == Approx(1.3 * 0.034 * g / 4));
    }
    const SpaceRobot v1 = read_space_robot(dynobench("quadrotor_v1.yaml"));
    double most_n = 0;
    Vector3 most_nm = {};  // by levers and drag
    for (std::size_t k = 0; k < v1.plant.rotors.size(); ++k) {
        const SpaceRotor& rotor = v1.plant.rotors[k];
        const Vector3 torque_m = cross(rotor.position_m, rotor.axis) - rotor.spin * rotor.drag_torque_m * rotor.axis;
        most_n += rotor.axis[2] * v1.max_thrust_n[k];
        for (std::size_t i = 0; i < 3; ++i) {
            most_nm[i] += std::max(0.0, torque_m[i]) * v1.max_thrust_n[k];
        }
    }
    CHECK(most_n == Approx(1.5 * 1 * g));
    for (const double torque_nm : most_nm) {
        CHECK(torque_nm == Approx(40).epsilon(1e-4));
        CHECK(torque_nm <= 40);  // none of its torques is beyond the model's
    }
}

TEST_CASE("every shipped robot in space is read as it was written") {
    const TestFolder folder;
    for (const fs::path& file : {fs::path(DOWNWASH_PROBLEMS) / "robots/hexa370_arm3.yaml",
                                 fs::path(DOWNWASH_PROBLEMS) / "robots/snu_f550_arm2.yaml",
                                 fs::path(DOWNWASH_PROBLEMS) / "robots/neo11_arm5.yaml",
                                 fs::path(DOWNWASH_PROBLEMS) / "robots/hexa960_arm2.yaml",
                                 fs::path(DOWNWASH_PROBLEMS) / "robots/ars_lrm_space.yaml",
                                 dynobench("quadrotor_v0.yaml"), dynobench("quadrotor_v1.yaml")}) {
        CAPTURE(file);
        CHECK(is_space_robot_file(file));
        std::vector<std::string> warnings;
        const SpaceRobot robot =
            read_space_robot(file, [&](const LocatedError& warning) { warnings.push_back(to_text(warning)); });
        // The model of quadrotor_v1 has torques for themselves: rotors that give them stand at one place, which is
        // told.
        CHECK(warnings.size() == (robot.name == "dynobench_quadrotor_v1" ? 1 : 0));
        folder.write("written.yaml", robot_yaml(robot));
        CHECK(robot_yaml(read_space_robot(folder / "written.yaml")) == robot_yaml(robot));
    }
}

TEST_CASE("the problem in space to start from is sound") {
    const TestFolder folder;
    for (const char* name : {"templates/first_space_problem.yaml", "robots/hexa370_arm3.yaml"}) {
        fs::copy_file(fs::path(DOWNWASH_PROBLEMS) / name, folder / fs::path(name).filename().string(),
                      fs::copy_options::overwrite_existing);
    }
    std::vector<std::string> warnings;
    const SpaceProblem problem =
        read_space_problem(folder / "first_space_problem.yaml", {},
                           [&](const LocatedError& warning) { warnings.push_back(to_text(warning)); });
    CHECK(problem.robot.name == "hexa370_arm3");
    CHECK(warnings.empty());
}

TEST_CASE("the schemas of files in space have every key of their tables and no other") {
    for (const FileKind kind : {FileKind::space_problem, FileKind::space_robot}) {
        const nlohmann::json schema = nlohmann::json::parse(json_schema(kind));
        std::size_t found = 0;
        for (const KeyReference& key : key_reference(kind)) {
            // Elements of lists stand in the form that is an array.
            const nlohmann::json* at = &schema;
            std::string path = key.info.path;
            CAPTURE(path);
            for (std::size_t from = 0; at != nullptr && from <= path.size();) {
                const std::size_t dot = std::min(path.find('.', from), path.size());
                std::string name = path.substr(from, dot - from);
                const bool is_list = name.ends_with("[]");
                name = is_list ? name.substr(0, name.size() - 2) : name;
                const nlohmann::json* next = nullptr;
                const auto look_in = [&](const nlohmann::json& form) {
                    if (form.contains("properties") && form["properties"].contains(name)) {
                        next = &form["properties"][name];
                    }
                };
                look_in(*at);
                if (next == nullptr && at->contains("anyOf")) {
                    for (const auto& form : (*at)["anyOf"]) {
                        look_in(form);
                    }
                }
                if (next != nullptr && is_list) {
                    const nlohmann::json* items = next->contains("items") ? &(*next)["items"] : nullptr;
                    if (items == nullptr && next->contains("anyOf")) {
                        for (const auto& form : (*next)["anyOf"]) {
                            items = form.contains("items") ? &form["items"] : items;
                        }
                    }
                    next = items;
                }
                at = next;
                from = dot + 1;
            }
            CHECK(at != nullptr);
            found += at != nullptr ? 1 : 0;
        }
        CHECK(found > 100);
    }
    CHECK(json_schema(FileKind::space_robot).find("pitch_inertia_kg_m2") == std::string::npos);
    CHECK(json_schema(FileKind::space_problem).find("\"plane\"") == std::string::npos);
}

#include "../support/test_problem.hpp"
#include "../support/test_robot.hpp"
#include "downwash/problems/problem_parameters.hpp"
#include "downwash/problems/problem_writer.hpp"
#include "downwash/problems/visit_order.hpp"
#include "edits.hpp"

using namespace downwash;
using namespace downwash::test;

TEST_CASE("a problem is read as it is written, angles in radians") {
    const Problem problem = TestFolder().read();
    CHECK(problem.name == "test");
    CHECK(problem.robot.name == "tester");
    CHECK(problem.robot.rotors.positions_m.size() == 4);
    CHECK(problem.robot.rotors.positions_m[1] == Vector3{0.3, -0.3, 0});
    CHECK(test::gains_of(problem.robot).max_tilt_rad == 0.6108652381980153);
    CHECK(problem.bounds.x_low_m == -6);
    CHECK(problem.bounds.z_high_m == 5);
    REQUIRE(problem.obstacles.size() == 2);
    CHECK(std::get<Cylinder>(problem.obstacles[1].shape).length_m == 5);
    CHECK(problem.obstacles[1].center_world_m == Vector3{4, 3, 2.5});
    CHECK(problem.aero.ceiling.parameters[0] == 6.9);
    CHECK(problem.start.at[plane::arm] == 1.5707963267948966);
    CHECK(std::holds_alternative<EndEffectorGoal>(problem.goal.kind));
}

TEST_CASE("what a file leaves out has the default of its member") {
    const Problem problem = TestFolder().read();
    const Problem fresh;
    CHECK(problem.aero.grid_m == fresh.aero.grid_m);
    CHECK(problem.aero.ceiling.parameters[1] == fresh.aero.ceiling.parameters[1]);
    CHECK(problem.motion.max_arm_rate_rad_s == fresh.motion.max_arm_rate_rad_s);
    CHECK(problem.planner.safety_margin_m == fresh.planner.safety_margin_m);
    CHECK_FALSE(problem.planner.max_iterations.has_value());
    CHECK_FALSE(problem.robot.arm.is_limited);
}

TEST_CASE("a problem takes over what its robot says of its own uncertainty, but for keys that it gives itself") {
    const TestFolder folder;
    const std::string robot = std::string(good_robot) +
                              "uncertainty:\n"
                              "  vehicle: {mass_scale: {sd: 0.11}, com_offset_m: {x: {sd: 0.03}, z: {sd: 0.04}}}\n"
                              "  sensing: {pitch_bias_deg: {range: [-1, 2]}, position_noise_m: 0}\n";
    const auto uncertainty_of = [&](std::string_view of_problem) {
        return folder.read(std::string(good_problem) + std::string(of_problem), robot).uncertainty;
    };
    const Uncertainty usual;
    const Uncertainty taken = uncertainty_of("uncertainty: {}\n").value();
    CHECK(taken.mass_scale == Spread::of_sd(0.11));
    CHECK(taken.center_of_mass_x_m == Spread::of_sd(0.03));
    CHECK(taken.center_of_mass_z_m == Spread::of_sd(0.04));
    CHECK(taken.pitch_bias_rad.form == Spread::Form::range);
    CHECK(taken.pitch_bias_rad.high == Approx(0.0349066));
    CHECK(taken.position_noise_m == Spread());
    CHECK(taken.inertia_scale == usual.inertia_scale);
    CHECK(taken.gyro_noise_rad_s == usual.gyro_noise_rad_s);
    CHECK(taken.ceiling_scale == usual.ceiling_scale);
    CHECK(taken.gust_m_s == usual.gust_m_s);

    // Key by key, also where the problem makes exact what the robot does not know, and wherever `robot:` stands.
    const Uncertainty mixed = uncertainty_of(
                                  "uncertainty: {aero: {ceiling_scale: 0}, vehicle: {mass_scale: 0, com_offset_m: {z: "
                                  "{sd: 0.001}}}, sensing: {position_noise_m: {sd: 0.005}}}\n")
                                  .value();
    CHECK(mixed.mass_scale == Spread());
    CHECK(mixed.center_of_mass_x_m == Spread::of_sd(0.03));
    CHECK(mixed.center_of_mass_z_m == Spread::of_sd(0.001));
    CHECK(mixed.position_noise_m == Spread::of_sd(0.005));
    CHECK(mixed.pitch_bias_rad == taken.pitch_bias_rad);
    CHECK(mixed.ceiling_scale == Spread());
    const std::string robot_last = edited(edited(good_problem, "robot: robot.yaml\n", ""), "seed: 1}\n",
                                          "seed: 1}\nuncertainty: {vehicle: {thrust_scale: 0}}\nrobot: robot.yaml\n");
    CHECK(folder.read(robot_last, robot).uncertainty.value().mass_scale == Spread::of_sd(0.11));
    CHECK(folder.read(robot_last, robot).uncertainty.value().thrust_scale == Spread());

    // Without one of its own a problem has the nominal world only, and the same problem.
    const std::string nothing = problem_sha256(folder.read());
    for (const std::string_view none : {"", "uncertainty: none\n"}) {
        const Problem problem = folder.read(std::string(good_problem) + std::string(none), robot);
        CHECK_FALSE(problem.uncertainty.has_value());
        CHECK(problem.robot.uncertainty.value().mass_scale == Spread::of_sd(0.11));
        CHECK(problem_sha256(problem) == nothing);
    }
}

TEST_CASE("the shipped robot states the defaults of its uncertainty to the last bit") {
    const Robot robot = read_robot(std::filesystem::path(DOWNWASH_PROBLEMS) / "robots/ars_lrm.yaml");
    CHECK(robot.uncertainty.value() == Uncertainty{});
}

TEST_CASE("a robot without the key has no wash, nor one that says none, and only with a wash it may be uncertain") {
    const TestFolder folder;
    const auto wash_of = [&](const std::string& arm_keys, const std::string& further) {
        const std::string robot = edited(good_robot, "max_torque_nm: 12", "max_torque_nm: 12" + arm_keys) + further;
        return folder.read(good_problem, robot).robot.arm.wash;
    };
    const std::string drag = ", drag: {quadratic_n_s2_m2: 0.05}";
    CHECK_FALSE(wash_of("", ""));
    CHECK_FALSE(wash_of(", wash: none", ""));
    CHECK(wash_of(drag + ", wash: {}", "").value().scale == 1);
    CHECK(wash_of(drag + ", wash: {scale: 0.8}", "").value().scale == 0.8);
    const std::string uncertain = "uncertainty: {vehicle: {arm_wash_scale: {sd: 0.2}}}\n";
    CHECK(wash_of(drag + ", wash: {scale: 1}", uncertain));
    CHECK_THROWS_WITH(wash_of(drag, uncertain), Catch::Contains("arm_wash_scale has a meaning only where the robot has "
                                                                "arm.wash: remove it"));
}

TEST_CASE("keys are read by their former names, which are reported") {
    const TestFolder folder;
    folder.write("problem.yaml", good_problem);
    folder.write("robot.yaml", edited(good_robot, "{kp: 8, rate_kp: 20}", "{k5: 7, ku5: 19, kiu5: 1}"));
    std::vector<LocatedError> outdated;
    const Problem problem =
        read_problem(folder / "problem.yaml", {}, [&](const LocatedError& key) { outdated.push_back(key); });
    const ModelInversion& gains = test::gains_of(problem.robot);
    CHECK(gains.attitude_kp == 7);
    CHECK(gains.attitude_rate_kp == 19);
    CHECK(gains.attitude_rate_ki == 1);
    REQUIRE(outdated.size() == 3);
    CHECK(to_text(outdated[1]) ==
          (folder / "robot.yaml").string() + ":16:21: controller.attitude.ku5 is now called rate_kp: rename it");
}

constexpr std::string_view inversion_gains =
    "  position: {kp: 2, kd: 2.6}\n  attitude: {kp: 8, rate_kp: 20}\n  arm: {kp: 30, kd: 11}\n";

TEST_CASE("a robot file chooses its control law, with defaults, an observer and a feed-forward") {
    const TestFolder folder;
    const Problem cascaded = folder.read(
        good_problem, edited(good_robot, inversion_gains,
                             "  type: cascaded-pid\n  pitch: {rate_kp: 3}\n  feed_forward: {offset_z_m: 0.03}\n"));
    const auto& cascade = std::get<CascadedPid>(cascaded.robot.controller.law);
    CHECK(cascade.pitch_rate_kp == 3);
    CHECK(cascade.vertical_velocity_kp == CascadedPid{}.vertical_velocity_kp);
    CHECK_FALSE(cascade.aids.observer);
    REQUIRE(cascade.aids.feed_forward);
    CHECK(cascade.aids.feed_forward->offset_x_m == 0);
    CHECK(cascade.aids.feed_forward->offset_z_m == 0.03);

    const Problem inverting =
        folder.read(good_problem, edited(good_robot, "controller:\n", "controller:\n  observer: {gain_1_s: 5}\n"));
    const ModelInversion& gains = test::gains_of(inverting.robot);
    REQUIRE(gains.aids.observer);
    CHECK(gains.aids.observer->gain_1_s == 5);
    CHECK_FALSE(gains.aids.feed_forward);
}

TEST_CASE("what a control law has beside its loops survives being written and read") {
    const TestFolder folder;
    const Problem problem = folder.read(
        good_problem, edited(good_robot, inversion_gains,
                             "  type: cascaded-pid\n  observer: {gain_1_s: 7}\n  feed_forward: {offset_x_m: -0.05}\n"));
    folder.write("written.yaml", effective_yaml(problem, (folder / "written.yaml").parent_path()));
    const Problem read = read_problem(folder / "written.yaml");
    const auto& law = std::get<CascadedPid>(read.robot.controller.law);
    REQUIRE(law.aids.observer);
    CHECK(law.aids.observer->gain_1_s == 7);
    REQUIRE(law.aids.feed_forward);
    CHECK(law.aids.feed_forward->offset_x_m == -0.05);
    CHECK(problem_sha256(read) == problem_sha256(problem));
}

TEST_CASE("a robot file chooses the Lyapunov law, whose gains survive being written and read") {
    const TestFolder folder;
    const Problem problem =
        folder.read(good_problem,
                    edited(good_robot, inversion_gains,
                           "  type: lyapunov\n  horizontal: {k: 0.7, k_rate: 1.9}\n  pitch: {rate_filter_s: 0.02}\n"));
    folder.write("written.yaml", effective_yaml(problem, (folder / "written.yaml").parent_path()));
    const Problem read = read_problem(folder / "written.yaml");
    const auto& law = std::get<PlanarLyapunov>(read.robot.controller.law);
    CHECK(law.horizontal_k == 0.7);
    CHECK(law.horizontal_k_rate == 1.9);
    CHECK(law.vertical_k == PlanarLyapunov{}.vertical_k);
    CHECK(law.pitch_rate_filter_s == 0.02);
    CHECK(problem_sha256(read) == problem_sha256(problem));
}

TEST_CASE("errors of several kinds and files are reported in one run, in the order of the files") {
    const TestFolder folder;
    CHECK(folder.errors_of(edited(edited(good_problem, "x_m: -4", "x_m: -40"), "seed: 1", "sead: 1"),
                           edited(good_robot, "max_thrust_n: 28", "max_thrust_n: 10")) ==
          "problem.yaml:12:14: start.x_m is -40, outside the bounds: expected -6 to 6\n"
          "problem.yaml:16:72: unknown key 'sead' in planner: did you mean 'seed'?\n"
          "robot.yaml:11:17: rotors.max_thrust_n gives 40 N with 4 rotors, which cannot lift the weight of 48.54 N: "
          "8.543 N are missing; expected more than 12.14 N a rotor");
}

TEST_CASE("a limit of thrust that the rotors cannot give is warned of, with its place") {
    // Four rotors of 28 N carry 4.95 kg: 112 N over 48.54 N is 2.307.
    const auto warnings_of = [](const std::string& ratio) {
        const TestFolder folder;
        folder.write("robot.yaml", good_robot);
        folder.write("problem.yaml",
                     edited(good_problem, "aero:\n", "motion: {max_thrust_ratio: " + ratio + "}\naero:\n"));
        std::vector<LocatedError> warnings;
        static_cast<void>(read_problem(folder / "problem.yaml", {}, {},
                                       [&](const LocatedError& found) { warnings.push_back(found); }));
        return warnings;
    };
    CHECK(warnings_of("null").empty());
    CHECK(warnings_of("2.3").empty());
    CHECK(warnings_of("2.32").empty());  // rounded somewhere
    const std::vector<LocatedError> warnings = warnings_of("2.5");
    REQUIRE(warnings.size() == 1);
    CHECK(warnings[0].line == 9);
    CHECK(warnings[0].column == 28);
    CHECK(
        warnings[0].message ==
        "motion.max_thrust_ratio is 2.5, and the rotors give 2.31 times the weight at most (112 N of 48.5 N): flights "
        "cannot follow references that ask for more; expected at most 2.31");
}

TEST_CASE("an arm that does not move has one angle, and a start at another one is an error") {
    const std::string robot = edited(good_robot, "max_torque_nm: 12", "max_torque_nm: 12, limits_deg: [90, 90]");
    const TestFolder folder;
    const Problem problem = folder.read(good_problem, robot);
    CHECK(problem.robot.arm.is_limited);
    CHECK(problem.robot.arm.lower_limit_rad == problem.robot.arm.upper_limit_rad);
    CHECK_THAT(folder.errors_of(edited(good_problem, "arm_deg: 90", "arm_deg: 80"), robot),
               Catch::Matchers::Contains("start.arm_deg is beyond the arm's limits"));
}

TEST_CASE("the controller that the error of a missing one proposes flies with its defaults") {
    const std::string_view own =
        "controller:\n  position: {kp: 2, kd: 2.6}\n  attitude: {kp: 8, rate_kp: 20}\n  arm: {kp: "
        "30, kd: 11}\n  max_tilt_deg: 35\n";
    const TestFolder folder;
    CHECK(folder.errors_of(good_problem, edited(good_robot, own, "controller: {type: cascaded-pid}\n")) == "sound");
}

TEST_CASE("every shipped problem is sound") {
    for (const auto& entry : std::filesystem::directory_iterator(DOWNWASH_PROBLEMS)) {
        if (entry.path().extension() == ".yaml") {
            CAPTURE(entry.path());
            CHECK_NOTHROW(read_problem(entry.path()));
        }
    }
    CHECK(read_robot(std::filesystem::path(DOWNWASH_PROBLEMS) / "robots/ars_lrm.yaml").name == "ars_lrm");
}

TEST_CASE("goals are read one by one, in turn, or as a choice") {
    const TestFolder folder;
    const auto read_with = [&](std::string_view text) {
        constexpr std::string_view one = "goal:\n  end_effector: {x_m: 3, z_m: 2.5, tolerance_m: 0.1}\n  hold_s: 5\n";
        return folder.read(edited(good_problem, one, text));
    };
    const Problem turn = read_with(
        "goal:\n  - configuration: {x_m: 1, tolerance_x_m: 0.2}\n    hold_s: 3\n"
        "  - end_effector: {x_m: 2, z_m: 3, tolerance_z_m: 0.3}\n  - configuration: {z_m: 4}\n    hold_s: 7\n");
    REQUIRE(turn.goals_before.size() == 2);
    CHECK(test::configuration(turn.goals_before[0]).x_m == 1);
    CHECK(test::configuration(turn.goals_before[0]).tolerance_x_m == 0.2);
    CHECK(turn.goals_before[0].hold_s == 3);
    CHECK(test::end_effector(turn.goals_before[1]).tolerance_z_m == 0.3);
    CHECK(turn.goals_before[1].hold_s == 5);
    CHECK(test::configuration(turn.goal).z_m == 4);
    CHECK(turn.goal.hold_s == 7);
    CHECK(goals_of(turn).size() == 3);

    const Problem choice =
        read_with("goal: {any_of: [{configuration: {x_m: 1}}, {configuration: {x_m: 2}, hold_s: 2}]}\n");
    CHECK(choice.goals_before.empty());
    REQUIRE(choice.goal.any_of.size() == 2);
    CHECK(choice.goal.any_of[0].hold_s == 5);
    CHECK(test::configuration(choice.goal.any_of[1]).x_m == 2);
    CHECK(choice.goal.any_of[1].hold_s == 2);

    const Problem alone = read_with("goal: [{configuration: {x_m: 1}}]\n");
    CHECK(alone.goals_before.empty());
    CHECK(test::configuration(alone.goal).x_m == 1);
}

TEST_CASE("targets in any order are read with their alternatives, the place to return to and the energy budget") {
    const TestFolder folder;
    constexpr std::string_view one = "goal:\n  end_effector: {x_m: 3, z_m: 2.5, tolerance_m: 0.1}\n  hold_s: 5\n";
    const Problem problem = folder.read(
        edited(good_problem, one,
               "goal:\n  return_to: {x_m: -4, z_m: 2, hold_s: 2}\n  energy_budget_j: 50000\n  in_any_order:\n"
               "    - {configuration: {x_m: 1}, hold_s: 3}\n    - end_effector: {x_m: 3, z_m: 2.5}\n"
               "    - any_of: [{configuration: {x_m: 2}}, {configuration: {x_m: 3, z_m: 2}, hold_s: 4}]\n"));
    REQUIRE(problem.targets.size() == 3);
    CHECK(test::configuration(problem.targets[0]).x_m == 1);
    CHECK(problem.targets[0].hold_s == 3);
    CHECK(test::end_effector(problem.targets[1]).z_m == 2.5);
    REQUIRE(problem.targets[2].any_of.size() == 2);
    CHECK(test::configuration(problem.targets[2].any_of[0]).x_m == 2);
    CHECK(problem.targets[2].any_of[0].hold_s == 5);
    CHECK(test::configuration(problem.targets[2].any_of[1]).z_m == 2);
    CHECK(problem.targets[2].any_of[1].hold_s == 4);
    CHECK(test::configuration(*problem.return_to).x_m == -4);
    CHECK(problem.return_to->hold_s == 2);
    CHECK(problem.energy_budget_j == 50000);
    CHECK(goals_of(problem).size() == 4);

    VisitOrder order;
    order.visits = {{2, 1}, {0, std::nullopt}};
    order.left_out = {{1, LeftOutReason::energy_budget, 60000}};
    const Problem sequence = in_order(problem, order);
    CHECK(sequence.targets.empty());
    CHECK(sequence.energy_budget_j == 50000);
    const std::vector<Goal> goals = goals_of(sequence);
    REQUIRE(goals.size() == 3);
    CHECK(test::configuration(goals[0]).x_m == 3);
    CHECK(goals[0].hold_s == 4);
    CHECK(test::configuration(goals[1]).x_m == 1);
    CHECK(test::configuration(goals[2]).x_m == -4);
    CHECK(goal_names(problem, order) == std::vector<std::string>{"target 3", "target 1", "the place to return to"});

    // One that visits nothing but the place to return to, and one that visits nothing.
    Problem other = problem;
    CHECK(goals_of(in_order(other, VisitOrder{})).size() == 1);
    other.return_to.reset();
    CHECK(goals_of(in_order(other, VisitOrder{})).size() == 3);
    CHECK(goal_names(other, VisitOrder{}).size() == 3);
}

TEST_CASE("an objective is a name or a sum with weights, of which those that are left out are 0") {
    const TestFolder folder;
    const auto objective_of = [&](std::string_view text) {
        return folder.read(edited(good_problem, "objective: energy", "objective: " + std::string(text)))
            .planner.objective;
    };
    const CostFunction sum = objective_of("{energy: 0.5, time: 50}");
    CHECK(sum.weight(Objective::energy) == 0.5);
    CHECK(sum.weight(Objective::time) == 50);
    CHECK(sum.weight(Objective::length) == 0);
    CHECK(sum.weight(Objective::clearance) == 0);
    CHECK(objective_of("{time: 2}").weight(Objective::energy) == 0);
    CHECK(objective_of("{length: 1}") == CostFunction(Objective::length));
    CHECK(objective_of("clearance") == CostFunction(Objective::clearance));
}

TEST_CASE("single values are set as a file would set them") {
    Problem problem = TestFolder().read();
    set_parameter(problem, "planner.variant", "mp-arm");
    CHECK(problem.planner.variant == Variant::mp_arm);
    set_parameter(problem, "planner.max_iterations", "500");
    CHECK(problem.planner.max_iterations == 500U);
    set_parameter(problem, "start.arm_deg", "180");
    CHECK(problem.start.at[plane::arm] == 3.141592653589793);
    CHECK_THROWS_WITH(set_parameter(problem, "planner.variant", "mparm"),
                      "planner.variant: is 'mparm': expected one of mp-arm, mp-arm-da or mp-arm-ada; did you mean "
                      "'mp-arm'?");
    CHECK_THROWS_AS(set_parameter(problem, "planner.seed", "-3"), InputError);
    CHECK_THROWS_AS(set_parameter(problem, "planner", "none"), InputError);
    problem.planner.objective.weight(Objective::time) = 3;
    set_parameter(problem, "planner.objective", "energy");
    CHECK(problem.planner.objective == CostFunction(Objective::energy));
    CHECK_THROWS_WITH(set_parameter(problem, "planner.objective", "fun"),
                      with_all_names("planner.objective: is 'fun': expected one of <objectives>"));
    CHECK_THROWS_AS(set_parameter(problem, "environment.obstacles[].name", "x"), InputError);
    set_parameter(problem, "robot.uncertainty.vehicle.thrust_scale", "0");
    set_parameter(problem, "uncertainty.vehicle.mass_scale", "0");
    CHECK(problem.uncertainty.value().mass_scale == Spread());
    CHECK(problem.uncertainty.value().thrust_scale == Spread());
}

TEST_CASE("every parameter is described, stands in a group and has a sound default unless it must be given") {
    for (const Parameter<Problem>& row : problem_parameters().rows()) {
        CAPTURE(row.path);
        CHECK_FALSE(row.description.empty());
        const std::string parent(parent_path(row.path));
        const std::string group = parent.ends_with("[]") ? parent.substr(0, parent.size() - 2) : parent;
        CHECK((group.empty() || problem_parameters().find(group) != nullptr));
        CHECK(problem_parameters().find(row.path) == &row);
        const bool is_always_there = row.get && parent.find("[]") == std::string::npos && !parent.starts_with("goal.");
        if (is_always_there && !row.required) {
            CHECK_FALSE(value_error(row, row.get(Problem{}, 0)).has_value());
        }
    }
}

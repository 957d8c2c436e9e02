#include <bit>
#include <cmath>
#include <cstdint>

#include "../support/random.hpp"
#include "../support/test_problem.hpp"
#include "downwash/problems/problem_parameters.hpp"
#include "downwash/problems/problem_writer.hpp"
#include "edits.hpp"

using namespace downwash;
using namespace downwash::test;

namespace {

/// Draws sound problems with numbers of many digits.
class ProblemMaker {
 public:
    explicit ProblemMaker(std::uint64_t seed) : random_(seed) {}

    /// A sound problem with what may be varied without making it impossible varied a little.
    Problem varied(Problem problem) {
        problem.bounds.x_low_m -= uniform();
        problem.bounds.z_high_m += uniform();
        problem.start.at[plane::x] += 0.1 * uniform();
        problem.start.at[plane::z] += 0.1 * uniform();
        problem.start.at[plane::arm] += 0.2 * uniform();
        problem.start.pitch_rate_rad_s = uniform() - 0.5;
        if (coin()) {
            ReferencePoint& reference = problem.start.reference.emplace();
            for (int axis = 0; axis < 3; ++axis) {
                reference.position[axis] = 10 * uniform();
                reference.velocity[axis] = uniform();
                reference.acceleration[axis] = -uniform();
            }
            problem.start.rotor_thrust_n.assign(problem.robot.rotors.positions_m.size(), 5 + uniform());
            problem.start.controller_memory = {uniform(), -uniform(), 0, uniform(), 1e-9 * uniform(), 0, uniform()};
        }
        problem.plane = PlaneOfMotion({0.01 * uniform(), 0, 0}, 1e-3 * uniform());
        for (Obstacle& obstacle : problem.obstacles) {
            obstacle.rpy_rad = {1e-3 * uniform(), 1e-5 * uniform(), uniform()};
            obstacle.center_world_m[1] += uniform();
        }
        problem.obstacles.push_back(
            {"ball \"quoted\" \\ \n\t \xc3\xa4 # : - [", Sphere{0.1 + uniform()}, {0, 30 + uniform(), 2}, {}});
        problem.description = "two\nlines: {and} \"more\"";
        test::gains_of(problem.robot).max_tilt_rad = 0.1 + uniform();
        test::gains_of(problem.robot).position_kp = std::exp(uniform());
        problem.robot.rotors.time_constant_s = coin() ? 0 : 0.06 + 1e-3 * uniform();
        problem.robot.rotors.positions_m[0][1] += 1e-7 * uniform();
        if (coin()) {
            test::limit_arm(problem.robot, -3 - uniform(), 3 + uniform());
        }
        test::end_effector(problem.goal).direction_tolerance_rad = 3 + 0.1 * uniform();
        if (coin()) {
            test::end_effector(problem.goal).direction_rad = 7 * uniform();
        }
        if (coin()) {
            auto& pose = problem.goal.kind.emplace<ConfigurationGoal>();
            pose.arm_rad = 20 * uniform();
            pose.tolerance_rad = uniform();
            test::limit_arm(problem.robot, 0, 0);
            problem.robot.arm.is_limited = false;
        }
        if (auto* tip = std::get_if<EndEffectorGoal>(&problem.goal.kind); tip != nullptr && coin()) {
            tip->tolerance_x_m = 0.1 + uniform();
        } else if (auto* pose = std::get_if<ConfigurationGoal>(&problem.goal.kind); pose != nullptr && coin()) {
            pose->z_m = 2 + uniform();
            pose->tolerance_z_m = 0.1 + uniform();
        }
        if (coin()) {
            Goal other = problem.goal;
            other.hold_s = 1 + uniform();
            if (coin()) {
                problem.goals_before = {other, problem.goal};
            } else if (coin()) {
                Goal either;
                either.any_of = {problem.goal, other};
                problem.targets = {other, either, problem.goal};
                problem.goal = {};
                if (coin()) {
                    problem.return_to = test::configuration_goal(uniform(), 2 + uniform(), uniform());
                    problem.energy_budget_j = 1e5 * uniform();
                }
            } else {
                problem.goal = {};
                problem.goal.any_of = {other};
            }
        }
        problem.motion.max_arm_rate_rad_s = 1 + uniform();
        problem.planner.variant = coin() ? Variant::mp_arm : Variant::mp_arm_da;
        problem.planner.objective = coin() ? Objective::length : Objective::clearance;
        if (coin()) {
            problem.planner.objective.weight(Objective::energy) = uniform();
        }
        problem.planner.seed = static_cast<std::uint32_t>(random_.uniform(0, 0x1p32));
        problem.planner.max_iterations =
            coin() ? std::optional<std::uint64_t>{} : static_cast<std::uint64_t>(random_.integer(1, 1000000));
        problem.aero.ceiling = coin() ? EffectModel::sanchez_cuevas : EffectModel::none;
        if (problem.aero.ceiling.model == EffectModel::sanchez_cuevas) {
            problem.aero.ceiling.parameters[0] = 1 + uniform();
        }
        problem.aero.max_factor = 1 + uniform();
        if (coin()) {
            Uncertainty& own = problem.robot.uncertainty.emplace();
            own.mass_scale = Spread::of_sd(0.1 * uniform());
            own.pitch_bias_rad = coin() ? Spread::of_sd(0.05 * uniform()) : Spread::over(-0.1 * uniform(), 0.1);
            own.delay_s = coin() ? Spread() : Spread::of_factor(uniform(), 1 + uniform());
        }
        if (coin()) {
            Uncertainty& all = problem.uncertainty.emplace();
            all.ceiling_scale = Spread::of_sd(0.1 * uniform());
            all.center_of_mass_z_m = coin() ? Spread() : Spread::over(-uniform(), uniform());
            all.pitch_bias_rad = Spread::of_sd(0.1 * uniform());
            all.wind_x_m_s = Spread::of_sd(uniform());
            all.gust_length_x_m = 1 + uniform();
        }
        return problem;
    }

 private:
    double uniform() { return random_.uniform(0, 1); }
    bool coin() { return random_.integer(0, 1) == 0; }

    Random random_;
};

/// A value down to its bits.
std::string bits(const Value& value) {
    std::string text = std::to_string(value.index()) + ":";
    const auto add = [&text](double number) { text += std::to_string(std::bit_cast<std::uint64_t>(number)) + " "; };
    if (const auto* number = std::get_if<double>(&value)) {
        add(*number);
    } else if (const auto* numbers = std::get_if<std::vector<double>>(&value)) {
        for (const double each : *numbers) {
            add(each);
        }
    } else if (const auto* points = std::get_if<std::vector<Vector3>>(&value)) {
        for (const Vector3& point : *points) {
            for (const double each : point) {
                add(each);
            }
        }
    } else if (const auto* flag = std::get_if<bool>(&value)) {
        text += *flag ? "true" : "false";
    } else if (const auto* whole = std::get_if<std::uint64_t>(&value)) {
        text += std::to_string(*whole);
    } else if (const auto* words = std::get_if<std::string>(&value)) {
        text += *words;
    } else if (const auto* spread = std::get_if<Spread>(&value)) {
        text += std::to_string(static_cast<int>(spread->form)) + " ";
        add(spread->low);
        add(spread->high);
    }
    return text;
}

/// Every value of a problem that is in use, by key and bit by bit.
std::string bits(const Problem& problem) {
    std::string text;
    for_each_value(problem_parameters(), problem,
                   [&](const Parameter<Problem>& row, const std::string& key, std::size_t index) {
                       text += key + " " + bits(row.get(problem, index)) + "\n";
                   });
    return text;
}

}  // namespace

TEST_CASE("what is written is read again to the last bit") {
    const TestFolder folder;
    const Problem sound = folder.read();
    for (std::uint64_t seed = 0; seed < 200; ++seed) {
        const Problem problem = ProblemMaker(seed).varied(sound);
        const std::string yaml = effective_yaml(problem, folder / "");
        folder.write("effective.yaml", yaml);
        CAPTURE(seed, yaml);
        REQUIRE(folder.errors_of("effective.yaml") == "sound");
        const Problem again = read_problem(folder / "effective.yaml");
        REQUIRE(bits(again) == bits(problem));
        REQUIRE(effective_yaml(again, folder / "") == yaml);
    }
    // Switched off surface effects stay off.
    Problem problem = sound;
    problem.aero.enabled = false;
    folder.write("effective.yaml", effective_yaml(problem, folder / ""));
    CHECK_FALSE(read_problem(folder / "effective.yaml").aero.enabled);
}

TEST_CASE("the effective problem gives every number of its uncertainty, and those of its robot beside it") {
    const TestFolder folder;
    const Problem problem = folder.read(
        std::string(good_problem) + "uncertainty: {vehicle: {thrust_scale: {sd: 0.01}}}\n",
        std::string(good_robot) + "uncertainty: {vehicle: {mass_scale: {sd: 0.11}, thrust_scale: {sd: 0.07}}}\n");
    const std::string yaml = effective_yaml(problem, folder / "");
    const std::size_t own = yaml.find("\n  uncertainty:\n"), resolved = yaml.find("\nuncertainty:\n");
    REQUIRE(own < resolved);
    REQUIRE(resolved != std::string::npos);
    const std::string of_robot = yaml.substr(own, resolved - own), of_problem = yaml.substr(resolved);
    CHECK(of_robot.find("    mass_scale: {sd: 0.11}") == of_robot.rfind("mass_scale: {sd: 0.11}") - 4);
    CHECK(of_robot.find("thrust_scale: {sd: 0.07}") != std::string::npos);
    CHECK(of_problem.find("mass_scale: {sd: 0.11}") != std::string::npos);
    CHECK(of_problem.find("    thrust_scale: {sd: 0.01}") != std::string::npos);
    CHECK(of_problem.find("gyro_noise_rad_s: {sd: 0.015}") != std::string::npos);
    folder.write("effective.yaml", yaml);
    const Problem again = read_problem(folder / "effective.yaml");
    CHECK(bits(again) == bits(problem));
    CHECK(problem_sha256(again) == problem_sha256(problem));
    // What the robot says counts where the problem takes it over, and only there.
    Problem other = problem;
    other.robot.uncertainty.reset();
    CHECK(problem_sha256(other) == problem_sha256(problem));
    other.uncertainty->mass_scale = Spread::of_sd(0.12);
    CHECK(problem_sha256(other) != problem_sha256(problem));
}

TEST_CASE("the hash of a problem depends on its meaning, not on how it is written") {
    const TestFolder folder;
    const Problem problem = folder.read();
    const auto hash = [&folder](std::string_view text) { return problem_sha256(folder.read(text)); };
    CHECK(hash(edited(edited(good_problem, "arm_deg: 90", "arm_deg: 9.0e1"), "goal:", "# a\ngoal:")) ==
          problem_sha256(problem));
    CHECK(hash(edited(good_problem, "arm_deg: 90", "arm_deg: 90.00000000000001")) != problem_sha256(problem));
    CHECK(problem_sha256(problem).size() == 64);
}

TEST_CASE("the hash of a problem forgets walls that do nothing, and no others") {
    const TestFolder folder;
    Problem problem = folder.read();
    const std::string nothing = problem_sha256(problem);
    problem.aero.wall.decay_radii = 2;
    CHECK(problem_sha256(problem) == nothing);
    problem.aero.wall.moment = 0.03;
    REQUIRE_FALSE(problem.robot.arm.wash);
    Problem in_wash = problem;
    in_wash.robot.arm.wash.emplace();
    CHECK(problem_sha256(in_wash) != nothing);
    const std::string with_walls = problem_sha256(problem);
    CHECK(with_walls != nothing);
    problem.aero.wall.decay_radii = 1;
    CHECK(problem_sha256(problem) != with_walls);
}

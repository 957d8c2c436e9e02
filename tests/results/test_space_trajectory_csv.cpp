#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "../support/csv_rows.hpp"
#include "downwash/problems/space_problem_model.hpp"
#include "downwash/problems/space_problem_reader.hpp"
#include "downwash/results/space_solution_file.hpp"
#include "downwash/results/space_trajectory_csv.hpp"
#include "downwash/simulation/space_effect.hpp"
#include "space_independent_plant.hpp"

using namespace downwash;
using test::rows_of;

namespace {

using Row = std::map<std::string, std::string>;

double number(const Row& row, const std::string& column) {
    return std::strtod(row.at(column).c_str(), nullptr);
}

std::vector<double> numbers(const Row& row, const std::vector<std::string>& columns) {
    std::vector<double> values;
    for (const std::string& column : columns) {
        values.push_back(number(row, column));
    }
    return values;
}

/// "joint_1_rad", "joint_2_rad"... of so many.
std::vector<std::string> numbered(const std::string& before, std::size_t count, const std::string& after) {
    std::vector<std::string> names;
    for (std::size_t i = 1; i <= count; ++i) {
        names.push_back(before + std::to_string(i) + after);
    }
    return names;
}

std::vector<std::string> joined(std::vector<std::string> names, const std::vector<std::string>& more) {
    names.insert(names.end(), more.begin(), more.end());
    return names;
}

test::SpaceVector state_in(const Row& row, std::size_t joints, std::size_t rotors) {
    test::SpaceVector state;
    state.q = numbers(row, joined({"x_m", "y_m", "z_m", "qw", "qx", "qy", "qz"}, numbered("joint_", joints, "_rad")));
    state.u = numbers(row, joined({"vx_m_s", "vy_m_s", "vz_m_s", "wx_rad_s", "wy_rad_s", "wz_rad_s"},
                                  numbered("joint_", joints, "_rate_rad_s")));
    state.energy_j = number(row, "energy_j");
    state.lag_n = numbers(row, numbered("rotor_", rotors, "_lag_n"));
    return state;
}

/// The shipped problem without drag, which the integration here does not know.
SpaceProblem around_a_girder() {
    SpaceProblem problem = read_space_problem(DOWNWASH_PROBLEMS "/space/around_a_girder.yaml");
    SpacePlant& plant = problem.robot.plant;
    plant.drag = {};
    for (SpaceLink& link : plant.links) {
        link.drag = {};
    }
    return problem;
}

}  // namespace

TEST_CASE("A trajectory in space can be integrated again from its rows") {
    const SpaceProblem problem = around_a_girder();
    const SpaceSolution given = read_solution(DOWNWASH_PROBLEMS "/space/around_a_girder.json", problem);
    const SpaceFlight flight = SpaceProblemModel(problem).execute(*given.plan);
    CHECK(flight.outcome == Outcome::ok);
    const std::vector<Row> rows = rows_of(trajectory_csv(flight));
    REQUIRE(rows.size() == flight.rows.size());
    REQUIRE(rows.size() > 2000);
    const std::size_t joints = 3, rotors = 6;
    const auto scene = std::make_shared<const Scene>(problem.obstacles);
    simulation::DirectSpaceEffect effect(scene, problem.aero, problem.robot);
    double strongest = 1;
    const auto factor = [&](std::size_t rotor, const Vector3& hub_m, double sine) {
        const auto level = effect.at_rotor(static_cast<int>(rotor), {hub_m[0], hub_m[1], hub_m[2]});
        const double below = level.all - level.above;
        const double half = problem.aero.tilt_loss.ground * sine * sine;
        strongest = std::max(strongest, level.all);
        return level.above + (below > 0 ? below * below / (below + half) : below);
    };
    double worst = 0;
    for (std::size_t k = 0; k + 1 < rows.size(); k += 7) {  // as long as all rows would take
        const test::HeldSpaceCommand command{numbers(rows[k], numbered("rotor_", rotors, "_cmd_n")),
                                             numbers(rows[k], numbered("joint_", joints, "_torque_nm"))};
        const auto next = integrated(problem.robot, factor, state_in(rows[k], joints, rotors), command, 0.01, 4);
        const auto written = state_in(rows[k + 1], joints, rotors);
        const auto compare = [&worst](const std::vector<double>& a, const std::vector<double>& b) {
            for (std::size_t i = 0; i < a.size(); ++i) {
                worst = std::max(worst, std::abs(a[i] - b[i]) / std::max(1.0, std::abs(b[i])));
            }
        };
        compare(next.q, written.q);
        compare(next.u, written.u);
        compare(next.lag_n, written.lag_n);
        compare({next.energy_j}, {written.energy_j});
    }
    CHECK(worst < 1e-6);
    CHECK(strongest > 1.01);
}

TEST_CASE("The columns of a trajectory in space are those of the page, and numbers read back as the very same") {
    SpaceFlight flight;
    flight.joints = 2;
    flight.rotor_count = 2;
    flight.rows.resize(1);
    SpaceFlightRow& row = flight.rows[0];
    row.t_s = 0.1 + 0.2;
    row.motion.position_m = {1e-310, -0.0, 1.0 / 3};
    row.motion.attitude = {0.5, -0.5, 0.5, 0.5};
    row.motion.joint_rates_rad_s[1] = 2.0 / 3;
    row.reference.position[space::first_joint + 1] = 1.0 / 7;
    row.joint_torque_nm[1] = 5.0 / 7;
    row.rotor_factor[0] = 1.25;
    row.rotor_factor[1] = 1.125;
    row.energy_j = 1e22 / 3;
    row.clearance_m = std::numeric_limits<double>::infinity();
    std::string text = trajectory_csv(flight);
    CHECK(text.substr(0, text.find('\n')) ==
          "t_s,ref_x_m,ref_y_m,ref_z_m,ref_yaw_rad,ref_joint_1_rad,ref_joint_2_rad,x_m,y_m,z_m,qw,qx,qy,qz,"
          "joint_1_rad,joint_2_rad,vx_m_s,vy_m_s,vz_m_s,wx_rad_s,wy_rad_s,wz_rad_s,joint_1_rate_rad_s,"
          "joint_2_rate_rad_s,joint_1_torque_nm,joint_2_torque_nm,aero_factor_min,aero_factor_max,clearance_m,"
          "ee_x_m,ee_y_m,ee_z_m,power_w,energy_j,rotor_1_cmd_n,rotor_1_aero_factor,rotor_2_cmd_n,"
          "rotor_2_aero_factor");
    const Row read = rows_of(text).at(0);
    CHECK(read.at("t_s") == "0.30000000000000004");
    CHECK(number(read, "x_m") == 1e-310);
    CHECK(read.at("y_m") == "-0");
    CHECK(number(read, "qx") == -0.5);
    CHECK(number(read, "joint_2_rate_rad_s") == 2.0 / 3);
    CHECK(number(read, "ref_joint_2_rad") == 1.0 / 7);
    CHECK(number(read, "joint_2_torque_nm") == 5.0 / 7);
    CHECK(read.at("aero_factor_min") == "1.125");
    CHECK(read.at("aero_factor_max") == "1.25");
    CHECK(read.at("clearance_m").empty());
    CHECK(number(read, "energy_j") == 1e22 / 3);
    flight.has_rotor_lag = true;
    text = trajectory_csv(flight);
    CHECK(text.substr(0, text.find('\n')).ends_with("rotor_2_cmd_n,rotor_2_lag_n,rotor_2_aero_factor"));
    const NumberTable table = read_number_table(text, "trajectory.csv", {"qw"});
    CHECK(csv_text(table) == text);
}

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "../support/csv_rows.hpp"
#include "../support/test_robot.hpp"
#include "downwash/planner/solve.hpp"
#include "downwash/problems/problem_reader.hpp"
#include "downwash/results/trajectory_csv.hpp"
#include "independent_plant.hpp"

using namespace downwash;
using test::rows_of;

namespace {

using Row = std::map<std::string, std::string>;

double number(const Row& row, const std::string& column) {
    return std::strtod(row.at(column).c_str(), nullptr);
}

test::PlantVector state_in(const Row& row, std::size_t rotors, bool lags) {
    test::PlantVector state;
    for (const char* column :
         {"x_m", "z_m", "pitch_rad", "arm_rad", "vx_m_s", "vz_m_s", "pitch_rate_rad_s", "arm_rate_rad_s", "energy_j"}) {
        state.push_back(number(row, column));
    }
    for (std::size_t i = 1; i <= rotors; ++i) {
        state.push_back(lags ? number(row, "rotor_" + std::to_string(i) + "_lag_n") : 0);
    }
    return state;
}

test::HeldCommand command_in(const Row& row, std::size_t rotors) {
    test::HeldCommand command;
    for (std::size_t i = 1; i <= rotors; ++i) {
        command.rotor_n.push_back(number(row, "rotor_" + std::to_string(i) + "_cmd_n"));
    }
    command.arm_torque_nm = number(row, "arm_torque_nm");
    return command;
}

/// Integrates the plant anew from every row and checks that it comes to the next: any integrator does that is fine
/// enough where a disc passes an edge.
void check_that_rows_follow(const Problem& problem, const std::vector<Row>& rows) {
    const auto model = make_flight_model(problem);
    const std::size_t rotors = problem.robot.rotors.positions_m.size();
    const bool lags = problem.robot.rotors.time_constant_s > 0;
    const auto factor = [&](std::size_t rotor, double x_m, double z_m, double pitch_rad) {
        const auto level = model->sided_factor(static_cast<int>(rotor), x_m, z_m);
        const double below = level.all - level.above;
        const double half = problem.aero.tilt_loss.ground * std::pow(std::sin(pitch_rad), 2);
        return level.above + (below > 0 ? below * below / (below + half) : below);
    };
    double worst = 0;
    for (std::size_t k = 0; k + 1 < rows.size(); ++k) {
        const auto next = integrated(problem.robot, factor, state_in(rows[k], rotors, lags),
                                     command_in(rows[k], rotors), 1 / problem.robot.controller.rate_hz, 200);
        const auto written = state_in(rows[k + 1], rotors, lags);
        for (std::size_t i = 0; i < written.size(); ++i) {
            worst = std::max(worst, std::abs(next[i] - written[i]) / std::max(1.0, std::abs(written[i])));
        }
    }
    CHECK(worst < 1e-6);
}

/// A flight up to the deck of the bridge, one rotor radius below it, with a swing of the arm.
Execution flight_to_deck(const Problem& problem) {
    const auto model = make_flight_model(problem);
    const std::vector<ReferenceKnot> knots{
        {0, at_rest(problem.start.at)}, {400, at_rest({-9.5, 9.4, 0.6})}, {800, at_rest({-8.5, 9.7, 1.2})}};
    return execute(*model, start_state(*model, problem.start), knots, problem.goal, true);
}

Problem bridge() {
    Problem problem = read_problem(DOWNWASH_PROBLEMS "/bridge_inspection.yaml");
    problem.robot = test::test_robot();  // without drag, which the integration here does not know
    problem.uncertainty.reset();
    return problem;
}

}  // namespace

TEST_CASE("A trajectory can be integrated again from its rows") {
    Problem problem = bridge();
    const std::string vehicle =
        GENERATE("as shipped", "rotors that lag", "a joint beside the centre of mass, a heading");
    CAPTURE(vehicle);
    if (vehicle == "rotors that lag") {
        problem.robot.rotors.time_constant_s = 0.03;
    } else if (vehicle != "as shipped") {
        problem.robot.arm.joint_x_m = 0.1;
        problem.robot.arm.joint_z_m = -0.05;
        problem.plane = PlaneOfMotion({0.3, 0.1, -0.1}, 0.05);
    }
    const Execution flight = flight_to_deck(problem);
    CAPTURE(name_of(flight.outcome));
    const std::vector<Row> rows = rows_of(trajectory_csv(flight));
    REQUIRE(rows.size() > 600);
    CHECK(number(rows.back(), "aero_factor_max") > 1.02);
    check_that_rows_follow(problem, rows);
}

TEST_CASE("A solved flight past walkway and deck can be integrated again") {
    Problem problem = bridge();
    problem.planner.max_iterations = 150;
    const Solution solution = solve(problem);
    REQUIRE(solution.execution);
    check_that_rows_follow(problem, rows_of(trajectory_csv(*solution.execution)));
}

TEST_CASE("The numbers of a trajectory read back as the very same") {
    Execution execution;
    execution.rotor_count = 2;
    execution.rows.resize(1);
    FlightRow& flown = execution.rows[0];
    flown.t_s = 0.1 + 0.2;
    flown.q[0] = 1e-310;
    flown.q[1] = -0.0;
    flown.energy_j = 1e22 / 3;
    flown.thrust_command_n = 1.0 / 3;
    flown.pitch_torque_command_nm = 2.0 / 3;
    flown.thrust_n = 4.0 / 3;
    flown.pitch_torque_nm = 5.0 / 3;
    flown.rotor_factor[0] = 1.25;
    flown.rotor_factor[1] = 1.125;
    flown.clearance_m = std::numeric_limits<double>::infinity();
    const std::string text = trajectory_csv(execution);
    const Row row = rows_of(text).at(0);
    CHECK(row.at("t_s") == "0.30000000000000004");
    CHECK(number(row, "x_m") == 1e-310);
    CHECK(row.at("z_m") == "-0");
    CHECK(number(row, "energy_j") == 1e22 / 3);
    CHECK(number(row, "thrust_cmd_n") == 1.0 / 3);
    CHECK(number(row, "pitch_torque_cmd_nm") == 2.0 / 3);
    CHECK(number(row, "thrust_n") == 4.0 / 3);
    CHECK(number(row, "pitch_torque_nm") == 5.0 / 3);
    CHECK(row.at("aero_factor_min") == "1.125");
    CHECK(row.at("aero_factor_max") == "1.25");
    CHECK(row.at("clearance_m").empty());
    CHECK(row.count("rotor_1_lag_n") == 0);
    CHECK(text.substr(0, text.find('\n'))
              .ends_with(",energy_j,rotor_1_cmd_n,rotor_1_aero_factor,rotor_2_cmd_n,rotor_2_aero_factor"));
    execution.has_rotor_lag = true;
    CHECK(rows_of(trajectory_csv(execution)).at(0).at("rotor_2_lag_n") == "0");
}

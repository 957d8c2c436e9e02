// Plans from C++ with an installed Downwash: a problem without any file, a stop token, progress, and the flight.

#include <cstdio>
#include <stop_token>

#include <downwash/planner/solve.hpp>

int main() {
    using namespace downwash;
    Problem problem;
    Robot& robot = problem.robot;
    robot.name = "quad-with-arm";
    robot.multirotor = {.mass_kg = 4.5, .pitch_inertia_kg_m2 = 0.20};
    robot.body = {{Box{{1.04, 1.04, 0.22}}, {0, 0, 0}}};
    robot.rotors.radius_m = 0.1905;
    robot.rotors.positions_m = {{0.32, 0.32, 0.06}, {0.32, -0.32, 0.06}, {-0.32, 0.32, 0.06}, {-0.32, -0.32, 0.06}};
    robot.rotors.max_thrust_n = 28;
    robot.rotors.power_coefficient_w_n1p5 = 3.15;
    robot.arm = {.length_m = 1.2, .mass_kg = 0.45, .center_of_mass_m = 0.72, .inertia_kg_m2 = 0.06, .radius_m = 0.03};
    robot.arm.max_torque_nm = 12;
    ModelInversion gains{
        .position_kp = 2, .position_kd = 2.6, .position_ki = 0.4, .attitude_kp = 8, .attitude_rate_kp = 20};
    gains.arm_kp = 30;
    gains.arm_kd = 11;
    robot.controller.law = gains;

    problem.bounds = {.x_low_m = -6, .x_high_m = 6, .z_low_m = 0.5, .z_high_m = 5};
    problem.obstacles = {{"ground", Box{{30, 20, 1}}, {0, 0, -0.5}}, {"ceiling", Box{{30, 8, 1}}, {0, 0, 5.5}}};
    problem.start = Start::resting_at({-4, 2, 1.57});
    problem.goal.kind = EndEffectorGoal{.x_m = 3, .z_m = 4.8, .direction_rad = {}};
    problem.planner.max_iterations = 100;

    std::stop_source interrupt;  // a mission planner would call interrupt.request_stop()
    SolveOptions options;
    options.stop = interrupt.get_token();
    options.on_progress = [](const Progress& p) { std::printf("%.1f s: %zu nodes\n", p.wall_s, std::size_t(p.nodes)); };
    const Solution solution = solve(problem, options);
    if (solution.status != Status::solved || !solution.execution) {
        return 1;
    }
    const Execution& flight = *solution.execution;
    const FlightRow& end = flight.rows.back();
    std::printf("%zu knots, %.1f s, %.0f J, end effector at (%.2f, %.2f) m: %s\n", solution.plan->reference.size(),
                flight.duration_s, flight.energy_j, end.end_effector_x_m, end.end_effector_z_m,
                flight.outcome == Outcome::ok ? "held at the goal" : "failed");
    return flight.outcome == Outcome::ok ? 0 : 3;
}

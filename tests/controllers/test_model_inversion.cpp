#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "../support/random.hpp"
#include "../support/test_robot.hpp"
#include "downwash/controllers/configuration.hpp"
#include "downwash/controllers/model_inversion_control.hpp"

using namespace downwash;
using namespace downwash::test;

namespace {

using Memory = ModelInversion::Memory<double>;
using Step = ModelInversion::Step<double>;

constexpr double tick_s = 0.01;

/// A robot whose arm is not at its centre of mass, so that nothing cancels by luck.
Robot offset_robot() {
    Robot robot = test_robot();
    robot.arm.joint_x_m = 0.1;
    robot.arm.joint_z_m = -0.07;
    gains_of(robot).attitude_rate_ki = 3;
    gains_of(robot).arm_ki = 5;
    return robot;
}

constexpr double still[4] = {0, 0, 0, 0};

/// One control step before any limit.
Step demanded(const ModelInversion& law, const PlantModel& model, const double (&q)[4], const double (&u)[4],
              const Memory& memory, const ReferencePoint& reference) {
    dynamics::PlantState<double> seen{};
    std::copy(q, q + 4, seen.q);
    std::copy(u, u + 4, seen.u);
    return law.demanded(model, seen, dynamics::motion_at(model, q, u), memory, reference, tick_s);
}

/// Somewhere in a lively flight.
struct Case {
    double q[4];
    double u[4];
    Memory memory;
    ReferencePoint reference;
    explicit Case(Random& random) {
        for (int i = 0; i < 4; ++i) {
            q[i] = random.uniform(-0.6, 0.6);
            u[i] = random.uniform(-1, 1);
        }
        memory = {{random.uniform(-1, 1), random.uniform(-1, 1)},
                  random.uniform(-0.3, 0.3),
                  random.uniform(-0.3, 0.3),
                  random.uniform(-0.4, 0.4),
                  random.uniform(-1, 1),
                  random.uniform(-1, 1)};
        for (int i = 0; i < 3; ++i) {
            reference.position[i] = q[i == 2 ? 3 : i] + random.uniform(-0.5, 0.5);
            reference.velocity[i] = random.uniform(-1, 1);
            reference.acceleration[i] = random.uniform(-1, 1);
        }
    }
    [[nodiscard]] Step step(const PlantModel& model, const ModelInversion& law) const {
        return demanded(law, model, q, u, memory, reference);
    }
};

/// What the plant does under a demand that is met in full.
void accelerations(const PlantModel& model, const double (&q)[4], const double (&u)[4], const Step& step,
                   double (&du)[4]) {
    const auto a = dynamics::attitude(model, q[2], q[3]);
    const controllers::Demand<double>& demand = step.demand;
    const double force[4] = {demand.thrust_n * std::sin(q[2]), demand.thrust_n * std::cos(q[2]), demand.pitch_torque_nm,
                             controllers::joint_torque(model, dynamics::motion_at(model, q, u), demand.arm_acceleration,
                                                       demand.thrust_n, demand.pitch_torque_nm)};
    dynamics::forward_dynamics(model, dynamics::equations_of_motion(model, a, u), force, du);
}

double limited(double value, double limit) {
    return std::clamp(value, -limit, limit);
}

double wanted_arm_acceleration(const ModelInversion& g, const Case& c) {
    return c.reference.acceleration[2] + g.arm_kd * (c.reference.velocity[2] - c.u[3]) +
           g.arm_kp * (c.reference.position[2] - c.q[3]) +
           limited(g.arm_ki * c.memory.arm_integral, g.arm_integral_limit_rad_s2);
}

double wanted_acceleration(const ModelInversion& g, const Case& c, int axis) {
    const bool is_height = axis == 1;
    return c.reference.acceleration[axis] +
           (is_height && g.height_kd ? *g.height_kd : g.position_kd) * (c.reference.velocity[axis] - c.u[axis]) +
           (is_height && g.height_kp ? *g.height_kp : g.position_kp) * (c.reference.position[axis] - c.q[axis]) +
           limited((is_height && g.height_ki ? *g.height_ki : g.position_ki) * c.memory.position_integral[axis],
                   g.position_integral_limit_m_s2);
}

}  // namespace

TEST_CASE("In hover the demand is the weight and the arm's gravity torque, and nothing needs remembering") {
    const auto robot = test_robot();
    const PlantModel model = plant_of(robot);
    for (const double arm : {0.0, 0.7, quarter_turn, -2.0}) {
        const double q[4] = {1, 2, 0, arm};
        const Step step = demanded(gains_of(robot), model, q, still, ModelInversion::rested(0.0), at_rest({1, 2, arm}));
        const double gravity_torque_nm = -0.45 * 9.80665 * 0.72 * std::cos(arm);
        CHECK(step.demand.thrust_n == Approx(4.95 * 9.80665).epsilon(1e-14));
        CHECK(controllers::joint_torque(model, dynamics::motion_at(model, q, still), step.demand.arm_acceleration,
                                        step.demand.thrust_n, step.demand.pitch_torque_nm) ==
              Approx(gravity_torque_nm).epsilon(1e-14).margin(1e-14));
        CHECK(step.demand.pitch_torque_nm == Approx(gravity_torque_nm).epsilon(1e-14).margin(1e-14));
        CHECK(step.integrated.pitch_reference_rad == Approx(0).margin(1e-15));
        CHECK(step.integrated.position_integral[0] == 0);
        CHECK(step.integrated.position_integral[1] == 0);
        CHECK(step.integrated.arm_integral == 0);
        CHECK(step.integrated.pitch_rate_integral == Approx(0).margin(1e-15));
    }
}

TEST_CASE("The demand produces the wanted pitch and arm accelerations exactly") {
    Random random(1);
    Robot robot = offset_robot();
    const PlantModel model = plant_of(robot);
    double worst = 0;
    for (int i = 0; i < 20'000; ++i) {
        gains_of(robot).rate_feed_forward = i % 2 == 0;
        const ModelInversion& g = gains_of(robot);
        const Case c(random);
        const Step step = c.step(model, g);

        // The pitch loop once more, from the pitch reference on.
        const double reference = step.integrated.pitch_reference_rad;
        const double raw_rate = (reference - c.memory.pitch_reference_rad) / tick_s;
        const double filtered = (g.pitch_rate_filter_s * c.memory.pitch_reference_rate + tick_s * raw_rate) /
                                (g.pitch_rate_filter_s + tick_s);
        const double rate_reference = filtered + g.attitude_kp * (reference - c.q[2]);
        double v5 = g.attitude_rate_kp * (rate_reference - c.u[2]) + g.attitude_rate_ki * c.memory.pitch_rate_integral;
        if (g.rate_feed_forward) {
            v5 += (rate_reference - c.memory.rate_reference) / tick_s;
        }
        double du[4];
        accelerations(model, c.q, c.u, step, du);
        worst = std::max({worst, std::abs(du[2] - v5) / std::max(1.0, std::abs(v5)),
                          std::abs(du[3] - wanted_arm_acceleration(g, c)) / 10});
        worst = std::max({worst, std::abs(step.integrated.pitch_reference_rate - filtered),
                          std::abs(step.integrated.rate_reference - rate_reference)});
    }
    CHECK(worst < 1e-10);
}

TEST_CASE("Once the vehicle has the pitch that is asked for, it accelerates exactly as wanted") {
    Random random(2);
    Robot robot = offset_robot();
    gains_of(robot).attitude_rate_kp = 0;  // the force is worked out for a pitch that does not accelerate
    gains_of(robot).attitude_rate_ki = 0;
    const PlantModel model = plant_of(robot);
    double worst = 0;
    int reached = 0;
    for (int i = 0; i < 2000; ++i) {
        Case c(random);
        Step step = c.step(model, gains_of(robot));
        for (int k = 0; k < 200; ++k) {
            c.q[2] = step.integrated.pitch_reference_rad;
            step = c.step(model, gains_of(robot));
        }
        if (std::abs(c.q[2]) > 0.99 * gains_of(robot).max_tilt_rad) {
            continue;  // clipped
        }
        ++reached;
        double du[4];
        accelerations(model, c.q, c.u, step, du);
        for (int axis = 0; axis < 2; ++axis) {
            worst = std::max(worst, std::abs(du[axis] - wanted_acceleration(gains_of(robot), c, axis)));
        }
    }
    CHECK(reached > 1000);
    CHECK(worst < 1e-9);
}

TEST_CASE("The pitch reference leans towards the target and never beyond the greatest tilt") {
    const auto robot = test_robot();
    const PlantModel model = plant_of(robot);
    const double q[4] = {0, 2, 0, quarter_turn};
    const auto pitch_reference = [&](double x_m, double z_m) {
        return demanded(gains_of(robot), model, q, still, ModelInversion::rested(0.0),
                        at_rest({x_m, z_m, quarter_turn}))
            .integrated.pitch_reference_rad;
    };
    for (const double side : {1, -1}) {
        CHECK(pitch_reference(side * 0.1, 2) == Approx(side * std::atan2(0.1 * 2.0, 9.80665)));
        CHECK(pitch_reference(side * 100, 2) == side * gains_of(robot).max_tilt_rad);
    }
    // Asked to dive faster than it can fall, it keeps its head up: f_min stands in for the downward force.
    CHECK(pitch_reference(0.1, -100) == Approx(std::atan2(0.1 * 2.0, 0.2 * 9.80665)));
}

TEST_CASE("Integrators add error over time and stop where their limit can use no more") {
    Robot robot = offset_robot();
    const ModelInversion& g = gains_of(robot);
    const PlantModel model = plant_of(robot);
    const double q[4] = {0, 2, 0, 0.5};
    const ReferencePoint far = at_rest({0.4, 1.7, 0.8});
    Memory memory = demanded(g, model, q, still, ModelInversion::rested(0.0), far).integrated;
    CHECK(memory.position_integral[0] == Approx(0.4 * tick_s));
    CHECK(memory.position_integral[1] == Approx(-0.3 * tick_s));
    CHECK(memory.arm_integral == Approx(0.3 * tick_s));
    for (int i = 0; i < 10'000; ++i) {
        memory = demanded(g, model, q, still, memory, far).integrated;
    }
    CHECK(memory.position_integral[0] == g.position_integral_limit_m_s2 / g.position_ki);
    CHECK(memory.position_integral[1] == -g.position_integral_limit_m_s2 / g.position_ki);
    CHECK(memory.arm_integral == g.arm_integral_limit_rad_s2 / g.arm_ki);
    CHECK(std::abs(memory.pitch_rate_integral) <= g.attitude_integral_limit_rad_s2 / g.attitude_rate_ki);

    // Wound up to the limit, the integral leaves it with the first error of the other sign.
    const auto back = demanded(g, model, q, still, memory, at_rest({-0.4, 2, 0.5}));
    CHECK(back.integrated.position_integral[0] ==
          Approx(g.position_integral_limit_m_s2 / g.position_ki - 0.4 * tick_s));
}

TEST_CASE("An integrator without gain stays where it is") {
    const auto robot = test_robot();
    const PlantModel model = plant_of(robot);
    Random random(3);
    const Case c(random);
    const Step step = c.step(model, gains_of(robot));
    CHECK(step.integrated.arm_integral == c.memory.arm_integral);
    CHECK(step.integrated.pitch_rate_integral == c.memory.pitch_rate_integral);
    CHECK(step.integrated.position_integral[0] != c.memory.position_integral[0]);
}

TEST_CASE("A frozen step keeps all integrals but goes on following the pitch reference") {
    const Robot robot = offset_robot();
    const PlantModel model = plant_of(robot);
    Random random(4);
    for (int i = 0; i < 100; ++i) {
        const Case c(random);
        const Step step = c.step(model, gains_of(robot));
        CHECK(step.frozen.position_integral[0] == c.memory.position_integral[0]);
        CHECK(step.frozen.position_integral[1] == c.memory.position_integral[1]);
        CHECK(step.frozen.pitch_rate_integral == c.memory.pitch_rate_integral);
        CHECK(step.frozen.arm_integral == c.memory.arm_integral);
        CHECK(step.frozen.pitch_reference_rad == step.integrated.pitch_reference_rad);
        CHECK(step.frozen.pitch_reference_rate == step.integrated.pitch_reference_rate);
        CHECK(step.frozen.rate_reference == step.integrated.rate_reference);
    }
}

TEST_CASE("A clipped tilt stops the integrals of x and z, and of nothing else") {
    const Robot robot = offset_robot();
    const PlantModel model = plant_of(robot);
    const double q[4] = {0, 2, 0, 0.5};
    Memory memory = ModelInversion::rested(0.0);
    memory.position_integral[0] = 0.2;
    memory.position_integral[1] = -0.1;
    const auto integrated = [&](double x_m, double z_m) {
        return demanded(gains_of(robot), model, q, still, memory, at_rest({x_m, z_m, 0.8})).integrated;
    };
    // Sideways beyond the greatest tilt; down faster than it can fall.
    for (const Memory& clipped : {integrated(100, 1.7), integrated(-100, 1.7), integrated(0.1, -100)}) {
        CHECK(clipped.position_integral[0] == 0.2);
        CHECK(clipped.position_integral[1] == -0.1);
        CHECK(clipped.arm_integral == Approx(0.3 * tick_s));
    }
    const Memory within = integrated(0.1, 1.7);
    CHECK(within.position_integral[0] == Approx(0.2 + 0.1 * tick_s));
    CHECK(within.position_integral[1] == Approx(-0.1 - 0.3 * tick_s));
}

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>

#include "../support/mujoco_space.hpp"
#include "../support/space_robots.hpp"
#include "downwash/simulation/space_flight.hpp"
#include "downwash/simulation/space_loop_of.hpp"

// Closed loops in space in a general-purpose rigid-body simulator. Ours are the control law, the surface effects at a
// point, and the reference. Bodies, rotor lag, levers and time integration are MuJoCo's; air drag and the tilt of
// rotors near surfaces are written once more here, from docs/model.md.

using namespace downwash;
using namespace downwash::test;

namespace {

constexpr double ground_tilt_loss = 0.37;

/// K that differs from place to place, by side.
class Slope final : public simulation::SpaceEffect {
 public:
    SidedFactor<double> at_rotor(int /*rotor*/, const dynamics::LaneVector<double>& hub_m) override {
        const double above = 1 + 0.1 / (1 + (3 - hub_m.z) * (3 - hub_m.z) + hub_m.x * hub_m.x);
        const double below = 0.05 / (1 + hub_m.z * hub_m.z + hub_m.y * hub_m.y);
        return {above + below, above};
    }
};

/// What MuJoCo does not know of a vehicle in the air: forces that it asks for at every stage of its integrator.
class AirForces {
 public:
    AirForces(const SpaceRobot& robot, simulation::SpaceEffect* effect) : robot_(robot), effect_(effect) {
        current = this;
        mjcb_control = [](const mjModel* m, mjData* d) { current->apply(m, d); };
    }
    ~AirForces() {
        mjcb_control = nullptr;
        current = nullptr;
    }
    AirForces(const AirForces&) = delete;
    AirForces& operator=(const AirForces&) = delete;

 private:
    using Vector = std::array<mjtNum, 3>;
    static constexpr int multirotor = 1, first_link = 2;  // MuJoCo's bodies

    void apply(const mjModel* m, mjData* d) const {
        mju_zero(d->qfrc_applied, m->nv);
        if (effect_ != nullptr) {
            apply_effects(m, d);
        }
        const mjtNum* center = d->xpos + 3 * multirotor;
        const Vector at{center[0], center[1], center[2]};
        push(m, d, drag_of(robot_.plant.drag, velocity_at(m, d, multirotor, at), 1), at, multirotor);
        for (std::size_t i = 0; i < robot_.plant.links.size(); ++i) {
            apply_link_drag(m, d, i);
        }
    }

    /// MuJoCo's own motors give the free-air thrust of each rotor along its axis; surfaces add K - 1 of it.
    void apply_effects(const mjModel* m, mjData* d) const {
        for (int i = 0; i < static_cast<int>(robot_.plant.rotors.size()); ++i) {
            const mjtNum* hub = d->site_xpos + 3 * i;
            const mjtNum* axes = d->site_xmat + 9 * i;
            const auto level = effect_->at_rotor(i, {hub[0], hub[1], hub[2]});
            const double below = level.all - level.above;
            const double half = ground_tilt_loss * (1 - axes[8] * axes[8]);  // sin^2 of the axis' tilt
            const double more_n = (level.above - 1 + below * below / (below + half)) * d->act[i];
            push(m, d, {more_n * axes[2], more_n * axes[5], more_n * axes[8]}, {hub[0], hub[1], hub[2]}, multirotor);
        }
    }

    /// Across the link only, at the two points of Gauss.
    void apply_link_drag(const mjModel* m, mjData* d, std::size_t i) const {
        const SpacePlant& plant = robot_.plant;
        const int body = first_link + static_cast<int>(i);
        const Vector3& way = i + 1 < plant.links.size() ? plant.links[i + 1].joint_m : plant.end_effector_m;
        const mjtNum* joint = d->xpos + 3 * body;
        const mjtNum* axes = d->xmat + 9 * body;
        Vector along{};
        mju_mulMatVec(along.data(), axes, way.data(), 3, 3);
        const double length_m = std::sqrt(dot(way, way));
        for (const double share : {0.5 - std::sqrt(1 / 12.0), 0.5 + std::sqrt(1 / 12.0)}) {
            Vector point{}, across{};
            for (std::size_t k = 0; k < 3; ++k) {
                point[k] = joint[k] + share * along[k];
            }
            const Vector v = velocity_at(m, d, body, point);
            const double slide = (v[0] * along[0] + v[1] * along[1] + v[2] * along[2]) / (length_m * length_m);
            for (std::size_t k = 0; k < 3; ++k) {
                across[k] = v[k] - slide * along[k];
            }
            push(m, d, drag_of(plant.links[i].drag, across, 0.5), point, body);
        }
    }

    static Vector drag_of(const DragParameters& drag, const Vector& v, double share) {
        const double resistance = -share * (drag.linear_n_s_m + drag.quadratic_n_s2_m2 * std::hypot(v[0], v[1], v[2]));
        return {resistance * v[0], resistance * v[1], resistance * v[2]};
    }

    static void push(const mjModel* m, mjData* d, const Vector& force_n, const Vector& point, int body) {
        const mjtNum no_torque[3] = {};
        mj_applyFT(m, d, force_n.data(), no_torque, point.data(), body, d->qfrc_applied);
    }

    /// Velocity of a point of a body, from its Jacobian.
    static Vector velocity_at(const mjModel* m, mjData* d, int body, const Vector& point) {
        std::array<mjtNum, 3 * (6 + max_joints)> jacobian{};
        Vector v{};
        mj_jac(m, d, jacobian.data(), nullptr, point.data(), body);
        for (std::size_t row = 0; row < 3; ++row) {
            v[row] = mju_dot(jacobian.data() + static_cast<std::size_t>(m->nv) * row, d->qvel, m->nv);
        }
        return v;
    }

    static inline const AirForces* current = nullptr;  // MuJoCo's callbacks carry no context

    const SpaceRobot& robot_;
    simulation::SpaceEffect* effect_;
};

struct Difference {
    double position_m = 0, attitude = 0, joint_rad = 0;
};

/// Flies ten seconds of the plan in MuJoCo, in closed loop, beside a flight of ours.
template <int n>
Difference difference_from_mujoco(const SpaceRobot& robot, int steps_per_tick, bool has_effects) {
    const SpacePlan plan = space_plan(n).beginning(1000);
    const SpaceMotion start = motion_at_rest(plan.reference.front().point);
    Slope slope;
    SpaceFlightSettings settings;
    settings.effect = &slope;
    settings.aero.tilt_loss = {ground_tilt_loss, 0};
    const SpaceFlight flight = fly(robot, plan, start, settings);
    REQUIRE(flight.outcome == Outcome::ok);
    REQUIRE(flight.rows.size() == 1001);

    const auto model = simulation::make_space_tick_model<n>(robot, settings.aero);
    const simulation::SpaceVehicle<double, n> at_start = simulation::vehicle_at(model, start);
    MujocoSpace mujoco(space_mjcf(robot.plant, model.tick_s / steps_per_tick));
    mjData* const data = mujoco.data();
    REQUIRE(mujoco.model()->nv == 6 + n);
    const AirForces air(robot, has_effects ? &slope : nullptr);
    const int rotors = model.nominal.plant.rotor_count;
    std::copy_n(at_start.plant.q, 7 + n, data->qpos);
    std::copy_n(at_start.plant.u, 6 + n, data->qvel);
    std::copy_n(at_start.plant.thrust_n, rotors, data->act);
    auto memory = at_start.memory;
    Difference worst;
    for (const SpaceFlightRow& row : flight.rows) {
        const mjtNum* q = data->qpos;
        for (std::size_t i = 0; i < 3; ++i) {
            worst.position_m = std::max(worst.position_m, std::abs(q[i] - row.motion.position_m[i]));
        }
        for (std::size_t i = 0; i < 4; ++i) {
            worst.attitude = std::max(worst.attitude, std::abs(q[3 + i] - row.motion.attitude[i]));
        }
        for (std::size_t i = 0; i < n; ++i) {
            worst.joint_rad = std::max(worst.joint_rad, std::abs(q[7 + i] - row.motion.joints_rad[i]));
        }
        dynamics::SpaceState<double, n> seen{};
        std::copy_n(data->qpos, 7 + n, seen.q);
        std::copy_n(data->qvel, 6 + n, seen.u);
        std::copy_n(data->act, rotors, seen.thrust_n);
        simulation::SpaceActuation<double, n> given{};
        simulation::SpaceLawMemory<double, n> next{};
        std::visit(
            [&](const auto& law) {
                simulation::control(model, law, seen, memory, simulation::point_for<n>(row.reference), slope, given,
                                    next);
            },
            model.law);
        memory = next;
        std::copy_n(given.command.joint_torque_nm, n, data->ctrl);
        std::copy_n(given.command.thrust_n, rotors, data->ctrl + n);
        mujoco.step(steps_per_tick);
    }
    return worst;
}

template <int n>
void check_same_flight(bool has_cascade) {
    SpaceRobot robot = space_robot(n);
    if (has_cascade) {
        robot.controller.law = cascade_gains_for(robot.plant.time_constant_s, {});
    }
    CAPTURE(n, has_cascade);
    const Difference fine = difference_from_mujoco<n>(robot, 10, true);
    CHECK(fine.position_m < 1e-6);
    CHECK(fine.attitude < 1e-6);
    CHECK(fine.joint_rad < 1e-6);
    // MuJoCo's own error is the greater one at steps of 10 ms: agreement is a matter of step size, not of luck.
    const Difference coarse = difference_from_mujoco<n>(robot, 1, true);
    CHECK(coarse.position_m > 3 * fine.position_m);
    CHECK(coarse.position_m < 1e-4);
    // Without surface effects the same loop flies elsewhere.
    CHECK(difference_from_mujoco<n>(robot, 10, false).position_m > 1e-4);
}

}  // namespace

TEST_CASE("Vehicles in space with arms of no, one, two and three joints fly in MuJoCo as we fly them, for 10 s") {
    const bool has_cascade = GENERATE(false, true);
    check_same_flight<0>(has_cascade);
    check_same_flight<1>(has_cascade);
    check_same_flight<2>(has_cascade);
    check_same_flight<3>(has_cascade);
}

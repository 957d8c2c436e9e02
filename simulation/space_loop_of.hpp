#pragma once

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>
#include <variant>

#include "downwash/dynamics/rotor_power.hpp"
#include "downwash/dynamics/space_contact_step.hpp"
#include "downwash/simulation/noise.hpp"
#include "downwash/simulation/space_loop.hpp"
#include "downwash/simulation/space_tick.hpp"

// The SpaceLoop of one number of joints. Private: each number has a source file of its own, space_loop_<n>.cpp, so that
// they compile side by side.

namespace downwash::simulation {

static_assert(SpaceField<SpaceEffect, double>);

/// Prepares a robot for the tick. @pre it has n joints
template <int n>
SpaceTickModel<n> make_space_tick_model(const SpaceRobot& robot, const SpaceAero& aero = {}) {
    std::vector<double> max_joint_torque_nm;
    for (const SpaceLinkLimits& link : robot.links) {
        max_joint_torque_nm.push_back(link.max_torque_nm);
    }
    SpaceTickModel<n> model{
        make_space_law_model<n>(robot.plant, robot.min_thrust_n, robot.max_thrust_n, max_joint_torque_nm),
        robot.controller.law, 1 / robot.controller.rate_hz, aero.tilt_loss,
        space_slipstreams_of(robot.plant, robot.rotor_radius_m)};
    model.nominal.plant.has_fountain = aero.has_fountain;
    model.nominal.plant.has_walls = aero.wall_force != 0 || aero.wall_moment_m != 0;
    model.nominal.plant.wall_force = aero.wall_force;
    model.nominal.plant.wall_moment_m = aero.wall_moment_m;
    return model;
}

/// The state of a vehicle with a motion. Where it carries nothing, rotors carry its weight, and its law has come to
/// rest there.
template <int n>
SpaceVehicle<double, n> vehicle_at(const SpaceTickModel<n>& model, const SpaceMotion& motion,
                                   const SpaceCarry& carry = {}) {
    SpaceVehicle<double, n> vehicle{};
    dynamics::SpaceState<double, n>& plant = vehicle.plant;
    std::copy_n(motion.position_m.begin(), 3, plant.q);
    std::copy_n(motion.attitude.begin(), 4, plant.q + 3);
    std::copy_n(motion.joints_rad.begin(), n, plant.q + 7);
    std::copy_n(motion.velocity_m_s.begin(), 3, plant.u);
    std::copy_n(motion.body_rates_rad_s.begin(), 3, plant.u + 3);
    std::copy_n(motion.joint_rates_rad_s.begin(), n, plant.u + 6);
    const double weight[4] = {model.nominal.plant.total_mass_kg * standard_gravity_m_s2, 0, 0, 0};
    dynamics::allocate(model.nominal.allocation, weight, plant.thrust_n);
    std::visit([&](const auto& law) { remember(law.rested(model.nominal, plant, model.tick_s), vehicle.memory); },
               model.law);
    std::ranges::copy(carry.rotor_thrust_n, plant.thrust_n);
    std::ranges::copy(carry.controller_memory, vehicle.memory.number);
    return vehicle;
}

/// The motion of a state.
template <int n>
SpaceMotion motion_of(const dynamics::SpaceState<double, n>& plant) {
    SpaceMotion motion;
    std::copy_n(plant.q, 3, motion.position_m.begin());
    std::copy_n(plant.q + 3, 4, motion.attitude.begin());
    std::copy_n(plant.q + 7, n, motion.joints_rad.begin());
    std::copy_n(plant.u, 3, motion.velocity_m_s.begin());
    std::copy_n(plant.u + 3, 3, motion.body_rates_rad_s.begin());
    std::copy_n(plant.u + 6, n, motion.joint_rates_rad_s.begin());
    return motion;
}

/// The axes of a reference that a vehicle with n joints has.
template <int n>
BasicSpacePoint<double, n> point_for(const SpacePoint& point) {
    BasicSpacePoint<double, n> own;
    std::copy_n(point.position, space_axes<n>, own.position);
    std::copy_n(point.velocity, space_axes<n>, own.velocity);
    std::copy_n(point.acceleration, space_axes<n>, own.acceleration);
    return own;
}

/// See SpaceLoop.
template <int n>
class SpaceLoopOf final : public SpaceLoop {
 public:
    explicit SpaceLoopOf(const SpaceLoopSetup& setup)
        : model_(make_space_tick_model<n>(setup.robot, setup.aero)),
          world_(make_space_world<n>(setup.robot, setup.world)),
          quiet_(world_.numbers),
          plant_(plant_in(model_, world_.numbers)),
          effect_(setup.effect),
          step_{setup.is_refined,
                {dynamics::joint_steps(model_.nominal.plant, model_.tick_s)},
                world_.numbers.center_of_mass_m} {
        quiet_.gust_m_s = 0;
        SpaceLoop::start(SpaceMotion{});
    }

    using SpaceLoop::start;
    void start(const SpaceMotion& motion, const SpaceCarry& carry) override {
        static_cast<SpaceVehicle<double, n>&>(state_) = vehicle_at(model_, motion, carry);
        forget();
    }
    void take_over(const AnySpaceState& state) override { copy_common(state, state_); }
    [[nodiscard]] AnySpaceState state() const override {
        AnySpaceState any{};
        copy_common(state_, any);
        return any;
    }
    void forget() override {
        state_.plant.energy_j = 0;
        state_.world = memory_at_start(world_, state_.plant);
    }
    void tick(std::int64_t number, const SpacePoint& reference, SpaceFlightRow& row) override {
        double noise[drawn_space_noise_count] = {};
        if (world_.has_noise) {
            draw_space_noise(normal_levels(), world_.tape, number, noise, 1);
        }
        step(world_.numbers, noise, reference, row);
        std::swap(state_, next_);
    }
    void touching_tick(std::int64_t number, const SpacePoint& reference, const dynamics::SpaceContact& contact,
                       const controllers::ToldPush* push, bool is_at_surface, SpaceFlightRow& row,
                       dynamics::SpaceContactRecord& seen) override {
        step_.contact = &contact;
        step_.seen = &seen;
        told_ = push;
        const SpaceFlightState<double, n> before = state_;
        tick(number, reference, row);
        step_.contact = nullptr;
        told_ = nullptr;
        if (seen.normal_impulse_n_s > 0 || is_at_surface) {
            stand_still(before);
        }
    }
    void quiet_tick(const SpacePoint& reference, SpaceFlightRow& row) override {
        look(reference, row);
        std::swap(state_, next_);
    }
    void look(const SpacePoint& reference, SpaceFlightRow& row) override {
        const double noise[drawn_space_noise_count] = {};
        step(quiet_, noise, reference, row);
    }
    void describe(SpaceFlightRow& row) override {
        const dynamics::SpaceState<double, n>& now = state_.plant;
        row.motion = motion_of(now);
        row.energy_j = now.energy_j;
        const SpaceModel<n>& nominal = model_.nominal.plant;
        const dynamics::LaneRotation<double> attitude = dynamics::rotation_of(now.q + 3);
        const WorldSpace<double, SpaceEffect> around(world_.numbers, world_.numbers.wind_m_s, effect_, model_.tilt_loss,
                                                     model_.slipstreams);
        const auto& here = dynamics::at_attitude<double>(around, attitude);
        for (int i = 0; i < nominal.rotor_count; ++i) {
            row.rotor_lag_n[i] = now.thrust_n[i];
            row.rotor_factor[i] = here.thrust_ratio(i, hub(attitude, i), attitude * nominal.rotor[i].axis);
        }
        dynamics::LaneVector<double> tip{};
        if constexpr (n > 0) {
            tip = dynamics::link_point(nominal, now.q, n - 1, nominal.end_effector_m);
        } else {
            tip = dynamics::LaneVector<double>{now.q[0], now.q[1], now.q[2]} + attitude * nominal.end_effector_m;
        }
        row.end_effector_m = {tip.x, tip.y, tip.z};
    }
    [[nodiscard]] SpaceMotion motion() const override { return motion_of(state_.plant); }
    [[nodiscard]] double energy_j() const override { return state_.plant.energy_j; }
    [[nodiscard]] bool is_within(double max) const override { return are_within(state_.plant, max); }
    [[nodiscard]] bool is_flyable() override {
        const dynamics::LaneRotation<double> attitude = dynamics::rotation_of(state_.plant.q + 3);
        for (int i = 0; i < model_.nominal.plant.rotor_count; ++i) {
            if (!effect_.is_flyable(i, nominal_place(world_.numbers, hub(attitude, i)))) {
                return false;
            }
        }
        return true;
    }

 private:
    /// The chosen step, as what a tick integrates with.
    struct ChosenStep {
        bool is_refined;
        dynamics::EqualSpaceSteps equal;
        dynamics::LaneVector<double> center_of_mass_m;
        const dynamics::SpaceContact* contact = nullptr;  ///< a surface beside which it moves; nullptr: none
        dynamics::SpaceContactRecord* seen = nullptr;     ///< what happens there

        template <class Around>
        dynamics::SpaceState<double, n> operator()(const SpaceModel<n>& model,
                                                   const dynamics::SpaceState<double, n>& state,
                                                   const dynamics::SpaceCommand<double, n>& command, double dt_s,
                                                   const Around& around) const {
            if (contact != nullptr) {
                const dynamics::SpaceContactStep beside{*contact, center_of_mass_m, *seen, equal.count};
                return beside(model, state, command, dt_s, around);
            }
            return is_refined ? dynamics::RefinedSpaceStep{}(model, state, command, dt_s, around)
                              : equal(model, state, command, dt_s, around);
        }
    };

    /// Writes the state one tick later to `next_`, and the commands to a row.
    void step(const SpaceWorldNumbers<double, n>& world, const double* noise, const SpacePoint& reference,
              SpaceFlightRow& row) {
        SpaceActuation<double, n> given{};
        std::visit(
            [&](const auto& law) {
                const auto fly = [&](const auto& told) {
                    tick_in_world(model_, law, world, plant_, noise, state_, point_for<n>(reference), effect_, given,
                                  next_, step_, told);
                };
                told_ != nullptr ? fly(*told_) : fly(NothingTold{});
            },
            model_.law);
        std::copy_n(given.command.thrust_n, model_.nominal.plant.rotor_count, row.rotor_command_n);
        std::copy_n(given.command.joint_torque_nm, n, row.joint_torque_nm);
        row.saturation = given.saturation;
        const SpaceModel<n>& nominal = model_.nominal.plant;
        const dynamics::SpaceState<double, n>& now = state_.plant;
        row.power_w = dynamics::rotor_power(nominal, nominal.has_rotor_lag ? now.thrust_n : given.command.thrust_n);
        for (int i = 0; i < n; ++i) {
            row.power_w += std::abs(row.joint_torque_nm[i] * now.u[6 + i]);
        }
    }
    /// Lets integrals stand still over the last tick, and an observer estimate what it did. @param before the tick
    void stand_still(const SpaceFlightState<double, n>& before) {
        std::visit(
            [&]<class Law>(const Law& law) {
                const auto kept = recalled<Law>(before.memory);
                auto memory = Law::with_integrals_of(kept, recalled<Law>(state_.memory));
                if constexpr (requires { law.observer_gain_1_s; }) {
                    if (law.observer_gain_1_s > 0) {
                        const SpaceModel<n>& nominal = model_.nominal.plant;
                        const auto momentum_of = [&](const dynamics::SpaceState<double, n>& plant, double* p) {
                            const auto places = dynamics::places_at(nominal, plant.q);
                            dynamics::momentum(nominal, places, dynamics::equations_of_motion(nominal, places, plant.u),
                                               plant.u, p);
                        };
                        double change[dynamics::space_speeds<n>], old[dynamics::space_speeds<n>];
                        momentum_of(state_.plant, change);
                        momentum_of(before.plant, old);
                        for (int i = 0; i < dynamics::space_speeds<n>; ++i) {
                            change[i] -= old[i];
                        }
                        controllers::hold_estimate<n>(law.observer_gain_1_s, model_.tick_s, change, kept.observed,
                                                      memory.observed);
                    }
                }
                remember(memory, state_.memory);
            },
            model_.law);
    }
    [[nodiscard]] dynamics::LaneVector<double> hub(const dynamics::LaneRotation<double>& attitude, int rotor) const {
        return dynamics::LaneVector<double>{state_.plant.q[0], state_.plant.q[1], state_.plant.q[2]} +
               attitude * model_.nominal.plant.rotor[rotor].position_m;
    }

    SpaceTickModel<n> model_;
    FlownSpaceWorld<n> world_;
    SpaceWorldNumbers<double, n> quiet_;  ///< the world without gusts
    BasicSpaceModel<double, n> plant_;    ///< that flies in the world
    SpaceEffect& effect_;
    ChosenStep step_;
    const controllers::ToldPush* told_ = nullptr;  ///< what the law is told of
    SpaceFlightState<double, n> state_{}, next_{};
};

/// The SpaceLoop of a robot with n joints; space_loop_<n>.cpp defines it.
template <int n>
[[nodiscard]] std::unique_ptr<SpaceLoop> make_space_loop_of(const SpaceLoopSetup& setup);

}  // namespace downwash::simulation

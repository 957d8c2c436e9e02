#include "twin_flights.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <utility>
#include <variant>
#include <vector>

#include "downwash/planner/solve.hpp"
#include "downwash/problems/problem_model.hpp"
#include "downwash/simulation/direct_field.hpp"
#include "downwash/simulation/flight_loop.hpp"
#include "downwash/simulation/noise.hpp"
#include "downwash/simulation/plane_in_space.hpp"
#include "downwash/simulation/pose.hpp"
#include "downwash/simulation/space_effect.hpp"
#include "downwash/simulation/space_loop_of.hpp"

namespace downwash::bench {
namespace {

using simulation::SpaceFlightState;

/// Yaw by the heading of the plane, then pitch.
std::array<double, 4> lifted_attitude(double pitch_rad, const PlaneOfMotion& plane) {
    const double half_yaw = 0.5 * plane.heading_rad(), half_pitch = 0.5 * pitch_rad;
    return {std::cos(half_yaw) * std::cos(half_pitch), -std::sin(half_yaw) * std::sin(half_pitch),
            std::cos(half_yaw) * std::sin(half_pitch), std::sin(half_yaw) * std::cos(half_pitch)};
}

/// Angle between two attitudes.
double angle_between(const std::array<double, 4>& a, const double* b) {
    const double vector[] = {a[0] * b[1] - a[1] * b[0] - a[2] * b[3] + a[3] * b[2],
                             a[0] * b[2] + a[1] * b[3] - a[2] * b[0] - a[3] * b[1],
                             a[0] * b[3] - a[1] * b[2] + a[2] * b[1] - a[3] * b[0]};
    return 2 * std::asin(std::min(1.0, std::hypot(vector[0], vector[1], vector[2])));
}

/// 1 where the steady wind blows forward, along which gusts pass in space, or -1.
double way_of_gusts(const World& world) {
    return world.wind_x_m_s < 0 ? -1 : 1;
}

/// The noise of the plane for a tick in space.
void lift_noise(const double* planar, const World& world, const PlaneOfMotion& plane, double* space) {
    std::fill_n(space, simulation::drawn_space_noise_count, 0.0);
    const Vector3 place = vector_in_space(planar[0], planar[1], plane),
                  velocity = vector_in_space(planar[2], planar[3], plane);
    std::copy_n(place.begin(), 3, space);
    std::copy_n(velocity.begin(), 3, space + 3);
    space[7] = planar[4];
    space[9] = way_of_gusts(world) * planar[5];
    space[12] = planar[6];
    space[13] = planar[7];
}

/// The closed loop in space whose world draws what the planar one draws.
class LiftedLoop {
 public:
    /// @param start at rest, from which the flight in the plane begins, with its gusts
    LiftedLoop(const SpaceRobot& robot, const World& world, const PlaneOfMotion& plane, const AeroSettings& aero,
               simulation::SpaceEffect& effect, const FlightState& start)
        : world_(world),
          plane_(plane),
          model_(simulation::make_space_tick_model<1>(robot, simulation::space_aero(aero, robot.rotor_radius_m))),
          law_(std::get<SpaceInversion>(model_.law)),
          flown_(make_space_world<1>(robot, in_space(world, plane))),
          plant_(plant_in(model_, flown_.numbers)),
          step_{dynamics::joint_steps(model_.nominal.plant, model_.tick_s)},
          effect_(effect) {
        SpaceMotion motion;
        motion.position_m = plane.to_world(start.plant.q[0], 0, start.plant.q[1]);
        motion.attitude = lifted_attitude(start.plant.q[2], plane);
        motion.joints_rad[0] = start.plant.q[3];
        static_cast<simulation::SpaceVehicle<double, 1>&>(state_) = simulation::vehicle_at(model_, motion);
        state_.world = memory_at_start(flown_, state_.plant);
        const double* gust = start.world.gust;
        const double lifted_gust[] = {way_of_gusts(world) * gust[0], 0, 0, gust[1], gust[2]};
        std::copy_n(lifted_gust, 5, state_.world.gust);
    }

    /// @return the saturation
    double tick(const double* planar_noise, const ReferencePoint& reference) {
        double noise[simulation::drawn_space_noise_count];
        lift_noise(planar_noise, world_, plane_, noise);
        simulation::SpaceActuation<double, 1> given{};
        simulation::tick_in_world(model_, law_, flown_.numbers, plant_, noise, state_,
                                  simulation::point_for<1>(in_space(reference, plane_)), effect_, given, next_, step_);
        std::swap(state_, next_);
        return given.saturation;
    }
    [[nodiscard]] const dynamics::SpaceState<double, 1>& plant() const { return state_.plant; }

 private:
    const World& world_;
    const PlaneOfMotion& plane_;
    simulation::SpaceTickModel<1> model_;
    const SpaceInversion& law_;
    FlownSpaceWorld<1> flown_;
    BasicSpaceModel<double, 1> plant_;
    dynamics::EqualSpaceSteps step_;
    simulation::SpaceEffect& effect_;
    SpaceFlightState<double, 1> state_{}, next_{};
};

}  // namespace

World in_plane(const World& world, const Robot& robot) {
    World mine = world;
    mine.scene_y_m = mine.position_bias_y_m = mine.wind_y_m_s = mine.gust_y_m_s = mine.lateral_error_m = 0;
    const std::vector<Vector3>& hubs_m = robot.rotors.positions_m;
    for (std::size_t i = 0; i < hubs_m.size(); ++i) {
        double sum = 0;
        int alike = 0;
        for (std::size_t j = 0; j < hubs_m.size(); ++j) {
            if (hubs_m[j][0] == hubs_m[i][0] && hubs_m[j][2] == hubs_m[i][2]) {
                sum += world.rotor_thrust_scale[j];
                ++alike;
            }
        }
        mine.rotor_thrust_scale[i] = sum / alike;
    }
    return mine;
}

Plan nominal_plan(Problem problem, std::uint32_t seed, std::uint64_t iterations) {
    problem.uncertainty.reset();
    problem.planner.variant = Variant::mp_arm_ada;
    problem.planner.seed = seed;
    problem.planner.max_iterations = iterations;
    problem.planner.time_limit_s.reset();
    const Solution solution = solve(problem);
    if (!solution.plan) {
        throw std::runtime_error(
            fmt::format("{}: {} iterations with seed {} find no plan", problem.name, iterations, seed));
    }
    return *solution.plan;
}

TwinFlights::TwinFlights(const Problem& problem, const SpaceRobot& in_space)
    : problem_(problem),
      in_space_(in_space),
      planar_(make_flight_model(problem)),
      scene_(std::make_shared<const Scene>(problem.obstacles)) {}

Apart TwinFlights::fly(const Plan& plan, const World& world, std::int64_t ticks) const {
    const PlaneOfMotion& plane = planar_->plane();
    const FlownWorld flown = make_world(planar_->robot(), world);
    simulation::FlightEffectOf planar_effect{simulation::DirectField(*planar_)};
    const simulation::FlightLoop loop(planar_->tick(), &flown, planar_effect);
    FlightState state = planar_->state_at(level_at(plan.first()));
    state.world = memory_at_start(flown, state.plant);

    simulation::DirectSpaceEffect space_effect(scene_, problem_.aero, in_space_);
    LiftedLoop space(in_space_, world, plane, problem_.aero, space_effect, state);

    Apart apart;
    for (std::int64_t tick = 0; tick < ticks; ++tick) {
        const ReferencePoint reference = plan.at(tick);
        double noise[simulation::noise_count] = {};
        if (flown.has_noise) {
            simulation::draw_noise(simulation::normal_levels(), world.tape, tick, noise, 1);
        }
        controllers::Actuation<double> given{};
        state = loop.tick(tick, state, reference, given);
        const double saturation = std::max(given.saturation, space.tick(noise, reference));
        const double* q = space.plant().q;
        const Vector3 place_m{q[0], q[1], q[2]};
        const Vector3 off_m = place_m - plane.to_world(state.plant.q[0], 0, state.plant.q[1]);
        apart.place_m = std::max(apart.place_m, std::sqrt(dot(off_m, off_m)));
        apart.beside_m = std::max(apart.beside_m, std::abs(plane.from_world(place_m)[1]));
        apart.attitude_rad =
            std::max(apart.attitude_rad, angle_between(lifted_attitude(state.plant.q[2], plane), q + 3));
        apart.joint_rad = std::max(apart.joint_rad, std::abs(q[7] - state.plant.q[3]));
        apart.clipped_ticks += saturation > 1 ? 1 : 0;
        if (apart.clipped_ticks == 0) {
            apart.before_clipping_m = apart.place_m;
        }
    }
    apart.energy_j = std::abs(space.plant().energy_j - state.plant.energy_j);
    return apart;
}

}  // namespace downwash::bench

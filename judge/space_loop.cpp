#include "downwash/judge/space_loop.hpp"

namespace downwash::judge {
namespace {

/// Moves coordinates from the point of the robot file to the true centre of mass (sign 1), or back (sign -1).
SpaceCoordinates shifted(SpaceCoordinates at, const Eigen::Vector3d& center_of_mass_m, double sign) {
    const Eigen::Quaterniond attitude = at.attitude.normalized();
    at.position_m += sign * (attitude * center_of_mass_m);
    at.velocity_m_s += sign * (attitude * at.body_rate_rad_s.cross(center_of_mass_m));
    return at;
}

}  // namespace

SpaceLoop::SpaceLoop(const SpaceControl& control, const SpaceSurroundings& nominal, const SpacePlant& plant,
                     const SpaceWorld& world, const SpaceRobot& robot, const SpaceCoordinates& start)
    : control_(control),
      nominal_surfaces_(nominal),
      plant_(&plant),
      world_(world),
      robot_(robot),
      state_{bodies_at(plant.vehicle(), shifted(start, plant.vehicle().center_of_mass_m, 1)),
             control.resting_thrust_n()},
      before_(state_),
      now_(start),
      seen_(start),
      memory_(control.at_start(start)),
      sensors_(world, robot, start),
      gusts_(world, control.tick_s()),
      wind_(Eigen::Vector3d::Zero()) {}

void SpaceLoop::carry(const std::vector<double>& rotor_thrust_n, const std::vector<double>& controller_memory) {
    if (!rotor_thrust_n.empty()) {
        state_.thrust_n = rotor_thrust_n;
    }
    if (!controller_memory.empty()) {
        memory_ = control_.memory_of(controller_memory);
    }
}

void SpaceLoop::next(std::int64_t tick, const SpacePoint& reference, bool is_at_surface,
                     const std::optional<BodyPush>& push) {
    const SpaceTape tape = tape_at(world_, tick);
    const SpaceCoordinates from = now_;
    const SpaceControlMemory memory_before = memory_;
    before_ = state_;
    seen_ = sensors_.seen(now_, tape);
    commands_ = control_.command(seen_, state_.thrust_n, reference, nominal_surfaces_, memory_, push);
    wind_ = gusts_.wind();
    state_ = plant_->after(state_, commands_, wind_, control_.tick_s());
    sensors_.remember(now_);
    gusts_.next(tape);
    now_ = shifted(coordinates_of(plant_->vehicle(), state_.bodies, now_.joints_rad),
                   plant_->vehicle().center_of_mass_m, -1);
    if (state_.contact_n > 0 || is_at_surface) {
        control_.stand_still(memory_before, from, now_, memory_);
    }
}

BodyMotions SpaceLoop::bodies_within(double since_s) const {
    return plant_->after(before_, commands_, wind_, since_s).bodies;
}

void SpaceLoop::forget(const SpaceWorld& world) {
    world_ = world;
    state_.energy_j = 0;
    before_ = state_;
    sensors_ = SpaceSensors(world_, robot_, now_);
    gusts_ = SpaceGusts(world_, control_.tick_s());
}

}  // namespace downwash::judge

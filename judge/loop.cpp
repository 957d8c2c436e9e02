#include "downwash/judge/loop.hpp"

#include <algorithm>

namespace downwash::judge {
namespace {

/// The motion of the point that the robot file calls the centre of mass. Goals, sensors and obstacles refer to it.
Motion of_file_point(const Vehicle& vehicle, Motion motion) {
    const Planar lever = from_body(vehicle.center_of_mass_m, motion.pitch_rad);
    motion.position_m = motion.position_m - lever;
    motion.velocity_m_s = motion.velocity_m_s - turned(motion.pitch_rate_rad_s, lever);
    return motion;
}

/// The motion of the true centre of mass, from that of the point of the robot file.
Motion of_true_point(const Vehicle& vehicle, Motion motion) {
    const Planar lever = from_body(vehicle.center_of_mass_m, motion.pitch_rad);
    motion.position_m = motion.position_m + lever;
    motion.velocity_m_s = motion.velocity_m_s + turned(motion.pitch_rate_rad_s, lever);
    return motion;
}

}  // namespace

Loop::Loop(const ControlLaw& law, const Surroundings& nominal, const Plant& plant, const World& world,
           const Robot& robot, const PlantState& state, const ControlMemory& memory)
    : law_(law),
      nominal_surroundings_(nominal),
      plant_(&plant),
      world_(world),
      sensors_(world, robot, of_file_point(plant.vehicle(), state.motion)),
      gusts_(world, law.tick_s()),
      state_(state),
      memory_(memory) {}

Motion Loop::motion() const {
    return of_file_point(plant_->vehicle(), state_.motion);
}

Motion Loop::seen(std::int64_t tick) const {
    return sensors_.seen(motion(), tape_at(world_, tick));
}

void Loop::next(std::int64_t tick, const ReferencePoint& reference, bool is_at_surface) {
    const Tape tape = tape_at(world_, tick);
    const Motion now = motion();
    before_ = state_;
    const ControlMemory memory_before = memory_;
    command_ = law_.command(sensors_.seen(now, tape), state_.thrust_n, reference, nominal_surroundings_, memory_);
    wind_ = gusts_.wind();
    state_ = plant_->after(state_, command_, wind_, law_.tick_s());
    if (state_.contact_n > 0 || is_at_surface) {
        law_.stand_still(memory_before, now, motion(), memory_);
    }
    sensors_.remember(now);
    gusts_.next(tape);
}

Motion Loop::motion_within(double since_s) const {
    return of_file_point(plant_->vehicle(), plant_->after(before_, command_, wind_, since_s).motion);
}

Motion motion_of(const Start& s) {
    using namespace plane;
    return {{s.at[x], s.at[z]}, {s.velocity[x], s.velocity[z]}, s.pitch_rad, s.pitch_rate_rad_s, s.at[arm],
            s.velocity[arm]};
}

PlantState start_of(const Start& s, const ControlLaw& law, const Vehicle& vehicle) {
    PlantState state;
    state.motion = of_true_point(vehicle, motion_of(s));
    state.thrust_n = law.resting_thrust_n();
    std::copy(s.rotor_thrust_n.begin(), s.rotor_thrust_n.end(), state.thrust_n.begin());
    return state;
}

}  // namespace downwash::judge

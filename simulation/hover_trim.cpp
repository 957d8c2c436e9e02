#include "downwash/simulation/hover_trim.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "downwash/controllers/control.hpp"
#include "downwash/dynamics/arm_wash.hpp"
#include "downwash/simulation/effect_slope.hpp"
#include "downwash/simulation/surroundings.hpp"

namespace downwash::simulation {
namespace {

using dynamics::Attitude;
using dynamics::EquationsOfMotion;
using dynamics::RotorWrench;

/// The wrench to demand so that the wrench in effect is `wanted`: the effect is linear in the demand.
RotorWrench<double> demand_for(const TickModel& model, const FlightState& at, LinearEffect& effect,
                               const RotorWrench<double>& wanted) {
    const PlantModel& plant = model.plant;
    const auto attitude = dynamics::attitude(plant, at.plant.q[2], at.plant.q[3]);
    const NominalSurroundings<double, LinearEffect> around(effect, no_tilt_loss);
    const auto acting = [&](double thrust_n, double pitch_torque_nm) {
        double command_n[max_rotors];
        command_rotors_at_rest(model, effect, at.plant, thrust_n, pitch_torque_nm, command_n);
        return dynamics::rotor_wrench(plant, attitude, at.plant.q[0], at.plant.q[1], command_n, around);
    };
    const RotorWrench<double> a = acting(1, 0);
    const RotorWrench<double> b = acting(0, 1);
    const double determinant = a.thrust_n * b.pitch_torque_nm - b.thrust_n * a.pitch_torque_nm;
    return {(wanted.thrust_n * b.pitch_torque_nm - b.thrust_n * wanted.pitch_torque_nm) / determinant,
            (a.thrust_n * wanted.pitch_torque_nm - wanted.thrust_n * a.pitch_torque_nm) / determinant};
}

/// What the slipstreams do to the arm of a vehicle at rest [N, N, N m, N m].
struct WashLoad {
    double force[4] = {};
};

WashLoad wash_load(const TickModel& model, const Attitude<double>& a, const double (&command_n)[max_rotors]) {
    WashLoad load;
    dynamics::WashedVehicle<double> vehicle{a, {}, {0, 0}, {}, 1};
    std::copy(command_n, command_n + max_rotors, vehicle.acting_n);
    dynamics::add_arm_wash(model.plant, model.slipstreams, vehicle, load.force);
    return load;
}

}  // namespace

void command_rotors_at_rest(const TickModel& model, LinearEffect& effect, const dynamics::PlantState<double>& at,
                            double thrust_n, double pitch_torque_nm, double (&command_n)[max_rotors]) {
    const std::optional<controllers::FeedForward> feed_forward = controllers::aids_of(model.law).feed_forward;
    if (!feed_forward) {
        dynamics::allocate(model.plant, thrust_n, pitch_torque_nm, command_n);
        return;
    }
    const NominalSurroundings<double, LinearEffect> map(effect.as_read(), no_tilt_loss);
    const auto attitude = dynamics::attitude(model.plant, at.q[2], at.q[3]);
    const auto ratios = controllers::read_ratios(*feed_forward, model.plant, at, attitude, map);
    controllers::allocate_against(model.plant, ratios, thrust_n, pitch_torque_nm, command_n);
}

HoverTrim hover_trim(const Robot& robot, const TickModel& model, LinearEffect& effect, const FlightState& resting) {
    const PlantModel& plant = model.plant;
    HoverTrim trim;
    trim.state = resting;
    const double arm_rad = resting.plant.q[3];
    const Attitude<double> a = dynamics::attitude(plant, resting.plant.q[2], arm_rad);
    const EquationsOfMotion<double> e = dynamics::equations_of_motion(plant, a, resting.plant.u);

    // The plant's side. Row 1 leaves no other pitch than level; rows 2 to 4 with du = 0 give thrust, torque, joint.
    RotorWrench<double> demand = demand_for(model, resting, effect, {e.bias[1], e.bias[2]});
    command_rotors_at_rest(model, effect, resting.plant, demand.thrust_n, demand.pitch_torque_nm, trim.rotor_command_n);
    trim.joint_torque_nm = e.bias[3];
    if (model.slipstreams.count > 0) {
        // What they push down asks for thrust, which makes them faster: each round adds a few percent of the last one.
        // Their push along x would take a tilted hover and is left out, like that of walls.
        constexpr int rounds = 20;
        for (int i = 0; i < rounds; ++i) {
            const WashLoad load = wash_load(model, a, trim.rotor_command_n);
            demand = demand_for(model, resting, effect, {e.bias[1] - load.force[1], e.bias[2] - load.force[2]});
            command_rotors_at_rest(model, effect, resting.plant, demand.thrust_n, demand.pitch_torque_nm,
                                   trim.rotor_command_n);
            trim.joint_torque_nm = e.bias[3] - load.force[3];
        }
    }
    for (bool& is_used : trim.feeds_back.plant.q) {
        is_used = true;
    }
    for (bool& is_used : trim.feeds_back.plant.u) {
        is_used = true;
    }
    for (int i = 0; i < plant.rotor_count; ++i) {
        trim.state.plant.thrust_n[i] = trim.rotor_command_n[i];
        trim.feeds_back.plant.thrust_n[i] = plant.has_rotor_lag;
    }

    for (PastMotion<bool>& past : trim.feeds_back.world.past) {
        std::fill(std::begin(past.q), std::end(past.q), robot.controller.delay_s > 0);
        std::fill(std::begin(past.u), std::end(past.u), robot.controller.delay_s > 0);
    }

    // The controller's side.
    controllers::visit_flown(model.law, [&](const auto& law) {
        const auto rest = law.rest(plant, e, {demand, trim.joint_torque_nm});
        trim.state.memory = controllers::remembered(rest.memory);
        trim.feeds_back.memory = controllers::remembered(rest.feeds_back);
        trim.reference.position[0] = resting.plant.q[0] + rest.error[0];
        trim.reference.position[1] = resting.plant.q[1] + rest.error[1];
        trim.reference.position[2] = arm_rad + rest.error[2];
        trim.pitch_reference_rad = rest.pitch_reference_rad;
        trim.height_gain_1_s2 = rest.height_gain_1_s2;
        trim.pitch_gain_1_s2 = rest.pitch_gain_1_s2;
        trim.limit = rest.limit;
    });

    // The plant's limits come first.
    const double joint_saturation = std::abs(trim.joint_torque_nm) / plant.max_joint_torque_nm;
    const double rotor_saturation = controllers::thrust_saturation(plant, trim.rotor_command_n);
    trim.saturation = lane::max(joint_saturation, rotor_saturation);
    if (robot.arm.is_limited && (arm_rad < robot.arm.lower_limit_rad || arm_rad > robot.arm.upper_limit_rad)) {
        trim.limit = HoldLimit::arm_angle;
    } else if (!(rotor_saturation < 1) || !std::isfinite(demand.thrust_n + demand.pitch_torque_nm)) {
        trim.limit = HoldLimit::rotor_thrust;
    } else if (!(joint_saturation < 1)) {
        trim.limit = HoldLimit::joint_torque;
    }
    return trim;
}

}  // namespace downwash::simulation

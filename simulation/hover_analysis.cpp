#include "downwash/simulation/hover_analysis.hpp"

#include <array>
#include <cmath>

#include "downwash/dynamics/flight_step.hpp"
#include "downwash/simulation/beyond_model.hpp"
#include "downwash/simulation/effect_slope.hpp"
#include "downwash/simulation/flight_loop.hpp"
#include "downwash/simulation/hover_modes.hpp"
#include "downwash/simulation/hover_trim.hpp"
#include "downwash/simulation/rotor_hubs.hpp"
#include "downwash/simulation/surroundings.hpp"
#include "downwash/simulation/vehicle_effect.hpp"

namespace downwash {
namespace {

using simulation::LinearEffect;
using simulation::TickModel;

constexpr std::array<std::string_view, 6> verdict_names = {"not_flyable", "in_collision", "no_equilibrium",
                                                           "unstable",    "unknown",      "stable"};
constexpr std::array<std::string_view, 7> limit_names = {"none", "arm_angle", "rotor_thrust", "joint_torque",
                                                         "tilt", "vertical",  "gain"};

using simulation::state_numbers;

/// Of a state without older motions, on the stack.
using Jacobian = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, state_numbers, state_numbers>;

/// Of one tick at its fixed point, by central differences of those numbers of the state that feed back. The effect is
/// linear already, so that the step may be small: 1e-6 leaves an error of some 1e-10.
template <class Matrix>
Matrix jacobian(const FlightModel& model, const HoverTrim& trim, LinearEffect& effect) {
    constexpr double step = 1e-6;
    TickModel level = model.tick();
    level.tilt_loss = no_tilt_loss;  // tangents are of a level vehicle
    const simulation::FlightLoop loop(level, flown_world(model, nullptr), effect);
    FlightState at_rest = trim.state;
    simulation::remember_older(model.nominal_world().numbers, at_rest.world);
    const int numbers = simulation::number_count_of(at_rest);
    const auto feeds_back = [&](int i) { return i >= state_numbers || number_at<bool>(trim.feeds_back, i); };
    const auto after_change = [&](int i, double change) {
        FlightState state = at_rest;
        simulation::set_number_of(state, i, simulation::number_of(state, i) + change);
        controllers::Actuation<double> given{};
        return loop.quiet_tick(state, trim.reference, given);
    };
    Matrix result(numbers, numbers);
    int columns = 0;
    for (int i = 0; i < numbers; ++i) {
        if (!feeds_back(i)) {
            continue;
        }
        const FlightState above = after_change(i, step);
        const FlightState below = after_change(i, -step);
        int rows = 0;
        for (int k = 0; k < numbers; ++k) {
            if (feeds_back(k)) {
                result(rows++, columns) =
                    (simulation::number_of(above, k) - simulation::number_of(below, k)) / (2 * step);
            }
        }
        ++columns;
    }
    result.conservativeResize(columns, columns);
    return result;
}

/// The slopes of the surfaces and the gains they compete with.
void find_stiffness(const TickModel& model, const HoverTrim& trim, LinearEffect& effect, HoverStability& stability) {
    const PlantModel& plant = model.plant;
    const double* q = trim.state.plant.q;
    const simulation::NominalSurroundings<double, LinearEffect> around(effect, no_tilt_loss);
    const auto wrench = [&](double z_m, double pitch_rad, const double* thrust_n) {
        return dynamics::rotor_wrench(plant, dynamics::attitude(plant, pitch_rad, q[3]), q[0], z_m, thrust_n, around);
    };
    constexpr double step = 1e-4;
    const double* command_n = trim.rotor_command_n;
    stability.force_slope_n_m =
        (wrench(q[1] + step, 0, command_n).thrust_n - wrench(q[1] - step, 0, command_n).thrust_n) / (2 * step);
    stability.torque_slope_nm_rad =
        (wrench(q[1], step, command_n).pitch_torque_nm - wrench(q[1], -step, command_n).pitch_torque_nm) / (2 * step);

    double unit_n[max_rotors];
    simulation::command_rotors_at_rest(model, effect, trim.state.plant, 1.0, 0.0, unit_n);
    stability.force_gain_n_m = plant.total_mass_kg * trim.height_gain_1_s2 * wrench(q[1], 0, unit_n).thrust_n;
    simulation::command_rotors_at_rest(model, effect, trim.state.plant, 0.0, 1.0, unit_n);
    const auto equations =
        dynamics::equations_of_motion(plant, dynamics::attitude(plant, 0.0, q[3]), trim.state.plant.u);
    const double nothing[3] = {};
    const double inertia_kg_m2 = dynamics::rotational_system(plant, equations, nothing).s55;
    stability.torque_gain_nm_rad = inertia_kg_m2 * trim.pitch_gain_1_s2 * wrench(q[1], 0, unit_n).pitch_torque_nm;
}

bool is_within_model(const FlightModel& model, const PlanarPose& pose) {
    return simulation::all_rotors(model, pose, [&](int rotor, double x_m, double z_m) {
        return !simulation::is_beyond_model(model.effect(rotor),
                                            model.plane().to_world(x_m, model.rotor_lateral_m(rotor), z_m));
    });
}

}  // namespace

std::string_view name_of(HoldVerdict verdict) {
    return verdict_names[static_cast<std::size_t>(verdict)];
}

std::string_view name_of(HoldLimit limit) {
    return limit_names[static_cast<std::size_t>(limit)];
}

HoverAnalysis analyse_hover(const FlightModel& model, double x_m, double z_m, double arm_rad) {
    HoverAnalysis analysis;
    const PlanarPose pose = level_at({x_m, z_m, arm_rad});
    if (!is_flyable(model, pose)) {
        return analysis;
    }
    analysis.verdict = HoldVerdict::in_collision;
    if (model.collisions().is_nearer_than(pose, 0)) {
        return analysis;
    }
    const TickModel& tick = model.tick();
    LinearEffect effect(model, pose);
    analysis.trim = simulation::hover_trim(model.robot(), tick, effect, model.state_at(pose));
    analysis.verdict = HoldVerdict::no_equilibrium;
    if (analysis.trim.limit != HoldLimit::none) {
        return analysis;
    }
    find_stiffness(tick, analysis.trim, effect, analysis.stability);
    if (simulation::older_ticks(model.nominal_world().numbers.delay_ticks) == 0) {
        simulation::find_modes(jacobian<Jacobian>(model, analysis.trim, effect), tick.tick_s, analysis.stability);
    } else {
        simulation::find_modes(jacobian<Eigen::MatrixXd>(model, analysis.trim, effect), tick.tick_s,
                               analysis.stability);
    }
    if (!(analysis.stability.spectral_radius < 1 - simulation::radius_slack)) {
        analysis.verdict = HoldVerdict::unstable;
    } else {
        analysis.verdict = is_within_model(model, pose) ? HoldVerdict::stable : HoldVerdict::unknown;
    }
    return analysis;
}

}  // namespace downwash

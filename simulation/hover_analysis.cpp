#include "downwash/simulation/hover_analysis.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>

#include "downwash/base/infinity.hpp"
#include "downwash/base/portable_math.hpp"
#include "downwash/dynamics/flight_step.hpp"
#include "downwash/simulation/effect_slope.hpp"
#include "downwash/simulation/flight_loop.hpp"
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

/// Nearer to 1 than this a spectral radius is not known to be below: rounding and differences.
constexpr double radius_slack = 1e-9;

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

/// Modes that cannot be found, as with gains beyond all measure, count as growing without limit.
template <class Matrix>
void find_modes(const Matrix& jacobian, double tick_s, HoverStability& stability) {
    stability.spectral_radius = infinity;
    stability.growth_rate_1_s = infinity;
    stability.growing_modes = static_cast<int>(jacobian.rows());
    if (!jacobian.allFinite()) {
        return;
    }
    const Eigen::EigenSolver<Matrix> solver(jacobian, false);
    if (solver.info() != Eigen::Success || !solver.eigenvalues().allFinite()) {
        return;
    }
    stability.growing_modes = 0;
    double largest = 0;  // squared modulus
    for (Eigen::Index i = 0; i < jacobian.rows(); ++i) {
        const double re = solver.eigenvalues()[i].real();
        const double im = solver.eigenvalues()[i].imag();
        const double squared = re * re + im * im;
        stability.growing_modes += squared > 1 ? 1 : 0;
        if (squared > largest) {
            largest = squared;
            stability.frequency_rad_s = std::abs(lane::atan2(im, re)) / tick_s;
        }
    }
    stability.spectral_radius = std::sqrt(largest);
    stability.growth_rate_1_s = natural_log(stability.spectral_radius) / tick_s;
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

/// Whether what is above a rotor pulls it in a way that K does not tell: some of it is so near that its part of K is
/// flat, or the sum of both sides is at the cap where it would rise on the way up. The ground is not asked for, and a
/// given map is taken at its word.
bool is_beyond_model(const DirectEffect& effect, const Vector3& hub_m) {
    const AeroSettings& settings = effect.settings();
    if (!settings.enabled || settings.map || effect.ceiling().is_none()) {
        return false;
    }
    // Slopes are taken over a step to either side.
    constexpr double h = simulation::slope_step_m;
    constexpr double farthest_m = 1e6;
    const double flat_m = effect.rotor_radius_m() * effect.ceiling().flat_distance();
    if (flat_m > 0 &&
        !column_is_clear(effect.scene(), hub_m, effect.rotor_radius_m(), std::min(flat_m + h, farthest_m))) {
        return true;
    }
    const auto above = effect.factors({hub_m[0], hub_m[1], hub_m[2] + h});
    const auto below = effect.factors({hub_m[0], hub_m[1], hub_m[2] - h});
    return std::max(above.total, below.total) >= settings.max_factor &&
           std::max(above.ground, below.ground) < settings.max_factor &&
           above.ground + above.ceiling > below.ground + below.ceiling;
}

bool is_within_model(const FlightModel& model, const PlanarPose& pose) {
    return simulation::all_rotors(model, pose, [&](int rotor, double x_m, double z_m) {
        return !is_beyond_model(model.effect(rotor), model.plane().to_world(x_m, model.rotor_lateral_m(rotor), z_m));
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
        find_modes(jacobian<Jacobian>(model, analysis.trim, effect), tick.tick_s, analysis.stability);
    } else {
        find_modes(jacobian<Eigen::MatrixXd>(model, analysis.trim, effect), tick.tick_s, analysis.stability);
    }
    if (!(analysis.stability.spectral_radius < 1 - radius_slack)) {
        analysis.verdict = HoldVerdict::unstable;
    } else {
        analysis.verdict = is_within_model(model, pose) ? HoldVerdict::stable : HoldVerdict::unknown;
    }
    return analysis;
}

}  // namespace downwash

#include "downwash/simulation/loop_margins.hpp"

#include <Eigen/Dense>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "downwash/base/key_error.hpp"
#include "downwash/base/numbers.hpp"
#include "downwash/dynamics/flight_step.hpp"
#include "downwash/simulation/flight_loop.hpp"
#include "downwash/simulation/hover_analysis.hpp"
#include "downwash/simulation/linear_loop.hpp"

namespace downwash {
namespace {

using simulation::LatePart;
using simulation::LinearLoops;

constexpr std::array<std::string_view, 3> input_names = {"thrust", "pitch_torque", "joint_torque"};

/// One tick, with something added to a command between controller and plant.
struct Disturbed {
    const FlightModel& model;
    const HoverTrim& trim;
    LoopInput input;

    struct Result {
        FlightState next;
        double commanded;  ///< by the controller, before anything is added
    };

    [[nodiscard]] Result operator()(const FlightState& state, double added) const {
        const PlantModel& plant = model.tick().plant;
        dynamics::DisturbedStep step{};
        if (input == LoopInput::joint_torque) {
            step.added.joint_torque_nm = added;
        } else {
            const bool is_thrust = input == LoopInput::thrust;
            dynamics::allocate(plant, is_thrust ? added : 0.0, is_thrust ? 0.0 : added, step.added.thrust_n);
        }
        simulation::FlightEffectOf calm{simulation::NoEffect{}};
        const simulation::FlightLoop loop(model.tick(), flown_world(model, nullptr), calm);
        controllers::Actuation<double> given{};
        Result result{};
        result.next = loop.quiet_tick(state, trim.reference, given, step);
        for (int i = 0; i < plant.rotor_count; ++i) {
            result.commanded += input == LoopInput::thrust         ? given.command.thrust_n[i]
                                : input == LoopInput::pitch_torque ? -plant.rotor_x_m[i] * given.command.thrust_n[i]
                                                                   : 0;
        }
        if (input == LoopInput::joint_torque) {
            result.commanded = given.command.joint_torque_nm;
        }
        return result;
    }
};

constexpr int motion_numbers = number_count<double, simulation::PastMotion<double>>;
static_assert(offsetof(dynamics::PlantState<double>, q) == 0);
static_assert(offsetof(dynamics::PlantState<double>, u) == 4 * sizeof(double));

/// The place of a number of a past motion among the numbers of a state.
int number_of_past(int age, int i) {
    constexpr int first = number_count<bool, simulation::VehicleState<bool>>;
    return age <= simulation::recent_ticks
               ? first + (age - 1) * motion_numbers + i
               : simulation::state_numbers + (age - simulation::recent_ticks - 1) * motion_numbers + i;
}

LinearLoops linearised(const Disturbed& tick) {
    constexpr double step = 1e-6;
    const simulation::WorldNumbers<double>& world = tick.model.nominal_world().numbers;
    FlightState at_rest = tick.trim.state;
    simulation::remember_older(world, at_rest.world);
    // The numbers of the vehicle come first, its motion before all others; then those of its past.
    constexpr int vehicle_numbers = number_count<double, simulation::VehicleState<double>>;
    std::vector<int> used;
    for (int i = 0; i < vehicle_numbers; ++i) {
        if (number_at<bool>(tick.trim.feeds_back, i)) {
            used.push_back(i);
        }
    }
    const auto size = static_cast<Eigen::Index>(used.size());
    const auto difference = [&](const Disturbed::Result& above, const Disturbed::Result& below, auto column) {
        for (Eigen::Index row = 0; row < size; ++row) {
            const int i = used[static_cast<std::size_t>(row)];
            column(row) = (number_at<double>(above.next, i) - number_at<double>(below.next, i)) / (2 * step);
        }
    };
    // How a tick depends on a number of the state.
    const auto column_of = [&](int i, auto&& a, double& c) {
        const auto changed = [&](double change) {
            FlightState state = at_rest;
            simulation::set_number_of(state, i, simulation::number_of(state, i) + change);
            return tick(state, 0);
        };
        const Disturbed::Result above = changed(step);
        const Disturbed::Result below = changed(-step);
        difference(above, below, [&](Eigen::Index row) -> double& { return a(row); });
        c = (above.commanded - below.commanded) / (2 * step);
    };
    LinearLoops loop{Eigen::MatrixXd(size, size), Eigen::MatrixXd(size, 1), Eigen::MatrixXd(1, size), {}};
    for (Eigen::Index column = 0; column < size; ++column) {
        column_of(used[static_cast<std::size_t>(column)], loop.a.col(column), loop.c(column));
    }
    difference(tick(at_rest, step), tick(at_rest, -step), [&](Eigen::Index row) -> double& { return loop.b(row); });
    if (world.delay_ticks > 0) {
        const int ages = simulation::recent_ticks + static_cast<int>(at_rest.world.older.size());
        for (int age = 1; age <= ages; ++age) {
            LatePart part{age, Eigen::MatrixXd(size, motion_numbers), Eigen::MatrixXd(1, motion_numbers)};
            for (int i = 0; i < motion_numbers; ++i) {
                column_of(number_of_past(age, i), part.a.col(i), part.c(i));
            }
            if (!part.a.isZero(0) || !part.c.isZero(0)) {
                loop.late.push_back(std::move(part));
            }
        }
    }
    return loop;
}

}  // namespace

std::string_view name_of(LoopInput input) {
    return input_names[static_cast<std::size_t>(input)];
}

std::array<LoopMargins, 3> loop_margins(const Robot& robot, double arm_rad) {
    AeroSettings calm;
    calm.enabled = false;
    const FlightModel model(robot, {}, std::make_shared<const Scene>(std::vector<Obstacle>{}), calm);
    const HoverAnalysis hover = analyse_hover(model, 0, 0, arm_rad);
    if (hover.verdict != HoldVerdict::stable) {
        throw_input_error("cannot hover in free air with its arm at this angle: " +
                              std::string(hover.verdict == HoldVerdict::unstable ? "the loop is unstable"
                                                                                 : name_of(hover.trim.limit)),
                          "controller");
    }
    std::array<LoopMargins, 3> margins{};
    for (const LoopInput input : all_loop_inputs) {
        margins[static_cast<std::size_t>(input)] =
            simulation::margins_of(linearised({model, hover.trim, input}), model.tick().tick_s).front();
    }
    return margins;
}

}  // namespace downwash
